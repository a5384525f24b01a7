//! The families of models, each fitted to recordings.

use interplay_planners::drivers::human::Style;
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
    pub model: Model,
}

/// Creates a model from values of its parameters and the decay time of the lateral speed \[s\].
type Model = fn(&[f64], f64) -> MotionModel;

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
pub(super) static FAMILIES: [Family; 12] = [
    Family::simple("constant velocity", &[], false, |_, _| MotionModel::ConstantVelocity),
    Family::simple("decaying acceleration", &[DECAY, HALF_NOISE], true, |values, decay_s| {
        let lateral = LateralMotion::Decaying(decay_s);
        MotionModel::DecayingAcceleration { time_s: values[0], half_noise_mps: values[1], lateral }
    }),
    Family::simple("IDM, literature", &[], false, |_, _| MotionModel::CarFollowing(CarFollowing::literature())),
    Family::simple("IDM, literature with a fitted lag", &[LAG, HALF_NOISE], true, |values, decay_s| {
        let lateral = LateralMotion::Decaying(decay_s);
        let [lag_s, half_noise_mps] = [values[0], values[1]];
        MotionModel::CarFollowing(CarFollowing { lag_s, half_noise_mps, lateral, ..CarFollowing::literature() })
    }),
    Family::simple("IDM, fitted", &[HEADWAY, GAP, ACCELERATION, BRAKING, WANTED], true, |values, decay_s| {
        idm_model(values, [0.0, 1.0], decay_s)
    }),
    Family::simple(
        "IDM, fitted with a lag",
        &[HEADWAY, GAP, ACCELERATION, BRAKING, WANTED, LAG, HALF_NOISE],
        true,
        |values, decay_s| idm_model(values, [values[5], values[6]], decay_s),
    ),
    Family::simple("seen motion", &[], false, |_, _| MotionModel::Seen { half_noise_mps: 1.0 }),
    Family::simple("seen motion, noise fitted", &[HALF_NOISE], false, |values, _| MotionModel::Seen {
        half_noise_mps: values[0],
    }),
    Family::planning("human, as it is", &[], false, |_, _| MotionModel::Driver(PredictedDriver::usual())),
    Family::planning("human, measured", &[], false, |_, _| MotionModel::Population(measured([0.0, 0.0]))),
    Family::planning("human, measured, flow fitted", &FLOW, false, |values, _| {
        MotionModel::Population(measured([values[0], values[1]]))
    }),
    Family::planning("human, fitted", &HUMAN, true, human_model),
];

/// The parameters of the human driver.
const HUMAN: [Parameter; 8] = [
    Parameter { name: "acceleration_change", values: &[0.05, 0.1, 0.2, 0.3, 0.4, 0.6, 0.9, 1.3, 2.0, 3.0], start: 3 },
    // 5 % of recorded time gaps are below the least.
    Parameter { name: "time_gap_s", values: &[0.6, 0.8, 1.0, 1.15, 1.3, 1.6, 2.0], start: 3 },
    Parameter { name: "keeps_gap", values: &[0.0, 0.5, 1.0], start: 2 },
    Parameter { name: "adapts_to_leaders", values: &[0.0, 0.1, 0.2, 0.27, 0.35, 0.45, 0.6], start: 3 },
    Parameter { name: "adapts_to_lane", values: &[0.0, 0.05, 0.1, 0.2, 0.3], start: 2 },
    HALF_NOISE,
    Parameter { name: "wants_ahead_s", values: &[0.0, 0.4, 0.8, 1.2, 1.6, 2.0, 2.5, 3.0], start: 2 },
    Parameter { name: "drifts_s", values: &[0.0, 1.0, 2.0], start: 1 },
];

impl Family {
    /// A family whose predictions are formulas.
    const fn simple(name: &'static str, parameters: &'static [Parameter], decays: bool, model: Model) -> Family {
        Family { name, parameters, decays, plans: false, model }
    }

    /// A family whose predictions are plans.
    const fn planning(name: &'static str, parameters: &'static [Parameter], decays: bool, model: Model) -> Family {
        Family { name, parameters, decays, plans: true, model }
    }
}

/// By which shares the style `measured` adapts to the vehicles ahead and to its lane: next to nothing up to what it does by itself, and more.
const FLOW: [Parameter; 2] = [
    Parameter { name: "adapts_to_leaders", values: &[1e-6, 0.1, 0.27, 0.4], start: 2 },
    Parameter { name: "adapts_to_lane", values: &[1e-6, 0.1, 0.2], start: 1 },
];

/// Number of members of the style `measured` whose mean is its prediction.
const MEMBERS: u32 = 5;

/// Members of the population of the style `measured`, with the shares by which they adapt if these are not 0.
fn measured([adapts_to_leaders, adapts_to_lane]: [f64; 2]) -> Vec<PredictedDriver> {
    let member = |number: u32| {
        let settings = human::Settings {
            style: Some(Style::Measured),
            member: Some(number),
            adapts_to_leaders,
            adapts_to_lane,
            ..human::Settings::default()
        };
        PredictedDriver { settings, ..PredictedDriver::usual() }
    };
    (0..MEMBERS).map(member).collect()
}

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
        time_gap_ratio: Some(1.0),
        adapts_to_leaders: values[3],
        adapts_to_lane: values[4],
        ..human::Settings::default()
    };
    MotionModel::Driver(PredictedDriver {
        settings,
        acceleration_change: values[0],
        time_gap_s: values[1],
        keeps_gap: values[2],
        half_noise_mps: values[5],
        wants_ahead_s: values[6],
        drifts_s: values[7],
        looks_beside: false,
        lateral: Some(LateralMotion::Decaying(decay_s)),
        ..PredictedDriver::usual()
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
