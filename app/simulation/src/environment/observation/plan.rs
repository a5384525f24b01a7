//! View of the announced plans of the nearest vehicles.

use interplay_planners::Trajectory;
use interplay_planners::scene::driver_estimate::DriverModel;
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

/// The probabilities of the kinds of driver of each of the nearest vehicles: tough, normal, nice, IDM, none of these. Empty rows
/// are 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BeliefView {
    /// Number of rows.
    pub count: usize,
}

impl Default for BeliefView {
    fn default() -> Self {
        BeliefView { count: 4 }
    }
}

impl BeliefView {
    pub(super) fn space(&self) -> ObservationSpace {
        let names = names(&DriverModel::ALL.map(|model| model.name()));
        let shape = vec![self.count, names.len()];
        ObservationSpace { low: 0.0, ..ObservationSpace::normalised("Belief", shape, names, true) }
    }

    pub(super) fn write(&self, seen: &Seen<'_>, out: &mut [f32]) {
        out.fill(0.0);
        let rows = out.chunks_exact_mut(DriverModel::ALL.len());
        for (other, row) in nearest_first(seen.scene).into_iter().zip(rows) {
            let Some(belief) = seen.beliefs.iter().find(|belief| belief.vehicle == other.name) else { continue };
            for (out, probability) in row.iter_mut().zip(belief.probabilities) {
                *out = probability as f32;
            }
        }
    }
}
