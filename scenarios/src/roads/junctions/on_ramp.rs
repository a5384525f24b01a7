//! A ramp that joins a motorway.

use interplay_planners::CentreLine;
use interplay_planners::road::centre_line::Piece;
use interplay_planners::road::network::{Lane, NeighbourRelation, RightOfWay};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::super::form::RoadFault;
use super::connector::turn;
use super::{beside, lane, limit_in_turn_mps, straight};

/// A main road along x and a ramp that joins it from the right. The acceleration lane begins at x = 0, and ends; the right
/// edge of the main road is y = 0. Lanes are called `main-0` (the rightmost), `main-1` and so on, `ramp` and `acceleration`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct OnRamp {
    /// How many lanes the main road has.
    #[schemars(range(min = 1, max = 8))]
    pub lane_count: usize,
    /// Width of each lane \[m\].
    #[schemars(range(min = 0.001, max = 40.0))]
    pub lane_width_m: f64,
    /// Length of the main road before the acceleration lane \[m\].
    #[schemars(range(min = 0.001, max = 5000.0))]
    pub before_m: f64,
    /// Length of the acceleration lane \[m\].
    #[schemars(range(min = 0.001, max = 5000.0))]
    pub acceleration_lane_m: f64,
    /// Length of the main road after the acceleration lane \[m\].
    #[schemars(range(min = 0.001, max = 5000.0))]
    pub after_m: f64,
    /// Angle between the ramp and the main road \[deg\].
    #[schemars(range(min = 1.0, max = 120.0))]
    pub angle_deg: f64,
    /// Length of the straight part of the ramp, before its curve \[m\].
    #[schemars(range(min = 0.001, max = 5000.0))]
    pub ramp_m: f64,
    /// Smallest radius of the ramp's curve \[m\].
    #[schemars(range(min = 0.001, max = 5000.0))]
    pub ramp_radius_m: f64,
    /// Highest permitted speed on the main road and on the acceleration lane; on the ramp it is at most the speed with a
    /// sideways acceleration of 2 m/s² \[m/s\].
    #[schemars(range(min = 0.001))]
    pub speed_limit_mps: f64,
}

impl Default for OnRamp {
    fn default() -> Self {
        OnRamp {
            lane_count: 2,
            lane_width_m: 3.5,
            before_m: 200.0,
            acceleration_lane_m: 180.0,
            after_m: 300.0,
            angle_deg: 20.0,
            ramp_m: 100.0,
            ramp_radius_m: 120.0,
            speed_limit_mps: 27.8,
        }
    }
}

impl OnRamp {
    /// The lanes of the main road, the ramp and the acceleration lane.
    ///
    /// # Errors
    /// For a curve of the ramp that is too tight for its width.
    pub(crate) fn lanes(&self) -> Result<Vec<Lane>, RoadFault> {
        let half_m = 0.5 * self.lane_width_m;
        if self.ramp_radius_m <= half_m {
            let message = format!("`road.ramp_radius_m` ({}) is not above half of a lane's width", self.ramp_radius_m);
            return Err(RoadFault::new("ramp_radius_m", "too tight", message)
                .help(format!("more than {half_m} m works; a car needs about 5.5 m")));
        }
        let (width_m, limit_mps) = (self.lane_width_m, self.speed_limit_mps);
        let mut lanes = Vec::new();
        for number in 0..self.lane_count {
            let begin = [-self.before_m, (number as f64 + 0.5) * width_m];
            let centre = straight(begin, 0.0, self.before_m + self.acceleration_lane_m + self.after_m)?;
            let is_inside = number + 1 < self.lane_count;
            let next = |other: usize| beside(&format!("main-{other}"), NeighbourRelation::SameDirection, true);
            lanes.push(Lane {
                left: is_inside.then(|| next(number + 1)).flatten(),
                right: match number.checked_sub(1) {
                    Some(before) => next(before),
                    None => beside("acceleration", NeighbourRelation::SameDirection, false),
                },
                ..lane(&format!("main-{number}"), centre, width_m, limit_mps)
            });
        }
        let ramp_mps = limit_in_turn_mps(self.ramp_radius_m, limit_mps);
        lanes.push(Lane {
            successors: vec!["acceleration".to_owned()],
            ..lane("ramp", self.ramp()?, width_m, ramp_mps)
        });
        let acceleration = straight([0.0, -half_m], 0.0, self.acceleration_lane_m)?;
        lanes.push(Lane {
            left: beside("main-0", NeighbourRelation::SameDirection, true),
            right_of_way: RightOfWay::Yield,
            ..lane("acceleration", acceleration, width_m, limit_mps)
        });
        Ok(lanes)
    }

    /// The middle of the ramp: it ends where the acceleration lane begins.
    fn ramp(&self) -> Result<CentreLine, RoadFault> {
        let heading_rad = self.angle_deg.to_radians();
        let curve = turn(-heading_rad, self.ramp_radius_m);
        let pieces: Vec<Piece> = [Piece::Straight { length_m: self.ramp_m }].into_iter().chain(curve).collect();
        let shape = CentreLine::from_pieces([0.0; 2], heading_rad, &pieces)?;
        let [x, y] = shape.at(shape.length_m()).position;
        Ok(CentreLine::from_pieces([-x, -0.5 * self.lane_width_m - y], heading_rad, &pieces)?)
    }
}
