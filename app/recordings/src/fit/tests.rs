//! Parameters of drivers are recovered from their trajectories: our human follows a car of varying speed, with disturbances.

use interplay_common::random::Random;
use interplay_planners::motion_prediction::{MotionModel, NearbyVehicle, STEP_S, TrafficMoment};
use interplay_scenarios::{RecordedMoment, RecordedTraffic, RecordedVehicle};

use super::*;
use crate::traffic::Timeline;

/// Number of simulated steps: 80 s.
const STEPS: usize = 400;
/// Standard deviation of the disturbances of its acceleration \[m/s²\].
const DISTURBANCE_MPS2: f64 = 0.15;

/// The record of our human behind a car that speeds up and slows down.
fn driven(ratio: f64, comfort: f64, seed: u64) -> Recordings {
    let model = MotionModel::Driver(driver(ratio, comfort, 22.0));
    let mut random = Random::new(seed, 1);
    let (mut leader, mut own) = ([40.0, 15.0, 0.0], [0.0, 15.0, 0.0]);
    let mut target_mps = 15.0;
    let mut rows = [Vec::new(), Vec::new()];
    for step in 0..STEPS {
        for (rows, [along_m, speed_mps, _]) in rows.iter_mut().zip([leader, own]) {
            rows.push(RecordedMoment { step: step as i64, position: [along_m, 0.0], heading_rad: 0.0, speed_mps });
        }
        let ahead = NearbyVehicle {
            ahead_m: leader[0] - own[0],
            speed_mps: leader[1],
            length_m: 4.5,
            width_m: 1.8,
            ..NearbyVehicle::default()
        };
        let known = TrafficMoment {
            speed_mps: own[1],
            acceleration_mps2: own[2],
            length_m: 4.5,
            width_m: 1.8,
            lane_width_m: 3.5,
            road_m: [1.75; 2],
            others: vec![ahead],
            ..TrafficMoment::default()
        };
        let planned_m = model.predict(&known).along_m[1];
        let planned_mps2 = (planned_m - own[1] * STEP_S) / (0.5 * STEP_S * STEP_S);
        own = moved(own, planned_mps2.clamp(-6.0, 3.0) + random.normal(0.0, DISTURBANCE_MPS2));
        if step % 40 == 0 {
            target_mps = random.uniform(8.0, 20.0);
        }
        leader = moved(leader, (0.4 * (target_mps - leader[1])).clamp(-2.0, 1.5));
    }
    let [first, second] = rows;
    let vehicle = |id: &str, moments| RecordedVehicle {
        id: id.to_owned(),
        kind: "car".to_owned(),
        length_m: 4.5,
        width_m: 1.8,
        moments,
    };
    let vehicles = vec![vehicle("leader", first), vehicle("own", second)];
    let traffic = RecordedTraffic { name: "driven".to_owned(), step_s: STEP_S, lanes: Vec::new(), vehicles };
    Recordings::of(vec![Timeline::of(traffic, 0)])
}

/// Position, speed and acceleration a step later.
fn moved([along_m, speed_mps, _]: [f64; 3], acceleration_mps2: f64) -> [f64; 3] {
    let next_mps = (speed_mps + STEP_S * acceleration_mps2).max(0.0);
    [along_m + 0.5 * STEP_S * (speed_mps + next_mps), next_mps, (next_mps - speed_mps) / STEP_S]
}

/// True parameters of the drivers: multiple of the time gap, weight of changes of the acceleration.
const DRIVERS: [[f64; 2]; 3] = [[0.6, 0.1], [0.85, 0.3], [1.4, 0.17]];

#[test]
fn parameters_of_drivers_are_recovered_from_their_trajectories() {
    let mut covered = 0;
    for (seed, [ratio, comfort]) in DRIVERS.into_iter().enumerate() {
        let found = fit_driver(&driven(ratio, comfort, seed as u64), "own").expect("it followed the leader");
        let gap = found.time_gap_s;
        assert!((gap.value / usual_gap_s() / ratio - 1.0).abs() < 0.25, "{ratio}, {comfort}: {found:?}");
        assert!(found.along_rmse_m < found.constant_velocity_rmse_m, "{found:?}");
        covered += usize::from((gap.low..=gap.high).contains(&(usual_gap_s() * ratio)));
    }
    assert!(covered >= 2, "{covered} of {} intervals contain the true value", DRIVERS.len());
}

#[test]
fn a_vehicle_without_a_leader_cannot_be_fitted() {
    let recordings = driven(1.0, 0.1, 9);
    assert!(matches!(fit_driver(&recordings, "leader"), Err(RecordingsError::TooLittleFollowing { starts: 0, .. })));
    assert!(matches!(fit_driver(&recordings, "missing"), Err(RecordingsError::UnknownVehicle { .. })));
}

/// Takes minutes: `cargo test --release -p interplay-recordings coverage -- --ignored --nocapture`.
#[test]
#[allow(clippy::print_stdout, reason = "the numbers are the result")]
#[ignore = "measures how often intervals have the truth, on forty drivers"]
fn coverage_of_the_intervals() {
    let mut random = Random::new(7, 7);
    let mut covered = [0_u32; 2];
    const COUNT: u64 = 40;
    for seed in 0..COUNT {
        let (ratio, comfort) = (random.uniform(0.55, 1.6), libm::exp(random.uniform(libm::log(0.05), libm::log(0.5))));
        let found = fit_driver(&driven(ratio, comfort, 100 + seed), "own").expect("it followed the leader");
        let has = |it: MeasureInterval, truth: f64| u32::from((it.low..=it.high).contains(&truth));
        covered[0] += has(found.time_gap_s, usual_gap_s() * ratio);
        covered[1] += has(found.acceleration_change, comfort);
        println!("{ratio:.2} {:?} | {comfort:.2} {:?}", found.time_gap_s, found.acceleration_change);
    }
    println!("of {COUNT}: time gap {}, comfort {}", covered[0], covered[1]);
}
