//! The true distances between footprints during a tick: of the ego to the others, and of any two vehicles.

use interplay_planners::State;
use interplay_scenarios::{Scenario, Vehicle};

use super::footprint::{Footprint, distance_m};
use super::near_pairs::{near_pairs, some_distance_m};

#[derive(Clone, Debug)]
pub(super) struct FootprintGaps {
    ego: usize,
    footprints: Vec<Footprint>,
    /// Whether each vehicle is not on the road in this tick.
    absent: Vec<bool>,
    smallest_m: Option<f64>,
    closest: Option<Closest>,
}

/// The two vehicles that came closest to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Closest {
    /// The distance \[m\].
    pub m: f64,
    /// Their indices, ascending.
    pub pair: [usize; 2],
    /// Share of the tick that has passed by then.
    pub share: f64,
}

impl FootprintGaps {
    /// Measures before the first tick.
    pub fn new(scenario: &Scenario) -> Self {
        let footprint = |vehicle: &Vehicle| Footprint::new(&vehicle.body, vehicle.outline());
        let footprints: Vec<Footprint> = scenario.vehicles.iter().map(footprint).collect();
        let absent = vec![false; footprints.len()];
        FootprintGaps { ego: scenario.ego_index(), footprints, absent, smallest_m: None, closest: None }
    }

    /// The footprint of each vehicle.
    pub fn footprints(&self) -> &[Footprint] {
        &self.footprints
    }

    /// Begins a tick in which some vehicles are not on the road; returns the ego's distance at its start \[m\], `None` without others.
    pub fn begin(&mut self, states: &[State], absent: Vec<bool>) -> Option<f64> {
        self.absent = absent;
        (self.smallest_m, self.closest) = (None, None);
        self.observe(states, 0.0);
        self.smallest_m
    }

    /// Updates the distances at a time within the tick, given as the elapsed share of the tick.
    pub fn observe(&mut self, states: &[State], share: f64) {
        let (Some(footprint), Some(state)) = (self.footprints.get(self.ego), states.get(self.ego)) else { return };
        let present = || {
            let all = self.footprints.iter().zip(states).enumerate();
            all.filter(|(index, _)| !self.absent[*index])
        };
        let others = present().filter(|(index, _)| *index != self.ego && !self.absent[self.ego]);
        for (_, other) in others {
            let so_far_m = self.smallest_m.unwrap_or(f64::INFINITY);
            if least_gap_m((footprint, state), other) < so_far_m {
                let m = distance_m((footprint, state), other);
                self.smallest_m = Some(m.min(so_far_m));
            }
        }
        let circles: Vec<_> = (0..states.len())
            .map(|index| (!self.absent[index]).then(|| (states[index].position(), self.footprints[index].radius_m)))
            .collect();
        let closest_m = self.closest.map_or(f64::INFINITY, |closest| closest.m);
        for [index, other] in near_pairs(&circles, closest_m.min(some_distance_m(&circles))) {
            let [a, b] = [index, other].map(|index| (&self.footprints[index], &states[index]));
            let smallest_m = self.closest.map_or(f64::INFINITY, |closest| closest.m);
            if smallest_m > 0.0 && least_gap_m(a, b) < smallest_m {
                let m = distance_m(a, b);
                if m < smallest_m {
                    self.closest = Some(Closest { m, pair: [index, other], share });
                }
            }
        }
    }

    /// Records that two vehicles begin to touch at a share of the tick.
    pub fn touch(&mut self, pair: [usize; 2], share: f64) {
        if pair.contains(&self.ego) {
            self.smallest_m = Some(0.0);
        }
        if self.closest.is_none_or(|closest| closest.m > 0.0) {
            self.closest = Some(Closest { m: 0.0, pair, share });
        }
    }

    /// The smallest distance of the ego in the tick \[m\]; `None` without other vehicles.
    pub fn smallest_m(&self) -> Option<f64> {
        self.smallest_m
    }

    /// The two vehicles that came closest to each other in the tick; `None` if there is only one.
    pub fn closest(&self) -> Option<Closest> {
        self.closest
    }
}

/// A lower bound of the distance between two footprints, from the circles around them \[m\].
pub(super) fn least_gap_m((footprint, state): (&Footprint, &State), (around, other): (&Footprint, &State)) -> f64 {
    let apart_m = libm::hypot(state.x_m - other.x_m, state.y_m - other.y_m);
    apart_m - footprint.radius_m - around.radius_m
}
