//! A driver who closes the gap: it drives faster while a vehicle from another lane is about to cut in ahead of it.
//!
//! The source has such drivers in figure 7.2 ("accelerates and ignores the lane changing need") and no model of them: a safety
//! weight of 0 ignores the other. Here the wanted speed rises by a stated amount as long as another vehicle
//! of the same road, not behind this one, would at its present heading and speed come into this one's lane within the
//! horizon.

use crate::prediction::steadily_along;
use crate::{Agent, Scene};

/// The speed that a driver with `closing_mps` wants while a vehicle threatens to cut in \[m/s\]; `None`
/// if none does.
pub(super) fn hurried_speed_mps(scene: &Scene, closing_mps: f64) -> Option<f64> {
    if closing_mps <= 0.0 || !scene.others.iter().any(|other| cuts_in(scene, other)) {
        return None;
    }
    let wanted = scene.goal.target.speed_mps + closing_mps;
    Some(wanted.min(scene.ego.limits.speed_max_mps))
}

fn cuts_in(scene: &Scene, other: &Agent) -> bool {
    let own = &scene.ego;
    let is_behind = own.lead_of(other) < -(own.body.rear_m + other.body.front_m);
    if own.crosses(other) || own.shares_lane_with(other) || is_behind {
        return false;
    }
    let lateral = own.across_m();
    let reach = 0.5 * (own.body.width_m + other.body.width_m);
    let predicted = steadily_along(&other.route, &other.body, &other.state, scene.horizon, scene.step_s);
    predicted.states.iter().any(|state| (own.route.across(state.position()) - lateral).abs() < reach)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{agent, crossing, scene};

    fn wanted(other: Agent) -> f64 {
        let mut scene = scene(agent(0.0, 0.555, 0.0, 1.2), vec![other]);
        scene.goal.target.speed_mps = 1.2;
        hurried_speed_mps(&scene, 0.2).unwrap_or(scene.goal.target.speed_mps)
    }

    #[test]
    fn a_driver_closes_the_gap_only_to_vehicles_that_turn_towards_its_lane() {
        assert_eq!(wanted(agent(0.5, 0.185, 0.1, 1.0)), 1.4);
        assert_eq!(wanted(agent(0.5, 0.185, 0.0, 1.0)), 1.2, "it keeps its lane");
        assert_eq!(wanted(agent(-0.5, 0.185, 0.1, 1.0)), 1.2, "it is behind");
        assert_eq!(wanted(agent(0.6, 0.5, 0.1, 1.0)), 1.2, "it is in the lane already");
        assert_eq!(wanted(crossing(1.0, -1.0, 1.0)), 1.2, "it crosses");
    }

    #[test]
    fn a_driver_closes_gaps_within_its_limits_and_only_if_set_to() {
        let mut scene = scene(agent(0.0, 0.555, 0.0, 1.2), vec![agent(0.5, 0.185, 0.1, 1.0)]);
        scene.goal.target.speed_mps = 1.4;
        let most = scene.ego.limits.speed_max_mps;
        assert_eq!(hurried_speed_mps(&scene, 5.0), Some(most));
        assert_eq!(hurried_speed_mps(&scene, 0.0), None);
    }
}
