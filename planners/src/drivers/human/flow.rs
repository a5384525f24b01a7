//! A driver who adapts to the flow: its wanted speed lies between that of its goal and those of the vehicles in its lane.
//!
//! ```text
//! v_wanted = v_goal + α (mean of the speeds of at most three vehicles ahead within 90 m − v_goal)
//!                   + β (85th percentile of the speeds in the lane in view − v_goal)
//! ```
//!
//! Recorded people look at several vehicles ahead: on US-101 and on a motorway of Munich `α = 0.27` and `β = 0.1` lower the error along
//! the road after 3 s by 5 % (`docs/evidence/how-human.md`).

use crate::{Agent, Scene};

/// How many vehicles ahead are looked at.
const MAX_LEADERS: usize = 3;
/// How far ahead they may be, for 1/10 scale cars \[m\].
const REACH_M: f64 = 9.0;
/// Share of the vehicles of a lane that drive slower than its flow.
const FLOW_SHARE: f64 = 0.85;

/// The wanted speed of a driver who adapts by the shares `[α, β]` \[m/s\]; `None` if it adapts to no vehicle.
pub(super) fn adapted_speed_mps(scene: &Scene, [to_leaders, to_lane]: [f64; 2]) -> Option<f64> {
    let wanted_mps = scene.goal.target.speed_mps;
    let mut change_mps = 0.0;
    if to_leaders > 0.0 {
        change_mps += leaders_mean_mps(scene).map_or(0.0, |mean_mps| to_leaders * (mean_mps - wanted_mps));
    }
    if to_lane > 0.0 {
        change_mps += lane_flow_mps(scene).map_or(0.0, |flow_mps| to_lane * (flow_mps - wanted_mps));
    }
    let limits = &scene.ego.limits;
    (change_mps != 0.0).then(|| (wanted_mps + change_mps).clamp(limits.speed_min_mps, limits.speed_max_mps))
}

/// The mean speed of the nearest vehicles ahead in the lane \[m/s\].
fn leaders_mean_mps(scene: &Scene) -> Option<f64> {
    let ego = &scene.ego;
    let reach_m = REACH_M * ego.body.scale;
    let ahead = scene.others.iter().filter(|other| ego.shares_lane_with(other));
    let mut ahead: Vec<(f64, &Agent)> = ahead.map(|other| (ego.lead_of(other), other)).collect();
    ahead.retain(|(lead_m, _)| *lead_m > 0.0 && *lead_m <= reach_m);
    ahead.sort_by(|a, b| a.0.total_cmp(&b.0));
    ahead.truncate(MAX_LEADERS);
    let sum_mps: f64 = ahead.iter().map(|(_, other)| other.state.speed_mps).sum();
    (!ahead.is_empty()).then(|| sum_mps / ahead.len() as f64)
}

/// The speed that most vehicles of the lane do not exceed, with the own one among them \[m/s\].
fn lane_flow_mps(scene: &Scene) -> Option<f64> {
    let in_lane = scene.others.iter().filter(|other| scene.ego.shares_lane_with(other));
    let mut speeds_mps: Vec<f64> = in_lane.map(|other| other.state.speed_mps).collect();
    if speeds_mps.is_empty() {
        return None;
    }
    speeds_mps.push(scene.ego.state.speed_mps);
    speeds_mps.sort_by(f64::total_cmp);
    let place = FLOW_SHARE * (speeds_mps.len() - 1) as f64;
    let below = place.floor() as usize;
    let above = (below + 1).min(speeds_mps.len() - 1);
    Some(speeds_mps[below] + (place - below as f64) * (speeds_mps[above] - speeds_mps[below]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{agent, scene};

    fn between_others() -> Scene {
        let others = vec![
            agent(1.0, 0.185, 0.0, 0.6),
            agent(2.0, 0.185, 0.0, 0.9),
            agent(12.0, 0.185, 0.0, 0.1),
            agent(1.5, 0.9, 0.0, 0.1),
            agent(-1.0, 0.185, 0.0, 1.4),
        ];
        scene(agent(0.0, 0.185, 0.0, 1.2), others)
    }

    #[test]
    fn the_wanted_speed_moves_towards_those_ahead_in_the_lane() {
        let adapted = adapted_speed_mps(&between_others(), [0.5, 0.0]).expect("a vehicle is ahead");
        assert!((adapted - (1.2 + 0.5 * (0.75 - 1.2))).abs() < 1e-12, "{adapted}");
    }

    #[test]
    fn the_flow_of_the_lane_is_a_quantile_of_its_speeds() {
        // 0.1, 0.6, 0.9, 1.2 and 1.4 m/s: 85 % of the way is 0.4 of the way from the fourth to the fifth.
        let adapted = adapted_speed_mps(&between_others(), [0.0, 1.0]).expect("a lane with others");
        assert!((adapted - 1.28).abs() < 1e-12, "{adapted}");
    }

    #[test]
    fn a_driver_that_does_not_adapt_wants_the_speed_of_its_goal() {
        assert_eq!(adapted_speed_mps(&between_others(), [0.0; 2]), None);
        let alone = Scene { others: Vec::new(), ..between_others() };
        assert_eq!(adapted_speed_mps(&alone, [0.5, 0.5]), None);
    }
}
