//! The true distance of the ego's footprint to the others'.

use interplay_planners::{Body, State};
use interplay_scenarios::Scenario;

use super::gap_m;

/// The smallest distance so far.
#[derive(Clone, Debug)]
pub struct Gap {
    ego: usize,
    bodies: Vec<Body>,
    /// Smallest distance \[m\]; none without other vehicles.
    pub smallest_m: Option<f64>,
}

impl Gap {
    /// Nothing seen yet.
    pub fn new(scenario: &Scenario) -> Self {
        let bodies = scenario.vehicles.iter().map(|vehicle| vehicle.body).collect();
        Gap { ego: scenario.ego_index(), bodies, smallest_m: None }
    }

    /// Notes that two vehicles touch.
    pub fn touch(&mut self, pair: [usize; 2]) {
        if pair.contains(&self.ego) {
            self.smallest_m = Some(0.0);
        }
    }

    /// Looks at one moment; returns the distance there \[m\].
    pub fn observe(&mut self, states: &[State]) -> Option<f64> {
        let ego = (self.bodies.get(self.ego)?, states.get(self.ego)?);
        let others = self.bodies.iter().zip(states).enumerate().filter(|(index, _)| *index != self.ego);
        let now = others.map(|(_, other)| gap_m(ego, other)).min_by(f64::total_cmp)?;
        self.smallest_m = Some(self.smallest_m.map_or(now, |smallest| smallest.min(now)));
        Some(now)
    }
}
