//! Measures of predictions.

mod bootstrap;

pub use bootstrap::MeasureInterval;
pub(crate) use bootstrap::{Resamples, Sums, nearest_rank};

use interplay_planners::motion_prediction::{MotionModel, PredictedMotion, STEP_S, STEPS};
use serde::Serialize;

use crate::geometry::Box2;
use crate::start::{HORIZONS_S, Later, Start};
use crate::traffic::Recordings;

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HorizonErrors {
    /// The time after the start \[s\].
    pub horizon_s: f64,
    /// Root mean squared error along the road \[m\].
    pub along_rmse_m: MeasureInterval,
    /// Root mean squared error across the road \[m\].
    pub across_rmse_m: MeasureInterval,
    /// Mean negative log-likelihood of the position under Laplace distributions along and across the road. Their scales are the mean
    /// errors on the half of the cars on which models are fitted.
    pub negative_log_likelihood: MeasureInterval,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModelMeasures {
    /// Errors after 1 to 5 s.
    pub horizons: Vec<HorizonErrors>,
    /// Share of the predictions that are more than 2 m off after 3 s.
    pub miss_share: MeasureInterval,
    /// Share of the predictions whose body overlaps another recorded one within 3 s.
    pub contact_share_3s: MeasureInterval,
    /// The same within 5 s.
    pub contact_share_5s: MeasureInterval,
    /// Share of the predictions whose centre is outside all lanes after 3 s; none without a map.
    pub off_road_share: Option<MeasureInterval>,
    /// Error along the road after 3 s as a share of that of constant velocity.
    pub along_ratio_to_constant_velocity: MeasureInterval,
    /// The same as a share of that of the fitted IDM without a lag.
    pub along_ratio_to_idm: MeasureInterval,
}

/// The measures of a model from its outcomes and those of constant velocity and of the fitted IDM at the same starts.
pub(crate) fn measures(resamples: &Resamples, own: &[Outcome], others: [&[Outcome]; 2]) -> ModelMeasures {
    let mean = |value: &dyn Fn(&Outcome) -> f64| resamples.estimate(&[Sums::of(resamples, own, value)], |it| it[0]);
    let root = |value: &dyn Fn(&Outcome) -> f64| {
        let sums = Sums::of(resamples, own, &|outcome| value(outcome) * value(outcome));
        resamples.estimate(&[sums], |it| it[0].sqrt())
    };
    let horizons = HORIZONS_S.iter().enumerate().map(|(index, horizon_s)| HorizonErrors {
        horizon_s: *horizon_s,
        along_rmse_m: root(&|outcome| outcome.along_m[index]),
        across_rmse_m: root(&|outcome| outcome.across_m[index]),
        negative_log_likelihood: mean(&|outcome| outcome.negative_log_likelihood[index]),
    });
    let square = |outcome: &Outcome| outcome.along_m[2] * outcome.along_m[2];
    let ratio_to = |other: &[Outcome]| {
        let sums = [Sums::of(resamples, own, &square), Sums::of(resamples, other, &square)];
        resamples.estimate(&sums, |it| (it[0] / it[1].max(1e-12)).sqrt())
    };
    let as_share = |is_so: bool| f64::from(u8::from(is_so));
    let has_map = own.iter().any(|outcome| outcome.is_off_road.is_some());
    ModelMeasures {
        horizons: horizons.collect(),
        miss_share: mean(&|outcome| as_share(libm::hypot(outcome.along_m[2], outcome.across_m[2]) > MISS_M)),
        contact_share_3s: mean(&|outcome| as_share(outcome.touches_within_3s)),
        contact_share_5s: mean(&|outcome| as_share(outcome.touches_within_5s)),
        off_road_share: has_map.then(|| mean(&|outcome| as_share(outcome.is_off_road == Some(true)))),
        along_ratio_to_constant_velocity: ratio_to(others[0]),
        along_ratio_to_idm: ratio_to(others[1]),
    }
}

/// A prediction with a larger error counts as a miss \[m\].
const MISS_M: f64 = 2.0;

const COUNT: usize = HORIZONS_S.len();

#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Outcome {
    /// Predicted minus recorded position along the road at each horizon \[m\].
    pub along_m: [f64; COUNT],
    /// The same across the road \[m\].
    pub across_m: [f64; COUNT],
    /// Negative log-likelihood of the recorded position at each horizon.
    pub negative_log_likelihood: [f64; COUNT],
    pub touches_within_3s: bool,
    pub touches_within_5s: bool,
    /// Whether the centre is outside all lanes after 3 s; none without a map.
    pub is_off_road: Option<bool>,
}

/// The mean absolute errors along and across the road at each horizon, on the starts on which models are fitted \[m\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Scales {
    along_m: [f64; COUNT],
    across_m: [f64; COUNT],
}

/// Minimum scale: records are not more exact than this \[m\].
const LEAST_SCALE_M: f64 = 0.01;
/// Contacts of a predicted body are checked at every this many steps.
const STEPS_BETWEEN: usize = 2;
/// Contact shares are counted up to this time and up to the last horizon \[s\].
const FIRST_S: f64 = 3.0;

impl Scales {
    /// The scales of a model on some starts.
    pub(crate) fn of(model: &MotionModel, starts: &[&Start]) -> Scales {
        use rayon::prelude::*;
        let errors: Vec<_> = starts.par_iter().map(|start| errors_m(&model.predict(&start.known), start)).collect();
        let mean = |index: usize, part: usize| {
            let sum: f64 = errors.iter().map(|errors| errors[part][index].abs()).sum();
            (sum / errors.len().max(1) as f64).max(LEAST_SCALE_M)
        };
        Scales {
            along_m: std::array::from_fn(|index| mean(index, 0)),
            across_m: std::array::from_fn(|index| mean(index, 1)),
        }
    }
}

/// The errors along and across the road at each horizon \[m\].
fn errors_m(motion: &PredictedMotion, start: &Start) -> [[f64; COUNT]; 2] {
    let at = |horizon_s: f64| (horizon_s / STEP_S).round() as usize;
    let along = |index: usize| motion.along_m[at(HORIZONS_S[index])] - start.truth[index].along_m;
    let across = |index: usize| motion.across_m[at(HORIZONS_S[index])] - start.truth[index].across_m;
    [std::array::from_fn(along), std::array::from_fn(across)]
}

impl Outcome {
    /// The outcome of a model's prediction at a start.
    pub(crate) fn of(model: &MotionModel, scales: &Scales, start: &Start, recordings: &Recordings) -> Outcome {
        let motion = model.predict(&start.known);
        let [along_m, across_m] = errors_m(&motion, start);
        let negative_log_likelihood = std::array::from_fn(|index| {
            let term = |error_m: f64, scale_m: f64| libm::log(2.0 * scale_m) + error_m.abs() / scale_m;
            term(along_m[index], scales.along_m[index]) + term(across_m[index], scales.across_m[index])
        });
        let timeline = &recordings.timelines[start.timeline];
        let car = &timeline.tracks[start.track];
        let place = |step: usize| start.way.position(start.along_m + motion.along_m[step], motion.across_m[step]);
        let body = |step: usize| {
            let (middle, heading_rad) = place(step);
            Box2 { middle, heading_rad, half_m: [0.5 * car.length_m, 0.5 * car.width_m] }
        };
        let contact_s = first_contact_s(start, recordings, |step| Some(body(step)));
        let first = (FIRST_S / STEP_S).round() as usize;
        Outcome {
            along_m,
            across_m,
            negative_log_likelihood,
            touches_within_3s: contact_s.is_some_and(|contact_s| contact_s <= FIRST_S + 1e-9),
            touches_within_5s: contact_s.is_some(),
            is_off_road: (!timeline.map.is_empty()).then(|| !timeline.map.covers(place(first).0)),
        }
    }

    /// The outcome of the record itself: contacts of its boxes, and positions outside the lanes of its map.
    pub(crate) fn of_record(start: &Start, recordings: &Recordings) -> Outcome {
        let timeline = &recordings.timelines[start.timeline];
        let later = Later { timeline, track: start.track, step: start.step };
        let contact_s = first_contact_s(start, recordings, |step| later.own_box(STEP_S * step as f64));
        let at_first = later.own_box(FIRST_S).map(|own| own.middle);
        Outcome {
            touches_within_3s: contact_s.is_some_and(|contact_s| contact_s <= FIRST_S + 1e-9),
            touches_within_5s: contact_s.is_some(),
            is_off_road: at_first.filter(|_| !timeline.map.is_empty()).map(|at| !timeline.map.covers(at)),
            ..Outcome::default()
        }
    }
}

/// Time at which a body first overlaps another recorded one \[s\].
fn first_contact_s(start: &Start, recordings: &Recordings, body: impl Fn(usize) -> Option<Box2>) -> Option<f64> {
    let later = Later { timeline: &recordings.timelines[start.timeline], track: start.track, step: start.step };
    let others = later.others();
    let times = (STEPS_BETWEEN..=STEPS).step_by(STEPS_BETWEEN);
    let touches = |step: &usize| body(*step).is_some_and(|own| later.touches(&own, &others, STEP_S * *step as f64));
    times.into_iter().find(touches).map(|step| STEP_S * step as f64)
}
