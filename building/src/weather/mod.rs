//! Weather ([`Weather`]), its sources ([`epw`] files, or the synthetic [`Climate`]), and its forecasts ([`Forecast`]).
//!
//! Time is in seconds from midnight at the start of the first day. A file states values at the end of each interval; here
//! all quantities are functions of time.

mod climate;
pub mod epw;
mod forecast;
mod recorded;
mod time_series;

pub use climate::Climate;
pub use epw::{Epw, EpwError};
pub use forecast::{ErrorLevel, ErrorModel, Forecast};
pub use recorded::{ReadWeather, RecordedWeather, RowMeaning, RunSpan, default_bridge_gaps_h};
pub use time_series::{Sky, TimeSeries};

/// Outdoor temperature and sunshine as functions of time.
#[derive(Clone, Debug, PartialEq)]
pub struct Weather {
    /// Dry-bulb temperature outdoors \[°C\].
    pub ambient_c: TimeSeries,
    /// Global radiation on a horizontal plane \[W/m²\].
    pub sun_w_per_m2: TimeSeries,
    /// Radiation by its direction, where it is known: windows of any orientation need it.
    pub sky: Option<Sky>,
}

impl Weather {
    /// Whether the weather is known up to this time: a series that is not cyclic ends.
    pub fn covers(&self, time_s: f64) -> bool {
        [&self.ambient_c, &self.sun_w_per_m2].iter().all(|series| series.cyclic || time_s <= series.end_s())
    }

    /// Outdoor temperatures for consecutive steps \[°C\]: each is that of the middle of its step, which is also its mean
    /// over the step unless the slope changes within it.
    pub fn ambient_steps_c(&self, start_s: f64, step_s: f64, steps: usize) -> Vec<f64> {
        (0..steps).map(|step| self.ambient_c.at(start_s + (step as f64 + 0.5) * step_s)).collect()
    }

    /// Global horizontal radiation for consecutive steps \[W/m²\], in the middle of each.
    pub fn sun_steps_w_per_m2(&self, start_s: f64, step_s: f64, steps: usize) -> Vec<f64> {
        (0..steps).map(|step| self.sun_w_per_m2.at(start_s + (step as f64 + 0.5) * step_s)).collect()
    }
}
