//! Measurements of zones, of the temperatures around them, and of the heat that is known.

use std::ops::Range;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Measurements of a building. Every series has one value a row.
#[derive(Debug, Clone, PartialEq)]
pub struct Telemetry {
    /// Sampling time T_s \[s\].
    pub step_s: f64,
    /// Time of each row since the midnight before the first \[s\].
    pub time_s: Vec<f64>,
    /// Rows that follow each other at the sampling time.
    pub segments: Vec<Range<usize>>,
    /// How many rows of the table were left out because a value was missing.
    pub left_out_rows: usize,
    /// The zones.
    pub zones: Vec<MeasuredZone>,
    /// Temperatures that act on zones and are not modelled.
    pub boundaries: Vec<Boundary>,
    /// The pairs of places between which heat flows.
    pub walls: Vec<MeasuredWall>,
}

/// Measurements of a zone.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredZone {
    /// Name in the mapping.
    pub name: String,
    /// Its temperature T_i \[°C\]; NaN where it is missing, which only [`Gaps::Bridge`](super::Gaps::Bridge) leaves in.
    pub temperature_c: Vec<f64>,
    /// Known heat that does not depend on the zone's temperature, u_i + w_i \[kW\], or in a unit of its own.
    pub power_kw: Vec<f64>,
    /// Whether the power is in kW rather than a signal without a unit.
    pub power_has_unit: bool,
    /// How the power goes on between rows.
    pub power_hold: Hold,
    /// Known heat that depends on the zone's temperature.
    pub supply_air: Vec<SupplyAir>,
    /// Irradiance \[kW/m²\], if measured.
    pub irradiance_kw_per_m2: Option<Vec<f64>>,
    /// How the irradiance goes on between rows.
    pub irradiance_hold: Hold,
}

/// Air blown into a zone: heat ṁ c_p (T_supply − T_i), eq. 2.2.
#[derive(Debug, Clone, PartialEq)]
pub struct SupplyAir {
    /// Heat that the flow carries per kelvin, ṁ c_p \[kW/K\].
    pub conductance_kw_per_k: Vec<f64>,
    /// Temperature of the supplied air, T_supply \[°C\].
    pub temperature_c: Vec<f64>,
}

/// A measured temperature that is not modelled.
#[derive(Debug, Clone, PartialEq)]
pub struct Boundary {
    /// Name in the mapping.
    pub name: String,
    /// The temperature \[°C\].
    pub temperature_c: Vec<f64>,
    /// How the temperature goes on between rows.
    pub hold: Hold,
}

/// How a measured series goes on from one row to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Hold {
    /// It keeps its value: a switch, or a mean over the time until the next row.
    ZeroOrder,
    /// It changes evenly to its next value: weather.
    FirstOrder,
}

impl Hold {
    /// The default of temperatures and irradiance.
    pub(super) fn first_order() -> Self {
        Self::FirstOrder
    }

    /// The default of heat.
    pub(super) fn zero_order() -> Self {
        Self::ZeroOrder
    }
}

/// A wall: two places between which heat flows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MeasuredWall {
    /// A zone, by its position in [`Telemetry::zones`].
    pub zone: usize,
    /// The place on the other side of the wall.
    pub other: Neighbour,
}

/// The place on the other side of a wall, by its index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Neighbour {
    /// A zone, by its index in [`Telemetry::zones`].
    Zone(usize),
    /// A boundary, by its index in [`Telemetry::boundaries`].
    Boundary(usize),
}

impl Telemetry {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.time_s.len()
    }

    /// The zones and boundaries that exchange heat with a zone through its walls, in the order of [`Telemetry::walls`].
    pub fn neighbours(&self, zone: usize) -> Vec<Neighbour> {
        self.walls
            .iter()
            .filter_map(|wall| match wall.other {
                other if wall.zone == zone => Some(other),
                Neighbour::Zone(other) if other == zone => Some(Neighbour::Zone(wall.zone)),
                _ => None,
            })
            .collect()
    }

    /// The name of a neighbour.
    pub fn name(&self, neighbour: Neighbour) -> &str {
        match neighbour {
            Neighbour::Zone(zone) => &self.zones[zone].name,
            Neighbour::Boundary(boundary) => &self.boundaries[boundary].name,
        }
    }

    /// The measured temperature of a neighbour \[°C\].
    pub fn temperature_c(&self, neighbour: Neighbour) -> &[f64] {
        match neighbour {
            Neighbour::Zone(zone) => &self.zones[zone].temperature_c,
            Neighbour::Boundary(boundary) => &self.boundaries[boundary].temperature_c,
        }
    }

    /// The segments before `row`, for training, and those from `row` on, for testing.
    pub fn split_at(&self, row: usize) -> (Vec<Range<usize>>, Vec<Range<usize>>) {
        let before = self.segments.iter().map(|segment| segment.start..segment.end.min(row));
        let after = self.segments.iter().map(|segment| segment.start.max(row)..segment.end);
        (before.filter(|rows| !rows.is_empty()).collect(), after.filter(|rows| !rows.is_empty()).collect())
    }
}

impl MeasuredZone {
    /// Known heat u_i + w_i in one row if the zone had this temperature \[kW\].
    pub fn heat_kw(&self, row: usize, temperature_c: f64) -> f64 {
        let supplied: f64 = self
            .supply_air
            .iter()
            .map(|air| air.conductance_kw_per_k[row] * (air.temperature_c[row] - temperature_c))
            .sum();
        self.power_kw[row] + supplied
    }

    /// Whether any heat is known.
    pub(crate) fn has_heat(&self) -> bool {
        !self.supply_air.is_empty() || self.power_kw.iter().any(|&power| power != 0.0)
    }
}
