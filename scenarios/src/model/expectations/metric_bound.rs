//! The expectations that bound a metric, from all keys that state them.

use std::collections::BTreeSet;

use serde_json::{Value as Json, json};

use crate::model::expectations::expect::{Expect, ExpectedComfort, ExpectedMetric, ExpectedSpeed};

/// A bound on a metric.
#[derive(Clone, Debug, PartialEq)]
pub struct MetricBound<'a> {
    /// Its name in reports.
    pub what: String,
    /// The name of the metric.
    pub metric: &'a str,
    /// The vehicle that it bounds; without one, the run, or every vehicle.
    pub vehicle: Option<&'a str>,
    /// The allowed values.
    pub limit: MetricLimit,
}

/// The allowed values of a metric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MetricLimit {
    /// At most this.
    AtMost(f64),
    /// At least this.
    AtLeast(f64),
    /// Below this.
    Below(f64),
    /// Above this.
    Above(f64),
    /// Exactly this, for a flag.
    Is(bool),
}

impl MetricLimit {
    /// Whether a value is allowed; flags are 0 and 1.
    pub fn admits(self, value: f64) -> bool {
        match self {
            MetricLimit::AtMost(most) => value <= most,
            MetricLimit::AtLeast(least) => value >= least,
            MetricLimit::Below(bound) => value < bound,
            MetricLimit::Above(bound) => value > bound,
            MetricLimit::Is(flag) => (value != 0.0) == flag,
        }
    }

    /// The excess of a value over the limit; negative if the value is allowed.
    pub fn excess(self, value: f64) -> f64 {
        match self {
            MetricLimit::AtMost(bound) | MetricLimit::Below(bound) => value - bound,
            MetricLimit::AtLeast(bound) | MetricLimit::Above(bound) => bound - value,
            MetricLimit::Is(flag) => (value - f64::from(flag)).abs(),
        }
    }

    /// The stated number or flag.
    pub fn to_json(self) -> Json {
        match self {
            MetricLimit::AtMost(bound)
            | MetricLimit::AtLeast(bound)
            | MetricLimit::Below(bound)
            | MetricLimit::Above(bound) => json!(bound),
            MetricLimit::Is(flag) => json!(flag),
        }
    }
}

/// A key that bounds a metric: its name, its value if stated, the metric, and the meaning of the value.
pub(crate) type MetricBoundKey = (&'static str, Option<f64>, &'static str, fn(f64) -> MetricLimit);

fn stated_bounds<'a>(
    vehicle: Option<&'a str>,
    bounds: &[MetricBoundKey],
    what: impl Fn(&str) -> String,
) -> Vec<MetricBound<'a>> {
    let stated = bounds.iter().filter_map(|(key, value, metric, limit)| {
        Some(MetricBound { what: what(key), metric, vehicle, limit: limit((*value)?) })
    });
    stated.collect()
}

impl Expect {
    /// The bounds on metrics that hold for the run or for all of its vehicles; that on the gap of the ego is the first.
    pub fn bounds_of_all(&self) -> Vec<MetricBound<'static>> {
        use MetricLimit::{AtLeast, AtMost};
        let bounds: [MetricBoundKey; 5] = [
            ("min_gap_m", self.min_gap_m, "ego_gap_m", AtLeast),
            ("gap_at_least_m", self.gap_at_least_m, "smallest_gap_m", AtLeast),
            ("time_to_collision_at_least_s", self.time_to_collision_at_least_s, "time_to_collision_s", AtLeast),
            ("off_road_at_most_m", self.off_road_at_most_m, "off_road_m", AtMost),
            ("speed_limit_exceeded_by_at_most_mps", self.speed_limit_exceeded_by_at_most_mps, "speeding_mps", AtMost),
        ];
        stated_bounds(None, &bounds, str::to_owned)
    }

    /// The bounds of `[[expect.speed]]` and `[[expect.comfort]]`.
    pub fn bounds_of_vehicles(&self) -> Vec<MetricBound<'_>> {
        let speed = self.speed.iter().map(|one| ("speed", one.vehicle.as_str(), one.bounds()));
        let comfort = self.comfort.iter().map(|one| ("comfort", one.vehicle.as_str(), one.bounds()));
        let all = speed.chain(comfort);
        all.flat_map(|(list, vehicle, bounds)| {
            stated_bounds(Some(vehicle), &bounds, |key| format!("{list}.{vehicle}.{key}"))
        })
        .collect()
    }

    /// The bounds of `[[expect.metric]]`.
    pub fn bounds_of_metrics<'a>(&'a self) -> Vec<MetricBound<'a>> {
        let of_one = |one: &'a ExpectedMetric| {
            let ExpectedMetric { name, vehicle, at_most, at_least, is } = one;
            let limits = [
                at_most.map(|most| ("at_most", MetricLimit::AtMost(most))),
                at_least.map(|least| ("at_least", MetricLimit::AtLeast(least))),
                is.map(|is| ("is", MetricLimit::Is(is))),
            ];
            let of_whom = vehicle.as_ref().map_or_else(String::new, |vehicle| format!(".{vehicle}"));
            limits.into_iter().flatten().map(move |(key, limit)| MetricBound {
                what: format!("metric.{name}{of_whom}.{key}"),
                metric: name,
                vehicle: vehicle.as_deref(),
                limit,
            })
        };
        self.metrics.iter().flat_map(of_one).collect()
    }
}

impl ExpectedSpeed {
    pub(crate) fn bounds(&self) -> [MetricBoundKey; 4] {
        use MetricLimit::{Above, Below};
        [
            ("min_below_mps", self.min_below_mps, "min_speed_mps", Below),
            ("min_above_mps", self.min_above_mps, "min_speed_mps", Above),
            ("max_below_mps", self.max_below_mps, "max_speed_mps", Below),
            ("max_above_mps", self.max_above_mps, "max_speed_mps", Above),
        ]
    }
}

impl ExpectedComfort {
    pub(crate) fn bounds(&self) -> [MetricBoundKey; 4] {
        use MetricLimit::AtMost;
        let lateral_mps2 = self.lateral_acceleration_at_most_mps2;
        [
            ("acceleration_at_most_mps2", self.acceleration_at_most_mps2, "peak_acceleration_mps2", AtMost),
            ("braking_at_most_mps2", self.braking_at_most_mps2, "peak_braking_mps2", AtMost),
            ("jerk_at_most_mps3", self.jerk_at_most_mps3, "peak_jerk_mps3", AtMost),
            ("lateral_acceleration_at_most_mps2", lateral_mps2, "peak_lateral_acceleration_mps2", AtMost),
        ]
    }
}

impl Expect {
    /// The names under which reports list these expectations, such as `order`, `completes.ego`, `speed.ego.max_above_mps`,
    /// `yields.ego.to.human`, `building.energy_kwh_at_most` and `zone.office.discomfort_k_h_at_most`; without repetition.
    pub fn names(&self) -> BTreeSet<String> {
        let bounds = self.bounds_of_vehicles().into_iter().chain(self.bounds_of_metrics());
        let mut names: BTreeSet<String> = bounds.map(|MetricBound { what, .. }| what).collect();
        let whole = serde_json::to_value(self).unwrap_or_default();
        for (key, value) in whole.as_object().into_iter().flatten().filter(|(_, value)| !value.is_null()) {
            match (key.as_str(), value) {
                ("completes", Json::Array(items)) => names.extend(items.iter().map(|item| named("completes", item))),
                ("yields", Json::Array(items)) => names.extend(items.iter().map(yield_name)),
                ("zone", Json::Array(items)) => {
                    let of = |item: &Json| format!("zone.{}", item["zone"].as_str().unwrap_or_default());
                    let bounds = items.iter().flat_map(|item| stated(item).map(move |key| (of(item), key)));
                    names.extend(bounds.filter(|(_, key)| key != "zone").map(|(name, key)| format!("{name}.{key}")));
                }
                ("speed" | "comfort" | "metric", _) => {}
                ("building", building) => {
                    let bounds = stated(building).filter(|key| key != "after_iterations");
                    names.extend(bounds.map(|key| format!("building.{key}")));
                }
                (key, _) => drop(names.insert(key.to_owned())),
            }
        }
        names
    }
}

/// The name of an expectation about a vehicle.
fn named(key: &str, item: &Json) -> String {
    format!("{key}.{}", item["vehicle"].as_str().unwrap_or_default())
}

/// The name of an expectation about the passing order of two vehicles.
fn yield_name(item: &Json) -> String {
    format!("{}.to.{}", named("yields", item), item["to"].as_str().unwrap_or_default())
}

/// The keys of a table that have a value.
fn stated(table: &Json) -> impl Iterator<Item = String> {
    let entries = table.as_object().into_iter().flatten();
    entries.filter(|(_, value)| !value.is_null()).map(|(key, _)| key.clone())
}
