//! The position of the sun.
//!
//! J. Meeus, *Astronomical Algorithms*, 2nd edition, 1998, chapters 12, 22 and 25 (the solar coordinates of low accuracy), with the
//! largest perturbations by planets and the moon of his *Astronomical Formulae for Calculators*, 1979, chapter 18, and the
//! parallax. `tests/peers/sun.py` compares with the algorithm of Reda and Andreas (2004) in pvlib: within 0.005° from 1990 to 2060.

use super::perez::sky_diffuse_w_per_m2;

/// Difference between terrestrial and universal time, about that of 2000 to 2030 \[s\].
const DELTA_T_S: f64 = 69.0;
const DAY_S: f64 = 86_400.0;
/// Days of a Julian century.
const CENTURY_DAYS: f64 = 36_525.0;
/// Days from noon of the 31st of December 1899 to noon of the 1st of January 2000.
const FROM_1900_DAYS: f64 = 36_525.0;
/// The sun's parallax at its mean distance \[°\].
const PARALLAX_DEG: f64 = 8.794 / 3600.0;

/// A place on the earth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// Latitude, positive to the north \[°\].
    pub latitude_deg: f64,
    /// Longitude, positive to the east \[°\].
    pub longitude_deg: f64,
    /// Elevation above the sea \[m\].
    pub elevation_m: f64,
}

/// The direction and the distance of the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunPosition {
    /// Angle from the zenith, without refraction \[rad\]; beyond π/2 the sun is below the horizon.
    pub zenith_rad: f64,
    /// Direction in the horizontal plane, clockwise from north \[rad\].
    pub azimuth_rad: f64,
    /// Distance from the earth \[astronomical units\].
    pub distance_au: f64,
}

/// The midnight (UTC) at the start of a day of the Gregorian calendar, in days since noon (UTC) of 1 January 2000.
pub fn days_since_2000(year: i32, month: i8, day: i8) -> f64 {
    // Fliegel and Van Flandern, Communications of the ACM 11 (10), 1968.
    let (year, month, day) = (i64::from(year), i64::from(month), i64::from(day));
    let january = (month - 14) / 12;
    let julian_day = (1461 * (year + 4800 + january)) / 4 + (367 * (month - 2 - 12 * january)) / 12
        - (3 * ((year + 4900 + january) / 100)) / 4
        + day
        - 32_075;
    (julian_day - 2_451_545) as f64 - 0.5
}

/// Right ascension and declination of the sun with the sidereal time.
struct Equatorial {
    right_ascension_rad: f64,
    declination_rad: f64,
    sidereal_rad: f64,
    distance_au: f64,
}

impl Site {
    /// The position of the sun at a universal time, in days since noon of 1 January 2000.
    pub fn sun(&self, utc_days: f64) -> SunPosition {
        let Equatorial { right_ascension_rad, declination_rad, sidereal_rad, distance_au } = equatorial(utc_days);
        let hour_rad = sidereal_rad + self.longitude_deg.to_radians() - right_ascension_rad;
        let latitude_rad = self.latitude_deg.to_radians();
        let (sin_latitude, cos_latitude) = (libm::sin(latitude_rad), libm::cos(latitude_rad));
        let (sin_declination, cos_declination) = (libm::sin(declination_rad), libm::cos(declination_rad));
        let (sin_hour, cos_hour) = (libm::sin(hour_rad), libm::cos(hour_rad));
        let up = sin_latitude * sin_declination + cos_latitude * cos_declination * cos_hour;
        let north = cos_latitude * sin_declination - sin_latitude * cos_declination * cos_hour;
        let east = -cos_declination * sin_hour;
        let zenith_rad = libm::acos(up.clamp(-1.0, 1.0));
        SunPosition {
            zenith_rad: zenith_rad + (PARALLAX_DEG / distance_au).to_radians() * libm::sin(zenith_rad),
            azimuth_rad: libm::atan2(east, north).rem_euclid(std::f64::consts::TAU),
            distance_au,
        }
    }
}

fn equatorial(utc_days: f64) -> Equatorial {
    let days = utc_days + DELTA_T_S / DAY_S;
    let t = days / CENTURY_DAYS;
    let anomaly_deg = 357.529_11 + t * (35_999.050_29 - 0.000_153_7 * t);
    let eccentricity = 0.016_708_634 - t * (0.000_042_037 + 0.000_000_126_7 * t);
    let centre_deg = (1.914_602 - t * (0.004_817 + 0.000_014 * t)) * sin_deg(anomaly_deg)
        + (0.019_993 - 0.000_101 * t) * sin_deg(2.0 * anomaly_deg)
        + 0.000_289 * sin_deg(3.0 * anomaly_deg);
    let mean_deg = 280.466_46 + t * (36_000.769_83 + 0.000_303_2 * t);
    let node_deg = 125.04 - 1934.136 * t;
    let nutation_deg = -0.004_78 * sin_deg(node_deg);
    let longitude_rad = (mean_deg + centre_deg + perturbation_deg(days) - 0.005_69 + nutation_deg).to_radians();
    let obliquity_deg = 23.439_291_11 - t * (0.013_004_167 + 0.000_000_164 * t) + 0.002_56 * cos_deg(node_deg);
    let (sin_longitude, cos_longitude) = (libm::sin(longitude_rad), libm::cos(longitude_rad));
    let true_anomaly_deg = anomaly_deg + centre_deg;
    let sidereal_deg = 280.460_618_37 + 360.985_647_366_29 * utc_days + 0.000_387_933 * t * t;
    Equatorial {
        right_ascension_rad: libm::atan2(cos_deg(obliquity_deg) * sin_longitude, cos_longitude),
        declination_rad: libm::asin(sin_deg(obliquity_deg) * sin_longitude),
        sidereal_rad: (sidereal_deg + nutation_deg * cos_deg(obliquity_deg)).rem_euclid(360.0).to_radians(),
        distance_au: 1.000_001_018 * (1.0 - eccentricity * eccentricity)
            / (1.0 + eccentricity * cos_deg(true_anomaly_deg)),
    }
}

/// What Venus, Jupiter and the moon add to the sun's longitude \[°\].
fn perturbation_deg(days: f64) -> f64 {
    let t = (days + FROM_1900_DAYS) / CENTURY_DAYS;
    0.001_34 * cos_deg(153.23 + 22_518.754_1 * t)
        + 0.001_54 * cos_deg(216.57 + 45_037.508_2 * t)
        + 0.002_00 * cos_deg(312.69 + 32_964.357_7 * t)
        + 0.001_79 * sin_deg(350.74 + t * (445_267.114_2 - 0.001_44 * t))
        + 0.001_78 * sin_deg(231.19 + 20.20 * t)
}

fn sin_deg(angle_deg: f64) -> f64 {
    libm::sin(angle_deg.rem_euclid(360.0).to_radians())
}

fn cos_deg(angle_deg: f64) -> f64 {
    libm::cos(angle_deg.rem_euclid(360.0).to_radians())
}

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
    fn days_are_counted_from_noon_of_1_january_2000() {
        assert_eq!(days_since_2000(2000, 1, 1), -0.5);
        assert_eq!(days_since_2000(2000, 3, 1) - days_since_2000(2000, 2, 28), 2.0);
        assert_eq!(days_since_2000(2026, 1, 1) - days_since_2000(2025, 1, 1), 365.0);
    }

    /// The example of Reda and Andreas (2004): Golden, 17 October 2003, 12:30:30 local time, seven hours behind Greenwich.
    #[test]
    fn the_sun_position_matches_the_published_example() {
        let site = Site { latitude_deg: 39.742476, longitude_deg: -105.1786, elevation_m: 1830.14 };
        let moment = days_since_2000(2003, 10, 17) + (19.0 + 30.5 / 60.0) / 24.0;
        let sun = site.sun(moment);
        // Published with refraction: 50.11162°; refraction at this height is 0.01613°.
        assert!((sun.zenith_rad.to_degrees() - 50.127_75).abs() < 0.002, "{}", sun.zenith_rad.to_degrees());
        assert!((sun.azimuth_rad.to_degrees() - 194.340_24).abs() < 0.004, "{}", sun.azimuth_rad.to_degrees());
        assert!((sun.distance_au - 0.996_542_297_4).abs() < 1e-4, "{}", sun.distance_au);
    }

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
