//! Windows, through which the sun of a direction heats a zone or a wall.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::sun::Plane;

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
