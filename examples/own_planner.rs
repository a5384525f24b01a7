//! A planner of one's own, in one's own crate: a kind of driver with a setting, which scenario files may name like ours.
//! `cargo run --release --example own_planner`

#![allow(clippy::print_stdout, reason = "an example prints what it found")]

use interplay_planners::prediction::steady_inputs;
use interplay_planners::scene::inferred_futures::InferredFutures;
use interplay_planners::{Drive, DriverKind, Plan, PlanError, Scene, Trajectory};
use interplay_scenarios::{Override, Registry};
use interplay_simulation::run::run;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Keeps its lane, and a time headway to the vehicle ahead.
#[derive(Clone, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields, default)]
struct Careful {
    /// How long after the rear of the vehicle ahead its own front passes a place.
    #[schemars(range(min = 0.1))]
    headway_s: f64,
}

impl Default for Careful {
    fn default() -> Careful {
        Careful { headway_s: 1.5 }
    }
}

impl DriverKind for Careful {
    fn kind(&self) -> &'static str {
        "careful"
    }

    fn driver(&self) -> Box<dyn Drive> {
        Box::new(self.clone())
    }
}

impl Drive for Careful {
    fn plan(&mut self, scene: &Scene, _: &InferredFutures) -> Result<Plan, PlanError> {
        let ego = &scene.ego;
        let ahead = scene.others.iter().filter(|other| ego.shares_lane_with(other) && ego.lead_of(other) > 0.0);
        let gap_m = ahead.map(|other| ego.lead_of(other) - ego.body.front_m - other.body.rear_m).min_by(f64::total_cmp);
        let allowed_mps = gap_m.map_or(f64::INFINITY, |gap_m| gap_m.max(0.0) / self.headway_s);
        let wanted_mps = allowed_mps.min(scene.goal.target.speed_mps);
        let inputs = steady_inputs(scene, (wanted_mps - ego.state.speed_mps) / scene.step_s);
        let mut states = Vec::new();
        scene.model().roll_out(&ego.state, &inputs, &mut states);
        Ok(Plan { trajectory: Trajectory { states, inputs }, ..Plan::default() })
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let registry = Registry::default().with_driver::<Careful>()?;
    for planner in ["careful", "conservative", "negotiation"] {
        let scenario = registry.load("lane-keeping/nice", &[Override::Planner(planner.to_owned())])?;
        let report = run(planner, &scenario, Vec::new())?;
        println!("{planner:12} order {}, smallest gap {:.2?} m", report.order.join(", "), report.min_gap_m());
    }
    Ok(())
}
