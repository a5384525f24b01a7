//! Errors of an identification.

use interplay_common::setting::SettingError;

/// Why an identification cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum IdentifyError {
    /// A setting is out of range.
    #[error("setting {0}")]
    Setting(#[from] SettingError),
    /// A zone has neither walls nor heat nor sun.
    #[error("zone `{zone}` has no wall, no heat and no sun: give it at least one, or there is nothing to identify")]
    NothingToIdentify {
        /// Name of the zone.
        zone: String,
    },
    /// There are too few rows.
    #[error(
        "{rows} usable steps are too few for {parameters} parameters: at least {wanted} are needed; add rows, raise `train_days`, or lower `harmonics` or `autoregressive_order`"
    )]
    TooFewRows {
        /// Number of usable steps.
        rows: usize,
        /// Number of parameters to fit.
        parameters: usize,
        /// The number of rows that is needed.
        wanted: usize,
    },
    /// The search among models would take too long.
    #[error(
        "it would take about {expected_s:.0} s of a processor, more than {limit_s} s: lengthen `time.step_s`, lower `most_states`, leave kinds out of `hidden`, identify fewer zones together, or allow it with `processor_s`"
    )]
    TooMuchWork {
        /// Time that is expected \[s\].
        expected_s: f64,
        /// Time that is allowed \[s\].
        limit_s: f64,
    },
    /// There are more zones than a filter can hold.
    #[error(
        "{zones} zones are too many: at most {most} can be identified together; identify groups of zones, with the others as boundaries"
    )]
    TooManyZones {
        /// Number of zones.
        zones: usize,
        /// Largest number of zones.
        most: usize,
    },
    /// The temperature of a zone has one value in all rows that are fitted: the sensor is stuck, and nothing follows from it.
    #[error(
        "the temperature of zone `{zone}` never changes: it is {value_c} °C in all {rows} rows that are fitted; check its sensor, and the column that `zone.{zone}.temperature` names"
    )]
    ConstantTemperature {
        /// Name of the zone.
        zone: String,
        /// The temperature \[°C\].
        value_c: f64,
        /// Number of rows that have a temperature.
        rows: usize,
    },
    /// A temperature is missing, which only the method `state-space` allows.
    #[error("a temperature of zone `{zone}` is missing: set `gaps = \"split\"`, or use the method `state-space`")]
    MissingTemperature {
        /// Name of the zone.
        zone: String,
    },
    /// A fit has no finite error.
    #[error("the residuals are not finite: check the telemetry for values that are not")]
    NotFinite,
}
