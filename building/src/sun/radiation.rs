//! Radiation of the sun and the sky, before it falls on anything.

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
