//! A form of road of one's own: a street in one direction.

// shown from here
use interplay_planners::CentreLine;
use interplay_planners::road::centre_line::Piece;
use interplay_planners::road::network::Lane;
use interplay_scenarios::{RoadFault, RoadForm};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A straight street from west to east with one lane, `through`.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct OneWay {
    /// Length of the street.
    #[schemars(range(min = 1.0, max = 5000.0))]
    length_m: f64,
    /// Width of its lane.
    #[schemars(range(min = 0.001, max = 40.0))]
    lane_width_m: f64,
}

impl Default for OneWay {
    fn default() -> Self {
        OneWay { length_m: 300.0, lane_width_m: 3.5 }
    }
}

impl RoadForm for OneWay {
    fn kind(&self) -> &'static str {
        "one-way"
    }

    fn lanes(&self) -> Result<Vec<Lane>, RoadFault> {
        let centre = CentreLine::from_pieces([0.0, 0.0], 0.0, &[Piece::Straight { length_m: self.length_m }])?;
        Ok(vec![Lane::new("through", centre, self.lane_width_m)])
    }

    fn lane_width_m(&self) -> f64 {
        self.lane_width_m
    }
}
// shown until here
