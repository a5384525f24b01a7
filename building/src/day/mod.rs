//! The closed loop of a building, day by day.
//!
//! ```text
//! midnight        Surroundings: forecast and actual disturbance of the day
//!                 Day::plan     the controller gets the forecast and the targets
//! each step       Day::control  the controller returns the heat of each zone; the equipment gives it within its limits
//!                 Day::balance  the temperatures move on by a step (eq. 2.15), and are recorded
//! end of the day  Day::learn    the controller gets the record
//! ```
//!
//! The application calls these functions from its phases, and [`run_day`] calls them in sequence; no other loop exists.
//!
//! # When a controller fails
//!
//! If a design finds no plan for a day, this is not an error: its controller repeats the previous day and gives the reason
//! ([`crate::control::Design::fallback`]). [`Day::plan`] and [`Day::learn`] return a [`ControlError`] if the controller cannot work with
//! this building or this day at all. The run then ends with that error, and no temperature changes any more.

mod key_figures;
mod surroundings;
mod whole_run;

pub use key_figures::{KeyFigures, ZoneFigures};
pub use surroundings::Surroundings;
pub use whole_run::{RunHistory, RunOptimum};

use std::borrow::Cow;

use crate::comfort::Targets;
use crate::control::{Control, ControlError, DayAhead, DayRecord, Design, Disturbance, Observation};
use crate::discretise::Model;

/// The largest number of inputs of a day (zones times steps) for which its regret is computed: where the model is
/// dense, the optimum takes time proportional to the cube of that number.
pub const MAX_REGRET_INPUTS: usize = 500;

/// A day in progress.
#[derive(Clone, Debug)]
pub struct Day {
    /// Temperatures of the nodes at midnight \[°C\], zones first.
    pub initial_c: Vec<f64>,
    /// The forecast disturbance of the day.
    pub forecast: Disturbance,
    /// The actual disturbance of the day.
    pub actual: Disturbance,
    /// The record of the steps so far.
    pub record: DayRecord,
    /// The forecast for the day after, if it is known.
    outlook: Option<Disturbance>,
    /// The targets under the forecast, where it changes them.
    expected_targets: Option<Targets>,
}

/// Heat from the equipment in a step, one number per zone.
#[derive(Clone, Debug, PartialEq)]
pub struct Heat {
    /// Heat that the controller requested \[kW\].
    pub requested_kw: Vec<f64>,
    /// Heat that the equipment gives: the request within its limits \[kW\].
    pub applied_kw: Vec<f64>,
}

impl Day {
    /// A day at its midnight, before its first step.
    pub fn new(initial_c: Vec<f64>, forecast: Disturbance, actual: Disturbance) -> Self {
        let empty = || Vec::with_capacity(actual.gains_kw.len());
        let record =
            DayRecord { temperatures_c: empty(), heat_kw: empty(), requested_kw: empty(), design: Design::default() };
        Self { initial_c, forecast, actual, record, outlook: None, expected_targets: None }
    }

    /// The same day with a forecast of the next day.
    #[must_use]
    pub fn before(self, outlook: Option<Disturbance>) -> Self {
        Self { outlook, ..self }
    }

    /// Lets the controller plan the day at midnight.
    ///
    /// # Errors
    /// [`ControlError`] if the controller cannot work on this day.
    pub fn plan(&mut self, controller: &mut dyn Control, targets: &Targets) -> Result<(), ControlError> {
        self.expected_targets = match targets.under(&self.forecast.ambient_c) {
            Cow::Borrowed(_) => None,
            Cow::Owned(targets) => Some(targets),
        };
        let Self { initial_c, forecast, outlook, actual, expected_targets, .. } = &*self;
        let targets = expected_targets.as_ref().unwrap_or(targets);
        let outlook = outlook.as_ref();
        controller.start_of_day(&DayAhead { initial_c, targets, forecast, outlook, actual: Some(actual) })?;
        self.record.design = controller.design();
        Ok(())
    }

    /// Asks the controller for the heat of each zone in step `step`, counted from midnight, and limits it to what the
    /// equipment can give. `zones_c` are the temperatures of the zones at the start of the step. The first step of a day that has no
    /// plan of its own is noted in the record.
    pub fn control(
        &mut self,
        plant: &Model,
        controller: &mut dyn Control,
        targets: &Targets,
        step: usize,
        zones_c: &[f64],
    ) -> Heat {
        let targets = self.expected_targets.as_ref().unwrap_or(targets);
        let requested_kw = controller.act(&Observation { step, temperatures_c: zones_c, targets });
        if let Some(why) = controller.trouble()
            && self.record.design.fallback.is_none()
        {
            self.record.design.fallback = Some(why.clone());
            self.record.design.fallbacks += 1;
        }
        let applied_kw = plant.network().limits().limited_all(&requested_kw);
        Heat { requested_kw, applied_kw }
    }

    /// Heat from people, sun and machines in step `step` \[kW\], zones first: one number for each node that can receive any.
    pub fn gains_kw(&self, plant: &Model, step: usize) -> &[f64] {
        let count = plant.network().gain_count();
        &self.actual.gains_kw[step * count..(step + 1) * count]
    }

    /// Moves the temperatures of the nodes on by step `step`, and records it.
    ///
    /// # Panics
    /// When a slice has the wrong length.
    pub fn balance(&mut self, plant: &Model, step: usize, temperatures_c: &mut [f64], heat: &Heat) {
        let gains_kw = self.gains_kw(plant, step);
        plant.step(temperatures_c, &heat.applied_kw, self.actual.ambient_c[step], gains_kw);
        self.record_step(&temperatures_c[..plant.network().zone_count()], heat);
    }

    /// Records a step that ended with these temperatures of the zones \[°C\], computed here or by another program.
    pub fn record_step(&mut self, zones_c: &[f64], heat: &Heat) {
        self.record.temperatures_c.extend_from_slice(zones_c);
        self.record.heat_kw.extend_from_slice(&heat.applied_kw);
        self.record.requested_kw.extend_from_slice(&heat.requested_kw);
    }

    /// Lets the controller learn from the day when it is over.
    ///
    /// # Errors
    /// [`ControlError::Shape`] if the day is not one of the controller's building.
    pub fn learn(&self, controller: &mut dyn Control) -> Result<(), ControlError> {
        controller.end_of_day(&self.record)
    }
}

/// Runs a whole day. `temperatures_c` are those of the nodes at midnight, and become those of the next midnight.
///
/// # Errors
/// [`ControlError`] if a series has a wrong length or the controller cannot plan (the temperatures are then unchanged), or
/// cannot learn.
pub fn run_day(
    plant: &Model,
    temperatures_c: &mut [f64],
    controller: &mut dyn Control,
    targets: &Targets,
    forecast: &Disturbance,
    actual: &Disturbance,
) -> Result<DayRecord, ControlError> {
    let network = plant.network();
    ControlError::check_length("the temperatures at midnight", temperatures_c.len(), network.node_count())?;
    ControlError::check_length("a row of targets", targets.zones, network.zone_count())?;
    forecast.check(targets, network)?;
    actual.check(targets, network)?;
    let mut day = Day::new(temperatures_c.to_vec(), forecast.clone(), actual.clone());
    day.plan(controller, targets)?;
    for step in 0..targets.steps() {
        let heat = day.control(plant, controller, targets, step, &temperatures_c[..network.zone_count()]);
        day.balance(plant, step, temperatures_c, &heat);
    }
    day.learn(controller)?;
    Ok(day.record)
}
