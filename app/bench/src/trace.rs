//! A run, reduced to what the score needs.

use interplay_planners::{Input, State};
use interplay_scenarios::Scenario;
use interplay_simulation::Simulation;
use interplay_simulation::frame::{Frame, RoadRule};
use interplay_simulation::measure::{Subscriptions, beyond_edge_m};
use interplay_simulation::run::RunError;

use crate::formula::{AFTERWARDS_S, EGO, FREE_BRAKING_MPS2, OFF_ROAD, UNCOMFORTABLE};
use crate::planner::Wheel;

/// What is measured of the ego by the simulation: it makes known whose fault contacts are, and which rules are broken.
const METRICS: [&str; 2] = ["contacts_at_fault", "rules_broken"];

/// A run, reduced to what the score needs.
#[derive(Clone, Debug)]
pub(crate) struct Trace {
    pub step_s: f64,
    /// The others without obstacles, in the scenario's order.
    pub others: Vec<OtherTrace>,
    /// The ego; none in a run without it.
    pub ego: Option<EgoTrace>,
    /// Digest of all states of the run.
    pub digest: String,
}

/// The way of another road user, by tick, until it leaves the road.
#[derive(Clone, Debug, Default)]
pub(crate) struct OtherTrace {
    /// Arc length along its route \[m\].
    pub along_m: Vec<f64>,
    /// Braking beyond what is free, summed up to the tick \[m/s\].
    pub braking_mps: Vec<f64>,
    /// Whether it has left the road.
    pub has_left: bool,
}

/// How the ego fared.
#[derive(Clone, Debug, Default)]
pub(crate) struct EgoTrace {
    /// When it reached its goal \[s\].
    pub completed_s: Option<f64>,
    /// What makes the score 0, in words.
    pub failure: Option<String>,
    pub uncomfortable_ticks: usize,
    pub ticks: usize,
    /// Wall time of its plans \[s\].
    pub planning_s: f64,
    pub off_road_s: f64,
    pub along_m: Option<f64>,
    pub last: Input,
}

impl EgoTrace {
    /// The share of the time that was uncomfortable.
    pub fn uncomfortable_share(&self) -> f64 {
        self.uncomfortable_ticks as f64 / self.ticks.max(1) as f64
    }
}

/// Runs a scenario until the score of its ego is decided, or to a time limit \[s\]. A wheel drives an ego whose driver is outside.
pub(crate) fn trace(scenario: &Scenario, limit_s: f64, mut wheel: Option<&mut Wheel>) -> Result<Trace, RunError> {
    let ego = scenario.index_of(EGO);
    let measured: Vec<usize> = ego.into_iter().collect();
    let subscriptions = Subscriptions::only(if ego.is_some() { &METRICS } else { &[] }, &measured);
    let mut world = Simulation::builder(scenario).subscribed_to(subscriptions).build()?;
    let is_other = |row: &usize| Some(*row) != ego && scenario.vehicles[*row].obstacle.is_none();
    let rows: Vec<usize> = (0..scenario.vehicles.len()).filter(is_other).collect();
    let mut found = Trace {
        step_s: scenario.step_s,
        others: vec![OtherTrace::default(); rows.len()],
        ego: ego.map(|_| EgoTrace::default()),
        digest: String::new(),
    };
    for tick in 0.. {
        if let Some(wheel) = wheel.as_mut() {
            wheel.watch(&world);
            if tick % scenario.ticks_per_plan == 0 {
                let input = wheel.input(&world, tick / scenario.ticks_per_plan)?;
                world.apply(EGO, input)?;
            }
        }
        let Some(frame) = world.step()?.cloned() else { break };
        let after = world.states();
        for (other, row) in found.others.iter_mut().zip(&rows) {
            other.observe(scenario, &frame, *row, &after[*row]);
        }
        let now_s = world.time_s();
        if let (Some(found), Some(row)) = (&mut found.ego, ego) {
            found.completed_s = world.measures().vehicles[row].completion.completed_s;
            found.observe(scenario, &frame, row, &after[row]);
            if found.is_decided(now_s) {
                break;
            }
        }
        if now_s >= limit_s {
            break;
        }
    }
    if let (Some(ego), Some(wheel)) = (&mut found.ego, wheel) {
        ego.planning_s = wheel.planning_s();
    }
    found.digest = world.measures().digest.phases().physics;
    Ok(found)
}

impl OtherTrace {
    fn observe(&mut self, scenario: &Scenario, frame: &Frame, row: usize, after: &State) {
        let (vehicle, step_s) = (&frame.vehicles[row], scenario.step_s);
        self.has_left = vehicle.is_absent;
        if vehicle.is_absent {
            return;
        }
        let near_m = self.along_m.last().copied();
        self.along_m.push(scenario.vehicles[row].route.locate(after.position(), near_m).along_m);
        // A vehicle that does not react may be stopped by its plant; a driver that brakes has this acceleration.
        let braking_mps2 = (vehicle.state.speed_mps - after.speed_mps) / step_s;
        let before_mps = self.braking_mps.last().copied().unwrap_or_default();
        self.braking_mps.push(before_mps + step_s * (braking_mps2 - FREE_BRAKING_MPS2).max(0.0));
    }
}

impl EgoTrace {
    fn observe(&mut self, scenario: &Scenario, frame: &Frame, row: usize, after: &State) {
        let (vehicle, step_s) = (&frame.vehicles[row], scenario.step_s);
        self.planning_s += if frame.plans { 1e-3 * vehicle.plan_ms } else { 0.0 };
        let jerk_mps3 = (vehicle.input.acceleration_mps2 - self.last.acceleration_mps2) / step_s;
        let yaw_rate_radps = (after.heading_rad - vehicle.state.heading_rad) / step_s;
        let is_rough = self.ticks > 0 && jerk_mps3.abs() > UNCOMFORTABLE[0];
        let is_sideways = (yaw_rate_radps * after.speed_mps).abs() > UNCOMFORTABLE[1];
        self.uncomfortable_ticks += usize::from(is_rough || is_sideways);
        self.last = vehicle.input;
        self.ticks += 1;
        let stated = &scenario.vehicles[row];
        let along_m = stated.route.locate(after.position(), self.along_m).along_m;
        self.along_m = Some(along_m);
        let is_off = beyond_edge_m(stated, after, along_m) > OFF_ROAD[0];
        self.off_road_s = if is_off { self.off_road_s + step_s } else { 0.0 };
        self.failure = self.failure.take().or_else(|| failure(frame, self.off_road_s));
    }

    /// Whether nothing that happens later changes the score.
    fn is_decided(&self, now_s: f64) -> bool {
        self.failure.is_some() || self.completed_s.is_some_and(|completed_s| now_s >= completed_s + AFTERWARDS_S)
    }
}

/// What of a tick makes the score 0.
fn failure(frame: &Frame, off_road_s: f64) -> Option<String> {
    let faults = frame.collisions.iter().filter_map(|contact| contact.fault.as_ref());
    if let Some(fault) = faults.into_iter().find(|fault| fault.vehicle == EGO) {
        return Some(format!("contact: {}", fault.why));
    }
    let is_judged = |rule: RoadRule| matches!(rule, RoadRule::StopSign | RoadRule::RedLight | RoadRule::RightOfWay);
    let broken = frame.broken_rules.iter().find(|broken| broken.vehicle == EGO && is_judged(broken.rule));
    if let Some(broken) = broken {
        return Some(format!("rule: {}", broken.words()));
    }
    (off_road_s > OFF_ROAD[1]).then(|| "off the road".to_owned())
}
