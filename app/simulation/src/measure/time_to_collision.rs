//! The shortest time to collision of any two vehicles in a run.

use interplay_planners::{Body, State};
use interplay_scenarios::Scenario;
use serde::Serialize;

use crate::frame::Frame;
use crate::physics::{MovingFootprint, time_to_collision_s};

/// Who touches only after a longer time than this is not on a collision course \[s\].
const MAX_TIME_TO_COLLISION_S: f64 = 100.0;

/// The time after which two vehicles would touch.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TimeToCollision {
    /// The time; 0 where they touch already \[s\].
    pub s: f64,
    /// Who, in the scenario's order.
    pub between: [String; 2],
    /// When it was so \[s\].
    pub time_s: f64,
}

/// The shortest time to collision so far, at the beginnings of ticks: the time until two footprints would touch if both
/// vehicles kept the velocity of the tick that begins.
///
/// The velocity of a tick is the displacement of the mass centre in it over its length. Headings stay.
#[derive(Clone, Debug)]
pub struct ShortestTimeToCollision {
    bodies: Vec<Body>,
    step_s: f64,
    /// The shortest time; none if no pair was on a collision course.
    pub shortest: Option<TimeToCollision>,
}

impl ShortestTimeToCollision {
    /// Nothing measured yet.
    pub fn new(scenario: &Scenario) -> Self {
        let bodies = scenario.vehicles.iter().map(|vehicle| vehicle.body).collect();
        ShortestTimeToCollision { bodies, step_s: scenario.step_s, shortest: None }
    }

    /// Takes one tick and the states that it led to.
    pub fn observe(&mut self, frame: &Frame, after: &[State]) {
        let vehicles = frame.vehicles.iter().zip(after).zip(&self.bodies);
        let moving: Vec<MovingFootprint<'_>> = vehicles
            .map(|((vehicle, after), body)| {
                let state = &vehicle.state;
                let velocity_mps = [after.x_m - state.x_m, after.y_m - state.y_m].map(|moved_m| moved_m / self.step_s);
                MovingFootprint { body, state, velocity_mps }
            })
            .collect();
        for (index, one) in moving.iter().enumerate() {
            for (other_index, other) in moving.iter().enumerate().skip(index + 1) {
                // Only a shorter time is of interest, which keeps the search small.
                let within_s = self.shortest.as_ref().map_or(MAX_TIME_TO_COLLISION_S, |shortest| shortest.s);
                if within_s <= 0.0 {
                    return;
                }
                if let Some(s) = time_to_collision_s(one, other, within_s).filter(|s| *s < within_s) {
                    let between = [index, other_index].map(|index| frame.vehicles[index].name.clone());
                    self.shortest = Some(TimeToCollision { s, between, time_s: frame.time_s });
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;
    use crate::frame::VehicleFrame;

    /// The ego behind and beside the others, seen once a second; only the front car is in its way.
    #[test]
    fn the_shortest_time_is_kept_with_its_pair() {
        let scenario = load("lane-change/front-nice", &[]).expect("authored");
        let mut measure = ShortestTimeToCollision::new(&scenario);
        let state = |x_m, y_m, speed_mps| State { x_m, y_m, heading_rad: 0.0, speed_mps };
        // Closing speed and distance of bumpers of ego and front: 1 s, 0.5 s, 2 s, and parting.
        for (time_s, ahead_m, speed_mps) in [(0.0, 1.0, 1.0), (1.0, 1.0, 2.0), (2.0, 2.0, 1.0), (3.0, 0.1, -1.0)] {
            let states = [state(5.0, 0.2, 1.0 + speed_mps), state(ahead_m + 5.4, 0.2, 1.0), state(2.0, 0.55, 1.0)];
            let vehicles = scenario.vehicles.iter().zip(states);
            let vehicles = vehicles.map(|(vehicle, state)| VehicleFrame {
                name: vehicle.name.clone(),
                state,
                ..VehicleFrame::default()
            });
            let frame = Frame { time_s, vehicles: vehicles.collect(), ..Frame::default() };
            let after = states.map(|state| State { x_m: state.x_m + scenario.step_s * state.speed_mps, ..state });
            measure.observe(&frame, &after);
        }
        let shortest = measure.shortest.expect("the front car is in the way");
        assert_eq!(shortest.between, [0, 1].map(|index: usize| scenario.vehicles[index].name.clone()));
        assert!((shortest.s - 0.5).abs() < 1e-4 && shortest.time_s == 1.0, "{shortest:?}");
    }
}
