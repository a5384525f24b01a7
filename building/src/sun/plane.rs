//! A plane that the sun shines on.

use super::perez::sky_diffuse_w_per_m2;
use super::position::SunPosition;

/// Radiation of the sun and the sky at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyRadiation {
    /// Direct radiation on a plane towards the sun \[W/m²\].
    pub direct_normal_w_per_m2: f64,
    /// Diffuse radiation on a horizontal plane \[W/m²\].
    pub diffuse_w_per_m2: f64,
    /// Global radiation on a horizontal plane \[W/m²\].
    pub global_w_per_m2: f64,
}

/// A flat surface: its orientation, and the ground in front of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Direction that it faces, clockwise from north \[°\]: 180 is south.
    pub facing_deg: f64,
    /// Angle between its outer side and the sky \[°\]: 0 is a roof, 90 a wall.
    pub tilt_deg: f64,
    /// Share of the global radiation that the ground before it reflects.
    pub ground_reflectance: f64,
}

impl Plane {
    /// Cosine of the angle between the plane's normal and the sun; negative where the sun is behind it.
    pub(crate) fn incidence(&self, sun: &SunPosition) -> f64 {
        let tilt_rad = self.tilt_deg.to_radians();
        let across_rad = sun.azimuth_rad - self.facing_deg.to_radians();
        libm::cos(sun.zenith_rad) * libm::cos(tilt_rad)
            + libm::sin(sun.zenith_rad) * libm::sin(tilt_rad) * libm::cos(across_rad)
    }

    /// Radiation on the plane \[W/m²\]. While the sun is below the horizon, direct radiation is zero and diffuse radiation is
    /// isotropic.
    pub(crate) fn radiation_w_per_m2(&self, sun: &SunPosition, sky: &SkyRadiation) -> f64 {
        let cos_tilt = libm::cos(self.tilt_deg.to_radians());
        let ground = 0.5 * self.ground_reflectance * sky.global_w_per_m2 * (1.0 - cos_tilt);
        let incidence = self.incidence(sun);
        if libm::cos(sun.zenith_rad) <= 0.0 {
            return 0.5 * sky.diffuse_w_per_m2 * (1.0 + cos_tilt) + ground;
        }
        sky.direct_normal_w_per_m2 * incidence.max(0.0)
            + sky_diffuse_w_per_m2(self.tilt_deg, incidence, sun, sky)
            + ground
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_roof_gets_the_global_radiation() {
        let sun = SunPosition { zenith_rad: 0.7, azimuth_rad: 2.0, distance_au: 1.0 };
        let global_w_per_m2 = 600.0 * libm::cos(0.7) + 120.0;
        let sky = SkyRadiation { direct_normal_w_per_m2: 600.0, diffuse_w_per_m2: 120.0, global_w_per_m2 };
        let roof = Plane { facing_deg: 77.0, tilt_deg: 0.0, ground_reflectance: 0.2 };
        let found = roof.radiation_w_per_m2(&sun, &sky);
        assert!((found - global_w_per_m2).abs() < 1e-9, "{found} {global_w_per_m2}");
    }

    #[test]
    fn a_wall_away_from_the_sun_gets_no_direct_radiation() {
        let sun = SunPosition { zenith_rad: 1.0, azimuth_rad: std::f64::consts::PI, distance_au: 1.0 };
        let wall = |facing_deg: f64| Plane { facing_deg, tilt_deg: 90.0, ground_reflectance: 0.0 };
        let sky = SkyRadiation { direct_normal_w_per_m2: 800.0, diffuse_w_per_m2: 0.0, global_w_per_m2: 400.0 };
        assert_eq!(wall(0.0).radiation_w_per_m2(&sun, &sky), 0.0);
        let south = wall(180.0).radiation_w_per_m2(&sun, &sky);
        assert!((south - 800.0 * libm::sin(1.0)).abs() < 1e-9, "{south}");
    }
}
