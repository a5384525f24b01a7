//! Recorded heat of people and machines.

use interplay_building::occupancy::ZoneRecord;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Heat of people and machines from a table of comma-separated values, with a column for each zone that has any.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GainsConfig {
    /// The table: a header, whose first title is that of the times (`hour` or `time_s` since the first midnight, or any other with
    /// dates) and whose others are names of zones, and rows at equal intervals, each of which holds until the next. The path is relative
    /// to the scenario or plan that states it, and in a flag to the current folder.
    #[schemars(example = &"gains.csv")]
    pub file: String,
    /// Heat of one unit of the table: 1 where it states kW, 0.001 for W, and about 0.08 where it counts people \[kW\].
    #[serde(default = "one")]
    #[schemars(range(min = -1000.0, max = 1000.0))]
    pub unit_kw: f64,
    /// Whether the heat comes beside that of people by schedule; otherwise it takes its place, in the zones of the table.
    #[serde(default)]
    pub beside_people: bool,
    /// Whether controllers know it in advance. Otherwise they expect the schedule.
    #[serde(default)]
    pub is_forecast: bool,
    /// Days of the table before the first day of the run.
    #[serde(default)]
    #[schemars(range(min = 0, max = 100000))]
    pub skip_days: usize,
    /// Whether the table begins anew after its end; otherwise it must cover the run.
    #[serde(default)]
    pub repeats: bool,
}

fn one() -> f64 {
    1.0
}

/// A table of gains after reading.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedGainsFile {
    /// Its statement in the file.
    pub stated: GainsConfig,
    /// Where the table was found: an absolute path.
    pub found: String,
    /// Its zones.
    pub zones: Vec<ZoneRecord>,
}

impl RecordedGainsFile {
    pub(crate) fn config(&self) -> GainsConfig {
        GainsConfig { file: self.found.clone(), ..self.stated.clone() }
    }
}
