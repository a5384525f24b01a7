//! The motion models as one type.

use super::{CarFollowing, LateralMotion, PredictedDriver, PredictedMotion, TrafficMoment, acceleration};

/// A model that predicts the motion of a vehicle.
#[derive(Clone, Debug, PartialEq)]
pub enum MotionModel {
    /// Speed and lateral place are kept.
    ConstantVelocity,
    /// The acceleration decays within about `time_s`.
    DecayingAcceleration {
        /// The time within which the acceleration falls to 37 % \[s\].
        time_s: f64,
        /// Noise of the record with which half of the acceleration is trusted \[m/s\].
        half_noise_mps: f64,
        /// How the lateral place goes on.
        lateral: LateralMotion,
    },
    /// The intelligent driver model.
    CarFollowing(CarFollowing),
    /// Our human driver.
    Driver(PredictedDriver),
    /// The motion that drivers expect who know no plans ([`SeenMotion`](crate::perception::SeenMotion)).
    Seen,
}

impl MotionModel {
    /// Predicts the motion of the vehicle.
    pub fn predict(&self, moment: &TrafficMoment) -> PredictedMotion {
        match self {
            MotionModel::ConstantVelocity => acceleration::predict(moment, None, LateralMotion::Kept),
            MotionModel::DecayingAcceleration { time_s, half_noise_mps, lateral } => {
                acceleration::predict(moment, Some([*time_s, *half_noise_mps]), *lateral)
            }
            MotionModel::CarFollowing(model) => model.predict(moment),
            MotionModel::Driver(model) => model.predict(moment),
            MotionModel::Seen => PredictedDriver::usual().predict_seen(moment),
        }
    }
}
