//! The score of a run, and those of planners from the same start.

use interplay_planners::Driver;
use interplay_scenarios::{Scenario, Vehicle};
use interplay_simulation::report::Report;
use interplay_simulation::run::run;
use serde::Serialize;

use super::live::Session;
use super::seat::SessionError;

/// The planners that drive the ego for comparison with a person, in the order of the score; the first also takes the wheel.
pub(crate) fn planners_beside_person() -> Vec<&'static Driver> {
    let mut ranked: Vec<&Driver> =
        Driver::kinds().iter().filter(|driver| driver.rank_beside_person().is_some()).collect();
    ranked.sort_by_key(|driver| driver.rank_beside_person());
    ranked
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Score {
    pub you: ScoreRow,
    /// Runs of planners from the same start.
    pub others: Vec<ScoreRow>,
    /// Right of way and contacts in sentences.
    pub story: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ScoreRow {
    pub name: String,
    /// Whether the vehicle had a goal to reach.
    pub has_task: bool,
    /// When the goal was reached \[s\].
    pub reached_s: Option<f64>,
    /// The smallest distance to another vehicle \[m\].
    pub smallest_gap_m: Option<f64>,
    /// The strongest braking \[m/s²\].
    pub hardest_braking_mps2: Option<f64>,
    /// The largest jerk \[m/s³\].
    pub largest_jerk_mps3: Option<f64>,
    /// Number of violations of traffic rules.
    pub rules_broken: u64,
    /// Whether the vehicle touched another one.
    pub contact: bool,
    /// Whether the vehicle left the road.
    pub off_road: bool,
}

impl ScoreRow {
    /// The measures of a vehicle from a report.
    fn of(name: &str, vehicle: &str, report: &Report) -> ScoreRow {
        let found = report.vehicle(vehicle);
        let number = |metric: &str| found.and_then(|vehicle| vehicle.metrics.number(metric));
        ScoreRow {
            name: name.to_owned(),
            has_task: found.is_some_and(|vehicle| vehicle.has_task),
            reached_s: found.and_then(|vehicle| vehicle.completed_s),
            smallest_gap_m: report.metrics.number("smallest_gap_m"),
            hardest_braking_mps2: number("peak_braking_mps2"),
            largest_jerk_mps3: number("peak_jerk_mps3"),
            rules_broken: number("rules_broken").unwrap_or_default() as u64,
            contact: report.collisions.iter().any(|contact| contact.between.iter().any(|name| name == vehicle)),
            off_road: number("leaves_road").is_some_and(|count| count > 0.0),
        }
    }
}

impl Session {
    /// The score of a seat so far, without the runs of planners.
    pub fn score(&self, seat: &str) -> Score {
        let report = self.report();
        let yielded = report.right_of_way.iter().filter(|passage| passage.yielded);
        let mut story: Vec<String> =
            yielded.map(|passage| format!("{} let {} go first", passage.second, passage.first)).collect();
        if story.is_empty() && report.order.len() > 1 {
            story.push(format!("In the end: {}", report.order.join(" before ")));
        }
        story.extend(
            report
                .collisions
                .iter()
                .map(|contact| format!("{} and {} touched", contact.between[0], contact.between[1])),
        );
        Score { you: ScoreRow::of("you", seat, &report), others: Vec::new(), story }
    }
}

/// The measures of runs without people, from the same start and for the same time. Several planners drive the seat if it is the
/// ego; otherwise the driver of the scenario does.
pub(crate) fn planner_rows(written: &Scenario, seat: &str, duration_s: f64) -> Result<Vec<ScoreRow>, SessionError> {
    let Some(index) = written.index_of(seat) else { return Ok(Vec::new()) };
    let as_written = written.vehicles[index].driver.clone();
    let drivers: Vec<(String, Driver)> = if index == written.ego_index() {
        planners_beside_person().into_iter().map(|driver| (driver.kind().to_owned(), driver.clone())).collect()
    } else {
        vec![(as_written.description(), as_written)]
    };
    let row = |(name, driver): (String, Driver)| {
        let mut scenario = Scenario { duration_s: duration_s.max(written.step_s), ..written.clone() };
        scenario.vehicles[index].driver = driver;
        Ok(ScoreRow::of(&name, seat, &run(&name, &scenario, Vec::new())?))
    };
    drivers.into_iter().map(row).collect()
}

/// The goal of a person in a seat.
#[derive(Clone, Debug, Serialize)]
pub struct PlayGoal {
    /// `lane`, `cross`, `last-lane` or `drive`.
    pub kind: &'static str,
    pub text: String,
    /// The line to cross \[m\].
    pub line: Option<[[f64; 2]; 2]>,
    /// The middle of the lane to reach \[m\].
    pub lane: Option<Vec<[f64; 2]>>,
}

/// Length of the mark of a lane, in lengths of the vehicle.
const MARK_LENGTHS: f64 = 30.0;
const MARK_POINTS: usize = 24;

pub(super) fn of(scenario: &Scenario, index: usize) -> PlayGoal {
    let vehicle = &scenario.vehicles[index];
    let route = &vehicle.route;
    let start_m = [route.along(vehicle.start.position()), route.across(vehicle.start.position())];
    let line = |along_m: f64| {
        let half_m = route.half_width.value(along_m).max(0.5 * scenario.road.lane_width_m());
        Some([-half_m, half_m].map(|across_m| route.position(along_m, across_m)))
    };
    if let Some([_, end_m]) = scenario.road.conflict_zone_m(vehicle.road) {
        let text = "Cross the other road".to_owned();
        return PlayGoal { kind: "cross", text, line: line(end_m + vehicle.body.rear_m), lane: None };
    }
    let last = route.legs.last().filter(|_| scenario.road.parallel_lanes().is_none() && route.legs.len() > 1);
    if let Some(leg) = last {
        let text = format!("Drive to the end of your route: {}", leg.lane.replace(['-', '_'], " "));
        return PlayGoal { kind: "last-lane", text, line: line(leg.from_m + vehicle.body.rear_m), lane: None };
    }
    let across_m = route.across(vehicle.target(&scenario.road).position());
    let is_elsewhere = (across_m - start_m[1]).abs() > 0.5 * vehicle.body.width_m;
    let text = match (is_elsewhere, across_m > start_m[1]) {
        (false, _) => "Stay in your lane and drive on. Other drivers may want to merge: let them in or not".to_owned(),
        (true, true) => "Change to the lane on your left".to_owned(),
        (true, false) => "Change to the lane on your right".to_owned(),
    };
    let lane = is_elsewhere.then(|| mark(vehicle, start_m[0], across_m));
    PlayGoal { kind: if is_elsewhere { "lane" } else { "drive" }, text, line: None, lane }
}

/// The middle of a lane, from beside the start on \[m\].
fn mark(vehicle: &Vehicle, from_m: f64, across_m: f64) -> Vec<[f64; 2]> {
    let reach_m = MARK_LENGTHS * (vehicle.body.front_m + vehicle.body.rear_m);
    let place = |place: usize| from_m + reach_m * place as f64 / MARK_POINTS as f64;
    (0..=MARK_POINTS).map(|at| vehicle.route.position(place(at), across_m)).collect()
}
