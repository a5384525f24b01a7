//! Measures of predictions.

mod bootstrap;

pub use bootstrap::MeasureInterval;
pub(crate) use bootstrap::{Outcome, Resamples, Scales, Sums, nearest_rank};

use serde::Serialize;

use crate::start::HORIZONS_S;

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
