//! A network of lanes as a file states it.

mod geometry;
mod lane_config;

use interplay_planners::road::network::Lane;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

pub use lane_config::{LaneConfig, LanePlaceConfig, LaneWidth, NeighbourConfig, NeighbourTable};

use super::form::RoadFault;

/// A network of lanes, one `[[road.lane]]` each. Each lane is driven in one direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LaneNetwork {
    /// The lanes, one `[[road.lane]]` each.
    #[serde(rename = "lane")]
    #[schemars(
        length(min = 1, max = 5000),
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
        self.lanes.iter().enumerate().map(|(index, stated)| lane(stated, &format!("lane.{index}"))).collect()
    }
}

/// The lane that a table states; `path` is that of the table below `road`.
fn lane(stated: &LaneConfig, path: &str) -> Result<Lane, RoadFault> {
    // The width bounds the length of the line, so the faults of the width are reported first.
    let width = stated.width_m.profile(path)?;
    Ok(Lane {
        name: stated.name.clone(),
        centre: geometry::centre(stated, path)?,
        width,
        successors: stated.successors.clone(),
        left: stated.left.as_ref().map(NeighbourConfig::neighbour),
        right: stated.right.as_ref().map(NeighbourConfig::neighbour),
        speed_limit_mps: stated.speed_limit_mps,
        right_of_way: stated.right_of_way,
        light: None,
        users: stated.users.clone(),
        is_zebra: stated.zebra,
    })
}
