//! The static feedback of a day: the gain with the wanted decay rate, or else the one with the best rate that is certified.

use nalgebra::DMatrix;

use super::guard::robust_gain;
use super::projection::Projection;
use super::{IterativeSettings, Stability, decay, feedback};
use crate::comfort::Targets;
use crate::control::ControlError;
use crate::control::stability::{closed_loop, positive_decay, spectral_radius};
use crate::control::uncertainty::factor;
use crate::lifted::Lifted;

/// Shares of the way from the wanted decay rate to 1 at which a certificate is tried after it was not found at the wanted one.
const RELAXATIONS: [f64; 3] = [0.0, 0.5, 0.75];

/// A designed static feedback with its certificate and its expected cost.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticFeedback {
    /// Gain K, zones by zones \[kW/K\].
    pub gain_kw_per_k: DMatrix<f64>,
    /// Spectral radius of the closed loop A − BK.
    pub spectral_radius: f64,
    /// The expected cost beyond the nominal one, under the best causal feedback.
    pub causal_cost: f64,
    /// The expected cost beyond the nominal one under K.
    pub cost: f64,
    /// Standard deviations of the inputs under K \[kW\], stacked.
    pub input_deviation_kw: Vec<f64>,
    /// Why K is not certified in the way, and with the decay rate, that was asked for.
    pub weaker: Option<ControlError>,
}

impl StaticFeedback {
    /// Performs steps 1 and 2 for a covariance of the disturbance; `price` is as in [`feedback::optimal_causal`].
    ///
    /// If no gain with the wanted decay rate is found, other certificates and rates nearer to 1 are tried; the initial gain is
    /// the last resort. [`StaticFeedback::weaker`] then says so.
    ///
    /// # Errors
    /// [`ControlError`] if the covariance is not positive definite, the decay rate is below its floor, or not even the initial
    /// gain is stable.
    pub fn design(
        settings: &IterativeSettings,
        lifted: &Lifted,
        targets: &Targets,
        covariance: DMatrix<f64>,
        price: &[f64],
    ) -> Result<Self, ControlError> {
        settings.check_size(lifted)?;
        let factor = factor(covariance)?;
        let causal = feedback::optimal_causal(lifted, targets, &factor, price)?;
        let loops = Loops::new(settings, lifted)?;
        let (gain, weaker) = match settings.stability {
            Stability::Fixed => (loops.initial_gain(), None),
            _ => loops.projected(&Projection::new(lifted, &causal, &targets.busy()), settings.stability)?,
        };
        let (gain, weaker) = if settings.model_error > 0.0 {
            let (gain, not_robust) = robust_gain(lifted.model(), gain, settings.model_error)?;
            (gain, weaker.or(not_robust))
        } else {
            (gain, weaker)
        };
        let spectral_radius = loops.radius(&gain);
        if !is_below_one(spectral_radius) {
            return Err(ControlError::Unstable { spectral_radius });
        }
        let response = feedback::static_feedback(lifted, &gain, &factor);
        Ok(Self {
            gain_kw_per_k: gain,
            spectral_radius,
            causal_cost: causal.cost(targets),
            cost: response.cost(targets),
            input_deviation_kw: response.input_deviation_kw(),
            weaker,
        })
    }
}

/// Whether a radius is below one; that of a matrix with a NaN is not.
fn is_below_one(radius: f64) -> bool {
    matches!(radius.partial_cmp(&1.0), Some(std::cmp::Ordering::Less))
}

/// The closed loops of a model.
struct Loops {
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    decay: f64,
    initial_gain_kw_per_k: f64,
}

impl Loops {
    fn new(settings: &IterativeSettings, lifted: &Lifted) -> Result<Self, ControlError> {
        let model = lifted.model();
        Ok(Self {
            a: model.state_matrix(),
            b: model.gain_matrix(),
            decay: decay::chosen(settings, model)?,
            initial_gain_kw_per_k: settings.initial_gain_kw_per_k,
        })
    }

    fn initial_gain(&self) -> DMatrix<f64> {
        DMatrix::from_diagonal_element(self.b.ncols(), self.b.ncols(), self.initial_gain_kw_per_k)
    }

    fn radius(&self, gain: &DMatrix<f64>) -> f64 {
        spectral_radius(&closed_loop(&self.a, &self.b, gain))
    }

    /// The gain of a method, and why it is not what was asked for.
    fn projected(
        &self,
        projection: &Projection<'_>,
        stability: Stability,
    ) -> Result<(DMatrix<f64>, Option<ControlError>), ControlError> {
        if stability == Stability::LeastSquares {
            let gain = projection.least_squares()?;
            if is_below_one(self.radius(&gain)) {
                return Ok((gain, None));
            }
        }
        let mut reason = None;
        for share in RELAXATIONS {
            let decay = self.decay + share * (1.0 - self.decay);
            let by_inequality = (stability != Stability::Linear).then(|| self.stable(projection.lmi(decay)));
            let found = match by_inequality {
                Some(Ok(gain)) => Ok(gain),
                // Keep the first reason: that of the requested certificate.
                Some(Err(error)) => {
                    reason.get_or_insert(error);
                    self.stable(projection.linear(decay))
                }
                None => self.stable(projection.linear(decay)),
            };
            match found {
                Ok(gain) => return Ok((gain, reason.map(|reason| self.weaker(decay, reason)))),
                Err(error) => _ = reason.get_or_insert(error),
            }
        }
        let gain = self.initial_gain();
        let certified = positive_decay(&closed_loop(&self.a, &self.b, &gain));
        Ok((gain, reason.map(|reason| self.weaker(certified, reason))))
    }

    /// A gain whose closed loop is stable.
    fn stable(&self, gain: Result<DMatrix<f64>, ControlError>) -> Result<DMatrix<f64>, ControlError> {
        let gain = gain?;
        let spectral_radius = self.radius(&gain);
        if is_below_one(spectral_radius) { Ok(gain) } else { Err(ControlError::Unstable { spectral_radius }) }
    }

    fn weaker(&self, certified: f64, reason: ControlError) -> ControlError {
        ControlError::WeakerFeedback { wanted: self.decay, certified, reason: Box::new(reason) }
    }
}
