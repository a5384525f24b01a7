//! The families of models, each fitted to recordings.

use interplay_planners::drivers::{human, idm};
use interplay_planners::motion_prediction::{CarFollowing, LateralMotion, MotionModel, PredictedDriver, STEP_S};

use super::search::{self, Parameter};
use crate::start::Start;

/// Index of the horizon at which models are fitted: 3 s.
pub(super) const FIT_HORIZON: usize = 2;
/// The step of a prediction at that horizon.
pub(super) const FIT_STEP: usize = 15;

pub(super) struct Family {
    pub name: &'static str,
    pub parameters: &'static [Parameter],
    /// Whether the lateral speed of the start decays in the model.
    pub decays: bool,
    /// Whether its prediction is a plan, which takes a thousand times as long.
    pub plans: bool,
    /// Creates the model from values of the parameters and the decay time of the lateral speed \[s\].
    pub model: fn(&[f64], f64) -> MotionModel,
}

const HEADWAY: Parameter =
    Parameter { name: "headway_s", values: &[0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0], start: 5 };
const GAP: Parameter = Parameter { name: "gap_m", values: &[0.5, 1.0, 1.5, 2.0, 3.0, 4.0], start: 3 };
const ACCELERATION: Parameter =
    Parameter { name: "acceleration_mps2", values: &[0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0, 1.4, 2.0], start: 5 };
const BRAKING: Parameter = Parameter { name: "braking_mps2", values: &[0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0], start: 3 };
const WANTED: Parameter =
    Parameter { name: "wanted_above_mps", values: &[0.0, 0.5, 1.0, 2.0, 3.0, 5.0, 8.0, 12.0], start: 3 };
const LAG: Parameter =
    Parameter { name: "lag_s", values: &[0.2, 0.4, 0.6, 0.8, 1.0, 1.3, 1.6, 2.0, 2.5, 3.0], start: 4 };
const DECAY: Parameter =
    Parameter { name: "decay_s", values: &[0.1, 0.3, 0.5, 0.7, 1.0, 1.3, 1.6, 2.0, 2.5, 3.0, 4.0, 6.0], start: 4 };

const HALF_NOISE: Parameter =
    Parameter { name: "half_noise_mps", values: &[0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.4, 1.0], start: 5 };

/// All models that are compared. The first is the baseline of the others.
pub(super) const FAMILIES: [Family; 8] = [
    Family {
        name: "constant velocity",
        parameters: &[],
        decays: false,
        plans: false,
        model: |_, _| MotionModel::ConstantVelocity,
    },
    Family { name: "seen", parameters: &[], decays: false, plans: false, model: |_, _| MotionModel::Seen },
    Family {
        name: "decaying acceleration",
        parameters: &[DECAY, HALF_NOISE],
        decays: true,
        plans: false,
        model: |values, decay_s| MotionModel::DecayingAcceleration {
            time_s: values[0],
            half_noise_mps: values[1],
            lateral: LateralMotion::Decaying(decay_s),
        },
    },
    Family {
        name: "IDM, literature",
        parameters: &[],
        decays: false,
        plans: false,
        model: |_, _| MotionModel::CarFollowing(CarFollowing::literature()),
    },
    Family {
        name: "IDM, fitted",
        parameters: &[HEADWAY, GAP, ACCELERATION, BRAKING, WANTED],
        decays: true,
        plans: false,
        model: |values, decay_s| idm_model(values, [0.0, 1.0], decay_s),
    },
    Family {
        name: "IDM, fitted with a lag",
        parameters: &[HEADWAY, GAP, ACCELERATION, BRAKING, WANTED, LAG, HALF_NOISE],
        decays: true,
        plans: false,
        model: |values, decay_s| idm_model(values, [values[5], values[6]], decay_s),
    },
    Family {
        name: "human, as it is",
        parameters: &[],
        decays: false,
        plans: true,
        model: |_, _| MotionModel::Driver(PredictedDriver::usual()),
    },
    Family {
        name: "human, fitted",
        parameters: &[
            Parameter {
                name: "acceleration_change",
                values: &[0.05, 0.1, 0.2, 0.3, 0.4, 0.6, 0.9, 1.3, 2.0, 3.0],
                start: 3,
            },
            Parameter { name: "following_weight", values: &[0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 10.0, 20.0], start: 3 },
            Parameter { name: "time_gap_s", values: &[0.2, 0.4, 0.6, 0.8, 1.0, 1.15, 1.3, 1.6, 2.0], start: 5 },
            Parameter { name: "adapts_to_leaders", values: &[0.0, 0.1, 0.2, 0.27, 0.35, 0.45, 0.6], start: 3 },
            Parameter { name: "adapts_to_lane", values: &[0.0, 0.05, 0.1, 0.2, 0.3], start: 2 },
            Parameter { name: "own_acceleration", values: &[0.0, 0.25, 0.5, 0.75, 1.0, 1.25], start: 4 },
            HALF_NOISE,
            Parameter { name: "wants_ahead_s", values: &[0.0, 0.4, 0.8, 1.2, 1.6, 2.0, 2.5, 3.0], start: 2 },
        ],
        decays: true,
        plans: true,
        model: human_model,
    },
];

fn idm_model(values: &[f64], [lag_s, half_noise_mps]: [f64; 2], decay_s: f64) -> MotionModel {
    let settings = idm::Settings {
        headway_s: values[0],
        gap_m: values[1],
        acceleration_mps2: values[2],
        braking_mps2: values[3],
        ..idm::Settings::default()
    };
    let lateral = LateralMotion::Decaying(decay_s);
    MotionModel::CarFollowing(CarFollowing {
        settings,
        wanted_above_mps: Some(values[4]),
        lag_s,
        half_noise_mps,
        lateral,
    })
}

/// Safety weight of the fitted driver. It does not change predictions measurably, since the time gap is fitted too.
const SAFETY_WEIGHT: f64 = 0.5;

fn human_model(values: &[f64], decay_s: f64) -> MotionModel {
    let settings = human::Settings {
        safety_weight: Some(SAFETY_WEIGHT),
        following_weight: values[1],
        adapts_to_leaders: values[3],
        adapts_to_lane: values[4],
        ..human::Settings::default()
    };
    MotionModel::Driver(PredictedDriver {
        settings,
        acceleration_change: values[0],
        time_gap_s: values[2],
        own_acceleration: values[5],
        half_noise_mps: values[6],
        wants_ahead_s: values[7],
        wanted_mps: None,
        looks_beside: false,
        lateral: Some(LateralMotion::Decaying(decay_s)),
    })
}

/// The decay time of lateral speeds that minimises the mean squared error across the road after 3 s \[s\].
pub(crate) fn decay_s(starts: &[&Start]) -> f64 {
    let error = |values: &[f64]| {
        let time_s = values[0];
        let passed = 1.0 - libm::exp(-STEP_S * FIT_STEP as f64 / time_s);
        let square = |start: &&Start| {
            let at_m = start.known.across_m + start.known.lateral_speed_mps * time_s * passed;
            let error_m = at_m - start.truth[FIT_HORIZON].across_m;
            error_m * error_m
        };
        starts.iter().map(square).sum::<f64>() / starts.len().max(1) as f64
    };
    search::least(&[DECAY], error)[0]
}
