//! The openings through which the sun comes into a network, and the heat that it brings.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Network;
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

/// A window, or another surface that takes up sun: where it faces, and what part of the sun on it becomes heat.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Window {
    /// Area of the glass \[m²\].
    #[schemars(range(min = 0.0), example = 4.0)]
    pub area_m2: f64,
    /// Direction that it faces, clockwise from north: 90 is east, 180 south, 270 west \[deg\].
    #[schemars(range(min = 0.0, max = 360.0), example = 180.0)]
    pub facing_deg: f64,
    /// Angle between its outer side and the sky: 90 in a wall, 0 in a flat roof \[deg\].
    #[serde(default = "default_tilt_deg")]
    #[schemars(range(min = 0.0, max = 180.0))]
    pub tilt_deg: f64,
    /// Share of the sun on it that becomes heat inside: the solar factor (g-value) of the glass times that of frame and shading. It is
    /// taken as the same for all angles of incidence.
    #[serde(default = "default_solar_factor")]
    #[schemars(range(min = 0, max = 1), extend("x-unit" = "dimensionless"))]
    pub solar_factor: f64,
    /// Share of the sun that the ground before it reflects: 0.2 of grass and streets, up to 0.8 of snow.
    #[serde(default = "default_ground_reflectance")]
    #[schemars(range(min = 0, max = 1), extend("x-unit" = "dimensionless"))]
    pub ground_reflectance: f64,
}

fn default_tilt_deg() -> f64 {
    90.0
}

fn default_solar_factor() -> f64 {
    0.6
}

fn default_ground_reflectance() -> f64 {
    0.2
}

impl Window {
    /// A window of this area \[m²\] in a wall that faces this direction, clockwise from north \[°\].
    pub fn facing(facing_deg: f64, area_m2: f64) -> Self {
        Self {
            area_m2,
            facing_deg,
            tilt_deg: default_tilt_deg(),
            solar_factor: default_solar_factor(),
            ground_reflectance: default_ground_reflectance(),
        }
    }

    /// The plane in which it lies.
    pub fn plane(&self) -> Plane {
        let Self { facing_deg, tilt_deg, ground_reflectance, .. } = *self;
        Plane { facing_deg, tilt_deg, ground_reflectance }
    }

    /// Area of an opening in its plane that would let in as much sun \[m²\].
    pub(super) fn aperture_m2(&self) -> f64 {
        self.area_m2 * self.solar_factor
    }
}
