//! A PID controller per zone.
//!
//! ```text
//! u(t) = k_p e(t) + k_i ∫e − k_d dT/dt,        e = r − T,   −limit of cooling ≤ u ≤ limit of heating
//! ```
//!
//! The derivative is that of the temperature, so that a step of the reference causes no peak. Anti-windup by conditional
//! integration: while the output is at a limit, an error that would push it further is not integrated. Where the
//! temperature is free, the output is zero and the integral is reset.

use interplay_common::setting::{self, SettingError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::interface::ControllerKind;
use super::{Control, ControlError, Observation};
use crate::discretise::Model;
use crate::network::PowerLimits;

/// Gains of a PID controller. They are per hour, not per step, so that they do not depend on the step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PidSettings {
    /// Heat per kelvin that the zone is too cold, `k_p` \[kW/K\].
    #[schemars(range(min = 0.0))]
    pub proportional_kw_per_k: f64,
    /// Heat per kelvin and hour that the zone has been too cold, `k_i` \[kW/(K·h)\].
    #[schemars(range(min = 0.0))]
    pub integral_kw_per_k_h: f64,
    /// Heat held back per kelvin an hour by which the temperature rises, `k_d` \[kW·h/K\].
    #[schemars(range(min = 0.0))]
    pub derivative_kw_h_per_k: f64,
}

impl Default for PidSettings {
    /// 0.2, 0.02 and 0.05 per step of half an hour.
    fn default() -> Self {
        Self { proportional_kw_per_k: 0.2, integral_kw_per_k_h: 0.04, derivative_kw_h_per_k: 0.025 }
    }
}

/// PID controllers with their states, one per zone.
#[derive(Clone, Debug)]
pub struct Pid {
    settings: PidSettings,
    limits: PowerLimits,
    step_h: f64,
    /// k_i ∫e \[kW\].
    integral_kw: Vec<f64>,
    before_c: Option<Vec<f64>>,
}

impl Pid {
    /// A controller in each zone.
    ///
    /// # Errors
    /// [`SettingError`] if a gain is negative.
    pub fn new(settings: PidSettings, limits: &PowerLimits, step_s: f64) -> Result<Self, SettingError> {
        setting::check(&settings)?;
        let integral_kw = vec![0.0; limits.zones()];
        Ok(Self { settings, limits: limits.clone(), step_h: step_s / 3600.0, integral_kw, before_c: None })
    }

    /// The output on top of a feedforward `planned_kw`; both together are kept within the limits.
    pub(super) fn act_on_top(&mut self, planned_kw: &[f64], observation: &Observation<'_>) -> Vec<f64> {
        let Observation { step, temperatures_c, targets } = *observation;
        let (reference_c, weight) = (targets.reference_at(step), targets.weight_at(step));
        let before_c = self.before_c.replace(temperatures_c.to_vec());
        let mut output_kw = Vec::with_capacity(self.limits.zones());
        for zone in 0..self.limits.zones() {
            if weight[zone] == 0.0 {
                self.integral_kw[zone] = 0.0;
                output_kw.push(self.limits.limited(zone, planned_kw[zone]));
                continue;
            }
            let error_k = reference_c[zone] - temperatures_c[zone];
            let rise_k = before_c.as_ref().map_or(0.0, |before_c| temperatures_c[zone] - before_c[zone]);
            let direct_kw = planned_kw[zone] + self.settings.proportional_kw_per_k * error_k
                - self.settings.derivative_kw_h_per_k * rise_k / self.step_h;
            let grown_kw = self.integral_kw[zone] + self.settings.integral_kw_per_k_h * self.step_h * error_k;
            let wanted_kw = direct_kw + grown_kw;
            let pushes_further = self.limits.excess_kw(zone, wanted_kw) > 0.0 && wanted_kw * error_k > 0.0;
            if !pushes_further {
                self.integral_kw[zone] = grown_kw;
            }
            output_kw.push(self.limits.limited(zone, direct_kw + self.integral_kw[zone]));
        }
        output_kw
    }
}

impl ControllerKind for PidSettings {
    fn kind(&self) -> &'static str {
        "pid"
    }

    fn look_for(&self) -> &'static str {
        "the controller has no memory: it is equally late every morning, and the cost does not fall"
    }

    fn controller(&self, model: &Model, _: usize) -> Result<Box<dyn Control>, ControlError> {
        Ok(Box::new(Pid::new(*self, model.network().limits(), model.step_s())?))
    }
}

impl Control for Pid {
    fn act(&mut self, observation: &Observation<'_>) -> Vec<f64> {
        self.act_on_top(&vec![0.0; self.limits.zones()], observation)
    }

    fn fork(&self) -> Option<Box<dyn Control>> {
        Some(Box::new(self.clone()))
    }
}
