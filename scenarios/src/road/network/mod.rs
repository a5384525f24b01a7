//! A network of lanes as a file states it.

mod geometry;
mod lane_config;

use interplay_planners::road::network::Lane;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

pub use lane_config::{LaneConfig, LanePlaceConfig, LaneWidth, NeighbourConfig, NeighbourTable};

use super::fault::RoadFault;

/// A network of lanes, one `[[road.lane]]` each. Each lane is driven in one direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LaneNetwork {
    /// The lanes, one `[[road.lane]]` each.
    #[serde(rename = "lane")]
    #[schemars(
        length(min = 1, max = 2000),
        extend("x-merge-by" = "name"),
        example = json!([{ "name": "main", "points": [[0.0, 0.0], [100.0, 0.0]], "width_m": 3.5 }])
    )]
    pub lanes: Vec<LaneConfig>,
}

impl LaneNetwork {
    /// The lanes, in the order of the file.
    ///
    /// # Errors
    /// For the first lane without a line or a width.
    pub(crate) fn lanes(&self) -> Result<Vec<Lane>, RoadFault> {
        self.lanes.iter().enumerate().map(|(index, lane)| lane.lane(&format!("lane.{index}"))).collect()
    }
}
