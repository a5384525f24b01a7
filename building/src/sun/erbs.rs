//! Direct and diffuse radiation from the global radiation alone.
//!
//! D. Erbs, S. Klein, J. Duffie, "Estimation of the diffuse radiation fraction for hourly, daily and monthly-average global radiation",
//! *Solar Energy* 28 (4), 1982.

use super::SunPosition;
use super::perez::extraterrestrial_w_per_m2;

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
