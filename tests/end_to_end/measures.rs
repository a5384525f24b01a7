//! Every figure of the report, worked out again from the frames.

use interplay_planners::State;

use crate::film::{FILMS, Film};
use crate::rectangles::distance;

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
    for film in FILMS.iter() {
        let moments = moments(film);
        for (tick, frame) in film.frames.iter().enumerate() {
            let (measured, expected) = (frame.gap_m.expect("there are others"), gap_m(film, &moments[tick]));
            assert!(measured >= 0.0 && (measured - expected).abs() < 1e-5, "{}: {measured} {expected}", film.name());
        }
        // The report looks between the ticks, too, though not at all times.
        let smallest = |moments: &mut dyn Iterator<Item = Vec<State>>| {
            moments.map(|states| gap_m(film, &states)).fold(f64::INFINITY, f64::min)
        };
        let at_ticks = smallest(&mut moments.iter().cloned());
        let often = film.frames.len() * 50;
        let between = smallest(&mut (0..often).map(|i| film.states_at(i as f64 * film.scenario.step_s / 50.0)));
        let measured = film.report.min_gap_m.expect("there are others");
        assert!((between - 1e-3..=at_ticks + 1e-5).contains(&measured), "{}: {measured}", film.name());
        assert!(film.report.collisions.is_empty() && measured > 0.0, "{}", film.name());
    }
}

#[test]
fn the_order_is_that_of_the_last_positions() {
    for film in FILMS.iter() {
        let mut places: Vec<_> = film.report.vehicles.iter().map(|vehicle| (vehicle.last.x_m, &vehicle.name)).collect();
        places.sort_by(|a, b| b.0.total_cmp(&a.0));
        assert!(places.iter().map(|(_, name)| *name).eq(&film.report.order), "{}", film.name());
    }
}

/// The ego has changed lane once its centre is within 15 % of a lane's width of the lane's centre.
#[test]
fn the_ego_completes_when_it_reaches_its_lane() {
    for film in FILMS.iter() {
        let ego = film.scenario.ego_index();
        let (lane_m, goal_m) = (film.scenario.road.lane_width_m(), film.scenario.road.lane_centre_m(1));
        let there = |states: &Vec<State>| (states[ego].y_m - goal_m).abs() <= 0.15 * lane_m;
        let expected = moments(film).iter().position(there).map(|tick| tick as f64 * film.scenario.step_s);
        let measured = film.report.vehicles[ego].completed_s;
        match (measured, expected) {
            (Some(measured), Some(expected)) => {
                assert!((measured - expected).abs() < 1e-9, "{}", film.name());
                assert!(measured.to_string().len() < 6, "{}: {measured}", film.name());
            }
            _ => assert_eq!(measured, expected, "{}", film.name()),
        }
    }
}

/// Who starts where it wants to be has nothing to complete.
#[test]
fn the_others_have_nothing_to_complete() {
    for film in FILMS.iter() {
        for vehicle in film.report.vehicles.iter().filter(|vehicle| vehicle.name != "ego") {
            assert_eq!(vehicle.completed_s, None, "{}: {}", film.name(), vehicle.name);
        }
    }
}

#[test]
fn speeds_and_comfort_are_those_of_the_frames() {
    for film in FILMS.iter() {
        let moments = moments(film);
        for (index, vehicle) in film.report.vehicles.iter().enumerate() {
            let speeds = || moments.iter().map(|states| states[index].speed_mps);
            assert_eq!(vehicle.min_speed_mps, speeds().fold(f64::INFINITY, f64::min));
            assert_eq!(vehicle.max_speed_mps, speeds().fold(f64::NEG_INFINITY, f64::max));
            let accelerations: Vec<f64> =
                film.frames.iter().map(|frame| frame.vehicles[index].input.acceleration_mps2).collect();
            let count = accelerations.len() as f64;
            let mean = accelerations.iter().map(|value| value.abs()).sum::<f64>() / count;
            assert!((vehicle.mean_abs_acceleration - mean).abs() < 1e-12);
            let before = [0.0].iter().chain(&accelerations);
            let changes = accelerations.iter().zip(before).map(|(now, before)| (now - before).abs());
            let jerk = changes.sum::<f64>() / film.scenario.step_s / count;
            assert!((vehicle.mean_abs_jerk - jerk).abs() < 1e-9);
            assert_eq!(vehicle.plans.count, film.frames.len());
        }
    }
}
