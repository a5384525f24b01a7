//! The report of a run: figures, and the verdicts on the scenario's expectations.

mod building;
mod counterfactual;
mod judge;
mod judge_building;
mod outcome;
mod words;

use interplay_planners::road::network::{Lane, RoadNetwork};
use interplay_scenarios::{Expect, Scenario, Vehicle};
use serde_json::json;
use xxhash_rust::xxh3::xxh3_128;

pub use building::{BuildingReport, ZoneOutcome};
pub use outcome::{BeliefReport, CounterfactualReport, Expectation, PlansReport, Report, VehicleReport};

use crate::measure::{BuildingMeasures, Measures, PhaseDigests, VehicleMeasures};
use crate::state::components::to_nanosecond;

impl Report {
    /// Builds the report from the measures of a run and judges its expectations. `wall_s` is its wall time \[s\];
    /// `ended_early_s` is set if the run ended before the scenario was over \[s\].
    pub fn new(
        name: &str,
        scenario: &Scenario,
        measures: &Measures,
        building: Option<&BuildingMeasures>,
        wall_s: f64,
        ended_early_s: Option<f64>,
    ) -> Self {
        let vehicles = measures.vehicles.iter().enumerate();
        let vehicles = vehicles
            .map(|(index, measured)| VehicleReport::new(scenario, index, measured, measures.waits.of(index)))
            .collect();
        let phase_digests = measures.digest.phases();
        let building = building.map(|measures| BuildingReport::new(scenario, measures));
        let mut report = Report {
            scenario: name.to_owned(),
            passed: true,
            seed: scenario.seed,
            remarks: scenario.remarks.iter().map(|remark| remark.to_string()).collect(),
            simulated_s: ended_early_s.unwrap_or_else(|| simulated_s(scenario)),
            ended_early_s,
            wall_s,
            digest: digest(scenario, &phase_digests, building.as_ref()),
            phase_digests,
            collisions: measures.collisions.clone(),
            metrics: measures.metrics.values(),
            right_of_way: measures.passages.passages(),
            broken_rules: measures.broken_rules.all().to_vec(),
            deadlocks: measures.waits.deadlocks().to_vec(),
            order: order(scenario, measures),
            vehicles,
            building,
            expectations: Vec::new(),
            counterfactuals: Vec::new(),
        };
        report.expectations = judge::judge(&scenario.expect, &report);
        report.passed = report.expectations.iter().all(|expectation| expectation.passed);
        report
    }

    /// Judges the counterfactuals of `scenario` by their runs, in the scenario's order.
    pub fn judge_counterfactuals(&mut self, scenario: &Scenario, runs: Vec<Report>) {
        let counterfactuals = scenario.counterfactuals.iter().zip(runs);
        self.counterfactuals = counterfactuals
            .map(|(one, run)| counterfactual::judge_counterfactual(&one.stated, scenario, self, run))
            .collect();
        self.passed &= self.counterfactuals.iter().all(|counterfactual| counterfactual.passed);
    }

    /// The report, failed if nothing was expected of the run and its ego began a contact.
    pub fn without_contacts_by_ego(mut self) -> Self {
        let expects_nothing = self.expectations.is_empty() && self.counterfactuals.is_empty();
        if expects_nothing && self.metrics.number("contact_by_ego").is_some_and(|begun| begun > 0.0) {
            let why =
                self.collisions.iter().filter_map(|contact| Some((contact.time_s, contact.fault.as_ref()?))).next();
            let why =
                why.map_or_else(|| "a contact".to_owned(), |(time_s, fault)| format!("{} at {time_s:.1} s", fault.why));
            let want = json!("no contact that the ego begins, where nothing else is expected");
            self.expectations.push(Expectation::new("no_contact_by_ego", want, json!(why), false));
            self.passed = false;
        }
        self
    }

    /// Judges this run by the expectations of a scenario, independently of its own.
    pub fn judged_by(&self, expect: &Expect) -> Vec<Expectation> {
        judge::judge(expect, self)
    }
}

/// Simulated duration, up to the end of the slower clock \[s\].
fn simulated_s(scenario: &Scenario) -> f64 {
    let last = |step_s: f64, count: usize| to_nanosecond(step_s * count as f64);
    let building = scenario.building.as_ref();
    let days_s = building.map_or(0.0, |building| last(building.step_s, scenario.days() * building.steps_per_day()));
    last(scenario.step_s, scenario.tick_count()).max(days_s)
}

/// One digest of all states: that of the vehicles, of the building, or of both.
fn digest(scenario: &Scenario, phases: &PhaseDigests, building: Option<&BuildingReport>) -> String {
    match building.map(|building| &building.digests.balance) {
        None => phases.physics.clone(),
        Some(balance) if scenario.vehicles.is_empty() => balance.clone(),
        Some(balance) => format!("{:032x}", xxh3_128(format!("{}{balance}", phases.physics).as_bytes())),
    }
}

/// Names from the front of the road to its rear; at an intersection, in the order in which they left the conflict zone, then
/// by remaining distance. On a network whose routes all end on one lane, or on adjacent lanes,
/// they are ordered along the ego's; otherwise
/// in the order in which they reached their goals, then by remaining distance.
fn order(scenario: &Scenario, measures: &Measures) -> Vec<String> {
    let road = &scenario.road;
    let vehicles = scenario.vehicles.iter().zip(&measures.vehicles);
    let is_network = scenario.network.is_some();
    let common = scenario.network.as_ref().filter(|network| end_side_by_side(scenario, network));
    let common = common.map(|_| scenario.main_route());
    let place = |(vehicle, measured): (&Vehicle, &VehicleMeasures)| {
        let position = measured.last.position();
        let along =
            common.as_ref().map_or_else(|| measured.completion.along_m(position), |route| route.along(position));
        let remaining = vehicle.route.end_m() - along;
        match road.conflict_zone_m(vehicle.road) {
            Some([_, end]) => {
                let never = if along > end { 0.0 } else { f64::INFINITY };
                [measured.completion.completed_s.unwrap_or(never), end - along]
            }
            None if is_network && common.is_none() => {
                [measured.completion.completed_s.unwrap_or(f64::INFINITY), remaining]
            }
            None => [0.0, -along],
        }
    };
    let mut places: Vec<([f64; 2], &str)> =
        vehicles.map(|(one, seen)| (place((one, seen)), one.name.as_str())).collect();
    places.sort_by(|([a, behind_a], _), ([b, behind_b], _)| a.total_cmp(b).then(behind_a.total_cmp(behind_b)));
    places.into_iter().map(|(_, name)| name.to_owned()).collect()
}

/// Whether the routes of all vehicles end on one lane, or on adjacent lanes between which vehicles may change.
fn end_side_by_side(scenario: &Scenario, network: &RoadNetwork) -> bool {
    let last = |vehicle: &Vehicle| vehicle.route.legs.last().and_then(|leg| network.lane(&leg.lane));
    let mut beside: Vec<&Lane> = scenario.vehicles.first().and_then(last).into_iter().collect();
    let mut next = 0;
    while let Some(lane) = beside.get(next) {
        let neighbours = [&lane.left, &lane.right].into_iter().flatten().filter(|neighbour| neighbour.is_open());
        let found: Vec<&Lane> = neighbours.filter_map(|neighbour| network.lane(&neighbour.lane)).collect();
        beside.extend(found.into_iter().filter(|lane| !beside.contains(lane)).collect::<Vec<_>>());
        next += 1;
    }
    scenario.vehicles.iter().all(|vehicle| last(vehicle).is_some_and(|lane| beside.contains(&lane)))
}
