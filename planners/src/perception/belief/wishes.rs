//! What an observed driver may want.
//!
//! Goals are not visible. A driver is assumed to weigh and to keep its distance as the observer does itself (`Goal::tracking`,
//! `comfort` and `safety` of the observer). What it may want besides is a grid:
//!
//! - **speed**: that at which it was first seen, or a fifth more or less; of one first seen slower than half the observer's wanted
//!   speed, that half takes the place of its speed;
//! - **lateral position**: the one at which it was first seen, or on a road with several lanes that of the observer or of the
//!   observer's goal, approached with the observer's lateral weight or with a tenth of it. On a network of lanes it keeps to its
//!   route, which is known.

use crate::{Agent, Goal, Scene, State};

/// Ratios of the wanted speed to the one first seen, with their prior probabilities; the likeliest first.
const SPEEDS: [(f64, f64); 3] = [(1.0, 0.6), (1.2, 0.2), (0.8, 0.2)];
/// No driver is believed to want less than this share of the speed that the observer wants, times the ratio above.
const SLOWEST_RATIO: f64 = 0.5;
/// Prior probability that a driver keeps its lateral position where it could change it.
const KEEPING_PRIOR: f64 = 0.7;
/// Ratios of the lateral weight of a driver that changes lanes to that of the observer.
const URGENCIES: [f64; 2] = [1.0, 0.1];

/// A goal that a driver may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wish {
    pub goal: Goal,
    /// Prior probability; those of all wishes sum to 1.
    pub prior: f64,
}

/// The wishes that a driver may have who is first seen at `seen`; the likeliest first.
pub(super) fn wishes(observed: &Agent, seen: &State, scene: &Scene) -> Vec<Wish> {
    let laterals = laterals(observed, seen, scene);
    let usual_mps = seen.speed_mps.max(SLOWEST_RATIO * scene.goal.target.speed_mps);
    let mut wishes: Vec<Wish> = Vec::new();
    for (ratio, speed_prior) in SPEEDS {
        for &(across_m, urgency, lateral_prior) in &laterals {
            let target = target(observed, seen, across_m, ratio * usual_mps);
            let [along, across, heading, speed] = scene.goal.tracking;
            let tracking = [along, urgency * across, heading, speed];
            wishes.push(Wish { goal: Goal { target, tracking, ..scene.goal }, prior: speed_prior * lateral_prior });
        }
    }
    wishes
}

/// Lateral coordinates that it may want, with the ratio of the lateral weight and the prior probability.
fn laterals(observed: &Agent, seen: &State, scene: &Scene) -> Vec<(f64, f64, f64)> {
    let route = &observed.route;
    if route.is_in_network() {
        return vec![(0.0, 1.0, 1.0)];
    }
    let own_m = route.across(seen.position());
    let mut others_m: Vec<f64> = Vec::new();
    if !observed.crosses(&scene.ego) {
        let [right_m, left_m] = route.edges_before_end_m(route.along(seen.position()));
        let half_m = 0.5 * observed.body.width_m;
        for place in [scene.goal.target.position(), scene.ego.state.position()] {
            let across_m = route.across(place);
            let is_new = others_m.iter().chain([&own_m]).all(|known| (known - across_m).abs() > half_m);
            if is_new && (right_m + half_m..=left_m - half_m).contains(&across_m) {
                others_m.push(across_m);
            }
        }
    }
    if others_m.is_empty() {
        return vec![(own_m, 1.0, 1.0)];
    }
    let prior = (1.0 - KEEPING_PRIOR) / (others_m.len() * URGENCIES.len()) as f64;
    let changes = others_m.iter().flat_map(|across_m| URGENCIES.map(|urgency| (*across_m, urgency, prior)));
    [(own_m, 1.0, KEEPING_PRIOR)].into_iter().chain(changes).collect()
}

/// The state that a driver wants at a lateral coordinate and a speed.
fn target(observed: &Agent, seen: &State, across_m: f64, speed_mps: f64) -> State {
    let at = observed.route.locate(seen.position(), None);
    let [x_m, y_m] = observed.route.centre.position(at.along_m, across_m);
    let speed_mps = speed_mps.min(observed.limits.speed_max_mps);
    State { x_m, y_m, heading_rad: at.heading_rad, speed_mps }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Corridor;
    use crate::fixture::{agent, crossing, scene};

    fn among_lanes(observed: Agent, goal_m: f64) -> Vec<Wish> {
        let lanes = |agent: Agent| {
            let heading_rad = agent.state.heading_rad;
            Agent { route: Corridor { heading_rad, right_m: 0.0, left_m: 0.74, end: None }.into(), ..agent }
        };
        let mut scene = scene(lanes(agent(0.0, 0.185, 0.0, 1.0)), vec![lanes(observed)]);
        scene.goal.target.y_m = goal_m;
        scene.goal.tracking = [0.0, 4.0, 1.0, 1.0];
        let observed = &scene.others[0];
        wishes(observed, &observed.state, &scene)
    }

    #[test]
    fn priors_sum_to_one_and_the_likeliest_wish_is_the_first() {
        for wishes in [among_lanes(agent(1.0, 0.185, 0.0, 1.0), 0.185), among_lanes(agent(1.0, 0.555, 0.0, 1.0), 0.555)]
        {
            assert!((wishes.iter().map(|wish| wish.prior).sum::<f64>() - 1.0).abs() < 1e-12);
            assert!(wishes.iter().all(|wish| wish.prior <= wishes[0].prior));
            assert!(wishes[0].goal.target.speed_mps == 1.0);
        }
    }

    #[test]
    fn a_lane_is_wished_for_that_the_observer_drives_in_or_wants() {
        let laterals = |wishes: Vec<Wish>| wishes.iter().take(5).map(|wish| wish.goal.target.y_m).collect::<Vec<f64>>();
        assert_eq!(laterals(among_lanes(agent(1.0, 0.555, 0.0, 1.0), 0.555))[..3], [0.555, 0.185, 0.185]);
        assert_eq!(among_lanes(agent(1.0, 0.185, 0.0, 1.0), 0.185).len(), 3, "the driver wants no other lane");
        assert_eq!(among_lanes(crossing(1.0, -1.0, 1.0), 0.185).len(), 3, "who crosses keeps its lane");
    }
}
