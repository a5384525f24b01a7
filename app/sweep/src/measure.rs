//! From the report of a run to a row.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use interplay_scenarios::{Scenario, SweepPoint};
use interplay_simulation::frame::Frame;
use interplay_simulation::report::{BuildingReport, Report, VehicleReport};
use interplay_simulation::run::run;
use interplay_simulation::watch::{WatchError, Watcher};

use crate::key::RunKey;
use crate::row::{BuildingResult, RunResult, SweepRow, TrafficResult};
use crate::version::program_version;

/// The share of a vehicle's strongest braking from which on it brakes hard.
const HARD_BRAKING_SHARE: f64 = 0.75;
/// A vehicle leaves the road if a corner of it comes this far beyond an edge, in widths of its body: 5 cm of a car.
const OFF_ROAD_WIDTHS: f64 = 0.03;

/// Makes a run and its row. A run that cannot be finished, or that panics, has a row with the reason.
pub(crate) fn measured_run(key: RunKey, point: &SweepPoint, scenario: &Scenario) -> SweepRow {
    let began = Instant::now();
    let contact = EgoContact::default();
    let watchers: Vec<Box<dyn Watcher>> =
        vec![Box::new(ContactWatcher { ego: scenario.ego_index(), seen: contact.clone() })];
    let outcome = catch_unwind(AssertUnwindSafe(|| run(&point.scenario, scenario, watchers)));
    let wall_s = began.elapsed().as_secs_f64();
    let outcome = match outcome {
        Ok(outcome) => outcome.map_err(|error| error.to_string()),
        Err(panic) => Err(format!("panic: {}", message(&*panic))),
    };
    let ego = |report: &Report| report.vehicles.get(scenario.ego_index()).map(|ego| ego.plans);
    let plans = outcome.as_ref().ok().and_then(ego);
    SweepRow {
        key,
        version: program_version(),
        scenario: point.scenario.clone(),
        family: point.family.clone(),
        style: point.style.clone(),
        planner: point.planner.clone(),
        sample: point.sample,
        seed: point.seed,
        inputs: point.inputs.iter().cloned().collect(),
        error: outcome.as_ref().err().cloned(),
        result: outcome.ok().map(|report| result(scenario, &report, contact.by_ego())),
        wall_s,
        plan_median_ms: plans.map(|plans| plans.median_ms),
        plan_p99_ms: plans.map(|plans| plans.p99_ms),
    }
}

/// The words of a panic.
fn message(panic: &(dyn std::any::Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("without a message")
}

fn result(scenario: &Scenario, report: &Report, contact_by_ego: bool) -> RunResult {
    RunResult {
        digest: report.digest.clone(),
        simulated_s: report.simulated_s,
        passed: report.passed,
        traffic: report.vehicles.get(scenario.ego_index()).map(|ego| traffic(scenario, report, ego, contact_by_ego)),
        building: report.building.as_ref().map(building),
    }
}

fn traffic(scenario: &Scenario, report: &Report, ego: &VehicleReport, contact_by_ego: bool) -> TrafficResult {
    let others = || report.vehicles.iter().filter(|vehicle| vehicle.name != ego.name);
    let of_ego = || report.collisions.iter().filter(|contact| contact.between.contains(&ego.name));
    let ego_contact = of_ego().next().is_some();
    let is_done = !ego.has_task || ego.completed_s.is_some();
    let yields = report.right_of_way.iter().filter(|passage| passage.second == ego.name).count() as u64;
    let place = match scenario.network {
        Some(_) => 1 + yields,
        None => report.order.iter().position(|name| *name == ego.name).map_or(0, |index| index as u64 + 1),
    };
    let with_task = || others().filter(|vehicle| vehicle.has_task);
    TrafficResult {
        success: is_done && !ego_contact,
        driver: ego.driver.clone(),
        has_task: ego.has_task,
        completed_s: ego.completed_s,
        deadlock: !is_done && report.collisions.is_empty(),
        others_with_task: with_task().count() as u64,
        others_completed: with_task().filter(|vehicle| vehicle.completed_s.is_some()).count() as u64,
        contacts: report.collisions.len() as u64,
        ego_contact,
        contact_by_ego,
        ego_contact_s: of_ego().map(|contact| contact.time_s).min_by(f64::total_cmp),
        order_kept: order_kept(report),
        impulse_ns: report.collisions.iter().map(|contact| contact.impulse_ns).max_by(f64::total_cmp),
        order: report.order.clone(),
        ego_place: place,
        ego_yields: yields,
        others_yield: report.right_of_way.iter().filter(|passage| passage.first == ego.name).count() as u64,
        ego_gap_m: report.min_gap_m,
        smallest_gap_m: report.smallest_gap.as_ref().map(|gap| gap.m),
        time_to_collision_s: report.shortest_time_to_collision.as_ref().map(|time| time.s),
        mean_abs_acceleration: ego.mean_abs_acceleration,
        mean_abs_jerk: ego.mean_abs_jerk,
        peak_acceleration_mps2: ego.peak_acceleration_mps2,
        peak_braking_mps2: ego.peak_braking_mps2,
        peak_braking_share: braking_share(scenario, ego),
        hard_braking: braking_share(scenario, ego) >= HARD_BRAKING_SHARE,
        peak_jerk_mps3: ego.peak_jerk_mps3,
        peak_lateral_acceleration_mps2: ego.peak_lateral_acceleration_mps2,
        min_speed_mps: ego.min_speed_mps,
        max_speed_mps: ego.max_speed_mps,
        off_road_m: ego.off_road_m,
        leaves_road: scenario.ego().is_some_and(|vehicle| ego.off_road_m > OFF_ROAD_WIDTHS * vehicle.body.width_m),
        speeding_mps: ego.speeding_mps,
        others_peak_braking_mps2: others().map(|vehicle| vehicle.peak_braking_mps2).max_by(f64::total_cmp),
        others_hard_braking: others().any(|vehicle| braking_share(scenario, vehicle) >= HARD_BRAKING_SHARE),
        plans: ego.plans.count as u64,
        plans_failed: ego.plans.failed as u64,
        plans_unfinished: ego.plans.unfinished as u64,
        others_plans_failed: others().map(|vehicle| vehicle.plans.failed as u64).sum(),
    }
}

/// Whether the scenario's expectations of order and right of way hold and nobody touches anybody; none without such expectations.
fn order_kept(report: &Report) -> Option<bool> {
    let is_order = |what: &str| what == "order" || what.starts_with("yields.");
    let mut of_order = report.expectations.iter().filter(|expectation| is_order(&expectation.what)).peekable();
    of_order.peek()?;
    Some(of_order.all(|expectation| expectation.passed) && report.collisions.is_empty())
}

/// A vehicle's largest deceleration as a share of its strongest braking.
fn braking_share(scenario: &Scenario, vehicle: &VehicleReport) -> f64 {
    let strongest_mps2 = scenario.vehicle(&vehicle.name).map_or(f64::INFINITY, |of| -of.limits.acceleration_min_mps2);
    vehicle.peak_braking_mps2 / strongest_mps2
}

fn building(report: &BuildingReport) -> BuildingResult {
    let days = &report.iterations;
    BuildingResult {
        controller: report.controller.clone(),
        days: days.len() as u64,
        fallbacks: days.iter().filter(|day| day.fallback).count() as u64,
        energy_kwh: days.iter().map(|day| day.figures.energy_kwh).sum(),
        electricity_kwh: days.iter().map(|day| day.figures.electricity_kwh).sum(),
        bill: report.currency.as_ref().and_then(|_| days.iter().map(|day| day.figures.energy_cost).sum()),
        currency: report.currency.clone(),
        discomfort_k_h: days.iter().map(|day| day.figures.discomfort_k_h).sum(),
        last_cost: days.last().map_or(0.0, |day| day.figures.cost),
    }
}

/// Whether the ego caused its first contact; none before there is one.
#[derive(Clone, Default)]
struct EgoContact(Arc<Mutex<Option<bool>>>);

impl EgoContact {
    fn by_ego(&self) -> bool {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).unwrap_or(false)
    }
}

/// Sees who moves towards whom when the ego is first touched.
struct ContactWatcher {
    ego: usize,
    seen: EgoContact,
}

impl Watcher for ContactWatcher {
    fn tick(&mut self, frame: &Frame) -> Result<(), WatchError> {
        let Some(ego) = frame.vehicles.get(self.ego) else { return Ok(()) };
        let Some(contact) = frame.collisions.iter().find(|contact| contact.between.contains(&ego.name)) else {
            return Ok(());
        };
        let is_other = |name: &str| name != ego.name && contact.between.iter().any(|one| one == name);
        let Some(other) = frame.vehicles.iter().find(|vehicle| is_other(&vehicle.name)) else { return Ok(()) };
        let mut seen = self.seen.0.lock().unwrap_or_else(PoisonError::into_inner);
        seen.get_or_insert(ego.state.drives_into(&other.state));
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), WatchError> {
        Ok(())
    }
}

#[cfg(test)]
mod tests;
