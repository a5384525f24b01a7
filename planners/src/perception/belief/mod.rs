//! What a driver believes of the others' drivers, and what it expects them to do.
//!
//! A driver with `prediction = "inferred"` knows no other plan. Of each vehicle that it sees it asks which of a list of
//! drivers would move like that:
//!
//! - our human driver, with a safety weight of 0, 8 or 50 and one of several wishes
//!   ([`DriverModel`](crate::scene::driver_estimate::DriverModel), `wishes`);
//! - the intelligent driver model;
//! - none of these: constant velocity with large errors.
//!
//! At every sighting the hypotheses' plans of the sighting before are compared with the motion since then (`likelihood`), and the
//! evidence is accumulated, forgotten, and bounded (`evidence`). Then each hypothesis plans anew, in the scene that the observed
//! driver sees: the observer with its real plan, and the others with what is expected of them (`hypotheses`). From the front
//! of the road to its rear, each driver knows what is expected of those ahead, as the drivers themselves do.
//!
//! The prediction of a vehicle is the plan of the likeliest kind of driver with its likeliest wish. Another hypothesis replaces it
//! only where it is by a factor likelier, so that the prediction does not flicker. An average of plans would be the plan of no driver.
//!
//! **Delay.** The last sighting may be some ticks old. The chosen driver then lives through these ticks again: it is shown what the
//! observer really did, plans, and moves on. A shifted plan would ignore how it has answered meanwhile.
//!
//! **Work.** Each sighting poses at most eleven problems per vehicle, however many wishes there are: the chosen wish and
//! the likeliest other one are always planned for, the rest in turn. Where no vehicle is in the way all styles share one plan, and
//! where tough and nice nearly coincide the normal driver has no plan of its own.

pub mod diagnostics;
mod evidence;
mod hypotheses;
mod likelihood;
mod observed_driver;
mod settings;
mod wishes;

use std::sync::Arc;

pub use settings::{Prior, Settings, StyleOdds};

use std::collections::VecDeque;

use crate::perception::sensing::{SensedScene, Sighting};
use crate::prediction::steadily_along;
use crate::scene::driver_estimate::DriverEstimate;
use crate::scene::inferred_futures::Alternative;
use crate::{Agent, Diagnostic, PlanEvent, Scene, Trajectory};
use observed_driver::{ObservedDriver, later};

/// The beliefs of one driver about all others.
#[derive(Clone, Debug)]
pub struct DriverBeliefs {
    settings: Settings,
    observed: Vec<ObservedDriver>,
    /// The observing vehicle at each tick since the oldest sighting.
    own: VecDeque<(usize, Agent)>,
}

/// A scene with predictions that are inferred from observed motions, and the beliefs behind them.
#[derive(Clone, Debug, PartialEq)]
pub struct InferredScene {
    /// The scene with the predictions that follow from the beliefs.
    pub scene: Scene,
    /// The belief about the driver of each other vehicle, in the order of the scene.
    pub estimates: Vec<DriverEstimate>,
    /// The belief about the nearest vehicle that the observer may meet, as numbers.
    pub diagnostics: Vec<Diagnostic>,
    /// An event for each driver whose likeliest kind has changed.
    pub events: Vec<PlanEvent>,
}

impl DriverBeliefs {
    /// What each of the others may do, in the order of the scene that [`DriverBeliefs::infer`] returned for `sensed`. A plan is as
    /// old as the last sighting, and is moved on by as many steps.
    pub fn alternatives(&self, sensed: &SensedScene, inferred: &Scene) -> Vec<Vec<Alternative>> {
        let others = inferred.others.iter().zip(&sensed.sightings).map(|(other, sighting)| {
            let driver = self.observed.iter().find(|driver| driver.name == other.name);
            let age = sensed.scene.tick.saturating_sub(sighting.tick);
            let motion = |plan: &Trajectory| if age == 0 { plan.clone() } else { later(plan, age, &other.state) };
            driver.map_or_else(Vec::new, |driver| driver.alternatives(motion))
        });
        others.collect()
    }

    /// Beliefs before any driver was observed.
    pub fn new(settings: Settings) -> DriverBeliefs {
        DriverBeliefs { settings, observed: Vec::new(), own: VecDeque::new() }
    }

    /// Updates the beliefs with one observation of all others, and predicts their motions. Call it once a tick.
    pub fn infer(&mut self, sensed: &SensedScene) -> InferredScene {
        let SensedScene { scene, sightings } = sensed;
        self.own.push_back((scene.tick, scene.ego.clone()));
        let oldest = sightings.iter().map(|sighting| sighting.tick).min().unwrap_or(scene.tick);
        while self.own.get(1).is_some_and(|(tick, _)| *tick <= oldest) {
            self.own.pop_front();
        }
        self.keep_those_in_sight(scene);
        let mut events = Vec::new();
        let places: Vec<usize> =
            scene.others.iter().zip(sightings).map(|(other, sighting)| self.place(other, sighting, scene)).collect();
        let fresh: Vec<bool> = places
            .iter()
            .zip(sightings)
            .map(|(place, sighting)| self.observed[*place].last.is_none_or(|last| last.tick < sighting.tick))
            .collect();
        for (index, other) in scene.others.iter().enumerate().filter(|(index, _)| fresh[*index]) {
            let driver = &mut self.observed[places[index]];
            let (before, is_first) = (driver.model, driver.last.is_none());
            driver.observe(other, &sightings[index], scene.step_s);
            if before != driver.model || is_first {
                events.push(PlanEvent::note(format!("takes {} for {}", other.name, driver.model.name())));
            }
        }
        let mut then: Vec<Agent> = (0..places.len())
            .map(|index| self.as_sighted(&scene.others[index], &sightings[index], places[index], scene))
            .collect();
        for index in from_front_to_rear(&then) {
            if fresh[index] {
                let mut seen = self.seen_by(index, sightings[index].tick, &then, scene);
                self.observed[places[index]].plan(&mut seen, &sightings[index]);
            }
            if let Some(plan) = self.observed[places[index]].selected_plan() {
                then[index].prediction = Arc::new(plan.clone());
            }
        }
        let now = (0..places.len()).map(|index| self.present(index, places[index], &sightings[index], &then, scene));
        let others: Vec<Agent> = now.collect();
        let estimates: Vec<DriverEstimate> = places
            .iter()
            .map(|place| &self.observed[*place])
            .map(|driver| DriverEstimate::new(&driver.name, driver.model, driver.probabilities()))
            .collect();
        let scene = Scene { others, ..scene.clone() };
        let diagnostics = nearest(&scene).map_or_else(Vec::new, |index| diagnostics::report(&estimates[index]));
        InferredScene { scene, estimates, diagnostics, events }
    }

    /// Forgets who is out of sight, or with a memory only where it was.
    fn keep_those_in_sight(&mut self, scene: &Scene) {
        let is_seen = |driver: &ObservedDriver| scene.others.iter().any(|other| other.name == driver.name);
        if !self.settings.memory {
            self.observed.retain(is_seen);
        }
        self.observed.iter_mut().filter(|driver| !is_seen(driver)).for_each(ObservedDriver::lose_sight);
    }

    /// Where the belief about a vehicle is kept; begins one for a vehicle that is seen for the first time.
    fn place(&mut self, other: &Agent, sighting: &Sighting, scene: &Scene) -> usize {
        let known = self.observed.iter().position(|driver| driver.name == other.name);
        known.unwrap_or_else(|| {
            self.observed.push(ObservedDriver::new(other, sighting, scene, self.settings));
            self.observed.len() - 1
        })
    }

    /// A vehicle as it was when it was sighted, expected to go on as it was expected to a sighting before.
    fn as_sighted(&self, other: &Agent, sighting: &Sighting, place: usize, scene: &Scene) -> Agent {
        let driver = &self.observed[place];
        let passed = driver.last.map(|last| sighting.tick - last.tick);
        let expected = passed.zip(driver.selected_plan()).map(|(ticks, plan)| later(plan, ticks, &sighting.estimate));
        let steady = || steadily_along(&other.route, &other.body, &sighting.estimate, scene.horizon, scene.step_s);
        Agent {
            state: sighting.estimate,
            previous_input: driver.input,
            prediction: Arc::new(expected.unwrap_or_else(steady)),
            can_be_asked: driver.model.can_be_asked(),
            ..other.clone()
        }
    }

    /// What number `index` of the others saw at a tick; its goal is not known.
    fn seen_by(&self, index: usize, tick: usize, then: &[Agent], scene: &Scene) -> Scene {
        let others = then.iter().enumerate().filter(|(other, _)| *other != index).map(|(_, other)| other.clone());
        let own = self.own.iter().find(|(at, _)| *at >= tick).map_or(&scene.ego, |(_, own)| own);
        let others = std::iter::once(own.clone()).chain(others).collect();
        Scene { tick, ego: then[index].clone(), others, ..scene.clone() }
    }

    /// A vehicle as it should be by now, and what it will do: its chosen driver lives through the ticks since the sighting.
    fn present(&self, index: usize, place: usize, sighting: &Sighting, then: &[Agent], scene: &Scene) -> Agent {
        let mut agents = then.to_vec();
        let mut driver = self.observed[place].continuing();
        for tick in sighting.tick + 1..=scene.tick {
            for agent in &mut agents {
                move_on(agent);
            }
            let mut seen = self.seen_by(index, tick, &agents, scene);
            if let Ok(Some(plan)) = driver.plan(&mut seen) {
                agents[index].prediction = Arc::new(plan);
            }
        }
        agents.swap_remove(index)
    }
}

/// Moves a vehicle by one step of what is expected of it.
fn move_on(agent: &mut Agent) {
    agent.previous_input = agent.prediction.inputs.first().copied().unwrap_or_default();
    agent.prediction = Arc::new(agent.prediction.shifted());
    agent.state = agent.prediction.states.first().copied().unwrap_or(agent.state);
}

/// The order in which drivers plan: from the front of the road to its rear.
fn from_front_to_rear(agents: &[Agent]) -> Vec<usize> {
    let along_m: Vec<f64> = agents.iter().map(|agent| agent.along_m()).collect();
    let mut order: Vec<usize> = (0..agents.len()).collect();
    order.sort_by(|a, b| along_m[*b].total_cmp(&along_m[*a]));
    order
}

/// The nearest of the others that the planning vehicle may meet.
fn nearest(scene: &Scene) -> Option<usize> {
    let distance = |index: &usize| {
        let ([x, y], [own_x, own_y]) = (scene.others[*index].state.position(), scene.ego.state.position());
        libm::hypot(x - own_x, y - own_y)
    };
    let may_meet = (0..scene.others.len()).filter(|index| scene.ego.may_meet(&scene.others[*index]));
    may_meet.min_by(|a, b| distance(a).total_cmp(&distance(b)))
}
