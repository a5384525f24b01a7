//! The intelligent driver model as a prediction.

use super::{LateralMotion, PredictedMotion, STEP_S, STEPS, TrafficMoment};
use crate::drivers::idm;

/// Steps of the model within a step of the prediction.
const SUBSTEPS: usize = 2;
/// Strongest braking that a prediction has \[m/s²\].
const STRONGEST_BRAKING_MPS2: f64 = 8.0;

/// The intelligent driver model, as a prediction of a vehicle in traffic.
#[derive(Clone, Debug, PartialEq)]
pub struct CarFollowing {
    /// Time gap, gap at standstill, acceleration, braking and exponent.
    pub settings: idm::Settings,
    /// By how much the wanted speed is above the present one \[m/s\]; none for the speed limit, or without one the highest speed in
    /// the lane.
    pub wanted_above_mps: Option<f64>,
    /// The time within which the present acceleration gives way to the model's; 0 for the model as it was published \[s\].
    pub lag_s: f64,
    /// Noise of the record with which half of the present acceleration is trusted \[m/s\].
    pub half_noise_mps: f64,
    /// How the lateral place goes on.
    pub lateral: LateralMotion,
}

impl CarFollowing {
    /// The values of the literature for real cars, [`idm::Settings::literature`].
    pub fn literature() -> CarFollowing {
        let settings = idm::Settings::literature();
        CarFollowing { settings, wanted_above_mps: None, lag_s: 0.0, half_noise_mps: 1.0, lateral: LateralMotion::Kept }
    }

    /// The speed that the vehicle wants \[m/s\].
    fn wanted_mps(&self, moment: &TrafficMoment) -> f64 {
        let fastest = || moment.leaders().iter().map(|it| it.speed_mps).fold(moment.speed_mps, f64::max);
        match self.wanted_above_mps {
            Some(above_mps) => (moment.speed_mps + above_mps).max(1.0),
            None => moment.speed_limit_mps.unwrap_or_else(fastest).max(1.0),
        }
    }

    pub(super) fn predict(&self, moment: &TrafficMoment) -> PredictedMotion {
        let wanted_mps = self.wanted_mps(moment);
        let leader = moment.leaders().first().copied();
        let (mut at_m, mut speed_mps) = (0.0, moment.speed_mps);
        let mut acceleration_mps2 = moment.trusted_acceleration_mps2(self.half_noise_mps);
        let mut along_m = vec![0.0];
        let tick_s = STEP_S / SUBSTEPS as f64;
        let kept = if self.lag_s > 0.0 { libm::exp(-tick_s / self.lag_s) } else { 0.0 };
        for tick in 0..STEPS * SUBSTEPS {
            let ahead = leader.map(|leader| {
                let gap_m = moment.gap_m(&leader) + leader.speed_mps * tick_s * tick as f64 - at_m;
                (gap_m, leader.speed_mps)
            });
            let model_mps2 =
                self.settings.acceleration_behind(speed_mps, wanted_mps, ahead).max(-STRONGEST_BRAKING_MPS2);
            acceleration_mps2 = kept * acceleration_mps2 + (1.0 - kept) * model_mps2;
            let next_mps = (speed_mps + tick_s * acceleration_mps2).max(0.0);
            at_m += 0.5 * tick_s * (speed_mps + next_mps);
            speed_mps = next_mps;
            if (tick + 1) % SUBSTEPS == 0 {
                along_m.push(at_m);
            }
        }
        PredictedMotion { along_m, across_m: self.lateral.places_m(moment) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::behind;
    use super::*;

    #[test]
    fn a_predicted_vehicle_stays_behind_a_slow_leader() {
        let moment = behind(30.0, 5.0);
        let motion = CarFollowing::literature().predict(&moment);
        assert!(motion.along_m[STEPS] < 30.0 + 25.0, "{}", motion.along_m[STEPS]);
    }

    #[test]
    fn an_idm_prediction_with_lag_keeps_the_present_acceleration_at_first() {
        let moment = TrafficMoment { acceleration_mps2: 1.0, ..behind(500.0, 20.0) };
        let at_1_s = |lag_s| {
            CarFollowing { lag_s, wanted_above_mps: Some(0.0), ..CarFollowing::literature() }.predict(&moment).along_m
                [5]
        };
        assert!(at_1_s(5.0) > 20.3 && at_1_s(0.0) < 20.0 + 1e-9);
    }
}
