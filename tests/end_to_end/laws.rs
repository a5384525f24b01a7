//! Laws that hold at every tick of every run.

use interplay_planners::{Bicycle, State};
use interplay_simulation::frame::Origin;

use crate::film::{FILMS, kinematic};

#[test]
fn every_tick_has_a_frame_of_every_vehicle() {
    for film in FILMS.iter() {
        assert_eq!(film.frames.len(), film.scenario.tick_count(), "{}", film.name());
        for (tick, frame) in film.frames.iter().enumerate() {
            assert_eq!(frame.tick, tick);
            assert!((frame.time_s - tick as f64 * film.scenario.step_s).abs() < 1e-9);
            let names = frame.vehicles.iter().map(|vehicle| &vehicle.name);
            assert!(names.eq(film.scenario.vehicles.iter().map(|vehicle| &vehicle.name)));
        }
    }
}

#[test]
fn vehicles_start_where_the_scenario_states() {
    for film in FILMS.iter() {
        let starts: Vec<State> = film.frames[0].vehicles.iter().map(|vehicle| vehicle.state).collect();
        assert_eq!(starts, film.scenario.starts(), "{}", film.name());
    }
}

/// Rolling out the applied inputs through the bicycle gives every state, bit for bit (eq. 6.1-6.5).
#[test]
fn the_kinematic_plant_is_the_bicycle() {
    for film in kinematic() {
        for (index, vehicle) in film.scenario.vehicles.iter().enumerate() {
            let applied: Vec<_> = film.frames.iter().map(|frame| frame.vehicles[index].input).collect();
            let mut states = Vec::new();
            let start = film.frames[0].vehicles[index].state;
            Bicycle::new(&vehicle.body, film.scenario.step_s).roll_out(&start, &applied, &mut states);
            for (tick, state) in states[1..].iter().enumerate() {
                assert_eq!(
                    *state,
                    film.states_after(tick)[index],
                    "{}: {} after tick {tick}",
                    film.name(),
                    vehicle.name
                );
            }
        }
    }
}

#[test]
fn inputs_and_speeds_stay_within_the_limits() {
    for film in kinematic() {
        for (tick, frame) in film.frames.iter().enumerate() {
            for (index, (seen, vehicle)) in frame.vehicles.iter().zip(&film.scenario.vehicles).enumerate() {
                let (limits, input, speed) = (vehicle.limits, seen.input, film.states_after(tick)[index].speed_mps);
                let at = format!("{}: {} at tick {tick}", film.name(), vehicle.name);
                let accelerations = limits.acceleration_min_mps2..=limits.acceleration_max_mps2;
                assert!(accelerations.contains(&input.acceleration_mps2), "{at}: {input:?}");
                assert!(input.steering_rad.abs() <= limits.steering_max_rad, "{at}: {input:?}");
                let before_mps = seen.state.speed_mps;
                let bound_rad = limits.steering_max_at_rad(&vehicle.body, before_mps);
                assert!(input.steering_rad.abs() <= bound_rad, "{at}: {input:?} at {before_mps} m/s");
                let speeds = limits.speed_min_mps - 1e-12..=limits.speed_max_mps + 1e-12;
                assert!(speeds.contains(&speed), "{at}: {speed}");
            }
        }
    }
}

/// The first input of a plan is applied; planners keep to the limits, so that no input is clamped.
#[test]
fn the_first_input_of_each_plan_is_applied() {
    for film in FILMS.iter() {
        for (tick, frame) in film.frames.iter().enumerate() {
            for vehicle in frame.vehicles.iter().filter(|vehicle| vehicle.origin == Origin::Planned) {
                let planned = vehicle.plan.trajectory.inputs[0].to_array();
                for (applied, planned) in vehicle.input.to_array().iter().zip(planned) {
                    let at = format!("{}: {} at tick {tick}", film.name(), vehicle.name);
                    assert!((applied - planned).abs() < 1e-9, "{at}: {planned} became {applied}");
                }
            }
        }
    }
}

/// A plan starts at the state in which it was made, is as long as the horizon, and obeys the bicycle.
#[test]
fn plans_satisfy_the_dynamics_of_their_vehicle() {
    for film in FILMS.iter() {
        for (tick, frame) in film.frames.iter().enumerate() {
            for (seen, vehicle) in frame.vehicles.iter().zip(&film.scenario.vehicles) {
                let plan = &seen.plan.trajectory;
                let at = format!("{}: {} at tick {tick}", film.name(), vehicle.name);
                assert_eq!(plan.horizon(), film.scenario.horizon_steps, "{at}");
                assert_eq!(plan.states[0], seen.state, "{at}");
                let mut states = Vec::new();
                Bicycle::new(&vehicle.body, film.scenario.step_s).roll_out(&seen.state, &plan.inputs, &mut states);
                let pairs = plan.states.iter().zip(&states);
                let off = pairs.flat_map(|(a, b)| (0..4).map(|i| (a.to_array()[i] - b.to_array()[i]).abs()));
                assert!(off.fold(0.0, f64::max) < 1e-12, "{at}");
            }
        }
    }
}

/// The road edges are soft rows of the planners; an exact penalty keeps the vehicles on the road all the same. A scenario may
/// state a larger tolerance, which its verdict then checks.
#[test]
fn vehicles_stay_on_the_road() {
    for film in kinematic() {
        let tolerance_m = film.scenario.expect.off_road_at_most_m.unwrap_or(1e-3);
        for frame in &film.frames {
            for (seen, vehicle) in frame.vehicles.iter().zip(&film.scenario.vehicles) {
                assert!(vehicle.route.contains(&vehicle.body, &seen.state, tolerance_m), "{}: {seen:?}", film.name());
            }
        }
    }
}
