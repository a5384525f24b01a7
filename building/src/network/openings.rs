//! The openings through which the sun comes into a network, and the heat that it brings.

use super::Network;
use super::window::Window;
use crate::sun::Plane;

/// The openings through which the sun warms the nodes of a network.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Openings {
    /// Horizontal apertures of each node \[m²\].
    pub horizontal_m2: Vec<f64>,
    /// The planes of all windows, each once.
    pub planes: Vec<Plane>,
    /// Windows: the node, the plane by its index, and the aperture \[m²\].
    pub windows: Vec<(usize, usize, f64)>,
}

impl Openings {
    /// Adds the windows and the horizontal aperture of the next node.
    pub fn push(&mut self, horizontal_m2: f64, windows: &[Window]) {
        let node = self.horizontal_m2.len();
        self.horizontal_m2.push(horizontal_m2);
        for window in windows.iter().filter(|window| window.aperture_m2() > 0.0) {
            let plane = window.plane();
            let known = self.planes.iter().position(|other| *other == plane);
            let index = known.unwrap_or_else(|| {
                self.planes.push(plane);
                self.planes.len() - 1
            });
            self.windows.push((node, index, window.aperture_m2()));
        }
    }

    /// Whether the sun falls on the node `first` or on a later one.
    pub fn any_from(&self, first: usize) -> bool {
        self.horizontal_m2[first..].iter().any(|aperture_m2| *aperture_m2 > 0.0)
            || self.windows.iter().any(|(node, ..)| *node >= first)
    }
}

impl Network {
    /// Whether the sun heats any node.
    pub fn has_sun(&self) -> bool {
        self.openings.any_from(0)
    }

    /// The distinct planes of the windows. `Network::sun_gains_kw` needs the radiation on each.
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
    pub(crate) fn sun_gains_kw(&self, sun_w_per_m2: f64, planes_w_per_m2: &[f64]) -> Vec<f64> {
        let apertures_m2 = &self.openings.horizontal_m2[..self.gain_count()];
        let mut gains_kw: Vec<f64> =
            apertures_m2.iter().map(|aperture_m2| aperture_m2 * sun_w_per_m2 / 1000.0).collect();
        for (node, plane, aperture_m2) in &self.openings.windows {
            gains_kw[*node] += aperture_m2 * planes_w_per_m2.get(*plane).unwrap_or(&0.0) / 1000.0;
        }
        gains_kw
    }
}
