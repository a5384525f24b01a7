//! The names of a scenario's expectations in reports.

use std::collections::BTreeSet;

use serde_json::Value as Json;

use crate::model::expectations::expect::Expect;
use crate::model::expectations::metric_bound::MetricBound;

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
