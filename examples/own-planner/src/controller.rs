//! A controller of one's own: it heats in proportion to what is missing.

// shown from here
use interplay_building::control::{Control, ControlError, ControllerKind, DayAhead, DayRecord, Observation};
use interplay_building::discretise::Model;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Heat in proportion to the difference from the wanted temperature.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Proportional {
    /// Heat for each kelvin that is missing.
    #[schemars(range(min = 0.0))]
    gain_kw_per_k: f64,
}

impl Default for Proportional {
    fn default() -> Self {
        Proportional { gain_kw_per_k: 1.0 }
    }
}

impl ControllerKind for Proportional {
    fn kind(&self) -> &'static str {
        "proportional"
    }

    fn controller(&self, _: &Model, _: usize) -> Result<Box<dyn Control>, ControlError> {
        Ok(Box::new(*self))
    }

    fn look_for(&self) -> &'static str {
        "temperatures stay below the wanted ones by what the steady heat needs"
    }
}

impl Control for Proportional {
    fn start_of_day(&mut self, _: &DayAhead<'_>) -> Result<(), ControlError> {
        Ok(())
    }

    fn act(&mut self, observation: &Observation<'_>) -> Vec<f64> {
        let Observation { step, temperatures_c, targets } = *observation;
        let wanted = targets.reference_at(step).iter().zip(targets.weight_at(step));
        let heat_kw = |((reference_c, weight), temperature_c): ((&f64, &f64), &f64)| {
            if *weight > 0.0 { self.gain_kw_per_k * (reference_c - temperature_c) } else { 0.0 }
        };
        wanted.zip(temperatures_c).map(heat_kw).collect()
    }

    fn end_of_day(&mut self, _: &DayRecord) -> Result<(), ControlError> {
        Ok(())
    }

    fn fork(&self) -> Option<Box<dyn Control>> {
        Some(Box::new(*self))
    }
}
// shown until here
