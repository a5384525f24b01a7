//! A planner of one's own: it waits in its lane until the gap in the lane of its goal is long enough.

mod controller;
mod metric;
mod observation;
mod obstacle;
mod road;

pub use controller::Proportional;
pub use metric::WAITING_SHARE;
pub use observation::Headway;
pub use obstacle::BOLLARD;
pub use road::OneWay;

// shown from here
use interplay_planners::scene::inferred_futures::InferredFutures;
use interplay_planners::trajectory::{Optimiser, Problem, Robust};
use interplay_planners::{Drive, DriverKind, Plan, PlanError, Scene, State, Trajectory};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Accepts a gap in the lane of its goal by its length in time; until then it stays in its own lane.
#[derive(Clone, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct GapAcceptance {
    /// Shortest time between the ego and the vehicles ahead and behind in its goal lane.
    #[schemars(range(min = 0.0))]
    gap_s: f64,
}

impl Default for GapAcceptance {
    fn default() -> Self {
        GapAcceptance { gap_s: 0.3 }
    }
}

impl DriverKind for GapAcceptance {
    fn kind(&self) -> &'static str {
        "gap-acceptance"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(LaneChanger { gap_s: self.gap_s, ..LaneChanger::default() })
    }
}

/// The driver with its last plan, and whether it has accepted a gap.
#[derive(Debug, Default)]
struct LaneChanger {
    gap_s: f64,
    has_accepted: bool,
    last: Trajectory,
    optimiser: Optimiser<Robust>,
}

impl Drive for LaneChanger {
    fn plan(&mut self, scene: &Scene, _: &InferredFutures) -> Result<Plan, PlanError> {
        let (ego, mut goal) = (&scene.ego, scene.goal);
        let across_m = |state: &State| ego.route.across(state.position());
        self.has_accepted |= scene.others.iter().all(|other| {
            let is_elsewhere = (across_m(&other.state) - across_m(&goal.target)).abs() > 0.2;
            let apart_m = ego.lead_of(other).abs() - ego.body.front_m - other.body.rear_m;
            is_elsewhere || apart_m > self.gap_s * ego.state.speed_mps.max(other.state.speed_mps)
        });
        if !self.has_accepted {
            (goal.target.x_m, goal.target.y_m) = (ego.state.x_m, ego.state.y_m);
        }
        let terms = scene.own_terms(0, &goal).into_iter().chain(scene.exact_keep_outs(&scene.others)).collect();
        let participants = vec![scene.participant()];
        let problem = Problem { horizon: scene.horizon, participants, shared_steps: 0, terms };
        let optimum = self.optimiser.optimise_or_improve(&problem, &[self.last.later_inputs()])?;
        self.last = optimum.trajectory(0);
        Ok(Plan { trajectory: self.last.clone(), statistics: optimum.statistics, ..Plan::default() })
    }
}
// shown until here
