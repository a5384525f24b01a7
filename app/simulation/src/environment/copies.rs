//! Copies of environments in the middle of an episode, and episodes as text.
//!
//! A copy in memory has all state, and costs about as much as a step. As text an episode is its start and its decisions, from which the same
//! environment repeats it up to the same decision; reading it takes as long as the episode took.

use std::sync::Arc;

use interplay_common::random::SplitMix64;
use serde::{Deserialize, Serialize};

use super::{Environment, EnvironmentError, EpisodeStart};
use crate::Simulation;

/// An episode up to a decision, as text.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedEpisode {
    /// State of the sequence of episodes.
    sequence: u64,
    /// How the episode began; `None` before the first.
    start: Option<EpisodeStart>,
    /// The numbers of all decisions, as their bits.
    decisions: Vec<u32>,
    /// Digest of all states, which proves that a repeated episode is the same.
    digest: String,
}

impl Environment {
    /// A copy that continues on its own, with the same numbers for the same actions.
    ///
    /// # Errors
    /// [`EnvironmentError::Run`] if a driver or a building cannot be copied.
    pub fn fork(&self) -> Result<Environment, EnvironmentError> {
        Ok(Environment {
            scenario: Arc::clone(&self.scenario),
            settings: Arc::clone(&self.settings),
            seeds: self.seeds.clone(),
            street: self.street.clone(),
            plans_per_decision: self.plans_per_decision,
            seats: self.seats.clone(),
            world: self.world.as_ref().map(Simulation::fork).transpose()?,
            time_s: self.time_s,
            episode_start: self.episode_start,
            decisions: self.decisions.clone(),
        })
    }

    /// The episode so far as text, for [`Environment::repeat`] of an environment with the same scenario and settings.
    pub fn saved(&self) -> SavedEpisode {
        SavedEpisode {
            sequence: self.seeds.state(),
            start: self.episode_start,
            decisions: self.decisions.iter().map(|number| number.to_bits()).collect(),
            digest: self.digest(),
        }
    }

    /// Repeats a saved episode up to its last decision.
    ///
    /// # Errors
    /// [`EnvironmentError::OtherEpisode`] if it reaches other states; otherwise as [`Environment::step`].
    pub fn repeat(&mut self, saved: &SavedEpisode) -> Result<(), EnvironmentError> {
        self.seeds = SplitMix64::new(saved.sequence);
        let Some(start) = saved.start else { return Ok(()) };
        self.begin(start)?;
        let numbers: Vec<f32> = saved.decisions.iter().map(|bits| f32::from_bits(*bits)).collect();
        for actions in numbers.chunks(self.action_space().len() * self.seats.len()) {
            self.step(actions)?;
        }
        if self.digest() == saved.digest { Ok(()) } else { Err(EnvironmentError::OtherEpisode) }
    }

    fn digest(&self) -> String {
        self.world.as_ref().map(|world| world.measures().digest.phases().physics).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{AgentView, BeliefView, EnvironmentSettings, Kinematics, StreetDraw};
    use super::*;

    fn environment(streets: Option<StreetDraw>) -> Environment {
        let scenario = interplay_scenarios::load("lane-change/front-nice", &[]).expect("authored");
        let observations = vec![AgentView::Kinematics(Kinematics::default()), AgentView::Belief(BeliefView::default())];
        let settings = EnvironmentSettings { observations, streets, ..EnvironmentSettings::default() };
        Environment::new(&scenario, &settings).expect("an environment")
    }

    /// The observation, the bits of the reward, and the digest after each of some steps.
    fn steps(environment: &mut Environment, count: usize) -> Vec<(Vec<f32>, u64, String)> {
        let step = |index: usize| {
            environment.step(&[(index % 3) as f32 / 4.0 - 0.2, 0.01]).expect("a step");
            let mut seen = vec![0.0; environment.observation_len()];
            environment.observe(0, &mut seen).expect("an observation");
            (seen, environment.reward(0).to_bits(), environment.digest())
        };
        (0..count).map(step).collect()
    }

    #[test]
    fn copies_in_mid_episode_continue_with_equal_bits() {
        for streets in [None, Some(StreetDraw::default())] {
            let mut original = environment(streets.clone());
            original.reset(Some(4)).expect("an episode");
            steps(&mut original, 5);
            let mut fork = original.fork().expect("a copy");
            let text = serde_json::to_string(&original.saved()).expect("text");
            let expected = steps(&mut original, 4);
            assert_eq!(steps(&mut fork, 4), expected);
            let mut repeated = environment(streets);
            repeated.repeat(&serde_json::from_str(&text).expect("read")).expect("repeated");
            assert_eq!(steps(&mut repeated, 4), expected);
            let next = [original, fork, repeated].map(|mut environment| {
                environment.reset(None).expect("the next episode");
                steps(&mut environment, 2)
            });
            assert!(next.iter().all(|after| *after == next[0]));
        }
    }

    #[test]
    fn an_episode_that_goes_otherwise_is_refused() {
        let mut original = environment(None);
        original.reset(Some(4)).expect("an episode");
        steps(&mut original, 3);
        let mut saved = original.saved();
        saved.decisions[0] = 0.9_f32.to_bits();
        assert!(matches!(environment(None).repeat(&saved), Err(EnvironmentError::OtherEpisode)));
    }
}
