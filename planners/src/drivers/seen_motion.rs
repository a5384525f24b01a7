//! The motion that every driver expects of a vehicle whose plan it does not know, from what can be seen of it.
//!
//! ```text
//! acceleration  a(t) = min(a₀ e^(−t/τ), behind its leader, before its line, within its speed limit),  τ = τ₀ max(1, −a₀/a_τ)
//! lateral       towards n₀ + v_n τ_n, or into the lane to which it indicates
//! ```
//!
//! `a₀` is its present acceleration and `v_n` its lateral speed. A vehicle that brakes hard is expected to brake for longer, as for a
//! stop. Behind its leader, whose own seen motion is known, and before the line at which the rules hold it, it brakes by the intelligent
//! driver model with the values of the literature and the time gap that it keeps now. The motion is rolled out through the bicycle, so
//! that its inputs reproduce it, on bends too.

use crate::drivers::idm;
use crate::prediction::steadily_along;
use crate::prediction::steering::{admissible, geometry};
use crate::vehicle::slip_on_curve_rad;
use crate::{Agent, Bicycle, Input, State, Trajectory};

/// Time within which an acceleration falls to 37 %, of real vehicles \[s\].
const DECAY_S: f64 = 1.0;
/// Braking that is harder than this lasts longer by its ratio to it \[m/s²\].
const LONGER_MPS2: f64 = 1.0;
/// The same of a lateral speed \[s\].
const LATERAL_DECAY_S: f64 = 1.0;
/// A vehicle at a larger angle to its route is expected to keep its speed and angle \[rad\].
const ALONG_RAD: f64 = 0.8;
/// A gap is at least this, of real vehicles \[m\].
const LEAST_GAP_M: f64 = 0.1;

/// What is seen of a vehicle, and of what may hold it back.
#[derive(Clone, Copy, Debug)]
pub struct SeenMotion<'a> {
    /// The vehicle; of its inputs only the acceleration is looked at.
    pub vehicle: &'a Agent,
    /// The vehicle ahead in its lane, with its own expected motion.
    pub leader: Option<&'a Agent>,
}

impl SeenMotion<'_> {
    /// The expected motion over some steps. A vehicle that knows no comfort, as model cars do, and an obstacle keep their speed.
    pub fn expected(&self, steps: usize, step_s: f64) -> Trajectory {
        let Agent { route, body, state, limits, .. } = self.vehicle;
        let here = route.locate(state.position(), None);
        let to_road_rad =
            state.heading_rad + slip_on_curve_rad(body.rear_axle_m, here.curvature_1pm) - here.heading_rad;
        let (sin, cos) = libm::sincos(to_road_rad);
        if self.vehicle.is_obstacle || limits.comfort.is_none() || cos < libm::cos(ALONG_RAD) {
            return steadily_along(route, body, state, steps, step_s);
        }
        let time_ratio = body.real_ratio().sqrt();
        let drift_m = state.speed_mps * sin * LATERAL_DECAY_S * time_ratio;
        let aim_m = self.vehicle.indicated_across_m(&here).unwrap_or(here.across_m + drift_m);
        let now_mps2 = self.vehicle.previous_input.acceleration_mps2;
        let decay_s = DECAY_S * time_ratio * (-now_mps2 / LONGER_MPS2).max(1.0);
        let follower = Follower::new(self, steps);
        let (model, mut state, mut near_m) = (Bicycle::new(body, step_s), *state, here.along_m);
        let mut motion = Trajectory { states: vec![state], inputs: Vec::with_capacity(steps) };
        for step in 0..steps {
            let at = route.locate(state.position(), Some(near_m));
            near_m = at.along_m;
            let time_s = step_s * (step as f64 + 0.5);
            let kept_mps2 = now_mps2 * libm::exp(-time_s / decay_s);
            let bound_mps2 = follower.highest_mps2(step, at.along_m, state.speed_mps);
            let permitted_mps2 = self.vehicle.permitted_acceleration_mps2(at.along_m, state.speed_mps, step_s);
            let wanted_mps2 = kept_mps2.min(bound_mps2).min(permitted_mps2.unwrap_or(f64::INFINITY));
            let input = Input {
                acceleration_mps2: admissible(self.vehicle, &state, wanted_mps2, step_s),
                steering_rad: at.steer(&geometry(self.vehicle, &state), &state, aim_m),
            };
            state = model.step(&state, &input);
            motion.inputs.push(input);
            motion.states.push(state);
        }
        motion
    }
}

/// The vehicle behind its leader and before its line.
struct Follower {
    model: idm::Settings,
    front_m: f64,
    least_gap_m: f64,
    line_m: Option<f64>,
    /// Where the rear of the leader is at each step \[m\], and its speed \[m/s\].
    ahead: Vec<[f64; 2]>,
}

impl Follower {
    fn new(seen: &SeenMotion<'_>, steps: usize) -> Follower {
        let Agent { route, body, state, rules, .. } = seen.vehicle;
        let ratio = body.real_ratio();
        let mut model = idm::Settings::literature().scaled(ratio);
        let mut ahead = Vec::new();
        if let Some(leader) = seen.leader {
            let mut near_m = None;
            let rear = |state: &State| {
                let along_m = route.locate(state.position(), near_m).along_m;
                near_m = Some(along_m);
                [along_m - leader.body.rear_m, state.speed_mps]
            };
            ahead = leader.prediction.states.iter().take(steps + 1).map(rear).collect();
            if let Some([rear_m, _]) = ahead.first() {
                let gap_m = rear_m - route.along(state.position()) - body.front_m;
                let kept_s = (gap_m - model.gap_m).max(0.0) / state.speed_mps.max(LEAST_GAP_M * ratio);
                model.headway_s = model.headway_s.min(kept_s);
                model.gap_m = model.gap_m.min(gap_m.max(LEAST_GAP_M * ratio));
            }
        }
        Follower { model, front_m: body.front_m, least_gap_m: LEAST_GAP_M * ratio, line_m: rules.stop_line_m, ahead }
    }

    /// The largest acceleration at a step, from a place and a speed.
    fn highest_mps2(&self, step: usize, along_m: f64, speed_mps: f64) -> f64 {
        let front_m = along_m + self.front_m;
        let behind = |model: idm::Settings, rear_m: f64, ahead_mps: f64| {
            let gap_m = (rear_m - front_m).max(self.least_gap_m);
            model.acceleration_behind(speed_mps, f64::INFINITY, Some((gap_m, ahead_mps)))
        };
        let ahead = self.ahead.get(step).or(self.ahead.last());
        let following_mps2 = ahead.map_or(f64::INFINITY, |[rear_m, mps]| behind(self.model, *rear_m, *mps));
        let at_line = idm::Settings { headway_s: 0.0, gap_m: 0.0, ..self.model };
        let line_mps2 = self.line_m.map_or(f64::INFINITY, |line_m| behind(at_line, line_m, 0.0));
        following_mps2.min(line_mps2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use crate::scene::IndicatorSide;
    use crate::vehicle::ComfortLimits;

    const STEP_S: f64 = 0.2;

    /// A real car along the x axis.
    fn car(x_m: f64, speed_mps: f64, acceleration_mps2: f64) -> Agent {
        let mut agent = fixture::real_car(x_m, speed_mps);
        agent.limits.comfort = Some(ComfortLimits::default());
        agent.previous_input.acceleration_mps2 = acceleration_mps2;
        agent
    }

    fn expected(vehicle: &Agent, leader: Option<&Agent>) -> Trajectory {
        SeenMotion { vehicle, leader }.expected(40, STEP_S)
    }

    fn end(motion: &Trajectory) -> State {
        *motion.states.last().expect("states")
    }

    #[test]
    fn an_acceleration_decays() {
        let ends_with = |mps2: f64| end(&expected(&car(0.0, 20.0, mps2), None)).speed_mps;
        assert!((ends_with(-1.0) - 19.0).abs() < 0.1 && (ends_with(-3.0) - 11.6).abs() < 0.2, "{}", ends_with(-3.0));
        assert_eq!(ends_with(-6.0), 0.0, "who brakes as hard as this stops");
        assert_eq!(end(&expected(&car(0.0, 20.0, 0.0), None)).speed_mps, 20.0);
    }

    #[test]
    fn the_inputs_reproduce_the_motion() {
        let mut vehicle = car(0.0, 10.0, 1.0);
        vehicle.state.heading_rad = 0.1;
        let motion = expected(&vehicle, None);
        let mut states = Vec::new();
        Bicycle::new(&vehicle.body, STEP_S).roll_out(&vehicle.state, &motion.inputs, &mut states);
        assert_eq!(states, motion.states);
    }

    #[test]
    fn a_follower_stops_behind_a_leader_that_stands() {
        let (follower, mut leader) = (car(0.0, 14.0, 0.0), car(60.0, 0.0, 0.0));
        leader.prediction = std::sync::Arc::new(expected(&leader, None));
        let stopped = end(&expected(&follower, Some(&leader)));
        let gap_m = leader.state.x_m - leader.body.rear_m - stopped.x_m - follower.body.front_m;
        assert!(gap_m > 0.5 && stopped.speed_mps < 1.0, "{gap_m} {stopped:?}");
    }

    #[test]
    fn a_follower_with_a_short_time_gap_is_not_expected_to_brake() {
        let (follower, mut leader) = (car(0.0, 20.0, 0.0), car(24.5, 20.0, 0.0));
        leader.prediction = std::sync::Arc::new(expected(&leader, None));
        assert!(end(&expected(&follower, Some(&leader))).speed_mps > 19.0);
    }

    #[test]
    fn a_vehicle_that_must_wait_stops_before_its_line() {
        let mut vehicle = car(0.0, 14.0, 0.0);
        vehicle.rules.stop_line_m = Some(70.0);
        let stopped = end(&expected(&vehicle, None));
        assert!(stopped.x_m + vehicle.body.front_m < 70.5 && stopped.speed_mps < 2.5, "{stopped:?}");
    }

    #[test]
    fn a_lane_change_is_carried_out_to_the_lane_that_is_indicated() {
        let vehicle = Agent { indicator: Some(IndicatorSide::Left), ..car(0.0, 20.0, 0.0) };
        let moved_m = end(&expected(&vehicle, None)).y_m - vehicle.state.y_m;
        assert!((3.0..4.5).contains(&moved_m), "{moved_m}");
    }
}
