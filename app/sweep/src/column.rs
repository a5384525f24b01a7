//! The columns of a table of rows: each with its type and the computation of its value.
//!
//! Each column is declared once. Metrics of runs are columns by their own declarations. This file declares the columns that identify
//! a row, and those that follow from the report of a run and are not metrics: the ego's task, aggregates over the other
//! vehicles, and sums over a building's days.

use std::path::Path;

use interplay_scenarios::{Better, MetricDeclaration, MetricKind, MetricSubject, RegisteredMetrics, Scenario};
use interplay_simulation::measure::{Passage, metrics_of};
use interplay_simulation::report::{BuildingReport, Report, VehicleReport};
use interplay_tables::{Cell, ColumnKind, TableSchema, TableWriter};
use serde_json::{Value as Json, json};

use crate::error::SweepError;
use crate::row::SweepRow;

/// A column that identifies a row or describes the run as a whole.
type RowColumn = (&'static str, ColumnKind, fn(&SweepRow) -> Json);

/// A column that follows from the report of a run with vehicles.
type TrafficColumn = (&'static str, ColumnKind, fn(&EgoRun<'_>) -> Json);

/// A column that follows from the report of a building.
type BuildingColumn = (&'static str, ColumnKind, fn(&BuildingReport) -> Json);

use ColumnKind::{Count, Flag, Number, Text};

/// Columns that are not reproducible.
pub(crate) const TIMINGS: [&str; 3] = ["wall_s", "plan_median_ms", "plan_p99_ms"];

/// A vehicle further beyond an edge has left the road, for a real car \[m\].
const MOST_OFF_ROAD_M: f64 = 0.05;

/// Columns before the varied inputs.
const HEAD: [RowColumn; 8] = [
    ("key", Text, |row| json!(row.key.to_string())),
    ("version", Text, |row| json!(row.version)),
    ("scenario", Text, |row| json!(row.scenario)),
    ("family", Text, |row| json!(row.family)),
    ("style", Text, |row| json!(row.style)),
    ("planner", Text, |row| json!(row.planner)),
    ("sample", Count, |row| json!(row.sample)),
    ("seed", Count, |row| json!(row.seed)),
];

/// Columns after the varied inputs.
const RUN: [RowColumn; 4] = [
    ("error", Text, |row| json!(row.error)),
    ("digest", Text, |row| json!(row.result.as_ref().map(|result| &result.digest))),
    ("simulated_s", Number, |row| json!(row.result.as_ref().map(|result| result.simulated_s))),
    ("passed", Flag, |row| json!(row.result.as_ref().map(|result| result.passed))),
];

/// The last columns, [`TIMINGS`].
const TAIL: [RowColumn; 3] = [
    ("wall_s", Number, |row| json!(row.wall_s)),
    ("plan_median_ms", Number, |row| json!(row.plan_median_ms)),
    ("plan_p99_ms", Number, |row| json!(row.plan_p99_ms)),
];

pub(crate) struct EgoRun<'a> {
    pub scenario: &'a Scenario,
    pub report: &'a Report,
    pub ego: &'a VehicleReport,
}

/// The ego's task, before the columns of metrics.
const TASK: [TrafficColumn; 17] = [
    // Whether the ego completes its task without contact; without a task, whether it has no contact. An ego that keeps the rules
    // of the road must also stay on the road, break no rule and never be stuck.
    ("success", Flag, |run| json!(run.is_done() && !run.has_contact() && run.is_lawful())),
    ("driver", Text, |run| json!(run.ego.driver)),
    ("has_task", Flag, |run| json!(run.ego.has_task)),
    ("completed_s", Number, |run| json!(run.ego.completed_s)),
    ("deadlock", Flag, |run| json!(!run.is_done() && run.report.collisions.is_empty())),
    ("others_with_task", Count, |run| json!(run.others().filter(|vehicle| vehicle.has_task).count())),
    ("others_completed", Count, |run| {
        json!(run.others().filter(|vehicle| vehicle.has_task && vehicle.completed_s.is_some()).count())
    }),
    ("contacts", Count, |run| json!(run.report.collisions.len())),
    ("ego_contact", Flag, |run| json!(run.has_contact())),
    ("contact_by_ego", Flag, |run| json!(run.report.metrics.number("contact_by_ego").map(|flag| flag != 0.0))),
    ("ego_contact_s", Number, |run| json!(run.contact_times_s().min_by(f64::total_cmp))),
    ("order_kept", Flag, |run| json!(order_kept(run.report))),
    ("impulse_ns", Number, |run| {
        json!(run.report.collisions.iter().map(|contact| contact.impulse_ns).max_by(f64::total_cmp))
    }),
    ("order", Text, |run| json!(run.report.order.join(" "))),
    // The position in the passing order; on a network, one more than the number of conflict zones in which another vehicle went first.
    ("ego_place", Count, |run| match run.scenario.network {
        Some(_) => json!(1 + run.goes_second().count()),
        None => json!(run.report.order.iter().position(|name| *name == run.ego.name).map_or(0, |index| index + 1)),
    }),
    ("ego_yields", Count, |run| json!(run.goes_second().filter(|passage| run.is_yielding(passage)).count())),
    ("others_yield", Count, |run| {
        let after_ego = run.report.right_of_way.iter().filter(|passage| passage.first == run.ego.name);
        json!(after_ego.filter(|passage| run.is_yielding(passage)).count())
    }),
];

/// Counts of plans, after the columns of metrics.
const PLANS: [TrafficColumn; 4] = [
    ("plans", Count, |run| json!(run.ego.plans.count)),
    ("plans_failed", Count, |run| json!(run.ego.plans.failed)),
    ("plans_unfinished", Count, |run| json!(run.ego.plans.unfinished)),
    ("others_plans_failed", Count, |run| json!(run.others().map(|vehicle| vehicle.plans.failed).sum::<usize>())),
];

/// Totals of a building over all its days.
const BUILDING: [BuildingColumn; 8] = [
    ("controller", Text, |building| json!(building.controller)),
    ("days", Count, |building| json!(building.iterations.len())),
    ("energy_kwh", Number, |building| json!(building.iterations.iter().map(|day| day.figures.energy_kwh).sum::<f64>())),
    ("electricity_kwh", Number, |building| {
        json!(building.iterations.iter().map(|day| day.figures.electricity_kwh).sum::<f64>())
    }),
    ("bill", Number, |building| {
        let costs = || building.iterations.iter().map(|day| day.figures.energy_cost).sum::<Option<f64>>();
        json!(building.currency.as_ref().and_then(|_| costs()))
    }),
    ("currency", Text, |building| json!(building.currency)),
    ("discomfort_k_h", Number, |building| {
        json!(building.iterations.iter().map(|day| day.figures.discomfort_k_h).sum::<f64>())
    }),
    ("last_cost", Number, |building| json!(building.iterations.last().map_or(0.0, |day| day.figures.cost))),
];

impl EgoRun<'_> {
    fn others(&self) -> impl Iterator<Item = &VehicleReport> {
        self.report.vehicles.iter().filter(|vehicle| vehicle.name != self.ego.name)
    }

    fn is_done(&self) -> bool {
        !self.ego.has_task || self.ego.completed_s.is_some()
    }

    fn contact_times_s(&self) -> impl Iterator<Item = f64> {
        let of_ego = self.report.collisions.iter().filter(|contact| contact.between.contains(&self.ego.name));
        of_ego.map(|contact| contact.time_s)
    }

    fn has_contact(&self) -> bool {
        self.contact_times_s().next().is_some()
    }

    /// The conflict zones in which another vehicle went before the ego.
    fn goes_second(&self) -> impl Iterator<Item = &Passage> {
        self.report.right_of_way.iter().filter(|passage| passage.second == self.ego.name)
    }

    /// Whether the second vehicle in a conflict zone yielded. For an ego that does not keep the rules, going second suffices.
    fn is_yielding(&self, passage: &Passage) -> bool {
        passage.yielded || !self.report.vehicle(&passage.second).is_some_and(|vehicle| vehicle.keeps_rules)
    }

    /// Whether an ego that keeps the rules obeys them: no corner further than 5 cm of a real car beyond an edge,
    /// no rule broken, no deadlock.
    fn is_lawful(&self) -> bool {
        let number = |name: &str| self.ego.metrics.number(name).unwrap_or(0.0);
        let is_on_road = number("off_road_m") <= MOST_OFF_ROAD_M * self.ego.scale;
        !self.ego.keeps_rules || (is_on_road && number("rules_broken") == 0.0 && number("deadlocks") == 0.0)
    }

    /// The values of all columns about vehicles, each with its name.
    pub fn values(&self) -> impl Iterator<Item = (String, Json)> {
        let fixed = TASK.iter().chain(&PLANS).map(|(name, _, value)| ((*name).to_owned(), value(self)));
        let of_run_and_ego = self.report.metrics.0.iter().chain(&self.ego.metrics.0);
        let metrics =
            of_run_and_ego.clone().map(|(declaration, measured)| (declaration.name.to_owned(), json!(measured.value)));
        let with_others = self.ego.metrics.0.iter().filter(|(declaration, _)| declaration.others);
        let others = with_others.map(|(declaration, _)| (declaration.others_name(), self.worst_of_others(declaration)));
        metrics.chain(others).chain(fixed)
    }

    /// The worst value of the other vehicles: whether any flag is set, the sum of counts, the largest number or the smallest.
    fn worst_of_others(&self, declaration: &MetricDeclaration) -> Json {
        let numbers = self.others().filter_map(|vehicle| vehicle.metrics.number(declaration.name));
        match (declaration.kind, declaration.better) {
            (MetricKind::Flag, _) => json!({ numbers }.any(|number| number != 0.0)),
            (MetricKind::Count, _) => json!(numbers.sum::<f64>() as u64),
            (MetricKind::Number, Some(Better::Higher)) => json!(numbers.min_by(f64::total_cmp)),
            (MetricKind::Number, _) => json!(numbers.max_by(f64::total_cmp)),
        }
    }
}

/// The values of all columns about a building, by their names.
pub(crate) fn building_values(building: &BuildingReport) -> impl Iterator<Item = (String, Json)> {
    BUILDING.iter().map(|(name, _, value)| ((*name).to_owned(), value(building)))
}

/// Whether the expectations of order and right of way hold and no vehicle touches another; none without such expectations.
/// They concern the drivers that the scenario's file states.
fn order_kept(report: &Report) -> Option<bool> {
    let is_order = |what: &str| what == "order" || what.starts_with("yields.");
    let mut of_order = report.expectations.iter().filter(|expectation| is_order(&expectation.what)).peekable();
    of_order.peek()?;
    Some(of_order.all(|expectation| expectation.passed) && report.collisions.is_empty())
}

/// The columns of a table in order, with those of the varied inputs between them.
pub(crate) fn schema(inputs: &TableSchema, registered: &RegisteredMetrics) -> TableSchema {
    fn named<T>(columns: &[(&str, ColumnKind, T)]) -> TableSchema {
        columns.iter().map(|(name, kind, _)| ((*name).to_owned(), *kind)).collect()
    }
    let task = named(&TASK);
    let declarations: Vec<MetricDeclaration> = metrics_of(registered).map(|metric| metric.declaration()).collect();
    let own = |of| declarations.iter().filter(move |one| one.of == of).map(|one| (one.name.to_owned(), kind_of(one)));
    let metrics = own(MetricSubject::Run).chain(own(MetricSubject::Vehicle)).filter(|column| !task.contains(column));
    let with_others = declarations.iter().filter(|one| one.others && one.of == MetricSubject::Vehicle);
    let others = with_others.map(|one| (one.others_name(), kind_of(one)));
    let parts: [TableSchema; 8] = [
        named(&HEAD),
        inputs.clone(),
        named(&RUN),
        task.clone(),
        metrics.chain(others).collect(),
        named(&PLANS),
        named(&BUILDING),
        named(&TAIL),
    ];
    parts.concat()
}

fn kind_of(declaration: &MetricDeclaration) -> ColumnKind {
    match declaration.kind {
        MetricKind::Flag => Flag,
        MetricKind::Count => Count,
        MetricKind::Number => Number,
    }
}

/// The values of a row in the columns of a schema; `inputs` are the varied inputs.
pub(crate) fn cells(row: &SweepRow, schema: &TableSchema, inputs: &TableSchema) -> Vec<Cell> {
    let measured = |name: &str| {
        let result = row.result.as_ref()?;
        [&result.traffic, &result.building].into_iter().flatten().find_map(|values| values.get(name)).cloned()
    };
    let value = |(at, (name, _)): (usize, &(String, ColumnKind))| {
        let of_row = HEAD.iter().chain(&RUN).chain(&TAIL).find(|(known, ..)| known == name);
        match of_row {
            _ if (HEAD.len()..HEAD.len() + inputs.len()).contains(&at) => row.inputs.get(name).cloned(),
            Some((_, _, value)) => Some(value(row)),
            None => measured(name),
        }
    };
    let columns = schema.iter().enumerate();
    columns.map(|column| cell_of(column.1.1, value(column).unwrap_or(Json::Null))).collect()
}

/// A value in a column of a type; none if it is of another type. A column of texts accepts every value.
fn cell_of(kind: ColumnKind, value: Json) -> Cell {
    match (kind, value) {
        (Flag, value) => Cell::Flag(value.as_bool()),
        (Count, value) => Cell::Count(value.as_u64()),
        (Number, value) => Cell::Number(value.as_f64()),
        (Text, Json::Null) => Cell::Text(None),
        (Text, Json::String(text)) => Cell::Text(Some(text)),
        (Text, other) => Cell::Text(Some(other.to_string())),
    }
}

/// Writes rows as a table; `inputs` are the columns of the varied inputs, and `registered` metrics add columns.
pub(crate) fn write_rows(
    target: &Path,
    inputs: &TableSchema,
    registered: &RegisteredMetrics,
    about: &[(&str, String)],
    rows: impl Iterator<Item = Result<SweepRow, SweepError>>,
) -> Result<usize, SweepError> {
    let columns = schema(inputs, registered);
    let mut writer = TableWriter::new(target, columns.clone(), about)?;
    let mut count = 0;
    for row in rows {
        writer.push(cells(&row?, &columns, inputs))?;
        count += 1;
    }
    writer.finish()?;
    Ok(count)
}
