//! A day: what is known of it, how it is run, what is left of it.

use super::{Control, ControlError, Design};
use crate::comfort::Targets;
use crate::discretise::Model;

/// What acts on a building besides its equipment, over the steps of a day.
#[derive(Clone, Debug, PartialEq)]
pub struct Disturbance {
    /// Outdoor temperature \[°C\], one per step.
    pub ambient_c: Vec<f64>,
    /// Heat from people, sun and machines \[kW\], stacked time-major: entry t·n + i is zone i in step t.
    pub gains_kw: Vec<f64>,
}

/// What a controller knows in the morning.
#[derive(Clone, Copy, Debug)]
pub struct Morning<'a> {
    /// Temperatures of the nodes at midnight \[°C\], zones first.
    pub initial_c: &'a [f64],
    /// What is wanted.
    pub targets: &'a Targets,
    /// What is expected.
    pub forecast: &'a Disturbance,
    /// What will happen: for the clairvoyant only.
    pub actual: Option<&'a Disturbance>,
}

/// What a controller sees at the start of a step.
#[derive(Clone, Copy, Debug)]
pub struct Observation<'a> {
    /// t, from zero at midnight.
    pub step: usize,
    /// Temperatures of the zones \[°C\].
    pub temperatures_c: &'a [f64],
    /// What is wanted over the day.
    pub targets: &'a Targets,
}

/// What happened. Temperatures are those at the ends of the steps; all are stacked, time-major.
#[derive(Clone, Debug, PartialEq)]
pub struct DayRecord {
    /// Temperatures of the zones T(1) … T(N) \[°C\].
    pub temperatures_c: Vec<f64>,
    /// Heat from the equipment u(0) … u(N−1), within its limits \[kW\].
    pub heat_kw: Vec<f64>,
    /// What the controller asked for \[kW\].
    pub requested_kw: Vec<f64>,
    /// How the controller came to it.
    pub design: Design,
}

impl Disturbance {
    /// Refuses one that does not fit the targets.
    pub(super) fn check(&self, targets: &Targets) -> Result<(), ControlError> {
        ControlError::check_length("the outdoor temperature", self.ambient_c.len(), targets.steps())?;
        ControlError::check_length("the heat gains", self.gains_kw.len(), targets.reference_c.len())
    }

    /// Refuses one that has a number that is none.
    pub(super) fn check_finite(&self) -> Result<(), ControlError> {
        ControlError::check_finite("the outdoor temperature", &self.ambient_c)?;
        ControlError::check_finite("the heat gains", &self.gains_kw)
    }
}

/// Runs a day: the controller plans, acts at each step, and learns at the end. `temperatures_c` are those of the nodes at
/// midnight, and become those of the next midnight.
///
/// # Errors
/// [`ControlError`] if a series has a wrong length or the controller cannot plan; the temperatures are then unchanged.
pub fn run_day(
    plant: &Model,
    temperatures_c: &mut [f64],
    controller: &mut impl Control,
    targets: &Targets,
    forecast: &Disturbance,
    actual: &Disturbance,
) -> Result<DayRecord, ControlError> {
    let network = plant.network();
    let (n, steps) = (network.zone_count(), targets.steps());
    ControlError::check_length("the temperatures at midnight", temperatures_c.len(), network.node_count())?;
    ControlError::check_length("a row of targets", targets.zones, n)?;
    forecast.check(targets)?;
    actual.check(targets)?;
    let initial_c: &[f64] = temperatures_c;
    controller.start_of_day(&Morning { initial_c, targets, forecast, actual: Some(actual) })?;
    let size = n * steps;
    let mut record = DayRecord {
        temperatures_c: Vec::with_capacity(size),
        heat_kw: Vec::with_capacity(size),
        requested_kw: Vec::with_capacity(size),
        design: controller.design(),
    };
    for step in 0..steps {
        let requested_kw = controller.act(&Observation { step, temperatures_c: &temperatures_c[..n], targets });
        let heat_kw: Vec<f64> =
            requested_kw.iter().zip(network.limits_kw()).map(|(kw, limit)| kw.clamp(-limit, *limit)).collect();
        let gains_kw = &actual.gains_kw[step * n..(step + 1) * n];
        plant.step(temperatures_c, &heat_kw, actual.ambient_c[step], gains_kw);
        record.temperatures_c.extend_from_slice(&temperatures_c[..n]);
        record.heat_kw.extend(heat_kw);
        record.requested_kw.extend(requested_kw);
    }
    controller.end_of_day(&record)?;
    Ok(record)
}
