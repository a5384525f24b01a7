//! Diffuse radiation of the sky on a tilted plane.
//!
//! ```text
//! D(plane) = D ((1 − F₁)(1 + cos β)/2 + F₁ max(0, cos θ)/max(cos 85°, cos z) + F₂ sin β)
//! ```
//!
//! with the diffuse horizontal radiation D, the tilt β, the angle of incidence θ and the zenith angle z. The brightness F₁ around the
//! sun and F₂ at the horizon are functions of the clearness ε, the brightness Δ and z. R. Perez, P. Ineichen, R. Seals, J. Michalsky,
//! R. Stewart, "Modeling daylight availability and irradiance components from direct and global irradiance", *Solar Energy* 44 (5),
//! 1990, Table 6. Air mass after F. Kasten and A. Young, *Applied Optics* 28, 1989.
//!
//! Direct and diffuse radiation from the global radiation alone.
//!
//! D. Erbs, S. Klein, J. Duffie, "Estimation of the diffuse radiation fraction for hourly, daily and monthly-average global radiation",
//! *Solar Energy* 28 (4), 1982.

use super::position::{SkyRadiation, SunPosition};

/// Radiation outside of the atmosphere at the mean distance, as the coefficients were fitted with \[W/m²\].
const SOLAR_CONSTANT_W_PER_M2: f64 = 1366.1;
/// Bounds of the clearness ε between the eight skies.
const CLEARNESS: [f64; 7] = [1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2];
/// F₁₁, F₁₂, F₁₃, F₂₁, F₂₂, F₂₃ of each sky.
const COEFFICIENTS: [[f64; 6]; 8] = [
    [-0.008, 0.588, -0.062, -0.060, 0.072, -0.022],
    [0.130, 0.683, -0.151, -0.019, 0.066, -0.029],
    [0.330, 0.487, -0.221, 0.055, -0.064, -0.026],
    [0.568, 0.187, -0.295, 0.109, -0.152, -0.014],
    [0.873, -0.392, -0.362, 0.226, -0.462, 0.001],
    [1.132, -1.237, -0.412, 0.288, -0.823, 0.056],
    [1.060, -1.600, -0.359, 0.264, -1.127, 0.131],
    [0.678, -0.327, -0.250, 0.156, -1.377, 0.251],
];
/// κ of the clearness, for angles in radians.
const KAPPA: f64 = 1.041;

/// Diffuse radiation on a plane of a tilt \[°\] while the sun is above the horizon \[W/m²\]. `incidence` is cos θ.
pub(super) fn sky_diffuse_w_per_m2(tilt_deg: f64, incidence: f64, sun: &SunPosition, sky: &SkyRadiation) -> f64 {
    let diffuse = sky.diffuse_w_per_m2;
    if diffuse <= 0.0 {
        return 0.0;
    }
    let zenith_rad = sun.zenith_rad;
    let cubed = KAPPA * zenith_rad * zenith_rad * zenith_rad;
    let clearness = ((diffuse + sky.direct_normal_w_per_m2) / diffuse + cubed) / (1.0 + cubed);
    let brightness = diffuse * air_mass(zenith_rad) / extraterrestrial_w_per_m2(sun);
    let [f11, f12, f13, f21, f22, f23] = COEFFICIENTS[CLEARNESS.partition_point(|bound| *bound <= clearness)];
    let around_sun = (f11 + f12 * brightness + f13 * zenith_rad).max(0.0);
    let at_horizon = f21 + f22 * brightness + f23 * zenith_rad;
    let tilt_rad = tilt_deg.to_radians();
    let lowest = libm::cos(85.0_f64.to_radians());
    let sky_share = 0.5 * (1.0 - around_sun) * (1.0 + libm::cos(tilt_rad))
        + around_sun * incidence.max(0.0) / libm::cos(zenith_rad).max(lowest)
        + at_horizon * libm::sin(tilt_rad);
    (diffuse * sky_share).max(0.0)
}

/// Radiation outside of the atmosphere on a plane towards the sun \[W/m²\].
pub(super) fn extraterrestrial_w_per_m2(sun: &SunPosition) -> f64 {
    SOLAR_CONSTANT_W_PER_M2 / (sun.distance_au * sun.distance_au)
}

/// Air that light passes through, as a multiple of that below the zenith.
fn air_mass(zenith_rad: f64) -> f64 {
    let zenith_deg = zenith_rad.to_degrees();
    1.0 / (libm::cos(zenith_rad) + 0.505_72 * libm::pow(96.079_95 - zenith_deg, -1.636_4))
}

/// Direct radiation is not told from the global one while the sun is lower than this \[°\].
const MAX_ZENITH_DEG: f64 = 87.0;

/// The two parts of the global radiation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplitRadiation {
    /// Direct radiation on a plane towards the sun \[W/m²\].
    pub direct_normal_w_per_m2: f64,
    /// Diffuse radiation on a horizontal plane \[W/m²\].
    pub diffuse_w_per_m2: f64,
}

/// The parts of a global radiation on a horizontal plane \[W/m²\].
pub fn split_global(sun: &SunPosition, global_w_per_m2: f64) -> SplitRadiation {
    let up = libm::cos(sun.zenith_rad);
    if sun.zenith_rad.to_degrees() > MAX_ZENITH_DEG || global_w_per_m2 <= 0.0 {
        return SplitRadiation { direct_normal_w_per_m2: 0.0, diffuse_w_per_m2: global_w_per_m2.max(0.0) };
    }
    let clearness = (global_w_per_m2 / (up * extraterrestrial_w_per_m2(sun))).min(1.0);
    let diffuse_w_per_m2 = diffuse_share(clearness) * global_w_per_m2;
    SplitRadiation { direct_normal_w_per_m2: (global_w_per_m2 - diffuse_w_per_m2) / up, diffuse_w_per_m2 }
}

/// The share of the diffuse radiation, by the share of the radiation outside of the atmosphere that comes through.
fn diffuse_share(clearness: f64) -> f64 {
    match clearness {
        dull if dull <= 0.22 => 1.0 - 0.09 * dull,
        k if k <= 0.8 => 0.9511 + k * (-0.1604 + k * (4.388 + k * (-16.638 + k * 12.336))),
        _ => 0.165,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn direct_and_diffuse_radiation_add_up_to_global_radiation() {
        for (zenith_deg, global) in [(10.0_f64, 900.0), (60.0, 120.0), (86.0, 30.0), (88.0, 10.0), (95.0, 3.0)] {
            let sun = SunPosition { zenith_rad: zenith_deg.to_radians(), azimuth_rad: 0.0, distance_au: 1.0 };
            let SplitRadiation { direct_normal_w_per_m2, diffuse_w_per_m2 } = split_global(&sun, global);
            let whole = direct_normal_w_per_m2 * libm::cos(sun.zenith_rad) + diffuse_w_per_m2;
            assert!((whole - global).abs() < 1e-9 && direct_normal_w_per_m2 >= 0.0, "{zenith_deg}: {whole} {global}");
        }
    }

    #[test]
    fn the_diffuse_share_is_continuous_in_the_clearness() {
        for bound in [0.22, 0.8] {
            assert!((diffuse_share(bound - 1e-9) - diffuse_share(bound + 1e-9)).abs() < 2e-3, "{bound}");
        }
    }
}
