//! View of the announced plans of the nearest vehicles.

use interplay_planners::Trajectory;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::view::{ObservationSpace, Scales, Seen, names, nearest_first, share};

/// Planned positions of the agent and the nearest vehicles: one row for each vehicle, from now to the end of the horizon, relative to
/// the agent's present position in world axes. Vehicles that announce no plan are extrapolated at constant velocity. The agent's own row
/// is its last plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PlanView {
    /// Number of rows, the agent's own included.
    pub count: usize,
    /// Whether positions are divided by the agent's distance in five seconds of a real car at its largest speed, and clipped to
    /// −1 and 1.
    pub normalize: bool,
}

impl Default for PlanView {
    fn default() -> Self {
        PlanView { count: 5, normalize: true }
    }
}

const POINT: [&str; 3] = ["presence", "x", "y"];

impl PlanView {
    pub(super) fn space(&self, horizon: usize) -> ObservationSpace {
        let shape = vec![self.count, horizon + 1, POINT.len()];
        ObservationSpace::normalised("Plan", shape, names(&POINT), self.normalize)
    }

    pub(super) fn write(&self, seen: &Seen<'_>, out: &mut [f32]) {
        let scene = seen.scene;
        let scale_m = Scales::of_ego(scene).along_m;
        let number = |value: f64| if self.normalize { share(value, scale_m) } else { value as f32 };
        out.fill(0.0);
        let agents = std::iter::once(&scene.ego).chain(nearest_first(scene));
        for (agent, row) in agents.zip(out.chunks_exact_mut(POINT.len() * (scene.horizon + 1))) {
            let Trajectory { states, .. } = &*agent.prediction;
            for (t, point) in row.chunks_exact_mut(POINT.len()).enumerate() {
                let state = states.get(t).or(states.last()).unwrap_or(&agent.state);
                let [x, y] = [state.x_m - scene.ego.state.x_m, state.y_m - scene.ego.state.y_m];
                point.copy_from_slice(&[1.0, number(x), number(y)]);
            }
        }
    }
}
