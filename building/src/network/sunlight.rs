//! What the sun brings into each node of a network.

use super::Network;
use crate::sun::Plane;

impl Network {
    /// Whether the sun warms anything.
    pub fn has_sun(&self) -> bool {
        self.openings.any_from(0)
    }

    /// The planes of its windows, each once: what [`Network::sun_gains_kw`] needs the radiation on.
    pub fn window_planes(&self) -> &[Plane] {
        &self.openings.planes
    }

    /// Heat that the sun brings through horizontal apertures into each of the first [`Network::gain_count`] nodes \[kW\], for a
    /// global radiation on a horizontal plane \[W/m²\].
    pub fn solar_gains_kw(&self, sun_w_per_m2: f64) -> Vec<f64> {
        self.sun_gains_kw(sun_w_per_m2, &[])
    }

    /// Heat that the sun brings into each of the first [`Network::gain_count`] nodes \[kW\], for a global radiation on a horizontal
    /// plane and that on each of [`Network::window_planes`] \[W/m²\]; planes that are left out are dark.
    pub fn sun_gains_kw(&self, sun_w_per_m2: f64, planes_w_per_m2: &[f64]) -> Vec<f64> {
        let apertures_m2 = &self.openings.horizontal_m2[..self.gain_count()];
        let mut gains_kw: Vec<f64> =
            apertures_m2.iter().map(|aperture_m2| aperture_m2 * sun_w_per_m2 / 1000.0).collect();
        for (node, plane, aperture_m2) in &self.openings.windows {
            gains_kw[*node] += aperture_m2 * planes_w_per_m2.get(*plane).unwrap_or(&0.0) / 1000.0;
        }
        gains_kw
    }
}
