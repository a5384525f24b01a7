//! Protects against a feedback whose model is wrong: the guard weakens the feedback if its inputs alternate, and
//! beforehand if a stated error of the model would make it unstable.
//!
//! A gain that is certified for the believed network can be unstable for the real one. If the believed capacity is twice the real one,
//! the temperature responds twice as strongly, an eigenvalue `1 − b k` of the closed loop leaves the unit circle at −1, and the input
//! jumps between its limits. The certificate cannot detect this, but two checks can:
//!
//! - [`worst_radius`] is the largest spectral radius over capacities and resistances that are wrong by a stated share;
//! - `AlternationGuard` watches the feedback's part of the heat, and halves the gain of a zone after `MOST_TURNS` large changes in
//!   turn up and down. Forecast errors do not alternate from step to step; an eigenvalue below zero does.

use nalgebra::DMatrix;

use crate::control::ControlError;
use crate::control::stability::{closed_loop, spectral_radius};
use crate::discretise::Model;
use crate::network::ModelMismatch;

/// Large changes in turn up and down after which a gain is halved.
const MOST_TURNS: usize = 6;
/// A change is large above this share of the zone's heating and cooling power together.
const LARGE_CHANGE_SHARE: f64 = 0.1;
/// Share of the gain that is left.
const LEFT_SHARE: f64 = 0.5;
/// Most halvings of a gain that a stated error of the model makes unstable.
const MAX_HALVINGS: u32 = 12;

/// Watches the heat of the feedback, zone by zone.
#[derive(Clone, Debug)]
pub(super) struct AlternationGuard {
    /// Large change \[kW\].
    large_kw: Vec<f64>,
    before_kw: Vec<f64>,
    /// The last change \[kW\].
    change_kw: Vec<f64>,
    turns: Vec<usize>,
    share: Vec<f64>,
}

impl AlternationGuard {
    /// A guard of zones with these powers of heating and cooling together \[kW\].
    pub fn new(powers_kw: impl Iterator<Item = f64>) -> Self {
        let large_kw: Vec<f64> = powers_kw.map(|power_kw| LARGE_CHANGE_SHARE * power_kw).collect();
        let zeros = vec![0.0; large_kw.len()];
        let (turns, share) = (vec![0; large_kw.len()], vec![1.0; large_kw.len()]);
        Self { large_kw, before_kw: zeros.clone(), change_kw: zeros, turns, share }
    }

    /// The remaining share of a zone's gain.
    pub fn share(&self, zone: usize) -> f64 {
        self.share[zone]
    }

    /// The smallest share, if a gain was weakened.
    pub fn weakest(&self) -> Option<f64> {
        self.share.iter().copied().filter(|share| *share < 1.0).min_by(f64::total_cmp)
    }

    /// Observes the feedback's part of the heat in a step \[kW\]. If it halves the gain of a zone, returns that zone.
    pub fn observe(&mut self, feedback_kw: &[f64]) -> Option<usize> {
        let mut halved = None;
        for (zone, feedback_kw) in feedback_kw.iter().enumerate() {
            let change_kw = feedback_kw - self.before_kw[zone];
            let is_turn = change_kw * self.change_kw[zone] < 0.0
                && change_kw.abs().min(self.change_kw[zone].abs()) > self.large_kw[zone];
            self.turns[zone] = if is_turn { self.turns[zone] + 1 } else { 0 };
            (self.before_kw[zone], self.change_kw[zone]) = (*feedback_kw, change_kw);
            if self.turns[zone] >= MOST_TURNS {
                self.share[zone] *= LEFT_SHARE;
                self.turns[zone] = 0;
                halved = Some(zone);
            }
        }
        halved
    }
}

/// The largest spectral radius of A − BK over capacities and resistances that are wrong by up to the share `error`,
/// evaluated at the corners, the edge midpoints and the centre of this square.
///
/// # Errors
/// [`ControlError::Model`] if one of the networks cannot be simulated at this step.
pub fn worst_radius(model: &Model, gain: &DMatrix<f64>, error: f64) -> Result<f64, ControlError> {
    let factors = [1.0 / (1.0 + error), 1.0, 1.0 + error];
    let mut worst: f64 = 0.0;
    for capacity_factor in factors {
        for resistance_factor in factors {
            let (inner_resistance_factor, outer_resistance_factor) = (resistance_factor, resistance_factor);
            let mismatch = ModelMismatch { capacity_factor, inner_resistance_factor, outer_resistance_factor };
            // The bounds of the setting keep the factors in their range.
            let Ok(network) = model.network().believed(&mismatch) else { continue };
            let other = Model::new(&network, model.method(), model.step_s())?;
            let radius = spectral_radius(&closed_loop(&other.state_matrix(), &other.gain_matrix(), gain));
            worst = worst.max(if radius.is_nan() { f64::INFINITY } else { radius });
        }
    }
    Ok(worst)
}

/// The gain, halved until it is stable for all networks that are wrong by up to the share `error`, and why it was.
///
/// # Errors
/// [`ControlError::NotRobust`] if no such gain is found.
pub(super) fn robust_gain(
    model: &Model,
    gain: DMatrix<f64>,
    error: f64,
) -> Result<(DMatrix<f64>, Option<ControlError>), ControlError> {
    let spectral_radius = worst_radius(model, &gain, error)?;
    if spectral_radius < 1.0 {
        return Ok((gain, None));
    }
    let mut weaker = gain;
    for halvings in 1..=MAX_HALVINGS {
        weaker *= LEFT_SHARE;
        if worst_radius(model, &weaker, error)? < 1.0 {
            let share = libm::pow(LEFT_SHARE, f64::from(halvings));
            return Ok((weaker, Some(ControlError::NotRobust { error, spectral_radius, share })));
        }
    }
    Err(ControlError::NotRobust { error, spectral_radius, share: 0.0 })
}
