//! What is known at a start does not change when the record after it does.

use interplay_common::random::Random;
use interplay_planners::motion_prediction::{CarFollowing, LateralMotion, MotionModel, PredictedDriver};
use interplay_scenarios::{RecordedLane, RecordedMoment, RecordedTraffic, RecordedVehicle};

use super::*;

/// Three cars on a road of one lane, with noise.
fn traffic() -> RecordedTraffic {
    let mut random = Random::new(3, 3);
    let mut vehicle = |id: &str, from_m: f64, speed_mps: f64| {
        let moments = (0..80).map(|step| RecordedMoment {
            step,
            position: [from_m + 0.2 * speed_mps * step as f64, random.normal(1.75, 0.1)],
            heading_rad: random.normal(0.0, 0.01),
            speed_mps: speed_mps + random.normal(0.0, 0.1),
        });
        let moments = moments.collect();
        RecordedVehicle { id: id.to_owned(), kind: "car".to_owned(), length_m: 4.5, width_m: 1.8, moments }
    };
    let vehicles = vec![vehicle("a", 0.0, 12.0), vehicle("b", 25.0, 11.0), vehicle("c", 60.0, 12.5)];
    let [left, right] = [3.5, 0.0].map(|y_m| vec![[-50.0, y_m], [400.0, y_m]]);
    let lanes = vec![RecordedLane { id: "1".to_owned(), left, right, ..RecordedLane::default() }];
    RecordedTraffic { name: "made".to_owned(), step_s: 0.2, lanes, vehicles }
}

fn models() -> [MotionModel; 4] {
    [
        MotionModel::ConstantVelocity,
        MotionModel::DecayingAcceleration { time_s: 1.0, half_noise_mps: 0.1, lateral: LateralMotion::Decaying(1.0) },
        MotionModel::CarFollowing(CarFollowing { lag_s: 1.0, ..CarFollowing::literature() }),
        MotionModel::Driver(PredictedDriver::usual()),
    ]
}

#[test]
fn records_after_the_start_do_not_change_predictions() {
    let step = 30;
    let mut changed = traffic();
    for at in changed.vehicles.iter_mut().flat_map(|vehicle| &mut vehicle.moments).filter(|at| at.step > step) {
        at.position = [at.position[0] + 40.0, at.position[1] - 2.0];
        at.speed_mps = 0.3;
        at.heading_rad += 0.5;
    }
    let [before, after] = [traffic(), changed].map(|traffic| Timeline::of(traffic, 0));
    let [known, known_of_changed] = [&before, &after].map(|it| known_at(it, 0, step).expect("it is there").2);
    assert_eq!(known, known_of_changed);
    for model in models() {
        assert_eq!(model.predict(&known), model.predict(&known_of_changed), "{model:?}");
    }
    // A change of the record at the start changes what is known.
    let mut present = traffic();
    for at in present.vehicles[1].moments.iter_mut().filter(|at| at.step == step) {
        at.speed_mps = 3.0;
    }
    let known_of_present = known_at(&Timeline::of(present, 0), 0, step).expect("it is there").2;
    assert!(known_of_present != known);
}

#[test]
fn starts_are_a_second_apart_with_enough_records_around_them() {
    let recordings = Recordings::of(vec![Timeline::of(traffic(), 0)]);
    let steps: Vec<i64> = starts(&recordings).iter().filter(|it| it.track == 0).map(|it| it.step).collect();
    assert_eq!(steps, [6, 11, 16, 21, 26, 31, 36, 41, 46, 51]);
    let start = &starts(&recordings)[0];
    assert!((start.truth[2].along_m - 36.0).abs() < 1e-9 && (start.known.speed_mps - 12.0).abs() < 0.5, "{start:?}");
    assert_eq!(start.known.leaders().len(), 2);
}
