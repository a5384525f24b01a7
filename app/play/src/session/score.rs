//! How a run went, beside the same start as planners drive it.

use interplay_planners::Driver;
use interplay_scenarios::Scenario;
use interplay_simulation::Simulation;
use interplay_simulation::report::Report;
use serde::Serialize;
use serde_json::Value as Json;

use super::error::SessionError;
use super::live::Session;

/// Who drives the ego beside a person who did.
const PLANNERS: [&str; 3] = ["negotiation", "conservative", "bayesian"];

/// How a run went.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Score {
    /// The person's run.
    pub you: ScoreRow,
    /// The same start as others drive it.
    pub others: Vec<ScoreRow>,
    /// Who let whom go first, in sentences.
    pub story: Vec<String>,
}

/// A run in some numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ScoreRow {
    /// Who drove.
    pub name: String,
    /// When the goal was reached \[s\].
    pub reached_s: Option<f64>,
    /// The smallest distance to anybody \[m\].
    pub smallest_gap_m: Option<f64>,
    /// The strongest braking \[m/s²\].
    pub hardest_braking_mps2: Option<f64>,
    /// The largest jerk \[m/s³\].
    pub largest_jerk_mps3: Option<f64>,
    /// How often a rule of the road was broken.
    pub rules_broken: u64,
    /// Whether somebody was touched.
    pub contact: bool,
    /// Whether the road was left.
    pub off_road: bool,
}

impl ScoreRow {
    /// The run of a vehicle by its report.
    fn of(name: &str, vehicle: &str, report: &Report) -> ScoreRow {
        let json = serde_json::to_value(report).unwrap_or_default();
        let vehicles = json["vehicles"].as_array().cloned().unwrap_or_default();
        let found = vehicles.into_iter().find(|entry| entry["name"] == vehicle).unwrap_or(Json::Null);
        ScoreRow {
            name: name.to_owned(),
            reached_s: found["completed_s"].as_f64(),
            smallest_gap_m: json["smallest_gap"]["m"].as_f64(),
            hardest_braking_mps2: found["peak_braking_mps2"].as_f64(),
            largest_jerk_mps3: found["peak_jerk_mps3"].as_f64(),
            rules_broken: found["rules_broken"].as_u64().unwrap_or_default(),
            contact: report.collisions.iter().any(|contact| contact.between.iter().any(|name| name == vehicle)),
            off_road: found["leaves_road"].as_bool().unwrap_or_default(),
        }
    }
}

impl Session {
    /// How the run of a seat has gone until now, without the runs of others.
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

/// The same start as others drive it, for as long: planners in place of the ego, and in place of anybody else whom the scenario has.
///
/// # Errors
/// [`SessionError::Run`] if a run cannot be finished.
pub(crate) fn others(written: &Scenario, seat: &str, duration_s: f64) -> Result<Vec<ScoreRow>, SessionError> {
    let Some(index) = written.index_of(seat) else { return Ok(Vec::new()) };
    let as_written = written.vehicles[index].driver.clone();
    let drivers: Vec<(String, Driver)> = if index == written.ego_index() {
        PLANNERS.iter().filter_map(|kind| Some(((*kind).to_owned(), Driver::of_kind(kind)?))).collect()
    } else {
        vec![(as_written.description(), as_written)]
    };
    let row = |(name, driver): (String, Driver)| {
        let mut scenario = Scenario { duration_s: duration_s.max(written.step_s), ..written.clone() };
        scenario.vehicles[index].driver = driver;
        let mut world = Simulation::new(&scenario)?;
        while world.step()?.is_some() {}
        Ok(ScoreRow::of(&name, seat, &world.finish()?))
    };
    drivers.into_iter().map(row).collect()
}
