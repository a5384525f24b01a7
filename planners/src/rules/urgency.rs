//! How much harder than is comfortable a vehicle has to brake.

use crate::plan::certificate::touches_ahead;
use crate::prediction::steering::{admissible, roll_out, steer};
use crate::problem::clearance::STANDSTILL_GAP_M;
use crate::{Agent, Input, Scene, Trajectory};

/// A driver who must brake does so by this much harder than is just enough.
const RESERVE: f64 = 1.15;
/// It stops this many lengths of its body behind a vehicle whose plan it knows.
const STANDSTILL_LENGTHS: f64 = 0.15;
/// Ratio to the comfortable braking above which a vehicle brakes as hard as it can.
const MOST: f64 = 10.0;
/// What a reacting driver leaves at least between itself and the one ahead when it counts how hard it has to brake, of real vehicles \[m\].
/// Its model stops farther behind, and comes up to that place without end.
const LEFT_M: f64 = 0.5;
/// Ratio to the comfortable braking from which on a reacting driver brakes as hard as it needs, without regard to its model.
const EMERGENCY: f64 = 2.0;

impl Scene {
    /// The ratio of the braking that safety asks of the planning vehicle to what is comfortable, at least 1; 1 for a driver who knows
    /// no comfort.
    ///
    /// Braking is needed behind the vehicle ahead in the same lane, if that one brakes comfortably to a stop or as it does now,
    /// and before the line at which the vehicle has to wait. Where neither its last plan nor comfortable braking nor the present speed
    /// keeps it from touching the vehicle ahead, it may do all that it can.
    pub(crate) fn urgency(&self) -> f64 {
        let ego = &self.ego;
        let Some(comfort) = ego.limits.comfort else { return 1.0 };
        let leaders = self.others.iter().filter(|other| ego.shares_lane_with(other) && ego.lead_of(other) > 0.0);
        let standstill_m = if self.knowledge.is_of_motion() {
            STANDSTILL_GAP_M * ego.body.scale
        } else {
            STANDSTILL_LENGTHS * (ego.body.front_m + ego.body.rear_m)
        };
        let behind = leaders.map(|leader| {
            let gap_m = ego.lead_of(leader) - ego.body.front_m - leader.body.rear_m - standstill_m;
            let their_mps2 = comfort.braking_mps2.max(-leader.previous_input.acceleration_mps2);
            braking_behind_stopping(ego, gap_m, leader.state.speed_mps, their_mps2)
        });
        let needed_mps2 = behind.fold(ego.braking_before_line_mps2(), f64::max);
        let ratio = ratio_to_comfort(ego, needed_mps2);
        let touches = |motion: &Trajectory| self.others.iter().any(|other| touches_ahead(self, motion, other));
        let is_in_danger = touches(&ego.prediction)
            && [-comfort.braking_mps2, 0.0]
                .into_iter()
                .all(|mps2| touches(&self.changing_comfortably_to(mps2, comfort.jerk_mps3)));
        if is_in_danger { MOST } else { ratio }
    }

    /// The motion along the road at the present lateral place, with an acceleration that is approached comfortably.
    fn changing_comfortably_to(&self, wanted_mps2: f64, jerk_mps3: f64) -> Trajectory {
        let ego = &self.ego;
        let across_m = ego.across_m();
        let mut acceleration_mps2 = ego.previous_input.acceleration_mps2;
        roll_out(self, |_, state| {
            let most = jerk_mps3 * self.step_s;
            acceleration_mps2 += (wanted_mps2 - acceleration_mps2).clamp(-most, most);
            Input {
                acceleration_mps2: admissible(ego, state, acceleration_mps2, self.step_s),
                steering_rad: steer(ego, state, across_m),
            }
        })
    }
}

impl Agent {
    /// The braking that stops it before the line at which it has to wait; 0 without one \[m/s²\].
    pub(crate) fn braking_before_line_mps2(&self) -> f64 {
        self.rules.stop_line_m.map_or(0.0, |line_m| {
            let room_m = line_m - self.along_m() - self.body.front_m;
            braking_within(self.state.speed_mps, room_m)
        })
    }
}

/// The ratio of a braking that safety asks for to the comfortable one, at least 1; 1 for a driver who knows no comfort.
pub(crate) fn ratio_to_comfort(ego: &Agent, needed_mps2: f64) -> f64 {
    let ratio = |comfortable_mps2: f64| (RESERVE * needed_mps2 / comfortable_mps2).clamp(1.0, MOST);
    ego.limits.comfort.map_or(1.0, |comfort| ratio(comfort.braking_mps2))
}

/// The braking that a reacting driver carries out whatever its model says: what it needs, where that is far beyond comfort \[m/s²\].
pub(crate) fn emergency_braking_mps2(ego: &Agent) -> Option<f64> {
    let comfort = ego.limits.comfort.filter(|_| ego.urgency >= EMERGENCY)?;
    Some((ego.urgency * comfort.braking_mps2).min(-ego.limits.acceleration_min_mps2))
}

/// The braking of a driver behind a leader of whom it sees a speed and an acceleration, at a gap between bumpers, if that one brakes
/// comfortably to a stop or as it does now, or keeps its speed \[m/s²\].
pub(crate) fn braking_behind(ego: &Agent, gap_m: f64, their_mps: f64, their_acceleration_mps2: f64) -> f64 {
    let comfortable_mps2 = ego.limits.comfort.map_or(f64::INFINITY, |comfort| comfort.braking_mps2);
    let room_m = gap_m - LEFT_M * ego.body.real_ratio();
    let stopping = braking_behind_stopping(ego, room_m, their_mps, comfortable_mps2.max(-their_acceleration_mps2));
    stopping.max(braking_within(ego.state.speed_mps - their_mps, gap_m))
}

/// The braking with which a vehicle stops on some room behind a leader that brakes to a stop \[m/s²\].
fn braking_behind_stopping(ego: &Agent, room_m: f64, their_mps: f64, their_mps2: f64) -> f64 {
    let their_way_m = their_mps * their_mps / (2.0 * their_mps2);
    braking_within(ego.state.speed_mps, room_m + their_way_m)
}

/// The braking that ends a speed within a way \[m/s²\].
pub(crate) fn braking_within(speed_mps: f64, way_m: f64) -> f64 {
    if speed_mps <= 0.0 {
        return 0.0;
    }
    speed_mps * speed_mps / (2.0 * way_m.max(1e-3))
}
