//! The columns of a table of rows: each with its type, and with how its value is found in a row.

use serde_json::Value as Json;

use crate::row::{BuildingResult, RunResult, SweepRow, TrafficResult};

/// The type of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// True or false.
    Flag,
    /// A whole number.
    Count,
    /// A number.
    Number,
    /// A text.
    Text,
}

/// A value of a row; none where there is nothing to say.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Cell {
    Flag(Option<bool>),
    Count(Option<u64>),
    Number(Option<f64>),
    Text(Option<String>),
}

/// How a value is found in a row.
type Getter = fn(&SweepRow) -> Cell;

/// A column that every table has.
pub(crate) struct FixedColumn {
    pub name: &'static str,
    pub kind: ColumnKind,
    pub get: Getter,
}

/// Columns that are not reproducible.
pub(crate) const TIMINGS: [&str; 3] = ["wall_s", "plan_median_ms", "plan_p99_ms"];

fn result<T>(row: &SweepRow, value: impl Fn(&RunResult) -> T) -> Option<T> {
    row.result.as_ref().map(value)
}

fn traffic<T>(row: &SweepRow, value: impl Fn(&TrafficResult) -> T) -> Option<T> {
    row.result.as_ref().and_then(|result| result.traffic.as_ref()).map(value)
}

fn building<T>(row: &SweepRow, value: impl Fn(&BuildingResult) -> T) -> Option<T> {
    row.result.as_ref().and_then(|result| result.building.as_ref()).map(value)
}

/// A column: its name, its type, and the value of a row.
macro_rules! column {
    ($name:literal, $kind:ident, $get:expr) => {
        FixedColumn { name: $name, kind: ColumnKind::$kind, get: |row| Cell::$kind($get(row)) }
    };
}

/// Columns before those of what varies.
pub(crate) const HEAD: [FixedColumn; 8] = [
    column!("key", Text, |row: &SweepRow| Some(row.key.to_string())),
    column!("version", Text, |row: &SweepRow| Some(row.version.clone())),
    column!("scenario", Text, |row: &SweepRow| Some(row.scenario.clone())),
    column!("family", Text, |row: &SweepRow| Some(row.family.clone())),
    column!("style", Text, |row: &SweepRow| Some(row.style.clone())),
    column!("planner", Text, |row: &SweepRow| Some(row.planner.clone())),
    column!("sample", Count, |row: &SweepRow| Some(row.sample)),
    column!("seed", Count, |row: &SweepRow| Some(row.seed)),
];

/// Columns after those of what varies.
pub(crate) const TAIL: [FixedColumn; 54] = [
    column!("error", Text, |row: &SweepRow| row.error.clone()),
    column!("digest", Text, |row| result(row, |of| of.digest.clone())),
    column!("simulated_s", Number, |row| result(row, |of| of.simulated_s)),
    column!("passed", Flag, |row| result(row, |of| of.passed)),
    column!("success", Flag, |row| traffic(row, |of| of.success)),
    column!("driver", Text, |row| traffic(row, |of| of.driver.clone())),
    column!("has_task", Flag, |row| traffic(row, |of| of.has_task)),
    column!("completed_s", Number, |row| traffic(row, |of| of.completed_s).flatten()),
    column!("deadlock", Flag, |row| traffic(row, |of| of.deadlock)),
    column!("others_with_task", Count, |row| traffic(row, |of| of.others_with_task)),
    column!("others_completed", Count, |row| traffic(row, |of| of.others_completed)),
    column!("contacts", Count, |row| traffic(row, |of| of.contacts)),
    column!("ego_contact", Flag, |row| traffic(row, |of| of.ego_contact)),
    column!("contact_by_ego", Flag, |row| traffic(row, |of| of.contact_by_ego)),
    column!("ego_contact_s", Number, |row| traffic(row, |of| of.ego_contact_s).flatten()),
    column!("order_kept", Flag, |row| traffic(row, |of| of.order_kept).flatten()),
    column!("impulse_ns", Number, |row| traffic(row, |of| of.impulse_ns).flatten()),
    column!("order", Text, |row| traffic(row, |of| of.order.join(" "))),
    column!("ego_place", Count, |row| traffic(row, |of| of.ego_place)),
    column!("ego_yields", Count, |row| traffic(row, |of| of.ego_yields)),
    column!("others_yield", Count, |row| traffic(row, |of| of.others_yield)),
    column!("ego_gap_m", Number, |row| traffic(row, |of| of.ego_gap_m).flatten()),
    column!("smallest_gap_m", Number, |row| traffic(row, |of| of.smallest_gap_m).flatten()),
    column!("time_to_collision_s", Number, |row| traffic(row, |of| of.time_to_collision_s).flatten()),
    column!("mean_abs_acceleration", Number, |row| traffic(row, |of| of.mean_abs_acceleration)),
    column!("mean_abs_jerk", Number, |row| traffic(row, |of| of.mean_abs_jerk)),
    column!("peak_acceleration_mps2", Number, |row| traffic(row, |of| of.peak_acceleration_mps2)),
    column!("peak_braking_mps2", Number, |row| traffic(row, |of| of.peak_braking_mps2)),
    column!("peak_braking_share", Number, |row| traffic(row, |of| of.peak_braking_share)),
    column!("hard_braking", Flag, |row| traffic(row, |of| of.hard_braking)),
    column!("peak_jerk_mps3", Number, |row| traffic(row, |of| of.peak_jerk_mps3)),
    column!("peak_lateral_acceleration_mps2", Number, |row| traffic(row, |of| of.peak_lateral_acceleration_mps2)),
    column!("min_speed_mps", Number, |row| traffic(row, |of| of.min_speed_mps)),
    column!("max_speed_mps", Number, |row| traffic(row, |of| of.max_speed_mps)),
    column!("off_road_m", Number, |row| traffic(row, |of| of.off_road_m)),
    column!("leaves_road", Flag, |row| traffic(row, |of| of.leaves_road)),
    column!("speeding_mps", Number, |row| traffic(row, |of| of.speeding_mps).flatten()),
    column!("others_peak_braking_mps2", Number, |row| traffic(row, |of| of.others_peak_braking_mps2).flatten()),
    column!("others_hard_braking", Flag, |row| traffic(row, |of| of.others_hard_braking)),
    column!("plans", Count, |row| traffic(row, |of| of.plans)),
    column!("plans_failed", Count, |row| traffic(row, |of| of.plans_failed)),
    column!("plans_unfinished", Count, |row| traffic(row, |of| of.plans_unfinished)),
    column!("others_plans_failed", Count, |row| traffic(row, |of| of.others_plans_failed)),
    column!("controller", Text, |row| building(row, |of| of.controller.clone())),
    column!("days", Count, |row| building(row, |of| of.days)),
    column!("energy_kwh", Number, |row| building(row, |of| of.energy_kwh)),
    column!("electricity_kwh", Number, |row| building(row, |of| of.electricity_kwh)),
    column!("bill", Number, |row| building(row, |of| of.bill).flatten()),
    column!("currency", Text, |row| building(row, |of| of.currency.clone()).flatten()),
    column!("discomfort_k_h", Number, |row| building(row, |of| of.discomfort_k_h)),
    column!("last_cost", Number, |row| building(row, |of| of.last_cost)),
    column!("wall_s", Number, |row: &SweepRow| Some(row.wall_s)),
    column!("plan_median_ms", Number, |row: &SweepRow| row.plan_median_ms),
    column!("plan_p99_ms", Number, |row: &SweepRow| row.plan_p99_ms),
];

/// The value of what varies; numbers in a column of numbers, everything else as a text.
pub(crate) fn input(row: &SweepRow, path: &str, kind: ColumnKind) -> Cell {
    let value = row.inputs.get(path);
    match kind {
        ColumnKind::Number => Cell::Number(value.and_then(Json::as_f64)),
        ColumnKind::Flag => Cell::Flag(value.and_then(Json::as_bool)),
        ColumnKind::Count => Cell::Count(value.and_then(Json::as_u64)),
        ColumnKind::Text => Cell::Text(value.map(|value| match value {
            Json::String(text) => text.clone(),
            other => other.to_string(),
        })),
    }
}
