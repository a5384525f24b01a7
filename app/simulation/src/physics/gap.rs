//! The true distance of the ego's footprint to the others' during a tick.

use interplay_planners::{Body, State};
use interplay_scenarios::Scenario;

use super::footprint::gap_m;

/// The smallest distance so far in a tick.
#[derive(Clone, Debug)]
pub(super) struct EgoGap {
    ego: usize,
    bodies: Vec<Body>,
    smallest_m: Option<f64>,
}

impl EgoGap {
    /// Nothing seen yet.
    pub fn new(scenario: &Scenario) -> Self {
        let bodies = scenario.vehicles.iter().map(|vehicle| vehicle.body).collect();
        EgoGap { ego: scenario.ego_index(), bodies, smallest_m: None }
    }

    /// Begins a tick; returns the distance there \[m\], none without other vehicles.
    pub fn begin(&mut self, states: &[State]) -> Option<f64> {
        self.smallest_m = None;
        self.observe(states);
        self.smallest_m
    }

    /// Looks at one time within the tick.
    pub fn observe(&mut self, states: &[State]) {
        let (Some(body), Some(state)) = (self.bodies.get(self.ego), states.get(self.ego)) else { return };
        let others = self.bodies.iter().zip(states).enumerate().filter(|(index, _)| *index != self.ego);
        let now_m = others.map(|(_, other)| gap_m((body, state), other));
        self.smallest_m = self.smallest_m.into_iter().chain(now_m).min_by(f64::total_cmp);
    }

    /// Notes that two vehicles touch.
    pub fn touch(&mut self, pair: [usize; 2]) {
        if pair.contains(&self.ego) {
            self.smallest_m = Some(0.0);
        }
    }

    /// The smallest distance of the tick \[m\]; none without other vehicles.
    pub fn smallest_m(&self) -> Option<f64> {
        self.smallest_m
    }
}
