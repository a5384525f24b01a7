//! Many environments that are stepped side by side.

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

/// Environments with one agent each that are stepped in one call, on all cores.
///
/// Each world behaves as it does alone: the same seeds and actions give the same numbers with any number of threads.
pub struct EnvironmentBatch {
    environments: Vec<Environment>,
    autoreset: Autoreset,
    /// Whether each world's episode was over after the last step.
    over: Vec<bool>,
}

/// The results of a step of all worlds, one row for each world.
#[derive(Clone, Debug)]
pub struct BatchSteps {
    /// The observations; for a world that began a new episode, the first of that episode.
    pub observations: Vec<f32>,
    /// The last observations of episodes that ended in this step and were followed by a new one; 0 elsewhere.
    pub last_observations: Vec<f32>,
    /// The rewards.
    pub rewards: Vec<f64>,
    /// Whether the episode ended by an event,
    pub terminated: Vec<bool>,
    /// or because the time is over.
    pub truncated: Vec<bool>,
    /// The terms of the rewards, in the order of [`RewardTerm::ALL`](super::RewardTerm::ALL).
    pub terms: Vec<TermValues>,
    /// How each episode ended, if it did.
    pub endings: Vec<Option<Ending>>,
}

impl BatchSteps {
    /// Room for the steps of `worlds` worlds with `observation_len` numbers each.
    pub fn new(worlds: usize, observation_len: usize) -> BatchSteps {
        BatchSteps {
            observations: vec![0.0; worlds * observation_len],
            last_observations: vec![0.0; worlds * observation_len],
            rewards: vec![0.0; worlds],
            terminated: vec![false; worlds],
            truncated: vec![false; worlds],
            terms: vec![TermValues::default(); worlds],
            endings: vec![None; worlds],
        }
    }

    fn rows(&mut self) -> Vec<BatchRow<'_>> {
        let length = self.observations.len() / self.rewards.len().max(1);
        let seen = self.observations.chunks_exact_mut(length).zip(self.last_observations.chunks_exact_mut(length));
        let ended = self.terminated.iter_mut().zip(&mut self.truncated).zip(&mut self.endings);
        let worth = self.rewards.iter_mut().zip(&mut self.terms);
        let rows = seen.zip(worth).zip(ended).map(|(((observation, last), (reward, terms)), ended)| {
            let ((terminated, truncated), ending) = ended;
            BatchRow { observation, last, reward, terminated, truncated, terms, ending }
        });
        rows.collect()
    }
}

/// The row of one world, to be written.
struct BatchRow<'a> {
    observation: &'a mut [f32],
    last: &'a mut [f32],
    reward: &'a mut f64,
    terminated: &'a mut bool,
    truncated: &'a mut bool,
    terms: &'a mut TermValues,
    ending: &'a mut Option<Ending>,
}

impl EnvironmentBatch {
    /// A batch of environments with equal spaces.
    ///
    /// # Errors
    /// [`EnvironmentError::Setting`] if the spaces differ, or if an environment has several agents.
    pub fn new(environments: Vec<Environment>, autoreset: Autoreset) -> Result<EnvironmentBatch, EnvironmentError> {
        let fault = |reason: &str| Err(EnvironmentError::Setting { setting: "batch", reason: reason.to_owned() });
        let Some(first) = environments.first() else { return fault("at least one world is needed") };
        let spaces = |environment: &Environment| (environment.observation_spaces(), environment.action_space());
        if environments.iter().any(|environment| environment.agents().count() != 1) {
            return fault("each world has one agent");
        }
        if environments.iter().any(|environment| spaces(environment) != spaces(first)) {
            return fault("all worlds have the same spaces");
        }
        let over = vec![false; environments.len()];
        let environments = environments.into_iter().map(Environment::without_report).collect();
        Ok(EnvironmentBatch { environments, autoreset, over })
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

    /// Steps all worlds by one decision each; `actions` holds the numbers of all worlds one after the other.
    ///
    /// # Errors
    /// [`EnvironmentError::Length`]; an invalid action, before any world has moved; or the first error of a world.
    pub fn step(&mut self, actions: &[f32], steps: &mut BatchSteps) -> Result<(), EnvironmentError> {
        let space = self.environments[0].action_space();
        let wanted = space.len() * self.environments.len();
        if actions.len() != wanted {
            return Err(EnvironmentError::Length { what: "actions of a batch", found: actions.len(), wanted });
        }
        let begins_anew = |over: bool| over && self.autoreset == Autoreset::NextStep;
        for (world, numbers) in actions.chunks_exact(space.len()).enumerate() {
            if self.over[world] && self.autoreset == Autoreset::Disabled {
                return Err(EnvironmentError::Over);
            }
            if let Some(reason) = space.fault(numbers).filter(|_| !begins_anew(self.over[world])) {
                return Err(EnvironmentError::Action { agent: format!("world {world}"), reason });
            }
        }
        let autoreset = self.autoreset;
        let worlds = self.environments.par_iter_mut().zip(&mut self.over);
        let worlds = worlds.zip(actions.par_chunks_exact(space.len())).zip(steps.rows());
        worlds
            .try_for_each(|(((environment, over), numbers), row)| step_one(environment, over, numbers, row, autoreset))
    }
}

fn step_one(
    environment: &mut Environment,
    over: &mut bool,
    numbers: &[f32],
    row: BatchRow<'_>,
    autoreset: Autoreset,
) -> Result<(), EnvironmentError> {
    if *over {
        environment.reset(None)?;
        *over = false;
        (*row.reward, *row.terminated, *row.truncated) = (0.0, false, false);
        (*row.terms, *row.ending) = (TermValues::default(), None);
        return environment.observe(0, row.observation);
    }
    environment.step(numbers)?;
    let episode = environment.episode(0);
    (*row.terminated, *row.truncated) = (episode.is_terminated(), episode.is_over() && !episode.is_terminated());
    (*row.terms, *row.ending) = (episode.terms, episode.ending);
    *row.reward = environment.reward(0);
    *over = episode.is_over();
    if *over && autoreset == Autoreset::SameStep {
        environment.observe(0, row.last)?;
        environment.reset(None)?;
        *over = false;
    }
    environment.observe(0, row.observation)
}
