//! The speed with which the ego reaches its goal in time.

use interplay_planners::State;
use interplay_planners::road::network::RoadNetwork;

use super::super::model::{PlanningProblem, Region};

/// The acceleration with which the ego reaches its desired speed \[m/s²\].
const ACCELERATION_MPS2: f64 = 1.5;
/// The highest speed of a car \[m/s\].
const MAX_SPEED_MPS: f64 = 50.0;
/// The number of bisections of the range of speeds: to less than 0.1 mm/s.
const HALVINGS: usize = 20;

/// The desired speed that reaches the goal in the middle of its time; `None` for a goal without position or time \[m/s\].
pub(super) fn wanted_mps(
    problem: &PlanningProblem<'_>,
    step_s: f64,
    network: &RoadNetwork,
    lanes: &[String],
    start: &State,
) -> Option<f64> {
    let goal = problem.goals.first()?;
    let [from, to] = goal.time?;
    let middle = goal.position.iter().find_map(Region::middle)?;
    let route = network.route(lanes).ok()?;
    let distance_m = route.along(middle) - route.along(start.position());
    let time_s = (0.5 * (from + to) - problem.initial.time) * step_s;
    (distance_m > 0.0 && time_s > 0.0).then(|| speed_mps(distance_m, time_s, start.speed_mps))
}

/// The speed that covers a distance in a time, if it is reached at a constant acceleration and then kept \[m/s\].
fn speed_mps(distance_m: f64, time_s: f64, own_mps: f64) -> f64 {
    let covered_m = |wanted_mps: f64| {
        let changing_s = ((wanted_mps - own_mps).abs() / ACCELERATION_MPS2).min(time_s);
        let reached_mps = own_mps + (wanted_mps - own_mps).signum() * ACCELERATION_MPS2 * changing_s;
        0.5 * (own_mps + reached_mps) * changing_s + reached_mps * (time_s - changing_s)
    };
    let (mut low_mps, mut high_mps) = (0.0, MAX_SPEED_MPS);
    for _ in 0..HALVINGS {
        let middle_mps = 0.5 * (low_mps + high_mps);
        if covered_m(middle_mps) < distance_m {
            low_mps = middle_mps;
        } else {
            high_mps = middle_mps;
        }
    }
    // If no speed is high enough, the acceleration limit is too low; the final speed of a constant acceleration is then the best choice.
    (0.5 * (low_mps + high_mps)).min((2.0 * distance_m / time_s - own_mps).max(own_mps))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arrival_speed_covers_the_distance_in_time() {
        assert!((speed_mps(100.0, 10.0, 10.0) - 10.0).abs() < 1e-3, "as it drives");
        // 10 m/s to 13 m/s takes 2 s and 23 m, and 8 s more are 104 m.
        assert!((speed_mps(127.0, 10.0, 10.0) - 13.0).abs() < 1e-3);
        // 10 m/s to 7 m/s takes 2 s and 17 m.
        assert!((speed_mps(17.0 + 56.0, 10.0, 10.0) - 7.0).abs() < 1e-3);
        assert!(speed_mps(1e4, 1.0, 10.0) <= 2e4, "never reached, and still a number");
    }
}
