//! View of the positions and velocities of the nearest vehicles.

use interplay_planners::{Agent, State};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::view::{ObservationSpace, Scales, Seen, names, nearest_first, share};

/// The agent and the nearest vehicles, one row each: presence, x, y, vx, vy, cos h, sin h, in world axes. Empty rows are 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Kinematics {
    /// Number of rows, the agent's own included.
    pub count: usize,
    /// Whether positions and velocities of the other vehicles are absolute instead of relative to the agent, whose own row always is.
    pub absolute: bool,
    /// Whether positions are divided by the agent's distance in five seconds of a real car at its largest speed, velocities by that
    /// speed, and all numbers clipped to −1 and 1.
    pub normalize: bool,
}

impl Default for Kinematics {
    fn default() -> Self {
        Kinematics { count: 5, absolute: false, normalize: true }
    }
}

const ROW: [&str; 7] = ["presence", "x", "y", "vx", "vy", "cos_h", "sin_h"];

impl Kinematics {
    pub(super) fn space(&self) -> ObservationSpace {
        ObservationSpace::normalised("Kinematics", vec![self.count, ROW.len()], names(&ROW), self.normalize)
    }

    pub(super) fn write(&self, seen: &Seen<'_>, out: &mut [f32]) {
        let (ego, others) = (&seen.scene.ego, nearest_first(seen.scene));
        let origin = if self.absolute { [0.0; 4] } else { motion(&ego.state) };
        let rows = std::iter::once((ego, [0.0; 4])).chain(others.into_iter().map(|other| (other, origin)));
        let scales = Scales::of_ego(seen.scene);
        out.fill(0.0);
        for ((agent, origin), row) in rows.zip(out.chunks_exact_mut(ROW.len())) {
            row.copy_from_slice(&self.row(agent, origin, scales));
        }
    }

    fn row(&self, agent: &Agent, origin: [f64; 4], scales: Scales) -> [f32; ROW.len()] {
        let (sin, cos) = libm::sincos(agent.state.heading_rad);
        let along = [scales.along_m, scales.along_m, scales.speed_mps, scales.speed_mps];
        let mut moved = motion(&agent.state);
        for (value, from) in moved.iter_mut().zip(origin) {
            *value -= from;
        }
        let [x, y, vx, vy] =
            std::array::from_fn(
                |index| {
                    if self.normalize { share(moved[index], along[index]) } else { moved[index] as f32 }
                },
            );
        [1.0, x, y, vx, vy, cos as f32, sin as f32]
    }
}

fn motion(state: &State) -> [f64; 4] {
    let (sin, cos) = libm::sincos(state.heading_rad);
    [state.x_m, state.y_m, state.speed_mps * cos, state.speed_mps * sin]
}
