//! The columns that are compared, each with the aggregation of its values over many runs.
//!
//! Metrics of runs are compared by their own declarations.

use interplay_scenarios::{Better, MetricComparison, MetricDeclaration, RegisteredMetrics};
use interplay_simulation::measure::metrics_of;

use super::records::RunRecord;

pub(super) struct ComparedColumns {
    pub figures: Vec<FigureColumn>,
    pub splits: Vec<SplitColumn>,
}

/// A figure of a planner, computed from a column.
pub(super) struct FigureColumn {
    pub key: String,
    /// Its name, in words with the unit.
    pub title: String,
    pub how: FigureKind,
    /// The column from which it is computed.
    pub column: String,
    /// The value of a row; flags are 0 and 1.
    of: fn(&RunRecord, &str) -> Option<f64>,
}

/// The aggregation of the values of many runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FigureKind {
    /// The share of the values that are not 0.
    Share,
    /// The number of values that are not 0.
    Runs,
    Sum,
    Mean,
    Quantiles,
    Median,
}

/// A metric by which one of a pair of runs is better.
pub(super) struct SplitColumn {
    pub key: &'static str,
    /// Its name, in words.
    pub title: String,
    column: &'static str,
    better: Better,
}

/// A figure that is not a metric: its key, its aggregation, the column, and the value of a row.
type FixedFigure = (&'static str, FigureKind, &'static str, fn(&RunRecord, &str) -> Option<f64>);

const FIGURES: [FixedFigure; 13] = [
    // Runs in which the ego completed its task without contact; without vehicles, those that passed.
    ("success", FigureKind::Share, "success", |record, _| Some(f64::from(succeeds(record)))),
    // Over runs that succeeded.
    ("completed_s", FigureKind::Mean, "completed_s", |record, name| record.number(name).filter(|_| succeeds(record))),
    // Runs in which the ego had the first place.
    ("first", FigureKind::Share, "ego_place", |record, name| Some(f64::from(record.number(name) == Some(1.0)))),
    // Runs in which another went before the ego in a conflict zone.
    ("yields", FigureKind::Share, "ego_yields", |record, name| Some(f64::from(record.flag(name) == Some(true)))),
    // Runs in which the ego went before another in a conflict zone.
    ("others_yield", FigureKind::Share, "others_yield", RunRecord::number),
    // Runs without contact that have the passing order of their scenario's file; only scenarios whose file states an order.
    ("order_kept", FigureKind::Share, "order_kept", RunRecord::number),
    // Runs in which the ego never completed its task although no vehicle touched another.
    ("deadlocks", FigureKind::Runs, "deadlock", RunRecord::number),
    // Runs in which the ego touched another vehicle.
    ("contacts", FigureKind::Runs, "ego_contact", RunRecord::number),
    // Runs with such a contact in which the ego approached the other vehicle at least as fast as the other approached it.
    ("contacts_by_ego", FigureKind::Runs, "contact_by_ego", RunRecord::number),
    // Runs in which any two vehicles touched.
    ("touched", FigureKind::Runs, "contacts", RunRecord::number),
    ("plans_failed", FigureKind::Sum, "plans_failed", RunRecord::number),
    // Medians over the runs of planning times, which are not reproducible.
    ("plan_median_ms", FigureKind::Median, "plan_median_ms", RunRecord::number),
    ("plan_p99_ms", FigureKind::Median, "plan_p99_ms", RunRecord::number),
];

/// Columns that are read in addition to those of figures and splits.
const MORE_COLUMNS: [&str; 6] = ["passed", "energy_kwh", "electricity_kwh", "bill", "currency", "discomfort_k_h"];

impl ComparedColumns {
    /// The columns that Interplay compares, with the registered metrics of other crates.
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
    /// The values of these runs in the compared column; runs without a value are left out.
    pub fn values(&self, records: &[&RunRecord]) -> Vec<f64> {
        records.iter().filter_map(|record| (self.of)(record, &self.column)).collect()
    }
}

impl SplitColumn {
    /// Whether the value of the first run is better than that of the second.
    pub fn is_better(&self, one: &RunRecord, other: &RunRecord) -> bool {
        let pair = one.number(self.column).zip(other.number(self.column));
        pair.is_some_and(|(one, other)| match self.better {
            Better::Lower => one < other,
            Better::Higher => one > other,
        })
    }
}

/// Whether the ego completed its task without contact; without vehicles, whether the run passed.
pub(super) fn succeeds(record: &RunRecord) -> bool {
    record.flag("success").or_else(|| record.flag("passed")).unwrap_or(false)
}
