//! The building of a scenario: its zones and walls.
//!
//! A building has its own clock: it advances step by step, and an iteration is a day.

use interplay_building::discretise::Discretisation;
use interplay_building::network::{ModelMismatch, Network, NetworkError, Wall, Zone};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::model::building::plant::BuildingPlant;

/// A day \[s\].
pub(crate) const DAY_S: f64 = 86_400.0;

/// Zones and walls, given as a `preset`, as a `grid`, or one by one; by default the testbed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BuildingConfig {
    /// A building with a name of its own.
    #[schemars(example = &"testbed", extend("x-excludes" = ["grid", "zone"]))]
    pub preset: Option<Preset>,
    /// Rooms in rows and columns, on one floor or several, each like those of the testbed.
    #[schemars(example = json!({ "rows": 3, "columns": 4 }), extend("x-excludes" = ["zone"]))]
    pub grid: Option<Grid>,
    /// The zones, one `[[building.zone]]` each.
    #[serde(rename = "zone")]
    #[schemars(length(max = 1000))]
    pub zones: Vec<Zone>,
    /// The walls between them and to `ambient`, one `[[building.wall]]` each.
    #[serde(rename = "wall")]
    #[schemars(length(max = 10000))]
    pub walls: Vec<Wall>,
    /// Time from one step to the next, such as 900 or 1800; a day must be a whole number of steps \[s\].
    #[schemars(range(min = 60.0, max = 3600.0))]
    pub step_s: f64,
    /// The time grid of the steps.
    pub method: Discretisation,
    /// Temperature of everything at the start \[°C\].
    #[schemars(range(min = -50.0, max = 100.0))]
    pub initial_c: f64,
    /// Factors between the controller's model and the building.
    pub believed: ModelMismatch,
    /// The system that the heat of the equipment acts on: the network above, or another program.
    pub plant: BuildingPlant,
}

impl Default for BuildingConfig {
    fn default() -> Self {
        BuildingConfig {
            preset: None,
            grid: None,
            zones: Vec::new(),
            walls: Vec::new(),
            step_s: 1800.0,
            method: Discretisation::Exact,
            initial_c: 28.0,
            believed: ModelMismatch::default(),
            plant: BuildingPlant::default(),
        }
    }
}

/// A predefined building.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// The four rooms of Table 2.1, in corrected units: two by two, each with a wall to the air outside.
    Testbed,
}

/// Rooms in rows and columns, on one floor or several.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Grid {
    /// How many rows of rooms there are.
    #[schemars(range(min = 1, max = 1000), example = 3)]
    pub rows: usize,
    /// The number of rooms in a row.
    #[schemars(range(min = 1, max = 1000), example = 4)]
    pub columns: usize,
    /// The number of floors of such rooms.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 1000))]
    pub floors: usize,
}

fn one() -> usize {
    1
}

impl Grid {
    /// The number of rooms.
    pub fn rooms(&self) -> usize {
        self.floors.saturating_mul(self.rows).saturating_mul(self.columns)
    }
}

/// The layout of rooms in drawings: floors side by side, rooms of a floor in rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FloorPlan {
    /// Rooms in a row.
    pub columns: usize,
    /// Rows of a floor.
    pub rows: usize,
    /// Floors.
    pub floors: usize,
}

impl BuildingConfig {
    /// The thermal network.
    ///
    /// # Errors
    /// [`NetworkError`] if zones and walls do not form a network; never for a loaded scenario.
    pub fn network(&self) -> Result<Network, NetworkError> {
        match (self.preset, self.grid) {
            _ if !self.zones.is_empty() => Network::new(&self.zones, &self.walls),
            (None, Some(grid)) if grid.rooms() > 0 => Ok(Network::tower(grid.floors, grid.rows, grid.columns)),
            (None, Some(_)) => Err(NetworkError::NoZones),
            (Some(Preset::Testbed) | None, _) => Ok(Network::testbed()),
        }
    }

    /// The controller's model of the network.
    ///
    /// # Errors
    /// As [`BuildingConfig::network`], and if a believed factor is out of range.
    pub fn believed_network(&self) -> Result<Network, NetworkError> {
        self.network()?.believed(&self.believed)
    }

    /// The layout of its rooms in drawings: that of its grid, or one floor about as wide as deep.
    pub fn floor_plan(&self) -> FloorPlan {
        let flat = |zones: usize| {
            let columns = (zones as f64).sqrt().ceil() as usize;
            FloorPlan { columns, rows: zones.div_ceil(columns.max(1)), floors: 1 }
        };
        match (self.grid, self.zones.len()) {
            (Some(Grid { rows, columns, floors }), 0) => FloorPlan { columns, rows, floors },
            (None, 0) => flat(4),
            (_, zones) => flat(zones),
        }
    }

    /// The number of zones.
    pub fn zone_count(&self) -> usize {
        match (self.zones.len(), self.grid) {
            (0, Some(grid)) if self.preset.is_none() => grid.rooms(),
            (0, _) => Network::testbed().zone_count(),
            (zones, _) => zones,
        }
    }

    /// The number of steps of a day.
    pub fn steps_per_day(&self) -> usize {
        (DAY_S / self.step_s).round() as usize
    }
}
