//! View of the own lane, the adjacent lanes, and the leader and follower in each.

use interplay_planners::Scene;
use interplay_planners::drivers::lanes::{RoadLanes, follower, leader};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::view::{ObservationSpace, Scales, Seen, names, share};

/// The agent in the Frenet frame of its route and the traffic by lane, as one row of numbers from −1 to 1.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LaneView {}

/// The entries of the agent itself.
const OWN: [&str; 11] = [
    "goal_across",
    "lane_across",
    "heading_error",
    "speed",
    "speed_missing",
    "acceleration",
    "steering",
    "curvature_now",
    "curvature_in_1_s",
    "curvature_in_2_s",
    "stop_line_gap",
];
/// The entries of each lane.
const LANE: [&str; 5] = ["exists", "leader_gap", "leader_speed", "follower_gap", "follower_speed"];
const LANES: [&str; 3] = ["right", "own", "left"];

/// Preview times of the road's curvature, for a real car \[s\].
const PREVIEW_S: [f64; 3] = [0.0, 1.0, 2.0];

impl LaneView {
    pub(super) fn space(&self) -> ObservationSpace {
        let beside = LANES.iter().flat_map(|lane| LANE.map(|what| format!("{lane}_{what}")));
        let names: Vec<String> = names(&OWN).into_iter().chain(beside).collect();
        ObservationSpace::normalised("Lane", vec![names.len()], names, true)
    }

    pub(super) fn write(&self, seen: &Seen<'_>, out: &mut [f32]) {
        let scene = seen.scene;
        let lanes = RoadLanes::of_road(scene, None);
        let now = lanes.at(scene.ego.route.across(scene.ego.state.position()));
        let (own, beside) = out.split_at_mut(OWN.len());
        own.copy_from_slice(&itself(scene, &lanes, now));
        let places = [now.checked_sub(1), Some(now), Some(now + 1).filter(|lane| *lane < lanes.count())];
        for (lane, out) in places.into_iter().zip(beside.chunks_exact_mut(LANE.len())) {
            out.copy_from_slice(&lane.map_or([0.0; LANE.len()], |lane| traffic(scene, &lanes, lane)));
        }
    }
}

/// The agent's own position and motion.
fn itself(scene: &Scene, lanes: &RoadLanes, now: usize) -> [f32; OWN.len()] {
    let (ego, scales) = (&scene.ego, Scales::of_ego(scene));
    let at = ego.route.locate(ego.state.position(), None);
    let goal_across_m = ego.route.across(scene.goal.target.position());
    let wanted_mps = scene.goal.target.speed_mps;
    let turn_rad = libm::remainder(ego.state.heading_rad - at.heading_rad, std::f64::consts::TAU);
    let curvature = |after_s: f64| {
        let ahead_m = after_s * ego.body.real_ratio().sqrt() * ego.state.speed_mps;
        share(ego.route.centre.at(at.along_m + ahead_m).curvature_1pm * scales.across_m, 1.0)
    };
    let [now_1pm, soon_1pm, later_1pm] = PREVIEW_S.map(curvature);
    let stop_gap_m = ego.rules.stop_line_m.map_or(f64::INFINITY, |line_m| line_m - at.along_m - ego.body.front_m);
    let acceleration = ego.previous_input.acceleration_mps2;
    [
        share(goal_across_m - at.across_m, scales.across_m),
        share(lanes.centre_m(now) - at.across_m, scales.across_m),
        share(turn_rad, 1.0),
        share(ego.state.speed_mps, scales.speed_mps),
        share(wanted_mps - ego.state.speed_mps, scales.speed_mps),
        share(acceleration, ego.limits.strongest_mps2(acceleration)),
        share(ego.previous_input.steering_rad, ego.limits.steering_max_rad),
        now_1pm,
        soon_1pm,
        later_1pm,
        share(stop_gap_m, scales.along_m),
    ]
}

/// Leader and follower in a lane; missing ones have the gap 1 and the speed 0, gaps beside the agent are negative.
fn traffic(scene: &Scene, lanes: &RoadLanes, lane: usize) -> [f32; LANE.len()] {
    let (ego, scales) = (&scene.ego, Scales::of_ego(scene));
    let faster = |speed_mps: f64| share(speed_mps - ego.state.speed_mps, scales.speed_mps);
    let ahead = leader(scene, lanes, lane, &ego.state, 0);
    let behind = follower(scene, lanes, lane);
    let behind = behind.map(|other| {
        let gap_m = -ego.lead_of(other) - ego.body.rear_m - other.body.front_m;
        (share(gap_m, scales.along_m), faster(other.state.speed_mps))
    });
    let ahead = ahead.map_or((1.0, 0.0), |ahead| (share(ahead.gap_m, scales.along_m), faster(ahead.speed_mps)));
    let behind = behind.unwrap_or((1.0, 0.0));
    [1.0, ahead.0, ahead.1, behind.0, behind.1]
}
