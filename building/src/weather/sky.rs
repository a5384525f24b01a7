//! Radiation by its direction: what windows of any orientation need.

use crate::sun::{Site, SplitRadiation};

/// The place under the sun where global radiation was measured, and its parts if they were measured.
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
    pub fn global_w_per_m2(&self) -> Option<Vec<f64>> {
        let global = |(days, part): (&f64, &SplitRadiation)| {
            let up = libm::cos(self.site.sun(*days).zenith_rad).max(0.0);
            part.direct_normal_w_per_m2 * up + part.diffuse_w_per_m2
        };
        Some(self.utc_days.iter().zip(self.parts.as_ref()?).map(global).collect())
    }
}
