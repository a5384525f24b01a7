//! Measurements of a building: temperatures of zones and of what surrounds them, and the heat that is known.
//!
//! [`Telemetry`] holds them in the units of this crate, from a table ([`Mapping`] and [`Telemetry::read`]) or a simulation.
//! Sampling is regular within a segment. The time between segments is unknown, so no sum, smoother or filter crosses it.

mod error;
mod form;
mod mapping;
mod measurements;
mod read;
mod recorded_days;
mod table;
mod units;
mod write;

pub use error::TelemetryError;
pub use mapping::{
    BoundaryColumns, ComputedColumn, Gaps, HeatColumns, Mapping, MeterReading, SolarColumn, TimeAxis, ZoneColumns,
};
pub use measurements::{Boundary, Hold, MeasuredWall, MeasuredZone, Neighbour, SupplyAir, Telemetry};
pub use recorded_days::RecordedDays;
pub use units::{
    AirFlowUnit, DecimalSign, EnergyUnit, IrradianceUnit, PowerUnit, TableForm, TemperatureUnit, WaterFlowUnit,
};

impl Telemetry {
    /// Reads a table as `mapping` says; `file` is its name for messages.
    ///
    /// # Errors
    /// [`TelemetryError`], with line and column, for an empty table, a column that is not there, a text where a number is
    /// wanted, an impossible temperature, and, unless [`Gaps::Split`] allows them, a gap or a missing value.
    pub fn read(file: &str, text: &str, mapping: &Mapping) -> Result<Self, TelemetryError> {
        read::read(file, text, mapping)
    }

    /// The telemetry as a table, which [`Telemetry::mapping`] reads back bit for bit. Names may contain any character;
    /// a table ignores spaces at their ends.
    pub fn to_csv(&self) -> String {
        write::to_csv(self)
    }

    /// The mapping of the table that [`Telemetry::to_csv`] writes.
    pub fn mapping(&self) -> Mapping {
        write::mapping(self)
    }
}
