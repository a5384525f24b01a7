//! What the rules of the road ask of a vehicle, as a value.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Whether a vehicle keeps the rules of the road: speed limits, stop signs and right of way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RuleKeeping {
    /// It keeps all of them, whatever drives it, drives no faster than it wants, and passes what stands in its way.
    Kept,
    /// It keeps none of them, for studies of who yields; humans and drivers after the intelligent driver model still keep right of way.
    Ignored,
}

/// Something that stands in the way and is not a queue.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    /// The vehicle.
    pub name: String,
    /// Where it begins and ends, along the driver's route \[m\].
    pub along_m: [f64; 2],
    /// Where its middle is across the driver's route \[m\].
    pub across_m: f64,
    /// The lateral position at which it is passed \[m\].
    pub pass_at_m: f64,
    /// Where the row ends that it begins and that is passed in one go, along the driver's route \[m\].
    pub row_end_m: f64,
    /// Whether it has no driver.
    pub is_without_driver: bool,
    /// Half the lengths and half the widths of both, together \[m\].
    pub reach_m: [f64; 2],
}

/// A vehicle ahead behind which another one stays.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Followed {
    /// The vehicle.
    pub name: String,
    /// How far along its own route the front of the follower may come at `t = 1…N` \[m\].
    pub lines_m: Vec<f64>,
    /// The speeds at `t = 1…N` with which the follower comes up to it in comfort; infinite where it is too far away to count \[m/s\].
    pub speeds_mps: Vec<f64>,
}

/// When a vehicle may be where its way joins that of others.
#[derive(Clone, Debug, PartialEq)]
pub struct Merging {
    /// Behind whom it falls in.
    pub behind: String,
    /// How far along its route the ways meet \[m\].
    pub meeting_m: f64,
    /// In what time it may be there \[s\].
    pub in_s: f64,
}

/// What the rules of the road ask of a vehicle now.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RoadRules {
    /// Whether its driver keeps all of them, speed limits too, and drives no faster than it wants.
    pub are_kept: bool,
    /// Whether it has to stay in the lane of its route: it is in it, and nothing slow or standing there is a reason to leave it.
    pub stays_in_lane: bool,
    /// How far along its route the front may come now; none if nothing holds it \[m\].
    pub stop_line_m: Option<f64>,
    /// The vehicle ahead that leaves no room behind a crossing way, before which it waits at the line.
    pub keeps_clear_behind: Option<String>,
    /// Where it drives across its route for now, in place of its goal: on the lane beside, to overtake, or at the edge \[m\].
    pub drives_at_m: Option<f64>,
    /// The vehicle that comes head-on in its lane, before which it brakes at the edge.
    pub evades: Option<String>,
    /// What stands in its lane and is passed now; there is room.
    pub passes: Option<Obstacle>,
    /// The vehicle ahead behind which it stays, of a driver who sees the motion of the others only.
    pub follows: Option<Followed>,
    /// When it may be where it joins the way of others from the lane beside; none if nothing holds it.
    pub merging: Option<Merging>,
    /// Whether it slows down a little for one that merges ahead of it, whose gap is too short.
    pub lets_in: bool,
    /// Whom it waits for there; empty where a sign alone holds it.
    pub waits_for: Vec<String>,
}

impl RoadRules {
    /// Its front has to stay before one more line \[m\].
    pub(crate) fn stop_before(&mut self, line_m: f64) {
        self.stop_line_m = Some(self.stop_line_m.map_or(line_m, |nearest_m| nearest_m.min(line_m)));
    }
}
