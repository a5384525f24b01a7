//! A synthetic tropical climate.
//!
//! ```text
//! T₀(h) = m + a (cos 2π(h − 14.2)/24 + 0.18 cos 4π(h − 13.2)/24) − storm(h) + noise(h)
//! ```
//!
//! The mean m of a day follows an AR(1) process from day to day, the amplitude a varies independently, some afternoons
//! have a thunderstorm that cools within half an hour and wears off over hours, and the noise is AR(1) within the day.
//! The defaults resemble Singapore: a mean of 28.5 °C, 25 to 33 °C. Nothing is taken from measurements.

use std::f64::consts::TAU;

use interplay_common::random::Random;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Sky, TimeSeries, Weather};
use crate::sun::{Site, days_since_2000};

/// Time between two values \[s\].
const INTERVAL_S: f64 = 1800.0;
const INTERVALS_PER_DAY: usize = 48;
/// The hour of the day when the sun is highest in Singapore, whose clocks are an hour ahead of the sun.
const NOON_H: f64 = 13.1;
/// Where the sun is highest at that hour, on clocks eight hours ahead of Greenwich.
const SITE: Site = Site { latitude_deg: 0.0, longitude_deg: 103.5, elevation_m: 0.0 };
const AHEAD_OF_GREENWICH_H: f64 = 8.0;
/// Radiation on a horizontal plane under the highest sun and a clear sky \[W/m²\].
const CLEAR_SUN_W_PER_M2: f64 = 950.0;

/// A synthetic climate, from which a seed makes weather.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Climate {
    /// Mean temperature \[°C\].
    pub mean_c: f64,
    /// Half of the difference between the warmest and the coldest hour, about \[K\].
    #[schemars(range(min = 0.0))]
    pub daily_amplitude_k: f64,
    /// Standard deviation of a day's mean \[K\].
    #[schemars(range(min = 0.0))]
    pub day_deviation_k: f64,
    /// Correlation of the means of two consecutive days.
    #[schemars(range(min = 0, max = 1), extend("x-unit" = "dimensionless"))]
    pub day_correlation: f64,
    /// Standard deviation of a day's amplitude \[K\].
    #[schemars(range(min = 0.0))]
    pub amplitude_deviation_k: f64,
    /// Probability of a thunderstorm in the afternoon.
    #[schemars(range(min = 0, max = 1), extend("x-unit" = "dimensionless"))]
    pub storm_probability: f64,
    /// Standard deviation of the noise within a day \[K\].
    #[schemars(range(min = 0.0))]
    pub noise_deviation_k: f64,
}

impl Default for Climate {
    fn default() -> Self {
        Self {
            mean_c: 28.5,
            daily_amplitude_k: 2.9,
            day_deviation_k: 0.5,
            day_correlation: 0.6,
            amplitude_deviation_k: 0.3,
            storm_probability: 0.4,
            noise_deviation_k: 0.3,
        }
    }
}

#[derive(Clone, Copy, Debug)]
struct Storm {
    start_h: f64,
    /// Largest cooling \[K\].
    depth_k: f64,
}

impl Climate {
    /// Returns the weather of `days` days from a seed. The first days do not depend on `days`. Forecasts by persistence
    /// use the day before the first, at negative times.
    pub fn weather(&self, seed: u64, days: usize) -> Weather {
        let mut ambient_c = Vec::with_capacity((days + 1) * INTERVALS_PER_DAY);
        let mut sun_w_per_m2 = Vec::with_capacity(ambient_c.capacity());
        let mut anomaly_k = Random::new(seed, 0).normal(0.0, self.day_deviation_k);
        let mut noise_k = 0.0;
        for day in 0..=days {
            let mut random = Random::new(seed, 1 + day as u64);
            let fresh = libm::sqrt((1.0 - self.day_correlation * self.day_correlation).max(0.0));
            anomaly_k = self.day_correlation * anomaly_k + fresh * random.normal(0.0, self.day_deviation_k);
            let amplitude_k = self.daily_amplitude_k + random.normal(0.0, self.amplitude_deviation_k);
            let clearness = random.uniform(0.5, 1.0);
            let storms = random.chance(self.storm_probability);
            let storm = Storm { start_h: random.uniform(13.5, 17.5), depth_k: random.uniform(1.5, 3.5) };
            for interval in 0..INTERVALS_PER_DAY {
                let hour = interval as f64 * INTERVAL_S / 3600.0;
                let cooled_k = if storms { storm.cooled_k(hour) } else { 0.0 };
                noise_k = self.noise(noise_k, &mut random);
                ambient_c.push(self.mean_c + anomaly_k + amplitude_k * diurnal(hour) - cooled_k + noise_k);
                let overcast = 1.0 - 0.6 * cooled_k / storm.depth_k;
                sun_w_per_m2.push(CLEAR_SUN_W_PER_M2 * clearness * overcast * sun_height(hour));
            }
        }
        let series = |values| TimeSeries { first_s: -86_400.0, interval_s: INTERVAL_S, cyclic: false, values };
        let sun_w_per_m2 = series(sun_w_per_m2);
        let sky = Some(Sky { site: SITE, utc_days: equinoxes(days + 1), parts: None });
        Weather { ambient_c: series(ambient_c), sun_w_per_m2, sky }
    }

    /// The next value of the AR(1) noise.
    fn noise(&self, before_k: f64, random: &mut Random) -> f64 {
        const CORRELATION: f64 = 0.85;
        let fresh = libm::sqrt(1.0 - CORRELATION * CORRELATION);
        CORRELATION * before_k + fresh * random.normal(0.0, self.noise_deviation_k)
    }
}

impl Storm {
    /// How much cooler it is than it would be without the storm \[K\].
    fn cooled_k(self, hour: f64) -> f64 {
        const ONSET_H: f64 = 0.5;
        const WEARS_OFF_H: f64 = 2.5;
        let since_h = hour - self.start_h;
        if since_h <= 0.0 {
            return 0.0;
        }
        self.depth_k * (since_h / ONSET_H).min(1.0) * libm::exp(-since_h / WEARS_OFF_H)
    }
}

/// The moments of the values of some days, each an equinox, as [`sun_height`] has it.
fn equinoxes(days: usize) -> Vec<f64> {
    let midnight = days_since_2000(2026, 3, 20) - AHEAD_OF_GREENWICH_H / 24.0;
    let of_day = (0..INTERVALS_PER_DAY).map(|interval| midnight + interval as f64 * INTERVAL_S / 86_400.0);
    std::iter::repeat_n(of_day, days).flatten().collect()
}

/// The course of a day with mean zero: coldest about 06:00, warmest about 14:00.
fn diurnal(hour: f64) -> f64 {
    libm::cos(TAU * (hour - 14.2) / 24.0) + 0.18 * libm::cos(2.0 * TAU * (hour - 13.2) / 24.0)
}

/// Sine of the sun's height near the equator; 0 at night.
fn sun_height(hour: f64) -> f64 {
    libm::cos(TAU * (hour - NOON_H) / 24.0).max(0.0)
}
