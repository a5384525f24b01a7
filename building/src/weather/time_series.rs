//! A quantity at equal intervals of time, interpolated linearly.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Weather;
use crate::sun::{Plane, Site, SkyRadiation, SplitRadiation, split_global};

/// Values at `first_s`, `first_s + interval_s`, …
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TimeSeries {
    /// Time of the first value \[s\].
    pub first_s: f64,
    /// Time between two values \[s\].
    pub interval_s: f64,
    /// Whether the values begin anew after the last, as those of a year do.
    pub cyclic: bool,
    /// The values; at least one.
    pub values: Vec<f64>,
}

impl TimeSeries {
    /// The value at a time, interpolated linearly. Beyond the ends of a series that is not cyclic, the value at the nearer end holds.
    ///
    /// # Panics
    /// When there are no values.
    pub fn at(&self, time_s: f64) -> f64 {
        let count = self.values.len();
        assert!(count > 0, "a series needs a value");
        let last = (count - 1) as f64;
        let position = (time_s - self.first_s) / self.interval_s;
        let position = if self.cyclic { position.rem_euclid(count as f64) } else { position.clamp(0.0, last) };
        // Rounding can lift a position just below zero to `count` itself.
        let before = (position.floor() as usize).min(count - 1);
        let after = if self.cyclic { (before + 1) % count } else { (before + 1).min(count - 1) };
        let part = position - before as f64;
        self.values[before] + part * (self.values[after] - self.values[before])
    }

    /// The time until which the last value holds: one interval after its own time \[s\].
    pub fn end_s(&self) -> f64 {
        self.first_s + self.values.len() as f64 * self.interval_s
    }

    /// The arithmetic mean of the values.
    pub fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len() as f64
    }
}

/// The site where global radiation was measured, and its direct and diffuse parts if they were measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Sky {
    /// The place.
    pub site: Site,
    /// The moment of each value of the global radiation in universal time, in days since noon of the 1st of January 2000.
    pub utc_days: Vec<f64>,
    /// Direct and diffuse radiation, a value for each of the global radiation; without them they are estimated after Erbs.
    pub parts: Option<Vec<SplitRadiation>>,
}

impl Sky {
    /// The global radiation on a horizontal plane at each moment \[W/m²\], of its parts; `None` without them.
    pub(crate) fn global_w_per_m2(&self) -> Option<Vec<f64>> {
        let global = |(days, part): (&f64, &SplitRadiation)| {
            let up = libm::cos(self.site.sun(*days).zenith_rad).max(0.0);
            part.direct_normal_w_per_m2 * up + part.diffuse_w_per_m2
        };
        Some(self.utc_days.iter().zip(self.parts.as_ref()?).map(global).collect())
    }
}

impl Weather {
    /// Radiation on a plane over time \[W/m²\], at the times of the global radiation and with the position of the sun
    /// at each of them; `None` if the site of the measurement is unknown.
    pub fn on_plane_w_per_m2(&self, plane: &Plane) -> Option<TimeSeries> {
        let sky = self.sky.as_ref()?;
        let radiation = |(index, (days, global)): (usize, (&f64, &f64))| {
            let sun = sky.site.sun(*days);
            let measured = sky.parts.as_ref().map(|parts| parts[index]);
            let SplitRadiation { direct_normal_w_per_m2, diffuse_w_per_m2 } =
                measured.unwrap_or_else(|| split_global(&sun, *global));
            let sky = SkyRadiation { direct_normal_w_per_m2, diffuse_w_per_m2, global_w_per_m2: *global };
            plane.radiation_w_per_m2(&sun, &sky)
        };
        let moments = sky.utc_days.iter().zip(&self.sun_w_per_m2.values).enumerate();
        Some(TimeSeries { values: moments.map(radiation).collect(), ..self.sun_w_per_m2.clone() })
    }

    /// The same weather with times counted from `start_s`.
    #[must_use]
    pub fn from_s(self, start_s: f64) -> Self {
        let shifted = |series: TimeSeries| TimeSeries { first_s: series.first_s - start_s, ..series };
        Self { ambient_c: shifted(self.ambient_c), sun_w_per_m2: shifted(self.sun_w_per_m2), sky: self.sky }
    }
}
