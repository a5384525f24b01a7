//! The outcome of a run, as plain values.

use interplay_planners::State;
use interplay_scenarios::{Scenario, readable};
use serde::{Serialize, Serializer};
use serde_json::{Value, json};

use super::building::BuildingReport;
use crate::measure::{Deadlock, HeldBelief, MetricValues, Passage, PhaseDigests, Travel, VehicleMeasures, Wait};
use crate::state::frame::{BrokenRule, Collision};

/// The outcome of one run; its serialisation is the output contract of `--json`. It omits keys about vehicles if there
/// are none, and `building` without a building.
#[derive(Clone, Debug, Serialize)]
#[serde(remote = "Report")]
pub struct Report {
    /// Name of the scenario.
    pub scenario: String,
    /// Whether every expectation held, those of counterfactuals included.
    pub passed: bool,
    /// The seed of the run.
    pub seed: u64,
    /// Settings of the scenario and its files that are allowed but may be unintended, in words.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub remarks: Vec<String>,
    /// Simulated time \[s\].
    pub simulated_s: f64,
    /// Time at which the run ended before the scenario was over \[s\]; expectations are then judged by the events until then.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ended_early_s: Option<f64>,
    /// Wall time \[s\]; not reproducible.
    pub wall_s: f64,
    /// Digest of all states, bit for bit.
    pub digest: String,
    /// Digests of the results of each phase.
    pub phase_digests: PhaseDigests,
    /// Contacts.
    pub collisions: Vec<Collision>,
    /// The metrics of the run; none without vehicles.
    #[serde(flatten)]
    pub metrics: MetricValues,
    /// Which vehicle went first in each zone where the routes of two vehicles cross or merge and that one of them entered.
    pub right_of_way: Vec<Passage>,
    /// The rules of the road that vehicles broke, with times and places.
    pub broken_rules: Vec<BrokenRule>,
    /// The deadlocks, with the times at which they were detected.
    pub deadlocks: Vec<Deadlock>,
    /// Names from the front of the road to its rear, at the end; at an intersection, in the order of crossing.
    pub order: Vec<String>,
    /// Every vehicle, in the scenario's order.
    pub vehicles: Vec<VehicleReport>,
    /// The building.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub building: Option<BuildingReport>,
    /// Its expectations.
    pub expectations: Vec<Expectation>,
    /// The counterfactual runs; none before they are judged.
    pub counterfactuals: Vec<CounterfactualReport>,
}

/// The outcome of one counterfactual.
#[derive(Clone, Debug, Serialize)]
pub struct CounterfactualReport {
    /// Its claim.
    pub name: String,
    /// Whether all its expectations held.
    pub passed: bool,
    /// Names from first to last, as in [`Report::order`].
    pub order: Vec<String>,
    /// Its expectations.
    pub expectations: Vec<Expectation>,
    /// Digest of all states, bit for bit.
    pub digest: String,
    /// The run itself.
    #[serde(skip)]
    pub run: Box<Report>,
}

const VEHICLE_KEYS: [&str; 7] =
    ["phase_digests", "collisions", "right_of_way", "broken_rules", "deadlocks", "order", "vehicles"];

impl Serialize for Report {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if !self.vehicles.is_empty() {
            return Report::serialize(self, serializer);
        }
        let mut whole = Report::serialize(self, serde_json::value::Serializer).map_err(serde::ser::Error::custom)?;
        if let Some(object) = whole.as_object_mut() {
            object.retain(|key, _| !VEHICLE_KEYS.contains(&key.as_str()));
        }
        whole.serialize(serializer)
    }
}

/// The outcome for one vehicle.
#[derive(Clone, Debug, Serialize)]
pub struct VehicleReport {
    /// Its name.
    pub name: String,
    /// The kind of its driver.
    pub driver: String,
    /// The flow of which it came; `None` if the scenario states it by itself.
    #[serde(skip)]
    pub flow: Option<String>,
    /// Whether it follows a record.
    #[serde(skip)]
    pub follows_record: bool,
    /// Whether it is the ego.
    #[serde(skip)]
    pub is_ego: bool,
    /// When it reached its goal \[s\].
    pub completed_s: Option<f64>,
    /// Whether it started away from its goal.
    #[serde(skip)]
    pub has_task: bool,
    /// Whether it is an obstacle without a driver.
    #[serde(skip)]
    pub is_obstacle: bool,
    /// Whether it keeps all rules of the road.
    #[serde(skip)]
    pub keeps_rules: bool,
    /// Ratio of its lengths to those of a real car.
    #[serde(skip)]
    pub scale: f64,
    /// How it travelled.
    #[serde(skip)]
    pub travel: Travel,
    /// Its last state.
    #[serde(rename = "final")]
    pub last: State,
    /// Its metrics, and as `peak_times_s` the times of those that are peaks.
    #[serde(flatten)]
    pub metrics: MetricValues,
    /// The reasons for which it stood although it wanted to drive, with durations.
    pub standing: Vec<Wait>,
    /// Its planner.
    pub plans: PlansReport,
    /// Its beliefs about the others at its last plan, if it infers their plans.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub beliefs: Vec<BeliefReport>,
}

/// Measures of a planner. Times are wall times and not reproducible.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct PlansReport {
    /// Plans made.
    pub count: usize,
    /// Plans that failed and were replaced by a fallback.
    pub failed: usize,
    /// Plans that are not optimal because the optimiser reached its iteration limit: they violate nothing, or are cheaper and at
    /// least as safe as continuing the plan before.
    pub unfinished: usize,
    /// Plans that were driven although they violate a constraint: by a certificate of each plan, they touch another vehicle later on, where
    /// the planner relies on its proposal or on its next plans. A plan that gives up the last fallback is refused, and counts as
    /// failed.
    pub violating: usize,
    /// Plans that exceeded the time budget of `real_time`, by the clock; none without it, and for drivers that model people.
    pub over_budget: Option<usize>,
    /// Median time \[ms\].
    pub median_ms: f64,
    /// 99th percentile \[ms\].
    pub p99_ms: f64,
}

impl Report {
    /// Smallest distance of the ego's footprint to another; `None` without others \[m\].
    pub fn min_gap_m(&self) -> Option<f64> {
        self.metrics.number("ego_gap_m")
    }

    /// Names from first to last, without obstacles.
    pub fn order_of_driven(&self) -> Vec<&str> {
        let is_driven = |name: &&str| self.vehicle(name).is_none_or(|vehicle| !vehicle.is_obstacle);
        self.order.iter().map(String::as_str).filter(is_driven).collect()
    }

    /// The outcome for the vehicle of that name.
    pub fn vehicle(&self, name: &str) -> Option<&VehicleReport> {
        self.vehicles.iter().find(|vehicle| vehicle.name == name)
    }
}

impl CounterfactualReport {
    /// The expectations that did not hold.
    pub fn failed(&self) -> impl Iterator<Item = &Expectation> {
        self.expectations.iter().filter(|expectation| !expectation.passed)
    }
}

impl VehicleReport {
    /// The lowest and the highest speed of the vehicle \[m/s\].
    pub fn speed_range_mps(&self) -> [f64; 2] {
        ["min_speed_mps", "max_speed_mps"].map(|name| self.metrics.number(name).unwrap_or(self.last.speed_mps))
    }

    /// Builds the outcome from the measures.
    pub(super) fn new(scenario: &Scenario, index: usize, measured: &VehicleMeasures, standing: Vec<Wait>) -> Self {
        let vehicle = &scenario.vehicles[index];
        VehicleReport {
            name: vehicle.name.clone(),
            flow: scenario.flows.of(&vehicle.name).map(str::to_owned),
            follows_record: vehicle.driver.record().is_some(),
            is_ego: index == scenario.ego_index(),
            driver: vehicle.driver.kind().to_owned(),
            is_obstacle: vehicle.obstacle.is_some(),
            keeps_rules: vehicle.keeps_rules(),
            scale: vehicle.body.real_ratio(),
            completed_s: measured.completion.completed_s,
            has_task: measured.completion.has_task(),
            travel: measured.travel,
            last: measured.last,
            metrics: measured.metrics.values(),
            standing,
            plans: PlansReport {
                count: measured.planning.count(),
                failed: measured.planning.failed,
                unfinished: measured.planning.unfinished,
                violating: measured.planning.violating,
                over_budget: measured.planning.over_budget(),
                median_ms: measured.planning.quantile_ms(0.5),
                p99_ms: measured.planning.quantile_ms(0.99),
            },
            beliefs: measured.beliefs.held().map(BeliefReport::new).collect(),
        }
    }
}

/// The final belief of a driver about another one.
#[derive(Clone, Debug, Serialize)]
pub struct BeliefReport {
    /// The name of the other vehicle.
    pub about: String,
    /// The most probable kind of driver, whose plan was the prediction.
    pub taken_for: String,
    /// The probability of that kind.
    pub probability: f64,
    /// The smallest set of kinds that contains the driver with a probability of at least 0.9, the most probable first.
    pub may_be: Vec<&'static str>,
    /// The probability of this set.
    pub may_be_probability: f64,
    /// Time since when the driver had been classified as that kind \[s\].
    pub since_s: f64,
    /// Mean of the safety weight, if it is a human.
    pub safety_weight: f64,
    /// Interval that holds the safety weight with a probability of at least 0.9, if it is a human.
    pub safety_weight_interval: [f64; 2],
    /// Entropy of the probabilities of the kinds of driver \[nat\].
    pub entropy: f64,
}

impl BeliefReport {
    pub(super) fn new(held: &HeldBelief) -> Self {
        let HeldBelief { estimate, since_s } = held;
        let credible = estimate.credible_models();
        BeliefReport {
            about: estimate.vehicle.clone(),
            taken_for: estimate.model.name().to_owned(),
            probability: estimate.probability(estimate.model),
            may_be: credible.iter().map(|model| model.name()).collect(),
            may_be_probability: credible.iter().map(|model| estimate.probability(*model)).sum(),
            since_s: *since_s,
            safety_weight: estimate.safety_weight,
            safety_weight_interval: estimate.safety_weight_interval,
            entropy: estimate.entropy,
        }
    }
}

/// One expectation and its outcome.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Expectation {
    /// The key in the scenario file, with the vehicle where there is one.
    pub what: String,
    /// What was expected.
    pub want: Value,
    /// The actual value.
    pub got: Value,
    /// Whether it held.
    pub passed: bool,
    /// Day or zone of the worst value, if it concerns several; the contacts, if there were to be none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<String>,
}

impl Expectation {
    pub(super) fn new(what: impl Into<String>, want: Value, got: Value, passed: bool) -> Self {
        Expectation { what: what.into(), want, got, passed, at: None }
    }

    /// The expected and the actual value, with numbers rounded for a reader.
    pub fn shown(&self) -> [Value; 2] {
        [rounded(&self.want, None), rounded(&self.got, self.want.as_f64())]
    }
}

/// The value with numbers rounded for a reader. A number that rounding would make equal to the bound keeps its digits.
fn rounded(value: &Value, bound: Option<f64>) -> Value {
    match value {
        Value::Number(number) if number.is_f64() => {
            let exact = number.as_f64().unwrap_or_default();
            let short = readable(exact);
            json!(if bound == Some(short) { exact } else { short })
        }
        Value::Array(items) => items.iter().map(|item| rounded(item, bound)).collect(),
        Value::Object(table) => {
            Value::Object(table.iter().map(|(key, item)| (key.clone(), rounded(item, bound))).collect())
        }
        other => other.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(want: Value, got: Value) -> [Value; 2] {
        Expectation { what: "gap".to_owned(), want, got, passed: false, at: None }.shown()
    }

    #[test]
    fn numbers_are_rounded_unless_rounding_hides_the_failure() {
        let gap = json!({ "m": 2.288_119_792_938_232_4, "time_s": 16.601_957_716, "between": ["a", "b"] });
        let short = json!({ "m": 2.288, "time_s": 16.6, "between": ["a", "b"] });
        assert_eq!(shown(json!(0.5), gap)[1], short);
        assert_eq!(shown(json!(0.5), json!(0.499_999_987_654)), [json!(0.5), json!(0.499_999_987_654)]);
    }
}
