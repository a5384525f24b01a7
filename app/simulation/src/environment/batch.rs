//! Many environments that are stepped side by side.

use std::sync::Arc;

use rayon::prelude::*;

use super::reward::TermValues;
use super::{Ending, Environment, EnvironmentError};

/// What a batch does with a world whose episode is over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Autoreset {
    /// The next step begins a new episode instead; it ignores the action and has the reward 0.
    #[default]
    NextStep,
    /// The same step begins a new episode; it returns the last observation of the old episode and the first of the new one.
    SameStep,
    /// Nothing: the caller resets the world.
    Disabled,
}

/// Environments that are stepped in one call, on all cores; each has the same number of agents.
///
/// Each world behaves as it does alone: the same seeds and actions give the same numbers with any number of threads.
pub struct EnvironmentBatch {
    environments: Vec<Environment>,
    autoreset: Autoreset,
    /// Number of agents of each world.
    agents: usize,
    /// Whether the episodes of all agents of each world were over after the last step.
    over: Vec<bool>,
}

/// The results of a step of all worlds: a row for each agent, all agents of the first world first.
#[derive(Clone, Debug)]
pub struct BatchSteps {
    /// The observations; in a world that began a new episode, the first of that episode.
    pub observations: Vec<f32>,
    /// The last observations in worlds whose episode ended in this step and was followed by a new one; 0 elsewhere.
    pub last_observations: Vec<f32>,
    /// The rewards.
    pub rewards: Vec<f64>,
    /// Whether the agent's episode ended in this step by an event,
    pub terminated: Vec<bool>,
    /// or because the time is over.
    pub truncated: Vec<bool>,
    /// The terms of the rewards, in the order of [`RewardTerm::ALL`](super::RewardTerm::ALL).
    pub terms: Vec<TermValues>,
    /// How the agent's episode ended in this step, if it did.
    pub endings: Vec<Option<Ending>>,
    /// Whether the agent's episode goes on, so that its next action counts.
    pub present: Vec<bool>,
}

impl BatchSteps {
    /// Room for the steps of `rows` agents with `observation_len` numbers each.
    pub fn new(rows: usize, observation_len: usize) -> BatchSteps {
        BatchSteps {
            observations: vec![0.0; rows * observation_len],
            last_observations: vec![0.0; rows * observation_len],
            rewards: vec![0.0; rows],
            terminated: vec![false; rows],
            truncated: vec![false; rows],
            terms: vec![TermValues::default(); rows],
            endings: vec![None; rows],
            present: vec![false; rows],
        }
    }

    /// The rows of each world with this number of agents.
    fn worlds(&mut self, agents: usize) -> Vec<WorldRows<'_>> {
        let length = agents * (self.observations.len() / self.rewards.len().max(1));
        let seen = self.observations.chunks_exact_mut(length).zip(self.last_observations.chunks_exact_mut(length));
        let ended = self.terminated.chunks_exact_mut(agents).zip(self.truncated.chunks_exact_mut(agents));
        let ended = ended.zip(self.endings.chunks_exact_mut(agents)).zip(self.present.chunks_exact_mut(agents));
        let worth = self.rewards.chunks_exact_mut(agents).zip(self.terms.chunks_exact_mut(agents));
        let rows = seen.zip(worth).zip(ended).map(|(((observations, last), (rewards, terms)), ended)| {
            let (((terminated, truncated), endings), present) = ended;
            WorldRows { observations, last, rewards, terminated, truncated, terms, endings, present }
        });
        rows.collect()
    }
}

/// The rows of one world, to be written.
struct WorldRows<'a> {
    observations: &'a mut [f32],
    last: &'a mut [f32],
    rewards: &'a mut [f64],
    terminated: &'a mut [bool],
    truncated: &'a mut [bool],
    terms: &'a mut [TermValues],
    endings: &'a mut [Option<Ending>],
    present: &'a mut [bool],
}

impl EnvironmentBatch {
    /// A batch of environments with equal spaces and numbers of agents.
    ///
    /// # Errors
    /// [`EnvironmentError::Setting`] if they differ.
    pub fn new(environments: Vec<Environment>, autoreset: Autoreset) -> Result<EnvironmentBatch, EnvironmentError> {
        let fault = |reason: &str| Err(EnvironmentError::Setting { setting: "batch", reason: reason.to_owned() });
        let Some(first) = environments.first() else { return fault("at least one world is needed") };
        if environments.iter().any(|environment| environment.spaces() != first.spaces()) {
            return fault("all worlds have the same spaces and the same number of agents");
        }
        let (agents, over) = (first.agents().count(), vec![false; environments.len()]);
        let without_report = |mut environment: Environment| {
            Arc::make_mut(&mut environment.settings).report = false;
            environment
        };
        let environments = environments.into_iter().map(without_report).collect();
        Ok(EnvironmentBatch { environments, autoreset, agents, over })
    }

    /// Number of agents of each world.
    pub fn agents(&self) -> usize {
        self.agents
    }

    /// The environments.
    pub fn environments(&self) -> &[Environment] {
        &self.environments
    }

    /// Begins episodes in all worlds that `which` selects, each with its seed, or with the next one of its own sequence.
    ///
    /// # Errors
    /// The first error of a world.
    pub fn reset(&mut self, seeds: &[Option<u64>], which: &[bool]) -> Result<(), EnvironmentError> {
        let worlds = self.environments.par_iter_mut().zip(&mut self.over).zip(seeds.par_iter().zip(which));
        worlds.filter(|(_, (_, is_reset))| **is_reset).try_for_each(|((environment, over), (seed, _))| {
            *over = false;
            environment.reset(*seed)
        })
    }

    /// Steps all worlds by one decision each; `actions` holds the numbers of all agents, those of the first world first.
    ///
    /// # Errors
    /// [`EnvironmentError::Length`]; an invalid action, before any world has moved; or the first error of a world.
    pub fn step(&mut self, actions: &[f32], steps: &mut BatchSteps) -> Result<(), EnvironmentError> {
        let (space, agents) = (self.environments[0].action_space(), self.agents);
        let each = space.len() * agents;
        let wanted = each * self.environments.len();
        if actions.len() != wanted {
            return Err(EnvironmentError::Length { what: "actions of a batch", found: actions.len(), wanted });
        }
        for (world, numbers) in actions.chunks_exact(each).enumerate() {
            if self.over[world] {
                if self.autoreset == Autoreset::Disabled {
                    return Err(EnvironmentError::Over);
                }
                continue;
            }
            for (agent, numbers) in numbers.chunks_exact(space.len()).enumerate() {
                let is_over = self.environments[world].episode(agent).is_over();
                if let Some(reason) = space.fault(numbers).filter(|_| !is_over) {
                    return Err(EnvironmentError::Action { agent: format!("world {world}"), reason });
                }
            }
        }
        let autoreset = self.autoreset;
        let worlds = self.environments.par_iter_mut().zip(&mut self.over);
        let worlds = worlds.zip(actions.par_chunks_exact(each)).zip(steps.worlds(agents));
        worlds.try_for_each(|(((environment, over), numbers), rows)| {
            step_one(environment, over, numbers, rows, autoreset)
        })
    }
}

fn step_one(
    environment: &mut Environment,
    over: &mut bool,
    numbers: &[f32],
    rows: WorldRows<'_>,
    autoreset: Autoreset,
) -> Result<(), EnvironmentError> {
    if *over {
        environment.reset(None)?;
        *over = false;
        rows.present.fill(true);
        return observe_all(environment, rows.observations);
    }
    let before: Vec<bool> = (0..rows.rewards.len()).map(|agent| environment.episode(agent).is_over()).collect();
    environment.step(numbers)?;
    for (agent, was_over) in before.into_iter().enumerate() {
        let episode = environment.episode(agent);
        rows.present[agent] = !episode.is_over();
        if was_over {
            continue;
        }
        (rows.terms[agent], rows.endings[agent]) = (episode.terms, episode.ending);
        rows.terminated[agent] = episode.is_terminated();
        rows.truncated[agent] = episode.is_over() && !episode.is_terminated();
        rows.rewards[agent] = environment.reward(agent);
    }
    *over = !environment.is_live();
    if *over && autoreset == Autoreset::SameStep {
        observe_all(environment, rows.last)?;
        environment.reset(None)?;
        *over = false;
        rows.present.fill(true);
    }
    observe_all(environment, rows.observations)
}

/// Writes the observations of all agents of a world.
fn observe_all(environment: &Environment, out: &mut [f32]) -> Result<(), EnvironmentError> {
    let mut each = out.chunks_exact_mut(environment.observation_len()).enumerate();
    each.try_for_each(|(agent, out)| environment.observe(agent, out))
}
