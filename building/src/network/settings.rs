//! Zones and walls as a scenario file states them, with units in the names.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::{Network, Window};

/// The name that a wall uses for the air outside.
pub const AMBIENT: &str = "ambient";

/// A room or a group of rooms whose air is well mixed, so that it has one temperature.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Zone {
    /// What walls, controllers and plots call it; not `ambient`.
    #[schemars(example = &"office")]
    pub name: String,
    /// Heat that warms the zone by one kelvin \[kJ/K\].
    #[serde(default = "default_capacity_kj_per_k")]
    #[schemars(range(min = 0.000001))]
    pub capacity_kj_per_k: f64,
    /// Largest heating power, and largest cooling power, where the next two keys do not state them \[kW\].
    #[serde(default = "default_limit_kw")]
    #[schemars(range(min = 0.0))]
    pub limit_kw: f64,
    /// Largest heating power; `limit_kw` if it is left out, and 0 without heating \[kW\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0), example = 3.0)]
    pub heating_limit_kw: Option<f64>,
    /// Largest cooling power; `limit_kw` if it is left out, and 0 without cooling \[kW\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0), example = 1.5)]
    pub cooling_limit_kw: Option<f64>,
    /// Area of the horizontal opening that would let in as much sun as warms the zone's air at once \[m²\]. Sun on a wall that
    /// stores heat has a key of its own, in the wall.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub solar_aperture_m2: f64,
    /// Its windows, one `[[building.zone.window]]` each, by the direction that they face; the weather must say where the sun stands.
    #[serde(rename = "window", default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000), example = json!([{ "area_m2": 4.0, "facing_deg": 180.0 }]))]
    pub windows: Vec<Window>,
}

fn default_capacity_kj_per_k() -> f64 {
    1000.0
}

fn default_limit_kw() -> f64 {
    2.0
}

impl Zone {
    /// A zone of the dissertation's testbed: 1000 kJ/K, at most 2 kW of heating or cooling (Table 2.1), no windows.
    pub fn named(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            capacity_kj_per_k: default_capacity_kj_per_k(),
            limit_kw: default_limit_kw(),
            heating_limit_kw: None,
            cooling_limit_kw: None,
            solar_aperture_m2: 0.0,
            windows: Vec::new(),
        }
    }
}

/// A way for heat between two zones, or between a zone and the air outside.
///
/// Several walls between the same two places conduct side by side.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// The two places that it separates: names of zones, or `ambient`.
    #[schemars(example = vec!["office", "ambient"])]
    pub between: [String; 2],
    /// Temperature difference that drives one kilowatt through \[K/kW\]. (1 K·min/kJ is 60 K/kW.) Leave out a wall that lets no
    /// heat through.
    #[schemars(range(min = 0.000001), example = 31.25)]
    pub resistance_k_per_kw: f64,
    /// Heat that the wall itself stores \[kJ/K\]. With it the wall is a temperature of its own, with half of the
    /// resistance to either side (2R1C), or as `mass_position` says.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.000001), example = 200.0)]
    pub capacity_kj_per_k: Option<f64>,
    /// Share of the resistance that lies between the first place and the stored heat; a half if it is left out. A small one
    /// together with a very large resistance makes a mass that only the first place exchanges heat with, such as furniture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.000000001, max = 0.999999999), extend("x-unit" = "dimensionless"), example = 0.3)]
    pub mass_position: Option<f64>,
    /// Area of the horizontal opening that would let in as much sun as falls on the stored heat of the wall \[m²\]: on floors
    /// and inner surfaces through windows, and on outer surfaces. Only a wall with `capacity_kj_per_k` can have it.
    #[serde(default)]
    #[schemars(range(min = 0.0), example = 1.5)]
    pub solar_aperture_m2: f64,
    /// Windows through which the sun falls on the stored heat of the wall, such as that of a floor, in the form of those of a zone. Only
    /// a wall with `capacity_kj_per_k` can have them.
    #[serde(rename = "window", default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000), example = json!([{ "area_m2": 4.0, "facing_deg": 180.0 }]))]
    pub windows: Vec<Window>,
}

impl Wall {
    /// A wall that stores no heat.
    pub fn new(one: impl Into<String>, other: impl Into<String>, resistance_k_per_kw: f64) -> Self {
        Self {
            between: [one.into(), other.into()],
            resistance_k_per_kw,
            capacity_kj_per_k: None,
            mass_position: None,
            solar_aperture_m2: 0.0,
            windows: Vec::new(),
        }
    }

    /// The same wall with a heat capacity.
    #[must_use]
    pub fn with_capacity_kj_per_k(self, capacity_kj_per_k: f64) -> Self {
        Self { capacity_kj_per_k: Some(capacity_kj_per_k), ..self }
    }
}

/// Resistance between adjacent rooms of the testbed \[K/kW\]: 1.0417 K·min/kJ in Table 2.1, whose printed unit is wrong.
const ROOM_TO_ROOM_K_PER_KW: f64 = 62.5;
/// Resistance from a room to the air outside \[K/kW\]: 0.5208 K·min/kJ in Table 2.1.
const ROOM_TO_AMBIENT_K_PER_KW: f64 = 31.25;

impl Network {
    /// The four-room testbed of section 2.4: rooms 1 and 2 over 3 and 4, each 1000 kJ/K, ±2 kW, 62.5 K/kW to each of two
    /// neighbours and 31.25 K/kW to the air outside. The resistances R₁₄ and R₂₃ of Table 2.1 (10000) stand for no wall.
    pub fn testbed() -> Self {
        Self::grid(2, 2)
    }

    /// Rooms of the testbed on one floor, called `room 1`, `room 2`, … by rows, each with a wall to its neighbours in the
    /// grid and one to the air outside.
    ///
    /// # Panics
    /// When the grid has no rooms.
    pub fn grid(rows: usize, columns: usize) -> Self {
        Self::tower(1, rows, columns)
    }

    /// Floors of rooms above one another, each a [`Network::grid`]; ceilings conduct like walls. Rooms are numbered floor
    /// by floor from the ground and, if there are several, called `floor 1 room 1`, ….
    ///
    /// # Panics
    /// When there are no rooms.
    pub fn tower(floors: usize, rows: usize, columns: usize) -> Self {
        let name = |floor: usize, row: usize, column: usize| {
            let room = format!("room {}", row * columns + column + 1);
            if floors == 1 { room } else { format!("floor {} {room}", floor + 1) }
        };
        let (mut zones, mut walls) = (Vec::new(), Vec::new());
        for floor in 0..floors {
            for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
                let here = name(floor, row, column);
                zones.push(Zone::named(&here));
                let beside = [(0, 0, 1), (0, 1, 0), (1, 0, 0)].map(|(up, down, right)| {
                    let [floor, row, column] = [floor + up, row + down, column + right];
                    (floor < floors && row < rows && column < columns).then(|| name(floor, row, column))
                });
                walls.extend(beside.into_iter().flatten().map(|there| Wall::new(&here, there, ROOM_TO_ROOM_K_PER_KW)));
                walls.push(Wall::new(&here, AMBIENT, ROOM_TO_AMBIENT_K_PER_KW));
            }
        }
        match Self::new(&zones, &walls) {
            Ok(network) => network,
            Err(error) => panic!("a tower of {floors} floors of {rows} by {columns} rooms: {error}"),
        }
    }
}
