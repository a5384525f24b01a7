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
        let behind = leaders.map(|leader| braking_behind(ego, leader, standstill_m, comfort.braking_mps2));
        let line = ego.rules.stop_line_m.map(|line_m| {
            let room_m = line_m - ego.route.along(ego.state.position()) - ego.body.front_m;
            braking_within(ego.state.speed_mps, room_m)
        });
        let needed_mps2 = behind.chain(line).fold(0.0, f64::max);
        let ratio = (RESERVE * needed_mps2 / comfort.braking_mps2).clamp(1.0, MOST);
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
        let across_m = ego.route.across(ego.state.position());
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

/// The braking with which a vehicle stops behind a leader that brakes to a stop \[m/s²\].
fn braking_behind(ego: &Agent, leader: &Agent, own_m: f64, comfortable_mps2: f64) -> f64 {
    let gap_m = ego.lead_of(leader) - ego.body.front_m - leader.body.rear_m - own_m;
    let their_mps2 = comfortable_mps2.max(-leader.previous_input.acceleration_mps2);
    let their_way_m = leader.state.speed_mps * leader.state.speed_mps / (2.0 * their_mps2);
    braking_within(ego.state.speed_mps, gap_m + their_way_m)
}

/// The braking that ends a speed within a way \[m/s²\].
pub(crate) fn braking_within(speed_mps: f64, way_m: f64) -> f64 {
    if speed_mps <= 0.0 {
        return 0.0;
    }
    speed_mps * speed_mps / (2.0 * way_m.max(1e-3))
}
