//! Builds a simulation with systems, state and watchers of the caller.

use std::sync::Arc;
use std::time::Instant;

use bevy_ecs::prelude::*;
use interplay_scenarios::Scenario;

use super::Simulation;
use super::extensions::Extensions;
use super::saved_run::Course;
use crate::measure::Subscriptions;
use crate::phases::Slot;
use crate::phases::time_points::TimePoints;
use crate::phases::watch::Watcher;
use crate::simulation::run_error::RunError;
use crate::simulation::world_state::WorldState;
use crate::state::components::DecidingThreads;

/// Builds a [`Simulation`] to which a caller adds systems, state and watchers.
///
/// ```
/// use bevy_ecs::prelude::*;
/// use interplay_simulation::phases::{Phase, Slot};
/// use interplay_simulation::{Simulation, components::CurrentTraffic};
///
/// #[derive(Resource, Clone, Default)]
/// struct PeakSpeed(f64);
///
/// fn find_peak(traffic: Res<CurrentTraffic>, mut peak: ResMut<PeakSpeed>) {
///     let speeds_mps = traffic.0.road_users.iter().map(|user| user.agent.state.speed_mps);
///     peak.0 = speeds_mps.fold(peak.0, f64::max);
/// }
///
/// let scenario = interplay_scenarios::load("lane-change/front-nice", &[])?;
/// let mut simulation = Simulation::builder(&scenario)
///     .with_state(PeakSpeed::default(), PeakSpeed::clone)
///     .with_system(Slot::After(Phase::Physics), find_peak)
///     .build()?;
/// simulation.advance_to(2.0)?;
/// assert!(simulation.state::<PeakSpeed>().is_some_and(|peak| peak.0 > 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct SimulationBuilder<'a> {
    name: String,
    scenario: &'a Scenario,
    watchers: Vec<Box<dyn Watcher>>,
    subscriptions: Subscriptions,
    threads: usize,
    extensions: Extensions,
    initial: World,
}

impl Simulation {
    /// Begins to build a simulation of `scenario`; its report is named after the scenario's title.
    pub fn builder(scenario: &Scenario) -> SimulationBuilder<'_> {
        SimulationBuilder {
            name: scenario.title.clone(),
            scenario,
            watchers: Vec::new(),
            subscriptions: Subscriptions::everything(),
            threads: 1,
            extensions: Extensions::default(),
            initial: World::new(),
        }
    }
}

impl SimulationBuilder<'_> {
    /// Sets the name of the run in its report.
    #[must_use]
    pub fn with_name(mut self, name: &str) -> Self {
        name.clone_into(&mut self.name);
        self
    }

    /// Adds watchers that receive every tick.
    #[must_use]
    pub fn with_watchers(mut self, watchers: Vec<Box<dyn Watcher>>) -> Self {
        self.watchers.extend(watchers);
        self
    }

    /// Measures only what these subscriptions name.
    #[must_use]
    pub fn subscribed_to(mut self, subscriptions: Subscriptions) -> Self {
        self.subscriptions = subscriptions;
        self
    }

    /// Lets vehicles decide on several threads where their decisions do not depend on each other. The run has the same bits with any
    /// number; with 1, which is the default, everything happens on the thread of the caller.
    #[must_use]
    pub fn with_threads(mut self, threads: usize) -> Self {
        self.threads = threads;
        self
    }

    /// Adds a system that runs between two phases, at every time point.
    ///
    /// Two systems in one slot are an error if one writes data that the other accesses: put them into two slots, or combine
    /// them by [`pipe`](IntoSystem::pipe). A system keeps its state in resources that [`SimulationBuilder::with_state`] registers;
    /// a snapshot refuses a system with a [`Local`], and does not contain state that a closure captures and changes.
    #[must_use]
    pub fn with_system<S, M>(mut self, slot: Slot, system: S) -> Self
    where
        S: IntoSystem<(), (), M> + Clone + Send + Sync + 'static,
        M: 'static,
    {
        self.extensions.add_system(slot, system);
        self
    }

    /// Adds a resource for additional systems; `fork` makes the copy that a snapshot holds.
    #[must_use]
    pub fn with_state<T: Resource>(mut self, initial: T, fork: impl Fn(&T) -> T + Send + Sync + 'static) -> Self {
        self.initial.insert_resource(initial);
        self.extensions.add_state(fork);
        self
    }

    /// Builds the world before its first tick.
    ///
    /// # Errors
    /// [`RunError::Building`] if the scenario's building cannot be built; [`RunError::Loop`] if the order of two systems is ambiguous;
    /// [`RunError::Threads`] if the system has no threads; [`RunError::UnknownState`] if a system names a component or resource that the
    /// world does not have.
    pub fn build(self) -> Result<Simulation, RunError> {
        let began = Instant::now();
        let SimulationBuilder { name, scenario, watchers, subscriptions, threads, extensions, initial } = self;
        let mut world = WorldState::initial(scenario, &subscriptions)?.into_world(watchers);
        if threads > 1 {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            world.insert_resource(DecidingThreads(Some(Arc::new(pool.map_err(RunError::Threads)?))));
        }
        extensions.copy_states(&initial, &mut world);
        let course = Course {
            name,
            scenario: Arc::new(scenario.clone()),
            time_points: TimePoints::new(scenario),
            inputs: Vec::new(),
            replaced: Vec::new(),
            extensions,
        };
        let mut simulation = Simulation::assembled(course, world)?;
        simulation.wall_s = began.elapsed().as_secs_f64();
        Ok(simulation)
    }
}
