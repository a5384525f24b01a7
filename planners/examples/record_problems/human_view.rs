//! The human driver's problem, rebuilt from its scene as its documentation describes it.

use interplay_planners::mpc::{KeepOut, Penalty, Problem};
use interplay_planners::predict::{constant_velocity, steady};
use interplay_planners::{Agent, Input, Scene, Trajectory, human};

/// A human leans towards yielding before it has a plan.
const FIRST_GUESS: f64 = 0.3;

/// The problem that a human poses.
pub fn problem(scene: &Scene, settings: &human::Settings) -> Problem {
    let keep_outs = scene.others.iter().filter_map(|other| keep_out(scene, other, settings)).collect();
    Problem {
        horizon: scene.horizon,
        participants: vec![scene.participant(keep_outs)],
        separations: Vec::new(),
        leaning: None,
    }
}

/// The guess of keeping on.
pub fn guess(scene: &Scene, last: Option<&Trajectory>) -> Vec<Input> {
    let limits = &scene.ego.limits;
    last.map_or_else(
        || {
            let yielding = FIRST_GUESS * limits.acceleration_min_mps2;
            steady(&scene.ego.state, yielding, limits, scene.horizon, scene.step_s)
        },
        |last| last.shifted().inputs,
    )
}

/// How a human minds one other vehicle on the same road: it follows a leader, ignores who is behind, and keeps apart from
/// the rest as far as its safety weight goes.
fn keep_out(scene: &Scene, other: &Agent, settings: &human::Settings) -> Option<KeepOut> {
    let (ego, weight) = (&scene.ego, settings.weight());
    if ego.shares_lane_with(other) {
        let penalty = Penalty::hinge(weight.max(settings.following_weight));
        return is_leader(scene, other).then(|| scene.keep_out(&other.prediction, ego.corridor.heading_rad, penalty));
    }
    let predicted = constant_velocity(&other.state, scene.horizon, scene.step_s);
    (weight > 0.0).then(|| scene.keep_out(&predicted, other.corridor.heading_rad, Penalty::hinge(weight)))
}

/// Whether nobody drives between the two.
fn is_leader(scene: &Scene, other: &Agent) -> bool {
    let lead = |agent: &Agent| scene.ego.lead_of(agent);
    let closer = |agent: &&Agent| scene.ego.shares_lane_with(agent) && lead(agent) > 0.0 && lead(agent) < lead(other);
    lead(other) > 0.0 && !scene.others.iter().any(|agent| closer(&agent))
}
