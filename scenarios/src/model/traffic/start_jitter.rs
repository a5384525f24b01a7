//! The random change of the starts.

use interplay_common::random::SplitMix64;
use interplay_planners::{Limits, State};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A random change of every start, uniform over `±` the stated amounts and drawn from the seed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct StartJitter {
    /// Largest shift along the vehicle's own heading \[m\].
    #[schemars(range(min = 0.0))]
    pub position_m: f64,
    /// Largest change of the speed, which stays within the vehicle's limits \[m/s\].
    #[schemars(range(min = 0.0))]
    pub speed_mps: f64,
}

impl StartJitter {
    /// A start, changed at random. It takes two numbers of the sequence: position, then speed.
    pub(crate) fn changed(&self, start: State, limits: &Limits, random: &mut SplitMix64) -> State {
        let [shift_m, faster_mps] = [self.position_m, self.speed_mps].map(|most| most * random.uniform(-1.0, 1.0));
        let (sin, cos) = libm::sincos(start.heading_rad);
        let speed_mps = if self.speed_mps > 0.0 {
            (start.speed_mps + faster_mps).max(limits.speed_min_mps).min(limits.speed_max_mps)
        } else {
            start.speed_mps
        };
        State { x_m: start.x_m + cos * shift_m, y_m: start.y_m + sin * shift_m, speed_mps, ..start }
    }
}
