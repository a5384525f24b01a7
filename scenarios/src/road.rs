//! Where vehicles may drive.
//!
//! Lanes are counted from the right: the centre of lane `i` lies at `(i + ½) w` to the left of the right edge.

use interplay_planners::Corridor;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A road; `kind` chooses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Road {
    /// A straight road along x with parallel lanes; its right edge is y = 0.
    Lanes(Lanes),
}

/// A straight road along x with parallel lanes. The default is that of a 1/10 scale car.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Lanes {
    /// How many lanes there are.
    #[schemars(range(min = 1, max = 16))]
    pub lane_count: usize,
    /// Width of each lane \[m\].
    #[schemars(range(min = 0.001))]
    pub lane_width_m: f64,
}

impl Default for Lanes {
    fn default() -> Self {
        Lanes { lane_count: 2, lane_width_m: 0.37 }
    }
}

impl Default for Road {
    fn default() -> Self {
        Road::Lanes(Lanes::default())
    }
}

impl Road {
    /// The strip that a vehicle may use.
    pub fn corridor(&self) -> Corridor {
        Corridor { heading_rad: self.heading_rad(), right_m: 0.0, left_m: self.width_m(), end: None }
    }

    /// Direction of the lanes \[rad\].
    pub fn heading_rad(&self) -> f64 {
        match self {
            Road::Lanes(_) => 0.0,
        }
    }

    /// How many lanes there are.
    pub fn lane_count(&self) -> usize {
        match self {
            Road::Lanes(lanes) => lanes.lane_count,
        }
    }

    /// Width of one lane \[m\].
    pub fn lane_width_m(&self) -> f64 {
        match self {
            Road::Lanes(lanes) => lanes.lane_width_m,
        }
    }

    /// Width of all lanes together \[m\].
    pub fn width_m(&self) -> f64 {
        self.lane_count() as f64 * self.lane_width_m()
    }

    /// Lateral coordinate of the centre of a lane, 0 being the rightmost \[m\].
    pub fn lane_centre_m(&self, lane: usize) -> f64 {
        (lane as f64 + 0.5) * self.lane_width_m()
    }

    /// The lane in which a lateral coordinate lies; beside the road, the nearest lane.
    pub fn lane_at(&self, lateral_m: f64) -> usize {
        let lane = (lateral_m / self.lane_width_m()).floor().max(0.0) as usize;
        lane.min(self.lane_count().saturating_sub(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_lane_centre_lies_in_its_lane() {
        let road = Road::Lanes(Lanes { lane_count: 5, lane_width_m: 3.5 });
        for lane in 0..5 {
            assert_eq!(road.lane_at(road.lane_centre_m(lane)), lane);
        }
        assert_eq!((road.lane_at(-1.0), road.lane_at(100.0)), (0, 4));
        assert_eq!(road.corridor().left_m, 17.5);
    }
}
