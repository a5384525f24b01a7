//! The motion of a driver who has chosen a lane.

use super::Settings;
use crate::drivers::lanes::{Leader, RoadLanes, leader};
use crate::prediction::steering::{admissible, roll_out, steer, steer_over_step};
use crate::problem::permitted_speed::{COURTESY_MPS, COURTESY_MPS2};
use crate::rules::obstacle::swing_m;
use crate::scene::road_rules::Obstacle;
use crate::{Agent, Input, Scene, State, Trajectory};

/// Way that the steering law needs to change its lateral place, as a multiple of a planner's.
const SWINGS: f64 = 3.0;

/// Ratio of the lateral aim to the place that it reaches.
const AIM: f64 = 1.1;

/// Distance that a driver looks ahead, as a multiple of the way on which comfortable braking builds up.
const LOOKING_AHEAD: f64 = 0.75;

/// Time in which it comes to the speed at which it waits for its gap, of real vehicles \[s\].
const MERGING_S: f64 = 1.5;

/// How a driver drives.
#[derive(Clone, Copy)]
pub(super) struct Motion<'a> {
    pub settings: &'a Settings,
    pub own: &'a Agent,
    pub wanted_mps: f64,
    pub step_s: f64,
    pub lanes: RoadLanes,
    /// The lane it is in, and the one it drives in or changes to.
    pub from_to: [usize; 2],
    /// Where it has to wait \[m\].
    pub line_m: Option<f64>,
    pub passed: Option<&'a Obstacle>,
}

impl Motion<'_> {
    /// The motion over the horizon of a scene, whose others it follows; `owed` is the same without those who have to let it go first and are
    /// not in its lane yet, if there are any.
    pub fn driven(&self, scene: &Scene, owed: Option<&Scene>) -> Trajectory {
        let mut before = self.own.previous_input;
        roll_out(scene, |t, state| {
            // In the lane that it leaves it minds the vehicle ahead until it is out of it.
            let [from, to] = self.from_to;
            let ahead = |scene: &Scene| {
                let taken = leader(scene, &self.lanes, to, state, t);
                [if from == to { taken } else { leader(scene, &self.lanes, from, state, t) }, taken]
            };
            before = self.input(state, &before, ahead(scene), owed.map(ahead));
            before
        })
    }

    /// The input at a state after another one, behind what is ahead in the lane that it leaves and in the one that it takes; `owed` is what
    /// would be ahead without those who have to let it go first.
    pub fn input(
        &self,
        state: &State,
        before: &Input,
        ahead: [Option<Leader>; 2],
        owed: Option<[Option<Leader>; 2]>,
    ) -> Input {
        let (own, step_s) = (self.own, self.step_s);
        let edge_m = own.rules.drives_at_m.filter(|_| own.rules.evades.is_some());
        let lane_m = edge_m.unwrap_or_else(|| self.lanes.centre_m(self.from_to[1]));
        // Straight roads have neither lines nor speed limits.
        let along_m = own.route.straight().is_none().then(|| own.route.along(state.position()));
        let passed = self.passed.zip(along_m.map(|along_m| along_m + own.body.front_m));
        let beside_m = |(obstacle, front_m): (&Obstacle, f64)| {
            let swing_m = SWINGS * swing_m(own, own.state.speed_mps);
            obstacle.lateral_m(front_m, lane_m, swing_m) - lane_m
        };
        let inwards_m = along_m.map_or(0.0, |along_m| self.inwards_m(along_m, lane_m));
        let lateral_m = lane_m + inwards_m + AIM * passed.map_or(0.0, beside_m);
        let steering_rad = match along_m {
            None => steer(own, state, lateral_m),
            Some(_) => steer_over_step(own, state, lateral_m, step_s),
        };
        let wanted = Input { acceleration_mps2: self.acceleration_mps2(state, along_m, ahead, owed), steering_rad };
        let Input { acceleration_mps2, steering_rad } = own.comfortably(before, wanted, state.speed_mps, step_s);
        Input { acceleration_mps2: admissible(own, state, acceleration_mps2, step_s), steering_rad }
    }

    /// How far beside the middle of a lane the mass centre is in a curve, positive to the left, where the strip that the body covers is in that
    /// middle \[m\]: with the mass centre on a circle of radius `r` the rear axle is on one of `√(r² − b²)`. The routes of networks contain it
    /// already.
    fn inwards_m(&self, along_m: f64, lane_m: f64) -> f64 {
        let Agent { route, body, limits, .. } = self.own;
        let curvature_1pm = route.centre.at(along_m).curvature_1pm;
        let radius_m = 1.0 / curvature_1pm.abs() - curvature_1pm.signum() * lane_m;
        if limits.comfort.is_none() || route.is_in_network() || !radius_m.is_finite() || radius_m <= body.wheelbase_m()
        {
            return 0.0;
        }
        let rear_m = (radius_m * radius_m - body.rear_axle_m * body.rear_axle_m).sqrt();
        let half_m = 0.5 * body.width_m;
        let outer_m = libm::hypot(rear_m + half_m, body.front_m + body.rear_axle_m);
        curvature_1pm.signum() * (0.5 * (rear_m - half_m + outer_m) - radius_m)
    }

    /// What the model wants behind the vehicles ahead, within what is permitted.
    fn acceleration_mps2(
        &self,
        state: &State,
        along_m: Option<f64>,
        ahead: [Option<Leader>; 2],
        owed: Option<[Option<Leader>; 2]>,
    ) -> f64 {
        let Motion { settings, own, wanted_mps, .. } = *self;
        let line = self.line_m.zip(along_m);
        let line = line.map(|(line_m, along_m)| Leader { gap_m: line_m - along_m - own.body.front_m, speed_mps: 0.0 });
        // Brakes take hold only after a while where jerk is bounded: a lower limit ahead counts already.
        let ahead_m = own
            .limits
            .comfort
            .map_or(0.0, |comfort| LOOKING_AHEAD * comfort.braking_mps2 / comfort.jerk_mps3 * state.speed_mps);
        let places_m = along_m.map(|along_m| [along_m, along_m + ahead_m]);
        let least = |found: [Option<f64>; 2]| found.into_iter().flatten().min_by(f64::total_cmp);
        let permitted_mps =
            places_m.and_then(|places_m| least(places_m.map(|along_m| own.permitted_speed_mps(along_m))));
        let wanted_mps = permitted_mps.map_or(wanted_mps, |permitted_mps| permitted_mps.min(wanted_mps));
        let among = |[left, taken]: [Option<Leader>; 2]| {
            settings.acceleration(state.speed_mps, wanted_mps, nearest([left, taken, line]))
        };
        let acceleration = among(ahead);
        let acceleration = owed.map_or(acceleration, |owed| {
            let alone = among(owed);
            let lost_mps = wanted_mps - state.speed_mps;
            let is_slow = lost_mps > COURTESY_MPS * own.body.real_ratio().sqrt();
            acceleration.max(alone.min(if is_slow { 0.0 } else { -COURTESY_MPS2 }))
        });
        // It slows down evenly for its gap.
        let merging_mps2 =
            own.merging_speed_mps().map(|mps| (mps - state.speed_mps) / (MERGING_S * own.body.real_ratio().sqrt()));
        let acceleration = merging_mps2.map_or(acceleration, |merging_mps2| acceleration.min(merging_mps2));
        // On a free road the model brakes too weakly for a limit ahead.
        let highest = |along_m: f64| own.permitted_acceleration_mps2(along_m, state.speed_mps, self.step_s);
        let highest_mps2 = places_m.and_then(|places_m| least(places_m.map(highest)));
        highest_mps2.map_or(acceleration, |highest_mps2| acceleration.min(highest_mps2))
    }
}

fn nearest(leaders: [Option<Leader>; 3]) -> Option<Leader> {
    leaders.into_iter().flatten().min_by(|a, b| a.gap_m.total_cmp(&b.gap_m))
}
