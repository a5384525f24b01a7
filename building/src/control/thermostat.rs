//! An on-off controller: full power when it is too cold or too warm, none otherwise.

use interplay_common::setting;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::interface::ControllerKind;
use super::{Control, ControlError, Observation};
use crate::discretise::Model;
use crate::network::PowerLimits;

/// A two-sided thermostat with a dead band.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ThermostatSettings {
    /// Equipment starts when the error exceeds this \[K\], and stops when the wanted temperature is reached.
    #[schemars(range(min = 0.0))]
    pub dead_band_k: f64,
    /// Power while the equipment runs, as a share of its limit.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "dimensionless"))]
    pub power: f64,
}

impl Default for ThermostatSettings {
    fn default() -> Self {
        Self { dead_band_k: 0.5, power: 1.0 }
    }
}

/// A thermostat with its state: for each zone whether it heats (1), cools (−1) or is off (0).
#[derive(Clone, Debug)]
pub struct Thermostat {
    settings: ThermostatSettings,
    limits: PowerLimits,
    running: Vec<f64>,
}

impl Thermostat {
    /// A thermostat in each zone.
    ///
    /// # Errors
    /// [`ControlError::Setting`] if the dead band is negative, or the power not a share.
    pub fn new(settings: ThermostatSettings, limits: &PowerLimits) -> Result<Self, ControlError> {
        setting::check(&settings)?;
        Ok(Self { settings, limits: limits.clone(), running: vec![0.0; limits.zones()] })
    }
}

impl ControllerKind for ThermostatSettings {
    fn kind(&self) -> &'static str {
        "thermostat"
    }

    fn look_for(&self) -> &'static str {
        "equipment runs at full power or not at all, and temperatures oscillate about the wanted ones"
    }

    fn controller(&self, model: &Model, _: usize) -> Result<Box<dyn Control>, ControlError> {
        Ok(Box::new(Thermostat::new(*self, model.network().limits())?))
    }
}

impl Control for Thermostat {
    fn act(&mut self, observation: &Observation<'_>) -> Vec<f64> {
        let Observation { step, temperatures_c, targets } = *observation;
        let wanted = targets.reference_at(step).iter().zip(targets.weight_at(step));
        for ((running, temperature_c), (reference_c, &weight)) in
            self.running.iter_mut().zip(temperatures_c).zip(wanted)
        {
            let missing_k = reference_c - temperature_c;
            if weight == 0.0 || *running * missing_k <= 0.0 {
                *running = 0.0;
            }
            if weight > 0.0 && missing_k.abs() > self.settings.dead_band_k {
                *running = missing_k.signum();
            }
        }
        let limit_kw = |zone: usize, running: f64| self.limits.towards_kw(zone, running);
        let running = self.running.iter().enumerate();
        running.map(|(zone, running)| running * self.settings.power * limit_kw(zone, *running)).collect()
    }

    fn fork(&self) -> Option<Box<dyn Control>> {
        Some(Box::new(self.clone()))
    }
}
