//! The score of a run, and those of planners from the same start.

use interplay_planners::Driver;
use interplay_scenarios::Scenario;
use interplay_simulation::frame::BrokenRule;
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
        let sentence = |broken: &BrokenRule| format!("{} {} at {:.1} s", broken.vehicle, broken.words(), broken.time_s);
        story.extend(report.broken_rules.iter().map(sentence));
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
