//! How many plans keep what their certificates ask for.
//!
//! ```sh
//! cargo run --release -p interplay-planners --example certificates
//! ```
//!
//! Drives every family of scenarios from perturbed starts with every planner, in closed loop, and checks every plan
//! ([`interplay_planners::plan::certificate`]). A row for each driver and condition says in how many plans it is violated, and how many
//! steps ahead: the least, the median and the greatest number.

#[path = "../tests/common/mod.rs"]
mod common;

use std::collections::BTreeMap;
use std::io::Write;

use common::world::{Vehicle, begin, egos, families};
use interplay_planners::Driver;
use interplay_planners::PlanCondition;
use interplay_planners::PlanError;
use interplay_planners::plan::certificate::violations;

const SEEDS: u64 = 4;
const TICKS: u64 = 50;

fn main() -> std::io::Result<()> {
    let mut plans: BTreeMap<&str, usize> = BTreeMap::new();
    let mut found: BTreeMap<(&str, &str), Vec<usize>> = BTreeMap::new();
    for (_, pose) in families() {
        for ego in egos() {
            for seed in 0..SEEDS {
                let mut vehicles = pose(ego.clone());
                common::starts::perturb(&mut vehicles, seed);
                if let Driver::Cooperative(_) = ego {
                    vehicles[1].drive(ego.clone());
                }
                drive(&vehicles, &mut plans, &mut found);
            }
        }
    }
    let mut out = std::io::stdout();
    writeln!(
        out,
        "| driver | plans | violated | in plans | steps ahead: least, median, greatest |\n|---|---|---|---|---|"
    )?;
    for ((kind, condition), mut stages) in found {
        stages.sort_unstable();
        let [low, middle, high] = [0, stages.len() / 2, stages.len() - 1].map(|index| stages[index]);
        writeln!(out, "| {kind} | {} | {condition} | {} | {low}, {middle}, {high} |", plans[kind], stages.len())?;
    }
    writeln!(out, "{plans:?}")
}

fn drive<'a>(
    vehicles: &[Vehicle],
    plans: &mut BTreeMap<&'a str, usize>,
    found: &mut BTreeMap<(&'a str, &'a str), Vec<usize>>,
) {
    let (mut traffic, mut planners) = begin(vehicles);
    for _ in 0..TICKS {
        traffic.drive(|index, scene| {
            let kind = vehicles[index].driver.kind();
            *plans.entry(kind).or_default() += 1;
            let plan = planners[index].plan(scene).inspect_err(|error| {
                if let PlanError::Refused(violation) = error {
                    found.entry((kind, "refused")).or_default().push(violation.stage);
                }
            })?;
            for violation in violations(scene, &plan.trajectory) {
                let condition = match violation.condition {
                    PlanCondition::Dynamics => "dynamics",
                    PlanCondition::InputLimits => "input limits",
                    PlanCondition::SpeedLimits => "speed limits",
                    PlanCondition::Road => "road",
                    PlanCondition::Clear(_) => "clear of others",
                };
                found.entry((kind, condition)).or_default().push(violation.stage);
            }
            Ok(plan)
        });
    }
}
