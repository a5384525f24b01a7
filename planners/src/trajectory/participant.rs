//! A vehicle whose inputs are decided, with its hard bounds.

use super::route_start::RouteStart;
use super::stage_bounds::StageBounds;
use crate::road::centre_line::FrenetExpansion;
use crate::{Bicycle, Input, Limits, State};

/// A vehicle whose inputs are decision variables: its model, bounds and start. The terms of the problem say what it
/// wants and avoids.
#[derive(Clone, Debug, PartialEq)]
pub struct Participant {
    /// The vehicle's model of motion.
    pub model: Bicycle,
    /// Hard bounds on inputs and speed.
    pub limits: Limits,
    /// Narrower bounds at each of the `N` stages; empty where `limits` alone hold.
    pub stage_bounds: Vec<StageBounds>,
    /// State at `t = 0`.
    pub start: State,
    /// Input applied before `t = 0`, for the first `Δu`.
    pub previous_input: Input,
    /// Inputs at `t = 0 … first−1` that are not decided but known (eq. 6.15: the human follows the prediction until
    /// `T_n`); empty for a vehicle that decides from the start.
    pub known_inputs: Vec<Input>,
    /// Its route, if that is curved, and where it starts beside it.
    pub route_start: Option<RouteStart>,
}

impl Participant {
    /// The first stage whose input is decided.
    pub fn first(&self) -> usize {
        self.known_inputs.len()
    }

    /// The nearest admissible inputs to a guess: known inputs kept, accelerations and steering clipped to their
    /// bounds, and the speed kept within its own.
    pub fn admissible(&self, guess: &[Input], horizon: usize) -> Vec<Input> {
        let step = self.model.step_s();
        let mut speed = self.start.speed_mps;
        (0..horizon)
            .map(|t| {
                let input = if t < self.first() {
                    self.known_inputs[t]
                } else {
                    let wanted = guess.get(t).copied().unwrap_or_default();
                    let [least_rad, most_rad] = self.steering_bounds_rad(t);
                    Input {
                        acceleration_mps2: self.reachable_acceleration(t, speed, wanted.acceleration_mps2),
                        steering_rad: wanted.steering_rad.clamp(least_rad, most_rad),
                    }
                };
                speed += step * input.acceleration_mps2;
                input
            })
            .collect()
    }

    /// The states that inputs lead to (`N + 1`, the first its start), and their Frenet coordinates at `t = 1…N`; none of these on a
    /// straight route.
    pub(super) fn roll_out(&self, inputs: &[Input], states: &mut Vec<State>, frenet: &mut Vec<FrenetExpansion>) {
        frenet.clear();
        match &self.route_start {
            Some(start) => start.roll_out(&self.model, &self.start, inputs, states, frenet),
            None => self.model.roll_out(&self.start, inputs, states),
        }
    }

    /// Bounds on the steering angle in step `t` \[rad\].
    pub fn steering_bounds_rad(&self, t: usize) -> [f64; 2] {
        let most_rad = self.limits.steering_max_rad;
        self.stage_bounds.get(t).map_or([-most_rad, most_rad], |bounds| bounds.steering_rad)
    }

    /// By how much the steering angle changes more in step `t` than the wheels can turn, with the sign of the change \[rad\].
    pub(super) fn excess_turn_rad(&self, t: usize, change_rad: f64) -> f64 {
        let most_rad = self.stage_bounds.get(t).map_or(f64::INFINITY, |bounds| bounds.turn_rad);
        change_rad - change_rad.clamp(-most_rad, most_rad)
    }

    /// Bounds on the acceleration in step `t` \[m/s²\].
    pub fn acceleration_bounds_mps2(&self, t: usize) -> [f64; 2] {
        let Limits { acceleration_min_mps2, acceleration_max_mps2, .. } = self.limits;
        self.stage_bounds
            .get(t)
            .map_or([acceleration_min_mps2, acceleration_max_mps2], |bounds| bounds.acceleration_mps2)
    }

    /// The acceleration in step `t`, at a speed, nearest to a wanted one that keeps itself and the next speed within bounds
    /// \[m/s²\].
    pub fn reachable_acceleration(&self, t: usize, speed_mps: f64, wanted_mps2: f64) -> f64 {
        let ([slowest, fastest], step_s) = (self.speed_bounds(t + 1), self.model.step_s());
        let [least_mps2, most_mps2] = self.acceleration_bounds_mps2(t);
        let low = least_mps2.max((slowest - speed_mps) / step_s);
        let high = most_mps2.min((fastest - speed_mps) / step_s);
        wanted_mps2.min(high).max(low)
    }

    /// Bounds on the speed at time `t` \[m/s\].
    pub fn speed_bounds(&self, t: usize) -> [f64; 2] {
        if let Some(bounds) = t.checked_sub(1).and_then(|stage| self.stage_bounds.get(stage)) {
            return bounds.speed_mps;
        }
        let (limits, elapsed_s) = (&self.limits, self.model.step_s() * t as f64);
        limits.speeds_within_reach([limits.speed_min_mps, limits.speed_max_mps], self.start.speed_mps, elapsed_s)
    }
}
