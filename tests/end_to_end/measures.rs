//! Every number of the report, computed again from the frames.

use interplay_planners::State;
use interplay_scenarios::{Branch, LaneReference, Road};
use interplay_simulation::frame::Origin;

use crate::collisions::distance;
use crate::film::{FILMS, Film, kinematic};

/// The states at every tick and after the last one: `[tick][vehicle]`.
fn moments(film: &Film) -> Vec<Vec<State>> {
    let seen = film.frames.iter().map(|frame| frame.vehicles.iter().map(|vehicle| vehicle.state).collect());
    seen.chain([film.report.vehicles.iter().map(|vehicle| vehicle.last).collect()]).collect()
}

/// Smallest distance of the ego's footprint to another.
fn gap_m(film: &Film, states: &[State]) -> f64 {
    let (ego, vehicles) = (film.scenario.ego_index(), &film.scenario.vehicles);
    let others = (0..vehicles.len()).filter(|other| *other != ego);
    let gaps =
        others.map(|other| distance((&vehicles[ego].body, &states[ego]), (&vehicles[other].body, &states[other])));
    gaps.fold(f64::INFINITY, f64::min)
}

/// The physics engine computes in single precision.
#[test]
fn the_gap_is_the_distance_between_the_rectangles() {
    for film in kinematic() {
        let moments = moments(film);
        for (tick, frame) in film.frames.iter().enumerate() {
            let (measured, expected) = (frame.gap_m.expect("there are others"), gap_m(film, &moments[tick]));
            let rounding_m = 1e-5 + 1e-6 * expected;
            assert!((measured - expected).abs() < rounding_m, "{}: {measured} {expected}", film.name());
            assert!(measured >= 0.0);
        }
        // The report looks between the ticks, too, though not at all times.
        let smallest = |moments: &mut dyn Iterator<Item = Vec<State>>| {
            moments.map(|states| gap_m(film, &states)).fold(f64::INFINITY, f64::min)
        };
        let at_ticks = smallest(&mut moments.iter().cloned());
        let often = film.frames.len() * 50;
        let between = smallest(&mut (0..often).map(|i| film.states_at(i as f64 * film.scenario.step_s / 50.0)));
        let measured = film.report.min_gap_m().expect("there are others");
        assert!((between - 1e-3..=at_ticks + 1e-5).contains(&measured), "{}: {measured}", film.name());
        assert!(film.report.collisions.is_empty() && measured > 0.0, "{}", film.name());
    }
}

/// Along a road, the order is that of the last positions; at an intersection, that in which vehicles crossed.
#[test]
fn the_passing_order_follows_the_road_or_the_crossing() {
    for film in FILMS.iter().filter(|film| film.report.collisions.is_empty()) {
        let places = film.report.vehicles.iter().enumerate().map(|(index, vehicle)| {
            let place = match film.scenario.road {
                Road::Intersection(_) => reached(film, index).expect("every vehicle crosses") as f64,
                Road::Lanes(_) | Road::RampMerge(_) => -vehicle.last.x_m,
                // Towards different goals, the order is that of arrival, and then by what is left of the way.
                _ if is_junction(film) => {
                    let route = &film.scenario.vehicles[index].route;
                    let left_m = || 1e6 + route.end_m() - route.along(vehicle.last.position());
                    reached(film, index).filter(|ticks| *ticks > 0).map_or_else(left_m, |ticks| ticks as f64)
                }
                // Where all end side by side, it is that along the ego's way.
                _ if film.scenario.network.is_some() => -film.scenario.main_route().along(vehicle.last.position()),
                _ => -film.scenario.vehicles[index].route.along(vehicle.last.position()),
            };
            (place, &vehicle.name)
        });
        let mut places: Vec<_> = places.collect();
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert!(places.iter().map(|(_, name)| *name).eq(&film.report.order), "{}", film.name());
    }
}

/// Whether vehicles of a film drive to goals that do not lie side by side.
fn is_junction(film: &Film) -> bool {
    let kinds = ["left-turn", "narrow-passage", "roundabout", "all-way-stop", "overtaking"];
    kinds.iter().any(|kind| film.name().starts_with(kind))
}

/// How many ticks it takes a vehicle on a network to have its rear bumper on the last of several lanes; otherwise to have its centre within 15 % of a lane's width of its lane's centre; at an
/// intersection of roads of the width `w` at the angle `γ`, to have its rear bumper `w/2 (1 + |cos γ|)/|sin γ|` beyond the
/// middle, where nothing of its road lies on the other.
fn reached(film: &Film, index: usize) -> Option<usize> {
    let vehicle = &film.scenario.vehicles[index];
    let there = |state: &State| match (&film.scenario.road, vehicle.road) {
        (Road::Intersection(crossing), branch) => {
            let half_m = 0.5 * crossing.lane_count as f64 * crossing.lane_width_m;
            let (sin, cos) = crossing.angle_deg.to_radians().sin_cos();
            let [x, y] = if branch == Branch::Main { [1.0, 0.0] } else { [cos, sin] };
            let passed_m = x * state.x_m + y * (state.y_m - half_m) - vehicle.body.rear_m;
            passed_m > half_m * (1.0 + cos.abs()) / sin.abs()
        }
        _ if film.scenario.network.is_some() => {
            let legs = &vehicle.route.legs;
            let begin_m = legs.last().map_or(0.0, |leg| leg.from_m);
            legs.len() > 1 && vehicle.route.along(state.position()) - vehicle.body.rear_m > begin_m
        }
        (road @ Road::Curve(_), branch) => {
            let at = vehicle.route.locate(state.position(), None);
            let goal_m = vehicle
                .goal
                .lane
                .as_ref()
                .and_then(|lane| road.lane_centre_m(branch, lane.number()?))
                .unwrap_or(at.across_m);
            (at.across_m - goal_m).abs() <= 0.15 * road.lane_width_m()
        }
        (road, _) => {
            let goal_m = vehicle
                .goal
                .lane
                .as_ref()
                .and_then(LaneReference::number)
                .map_or(state.y_m, |lane| (lane as f64 + 0.5) * road.lane_width_m());
            (state.y_m - goal_m).abs() <= 0.15 * road.lane_width_m()
        }
    };
    moments(film).iter().position(|states| there(&states[index]))
}

#[test]
fn vehicles_complete_their_task_in_their_lane_or_beyond_the_crossing() {
    for film in FILMS.iter() {
        for (index, vehicle) in film.report.vehicles.iter().enumerate() {
            let at = format!("{}: {}", film.name(), vehicle.name);
            // A vehicle that starts at its goal has nothing to complete.
            let expected = reached(film, index).filter(|ticks| *ticks > 0);
            let expected = expected.map(|ticks| ticks as f64 * film.scenario.step_s);
            match (vehicle.completed_s, expected) {
                (Some(measured), Some(expected)) => {
                    assert!((measured - expected).abs() < 1e-9, "{at}: {measured} {expected}");
                    let has_round_steps = film.scenario.step_s == 0.1;
                    assert!(!has_round_steps || measured.to_string().len() < 6, "{at}: {measured}");
                }
                (measured, _) => assert_eq!(measured, expected, "{at}"),
            }
        }
    }
}

#[test]
fn reported_speeds_and_comfort_match_the_frames() {
    for film in FILMS.iter() {
        let moments = moments(film);
        for (index, vehicle) in film.report.vehicles.iter().enumerate() {
            let speeds = || moments.iter().map(|states| states[index].speed_mps);
            let extremes = [speeds().fold(f64::INFINITY, f64::min), speeds().fold(f64::NEG_INFINITY, f64::max)];
            assert_eq!(vehicle.speed_range_mps(), extremes);
            let number = |name: &str| vehicle.metrics.number(name).expect("every vehicle has one");
            let accelerations: Vec<f64> =
                film.frames.iter().map(|frame| frame.vehicles[index].input.acceleration_mps2).collect();
            let count = accelerations.len() as f64;
            let mean = accelerations.iter().map(|value| value.abs()).sum::<f64>() / count;
            assert!((number("mean_abs_acceleration") - mean).abs() < 1e-12);
            let before = [0.0].iter().chain(&accelerations);
            let changes = accelerations.iter().zip(before).map(|(now, before)| (now - before).abs());
            let jerk = changes.sum::<f64>() / film.scenario.step_s / count;
            assert!((number("mean_abs_jerk") - jerk).abs() < 1e-9);
            let steering: Vec<f64> = film.frames.iter().map(|frame| frame.vehicles[index].input.steering_rad).collect();
            let turns = [0.0].iter().chain(&steering).zip(&steering).map(|(before, now)| (now - before).abs());
            let rate_radps = turns.fold(0.0, f64::max) / film.scenario.step_s;
            assert!((number("peak_steering_rate_radps") - rate_radps).abs() < 1e-9);
            let asked = film.frames.iter().filter(|frame| frame.vehicles[index].origin != Origin::Crashed);
            assert_eq!(vehicle.plans.count, asked.count());
        }
    }
}
