//! An environment: one scenario, one world, its agents.

use std::sync::Arc;

use interplay_common::random::SplitMix64;
use interplay_planners::drivers::external;
use interplay_planners::perception::sensing::SensedScene;
use interplay_planners::{Driver, DriverKind, Planner};
use interplay_scenarios::Scenario;

use super::agent_interface::{AgentInterface, goes_on};
use super::{
    ActionSpace, DiscreteMeta, EnvironmentError, EnvironmentSettings, Episode, EpisodeStart, ObservationSpace,
    StreetDraw,
};
use crate::Simulation;
use crate::report::Report;

/// A scenario in which some vehicles are driven from outside, episode by episode.
///
/// Numbers of several agents follow one another in the order of [`Environment::agents`].
pub struct Environment {
    pub(super) scenario: Arc<Scenario>,
    pub(super) settings: Arc<EnvironmentSettings>,
    pub(super) seeds: SplitMix64,
    /// The name of the street of the episode, if streets are drawn.
    pub(super) street: Option<String>,
    /// Number of plans from one decision to the next.
    pub(super) plans_per_decision: usize,
    pub(super) seats: Vec<Seat>,
    pub(super) world: Option<Simulation>,
    pub(super) time_s: f64,
    /// How the episode began; `None` before the first.
    pub(super) episode_start: Option<EpisodeStart>,
    /// The numbers of all decisions of the episode.
    pub(super) decisions: Vec<f32>,
}

#[derive(Clone)]
pub(super) struct Seat {
    vehicle: usize,
    name: String,
    interface: AgentInterface,
    episode: Episode,
    sensed: Option<SensedScene>,
}

impl Environment {
    /// The environment of a scenario, before its first episode.
    ///
    /// # Errors
    /// [`EnvironmentError`] names the invalid setting, and what would work.
    pub fn new(scenario: &Scenario, settings: &EnvironmentSettings) -> Result<Environment, EnvironmentError> {
        if let Some(reason) = settings.streets.as_ref().and_then(StreetDraw::fault) {
            return Err(EnvironmentError::Setting { setting: "streets", reason });
        }
        let mut environment = Environment {
            scenario: Arc::new(scenario.clone()),
            settings: Arc::new(settings.clone()),
            seeds: SplitMix64::new(scenario.seed),
            street: None,
            plans_per_decision: 1,
            seats: Vec::new(),
            world: None,
            time_s: 0.0,
            episode_start: None,
            decisions: Vec::new(),
        };
        environment.play(scenario)?;
        Ok(environment)
    }

    /// Makes a scenario the one of the following episodes, with its agents driven from outside.
    fn play(&mut self, scenario: &Scenario) -> Result<(), EnvironmentError> {
        let (mut scenario, settings) = (scenario.clone().without_counterfactuals(), &self.settings);
        let agents = agents(&scenario, settings)?;
        let plan_s = scenario.step_s * scenario.ticks_per_plan as f64;
        let Some(ego) = scenario.ego() else { return Err(EnvironmentError::NoVehicles) };
        if settings.decision_s.is_some_and(|decision_s| !(decision_s > 0.0 && decision_s <= scenario.duration_s)) {
            let reason = format!("above 0 and at most the {} s of the scenario", scenario.duration_s);
            return Err(EnvironmentError::Setting { setting: "decision_s", reason });
        }
        let plans_per_decision = settings.action.plans_per_decision(settings.decision_s, &ego.body, plan_s);
        for agent in &agents {
            scenario.vehicles[*agent].driver = Driver::External(external::Settings::default());
        }
        let horizon = scenario.horizon_steps;
        let seat = |vehicle: usize| Seat {
            vehicle,
            name: scenario.vehicles[vehicle].name.clone(),
            interface: AgentInterface::new(&settings.observations, settings.action, horizon),
            episode: Episode::default(),
            sensed: None,
        };
        self.seats = agents.into_iter().map(seat).collect();
        (self.plans_per_decision, self.scenario) = (plans_per_decision, Arc::new(scenario));
        Ok(())
    }

    /// The scenario, with its agents driven from outside.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// The names of the agents' vehicles.
    pub fn agents(&self) -> impl Iterator<Item = &str> {
        self.seats.iter().map(|seat| seat.name.as_str())
    }

    /// Interval of decisions \[s\].
    pub fn decision_s(&self) -> f64 {
        self.plans_per_decision as f64 * self.scenario.step_s * self.scenario.ticks_per_plan as f64
    }

    /// The observation spaces of each agent, in order.
    pub fn observation_spaces(&self) -> Vec<ObservationSpace> {
        self.seats[0].interface.observation_spaces()
    }

    /// The action space of each agent.
    pub fn action_space(&self) -> ActionSpace {
        self.seats[0].interface.action_space()
    }

    /// What is the same in all environments that may replace each other.
    pub(super) fn spaces(&self) -> (Vec<ObservationSpace>, ActionSpace, usize) {
        (self.observation_spaces(), self.action_space(), self.seats.len())
    }

    /// The name of the street of the episode, if streets are drawn.
    pub fn street(&self) -> Option<&str> {
        self.street.as_deref()
    }

    /// Number of numbers of each agent's observation.
    pub fn observation_len(&self) -> usize {
        self.seats[0].interface.observation_len()
    }

    /// Begins an episode. A seed begins a sequence of episodes; without one, the next of the sequence follows.
    ///
    /// # Errors
    /// [`EnvironmentError::Run`] if the world cannot be built.
    pub fn reset(&mut self, seed: Option<u64>) -> Result<(), EnvironmentError> {
        if let Some(seed) = seed {
            self.seeds = SplitMix64::new(seed);
        }
        let seed = self.seeds.next_u64();
        self.begin(EpisodeStart::Drawn(seed))
    }

    /// Begins the episode of the scenario as written, with a seed of its random numbers, as `interplay run --seed` does.
    ///
    /// # Errors
    /// As [`Environment::reset`].
    pub fn reset_as_written(&mut self, seed: u64) -> Result<(), EnvironmentError> {
        self.begin(EpisodeStart::AsWritten(seed))
    }

    /// Begins an episode that depends only on its start.
    pub(super) fn begin(&mut self, start: EpisodeStart) -> Result<(), EnvironmentError> {
        let settings = Arc::clone(&self.settings);
        let (EpisodeStart::Drawn(seed) | EpisodeStart::AsWritten(seed)) = start;
        if let Some(streets) = &settings.streets {
            let (name, street) = streets.drawn(seed)?;
            let spaces = self.spaces();
            self.play(&street)?;
            if self.spaces() != spaces {
                let reason = format!("`{name}` has other spaces; choose observations and actions without a horizon");
                return Err(EnvironmentError::Setting { setting: "streets", reason });
            }
            self.street = Some(name);
        }
        let drawn = match start {
            EpisodeStart::Drawn(seed) => settings.start.drawn(&self.scenario, seed),
            EpisodeStart::AsWritten(seed) => Scenario { seed, ..(*self.scenario).clone() },
        };
        let agents = self.seats.iter().map(|seat| seat.vehicle);
        let world = Simulation::builder(&drawn).subscribed_to(settings.subscriptions(agents)).build()?;
        let (starts, horizon) = (drawn.starts(), drawn.horizon_steps);
        for seat in &mut self.seats {
            seat.interface = AgentInterface::new(&settings.observations, settings.action, horizon);
            seat.episode = Episode::begin(&drawn.vehicles[seat.vehicle], &starts[seat.vehicle]);
        }
        (self.world, self.time_s, self.episode_start) = (Some(world), 0.0, Some(start));
        self.decisions.clear();
        self.look()
    }

    /// Updates the sensed scene of every agent.
    fn look(&mut self) -> Result<(), EnvironmentError> {
        let Some(world) = &self.world else { return Err(EnvironmentError::Over) };
        let vehicles: Vec<usize> = self.seats.iter().map(|seat| seat.vehicle).collect();
        let Some(sensed) = world.observe_all(&vehicles) else { return Err(EnvironmentError::Over) };
        for (seat, sensed) in self.seats.iter_mut().zip(sensed) {
            seat.interface.look(&sensed);
            seat.sensed = Some(sensed);
        }
        Ok(())
    }

    /// Advances the world by one decision of every agent. Numbers of agents whose episode is over are ignored; their vehicles continue
    /// along their lanes.
    ///
    /// # Errors
    /// [`EnvironmentError`] if no episode is in progress or an action is invalid; then nothing has moved.
    pub fn step(&mut self, actions: &[f32]) -> Result<(), EnvironmentError> {
        self.decide(actions)?;
        // Ignored numbers of agents whose episode is over may be infinite, which no text could hold.
        self.decisions.extend(actions.iter().map(|number| if number.is_finite() { *number } else { 0.0 }));
        for _ in 0..self.plans_per_decision {
            self.hand_in()?;
            let is_over = self.step_to_next_plan()?;
            self.look()?;
            if is_over || !self.is_live() {
                break;
            }
        }
        Ok(())
    }

    fn decide(&mut self, actions: &[f32]) -> Result<(), EnvironmentError> {
        if !self.is_live() {
            return Err(EnvironmentError::Over);
        }
        let (each, wanted) = (self.action_space(), self.action_space().len() * self.seats.len());
        if actions.len() != wanted {
            return Err(EnvironmentError::Length { what: "actions", found: actions.len(), wanted });
        }
        let live =
            || self.seats.iter().zip(actions.chunks_exact(each.len())).filter(|(seat, _)| !seat.episode.is_over());
        for (seat, numbers) in live() {
            if let Some(reason) = each.fault(numbers) {
                return Err(EnvironmentError::Action { agent: seat.name.clone(), reason });
            }
        }
        for (seat, numbers) in self.seats.iter_mut().zip(actions.chunks_exact(each.len())) {
            let is_over = seat.episode.is_over();
            seat.episode.begin_decision();
            if let (false, Some(sensed)) = (is_over, &seat.sensed) {
                let decided = seat.interface.decide(&sensed.scene, numbers);
                decided.map_err(|reason| EnvironmentError::Action { agent: seat.name.clone(), reason })?;
            }
        }
        Ok(())
    }

    fn hand_in(&mut self) -> Result<(), EnvironmentError> {
        let Some(world) = &mut self.world else { return Err(EnvironmentError::Over) };
        for seat in &mut self.seats {
            let Some(sensed) = &seat.sensed else { continue };
            let handed_in =
                if seat.episode.is_over() { goes_on(&sensed.scene) } else { seat.interface.handed_in(&sensed.scene) };
            world.hand_in(&seat.name, handed_in)?;
        }
        Ok(())
    }

    /// Steps the world until the vehicles plan again, including steps of a building in between. Returns whether the time is over.
    fn step_to_next_plan(&mut self) -> Result<bool, EnvironmentError> {
        let Some(world) = &mut self.world else { return Err(EnvironmentError::Over) };
        let mut ticks = 0;
        while ticks < self.scenario.ticks_per_plan && world.vehicles_move_again() {
            world.step()?;
            let (measures, frame) = (world.measures(), world.frame());
            let Some(frame) = frame.filter(|frame| !frame.vehicles.is_empty()) else { continue };
            ticks += 1;
            for seat in self.seats.iter_mut().filter(|seat| !seat.episode.is_over()) {
                seat.episode.observe(world.scenario(), seat.vehicle, measures, frame);
            }
        }
        self.time_s += ticks as f64 * self.scenario.step_s;
        let is_over = !world.vehicles_move_again();
        if is_over {
            self.seats.iter_mut().for_each(|seat| seat.episode.time_is_over());
        }
        Ok(is_over)
    }

    /// Simulated time of the vehicles since the episode began \[s\].
    pub fn time_s(&self) -> f64 {
        self.time_s
    }

    /// Whether any agent's episode is in progress.
    pub fn is_live(&self) -> bool {
        self.world.is_some() && self.seats.iter().any(|seat| !seat.episode.is_over())
    }

    /// The episode of an agent.
    pub fn episode(&self, agent: usize) -> &Episode {
        &self.seats[agent].episode
    }

    /// The reward of an agent for the last decision.
    pub fn reward(&self, agent: usize) -> f64 {
        self.settings.reward.sum(&self.seats[agent].episode.terms)
    }

    /// Writes the observation of an agent; `out` has [`Environment::observation_len`] numbers.
    ///
    /// # Errors
    /// [`EnvironmentError::Over`] before the first episode; [`EnvironmentError::Length`].
    pub fn observe(&self, agent: usize, out: &mut [f32]) -> Result<(), EnvironmentError> {
        let wanted = self.observation_len();
        if out.len() != wanted {
            return Err(EnvironmentError::Length { what: "an observation", found: out.len(), wanted });
        }
        let seat = &self.seats[agent];
        let Some(sensed) = &seat.sensed else { return Err(EnvironmentError::Over) };
        seat.interface.observe(&sensed.scene, out);
        Ok(())
    }

    /// The meta-actions that are possible for an agent now; `None` with other actions, or before the first episode.
    pub fn action_mask(&self, agent: usize) -> Option<[bool; DiscreteMeta::COUNT]> {
        let seat = &self.seats[agent];
        seat.interface.action_mask(&seat.sensed.as_ref()?.scene)
    }

    /// A planner of one of Interplay's kinds for an agent; it senses and infers as in a run with that driver.
    pub fn planner(&self, agent: usize, kind: &dyn DriverKind) -> Planner {
        let stated = &self.scenario.vehicles[self.seats[agent].vehicle];
        Planner::new(kind, &stated.inference.unwrap_or_default())
    }

    /// The present action of one of Interplay's planners for an agent. It plans in the agent's sensed scene, and brakes
    /// if it finds no plan.
    ///
    /// # Errors
    /// [`EnvironmentError::Over`] before the first episode.
    pub fn action_of(&self, agent: usize, planner: &mut Planner) -> Result<Vec<f32>, EnvironmentError> {
        let seat = &self.seats[agent];
        let Some(sensed) = &seat.sensed else { return Err(EnvironmentError::Over) };
        let plan = planner.plan_sensed(sensed).unwrap_or_else(|_| super::agent_interface::braking(&sensed.scene));
        Ok(seat.interface.numbers_of(&sensed.scene, &plan))
    }

    /// The world of the episode; `None` before the first.
    pub fn world(&self) -> Option<&Simulation> {
        self.world.as_ref()
    }

    /// Ends the episode and returns its report; `None` before the first.
    ///
    /// # Errors
    /// [`EnvironmentError::Run`] if a watcher failed.
    pub fn finish(&mut self) -> Result<Option<Report>, EnvironmentError> {
        self.episode_start = None;
        self.decisions.clear();
        Ok(self.world.take().map(Simulation::finish).transpose()?)
    }
}

/// The indices of the agents' vehicles; by default, the ego.
fn agents(scenario: &Scenario, settings: &EnvironmentSettings) -> Result<Vec<usize>, EnvironmentError> {
    let fault = |setting, reason| Err(EnvironmentError::Setting { setting, reason });
    if scenario.vehicles.is_empty() {
        return Err(EnvironmentError::NoVehicles);
    }
    if settings.observations.is_empty() {
        return fault("observations", "at least one is needed".to_owned());
    }
    if let Some(reason) = settings.observations.iter().find_map(|observation| observation.fault()) {
        return fault("observations", reason);
    }
    let weights = settings.reward.to_array();
    let jitter = [settings.start.position_m, settings.start.speed_mps].into_iter().flatten();
    let drawn = jitter.chain(settings.start.safety_weights.iter().flatten().copied());
    if !weights.iter().all(|weight| weight.is_finite()) {
        return fault("reward", "every weight is a finite number".to_owned());
    }
    if !drawn.into_iter().all(|amount| amount.is_finite() && amount >= 0.0) {
        return fault("start", "every number is finite and not negative".to_owned());
    }
    let drivable = |index: &usize| {
        let vehicle = &scenario.vehicles[*index];
        vehicle.obstacle.is_none() && vehicle.driver.can_be_replaced()
    };
    let mut agents = Vec::new();
    for name in &settings.agents {
        match scenario.index_of(name).filter(drivable) {
            Some(index) if !agents.contains(&index) => agents.push(index),
            Some(_) => return fault("agents", format!("`{name}` is named twice")),
            None => {
                let names = (0..scenario.vehicles.len()).filter(drivable);
                let names: Vec<&str> = names.map(|index| scenario.vehicles[index].name.as_str()).collect();
                return fault(
                    "agents",
                    format!("`{name}` is not a vehicle that can be driven; choose from {}", names.join(", ")),
                );
            }
        }
    }
    Ok(if agents.is_empty() { vec![scenario.ego_index()] } else { agents })
}
