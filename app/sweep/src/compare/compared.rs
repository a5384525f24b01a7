//! What of the rows is compared: a list of columns, each with how its values of many runs become one figure.
//!
//! The metrics of runs are on the list by their own declarations.

use interplay_scenarios::{Better, MetricComparison, MetricDeclaration, RegisteredMetrics};
use interplay_simulation::measure::metrics_of;

use super::records::RunRecord;

/// All that is compared.
pub(super) struct ComparedColumns {
    pub figures: Vec<FigureColumn>,
    pub splits: Vec<SplitColumn>,
}

/// A figure of a planner.
pub(super) struct FigureColumn {
    /// Its key.
    pub key: String,
    /// What it is, in words with the unit.
    pub title: String,
    pub how: FigureKind,
    /// The column of rows that it is made of.
    pub column: String,
    /// The value of a row; flags are 0 and 1.
    of: fn(&RunRecord, &str) -> Option<f64>,
}

/// How the values of many runs become one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FigureKind {
    /// The share of those that are not 0.
    Share,
    /// How many are not 0.
    Runs,
    Sum,
    Mean,
    Quantiles,
    Median,
}

/// A metric by which one of a pair of runs is better.
pub(super) struct SplitColumn {
    /// Its key.
    pub key: &'static str,
    /// What it is, in words.
    pub title: String,
    column: &'static str,
    better: Better,
}

/// A figure that is no metric: its key, how it is made, the column, and the value of a row.
type FixedFigure = (&'static str, FigureKind, &'static str, fn(&RunRecord, &str) -> Option<f64>);

const FIGURES: [FixedFigure; 13] = [
    // Runs in which the ego did its task and touched nobody; without vehicles, those that passed.
    ("success", FigureKind::Share, "success", |record, _| Some(f64::from(succeeds(record)))),
    // Of runs that succeeded.
    ("completed_s", FigureKind::Mean, "completed_s", |record, name| record.number(name).filter(|_| succeeds(record))),
    // Runs in which the ego had the first place.
    ("first", FigureKind::Share, "ego_place", |record, name| Some(f64::from(record.number(name) == Some(1.0)))),
    // Runs in which another went before the ego in a conflict zone.
    ("yields", FigureKind::Share, "ego_yields", |record, name| Some(f64::from(record.flag(name) == Some(true)))),
    // Runs in which the ego went before another in a conflict zone.
    ("others_yield", FigureKind::Share, "others_yield", RunRecord::number),
    // Runs in which the order is that of the scenario's file and nobody touched anybody, of those whose file states one.
    ("order_kept", FigureKind::Share, "order_kept", RunRecord::number),
    // Runs in which the ego never did its task, though nobody touched anybody.
    ("deadlocks", FigureKind::Runs, "deadlock", RunRecord::number),
    // Runs in which the ego touched somebody.
    ("contacts", FigureKind::Runs, "ego_contact", RunRecord::number),
    // Those of them in which it moved towards the other at least as fast as the other towards it.
    ("contacts_by_ego", FigureKind::Runs, "contact_by_ego", RunRecord::number),
    // Runs in which anybody touched anybody.
    ("touched", FigureKind::Runs, "contacts", RunRecord::number),
    ("plans_failed", FigureKind::Sum, "plans_failed", RunRecord::number),
    // Medians over the runs of times of plans, which are not reproducible.
    ("plan_median_ms", FigureKind::Median, "plan_median_ms", RunRecord::number),
    ("plan_p99_ms", FigureKind::Median, "plan_p99_ms", RunRecord::number),
];

/// Columns that are read besides those of figures and splits.
const MORE_COLUMNS: [&str; 6] = ["passed", "energy_kwh", "electricity_kwh", "bill", "currency", "discomfort_k_h"];

impl ComparedColumns {
    /// What Interplay compares, with the metrics of others that are registered.
    pub fn new(registered: &RegisteredMetrics) -> Self {
        let fixed = FIGURES.map(|(key, how, column, of)| FigureColumn {
            key: key.to_owned(),
            title: key.replace('_', " "),
            how,
            column: column.to_owned(),
            of,
        });
        let mut compared = ComparedColumns { figures: fixed.into(), splits: Vec::new() };
        for declaration in metrics_of(registered).map(|metric| metric.declaration()) {
            compared.add(&declaration);
        }
        compared
    }

    fn add(&mut self, declaration: &MetricDeclaration) {
        let MetricDeclaration { name, others, better, .. } = *declaration;
        let Some(comparison) = declaration.comparison else { return };
        let how = match comparison {
            MetricComparison::Share => FigureKind::Share,
            MetricComparison::Sum => FigureKind::Sum,
            MetricComparison::Mean => FigureKind::Mean,
            MetricComparison::Quantiles => FigureKind::Quantiles,
        };
        let unit = declaration.unit().map_or_else(String::new, |unit| format!(" {unit}"));
        let title = declaration.quantity().replace('_', " ") + &unit;
        let figure = |key: String, title: String, column: String| FigureColumn {
            key,
            title,
            how,
            column,
            of: RunRecord::number,
        };
        let key = declaration.compared_as();
        self.figures.push(figure(key.to_owned(), title.clone(), name.to_owned()));
        if others {
            let column = declaration.others_name();
            self.figures.push(figure(format!("others_{key}"), format!("others {title}"), column));
        }
        self.splits.extend(better.map(|better| SplitColumn { key, title, column: name, better }));
    }

    /// The columns that a comparison reads.
    pub fn columns(&self) -> impl Iterator<Item = &str> {
        let figures = self.figures.iter().map(|figure| figure.column.as_str());
        figures.chain(self.splits.iter().map(|split| split.column)).chain(MORE_COLUMNS)
    }
}

impl FigureColumn {
    /// The values of the runs that have one.
    pub fn values(&self, records: &[&RunRecord]) -> Vec<f64> {
        records.iter().filter_map(|record| (self.of)(record, &self.column)).collect()
    }
}

impl SplitColumn {
    /// Whether the first run is better than the second.
    pub fn is_better(&self, one: &RunRecord, other: &RunRecord) -> bool {
        let pair = one.number(self.column).zip(other.number(self.column));
        pair.is_some_and(|(one, other)| match self.better {
            Better::Lower => one < other,
            Better::Higher => one > other,
        })
    }
}

/// Whether the ego did its task and touched nobody; without vehicles, whether the run passed.
pub(super) fn succeeds(record: &RunRecord) -> bool {
    record.flag("success").or_else(|| record.flag("passed")).unwrap_or(false)
}
