//! A scenario as an environment for reinforcement learning: episodes, observations, actions and rewards.
//!
//! ```text
//! reset(seed) -> observation;   step(actions) -> observation, terms of the reward, terminated, truncated
//! ```
//!
//! An [`Environment`] is a loop over [`Simulation::step`](crate::Simulation::step) in which some vehicles, its agents, are driven from
//! outside; all other vehicles keep the scenario's drivers. An [`EnvironmentBatch`] steps many of them on all cores. A [`Policy`] works in
//! the opposite direction: an agent that was trained in an environment drives a vehicle in any run ([`PolicyDriver`]).
//!
//! ```
//! use interplay_simulation::environment::{Environment, EnvironmentSettings};
//!
//! let scenario = interplay_scenarios::load("lane-change/front-nice", &[])?;
//! let mut environment = Environment::new(&scenario, &EnvironmentSettings::default())?;
//! environment.reset(Some(1))?;
//! while environment.is_live() {
//!     environment.step(&[0.0, 0.0])?;
//! }
//! assert!(environment.episode(0).is_over());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod action;
mod agent_interface;
mod batch;
mod copies;
mod episode;
mod error;
mod network;
mod observation;
mod reward;
mod start;
mod streets;
#[cfg(test)]
mod tests;
mod world;

pub use action::{Action, ActionSpace, DiscreteMeta};
pub use agent_interface::{AgentInterface, Policy, PolicyDriver, PolicyError};
pub use batch::{Autoreset, BatchSteps, EnvironmentBatch};
pub use copies::SavedEpisode;
pub use episode::{Ending, Episode};
pub use error::EnvironmentError;
pub use network::{NetworkPolicy, RegisterPolicies};
pub use observation::{
    AgentView, BeliefView, ForeignView, Kinematics, LaneView, ObservationKind, ObservationSpace, OccupancyGrid,
    PlanView,
};
pub use reward::{EnvironmentSettings, RewardTerm, RewardWeights};
pub use start::{EpisodeStart, StartDraw};
pub use streets::StreetDraw;
pub use world::Environment;
