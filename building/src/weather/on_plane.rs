//! Radiation of a weather on planes of any orientation.

use super::{TimeSeries, Weather};
use crate::sun::{Plane, SkyRadiation, SplitRadiation, split_global};

impl Weather {
    /// Radiation on a plane over time \[W/m²\], at the times of the global radiation, with the sun where it stands at each of
    /// them; `None` where the sky is not known.
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

    /// The same weather, its times counted from `start_s` on.
    #[must_use]
    pub fn from_s(self, start_s: f64) -> Self {
        let shifted = |series: TimeSeries| TimeSeries { first_s: series.first_s - start_s, ..series };
        Self { ambient_c: shifted(self.ambient_c), sun_w_per_m2: shifted(self.sun_w_per_m2), sky: self.sky }
    }
}
