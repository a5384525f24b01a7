//! The conditions under which a run passes. Each key that is present is one expectation; an absent key is not judged.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

/// The expectations of a scenario.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Expect {
    /// Whether no two vehicles may touch (`true`), or some must (`false`).
    #[schemars(example = true, extend("x-concerns" = "vehicles"))]
    pub no_collision: Option<bool>,
    /// The pairs of vehicles that must collide; no others may.
    #[schemars(example = vec![["ego", "front"]], extend("x-excludes" = ["no_collision"]), extend("x-concerns" = "vehicles"))]
    pub collisions: Option<Vec<[String; 2]>>,
    /// The vehicles from first to last: along the road at the end of the run, or through the conflict zone of an
    /// intersection. Those left out are not judged.
    #[schemars(example = vec!["ego", "front"], extend("x-concerns" = "vehicles"))]
    pub order: Option<Vec<String>>,
    /// The smallest gap allowed between the footprint of the ego and any other \[m\].
    #[schemars(range(min = 0.0), example = 0.05, extend("x-concerns" = "vehicles"))]
    pub min_gap_m: Option<f64>,
    /// The smallest gap allowed between the footprints of any two vehicles \[m\].
    #[schemars(range(min = 0.0), example = 0.05, extend("x-concerns" = "vehicles"))]
    pub gap_at_least_m: Option<f64>,
    /// The shortest time allowed until any two footprints would touch if both vehicles kept their present velocities \[s\].
    #[schemars(range(min = 0.0, max = 100.0), example = 0.5, extend("x-concerns" = "vehicles"))]
    pub time_to_collision_at_least_s: Option<f64>,
    /// The largest distance by which a corner of any vehicle may be beyond an edge of its road \[m\].
    #[schemars(range(min = 0.0), example = 0.01, extend("x-concerns" = "vehicles"))]
    pub off_road_at_most_m: Option<f64>,
    /// The largest speed above the limit of its lane that any vehicle may have \[m/s\].
    #[schemars(range(min = 0.0), example = 0.5, extend("x-concerns" = "vehicles"))]
    pub speed_limit_exceeded_by_at_most_mps: Option<f64>,
    /// Whether no vehicle that keeps the rules of the road may break one (`true`), or some must (`false`).
    #[schemars(example = true, extend("x-concerns" = "vehicles"))]
    pub rules_kept: Option<bool>,
    /// The largest number of failed plans, over all vehicles.
    #[schemars(example = 0, extend("x-concerns" = "vehicles"))]
    pub plan_failures_at_most: Option<usize>,
    /// Vehicles that must reach their goal, one `[[expect.completes]]` each.
    #[schemars(extend("x-concerns" = "vehicles"))]
    pub completes: Vec<Completes>,
    /// Bounds on the extremes of speeds over the run, one `[[expect.speed]]` each.
    #[schemars(extend("x-concerns" = "vehicles"))]
    pub speed: Vec<ExpectedSpeed>,
    /// Bounds on the peaks of accelerations and jerk, one `[[expect.comfort]]` each.
    #[schemars(extend("x-concerns" = "vehicles"))]
    pub comfort: Vec<ExpectedComfort>,
    /// Vehicles that let another one go first where their routes cross or merge, one `[[expect.yields]]` each.
    #[schemars(extend("x-concerns" = "vehicles"))]
    pub yields: Vec<ExpectedYield>,
    /// Bounds on any metric of the run or of vehicles, one `[[expect.metric]]` each.
    #[serde(rename = "metric")]
    #[schemars(extend("x-concerns" = "vehicles"))]
    pub metrics: Vec<ExpectedMetric>,
    /// The expectations of the building.
    #[schemars(example = json!({ "after_iterations": 2 }), extend("x-concerns" = "building"))]
    pub building: Option<BuildingExpect>,
    /// The expectations of a zone, one `[[expect.zone]]` each.
    #[serde(rename = "zone")]
    #[schemars(extend("x-concerns" = "building"))]
    pub zones: Vec<ExpectedZone>,
}

/// The expectations of a counterfactual: those that a scenario may state, and comparisons with the scenario's own run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct CounterfactualExpect {
    /// Whether the vehicles are in another order than in the scenario's own run (`true`), or in the same (`false`).
    #[schemars(example = true, extend("x-concerns" = "vehicles"))]
    pub order_differs: Option<bool>,
    /// Vehicles that reach their goal later than in the scenario's own run, or never.
    #[schemars(example = json!([{ "vehicle": "ego", "by_s": 0.3 }]), extend("x-concerns" = "vehicles"))]
    pub later: Vec<CompletionShift>,
    /// Vehicles that reach their goal earlier than in the scenario's own run.
    #[schemars(example = json!([{ "vehicle": "front", "by_s": 0.3 }]), extend("x-concerns" = "vehicles"))]
    pub earlier: Vec<CompletionShift>,
    /// The expectations of the scenario that fail in this run, and no others: keys of its `[expect]`, those about a vehicle
    /// with its name.
    #[schemars(example = vec!["order", "completes.ego"])]
    pub breaks: Option<Vec<String>>,
    /// The keys of the scenario's own `[expect]`.
    #[serde(flatten)]
    pub plain: Expect,
}

/// A vehicle reaches its goal at another time than in the scenario's own run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CompletionShift {
    /// Name of the vehicle.
    #[schemars(example = &"ego")]
    pub vehicle: String,
    /// The least difference between both times \[s\].
    #[schemars(range(min = 0.001), example = 0.3)]
    pub by_s: f64,
}

/// Bounds on the key figures of a building. Each is judged on every day after `after_iterations`: the worst one counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BuildingExpect {
    /// The number of days at the start that are not judged, while a controller learns.
    pub after_iterations: usize,
    /// Whether the cost never rises from one of these days to the next.
    #[schemars(example = true)]
    pub cost_never_rises: Option<bool>,
    /// Every cost is at most this share of the first day's.
    #[schemars(range(min = 0.0), example = 0.5, extend("x-unit" = "dimensionless"))]
    pub cost_at_most_share_of_first: Option<f64>,
    /// Root of the mean squared error while occupied \[K\].
    #[schemars(range(min = 0.0), example = 0.6, extend("x-unit" = "K"))]
    pub tracking_rmse_c_at_most: Option<f64>,
    /// Deviation beyond the comfort band while occupied \[K·h per zone and day\].
    #[schemars(range(min = 0.0), example = 1.2, extend("x-unit" = "K·h per zone and day"))]
    pub discomfort_k_h_at_most: Option<f64>,
    /// Heat brought in and taken out \[kWh a day\].
    #[schemars(range(min = 0.0), example = 32.0, extend("x-unit" = "kWh a day"))]
    pub energy_kwh_at_most: Option<f64>,
    /// Electricity for this heat \[kWh a day\].
    #[schemars(range(min = 0.0), example = 11.0, extend("x-unit" = "kWh a day"))]
    pub electricity_kwh_at_most: Option<f64>,
    /// Cost of the electricity \[currency a day\]; with a `[tariff]`.
    #[schemars(example = 4.0, extend("x-unit" = "currency a day"))]
    pub energy_cost_at_most: Option<f64>,
    /// Cost of the electricity of all these days together \[currency\]; with a `[tariff]`.
    #[schemars(example = 25.0, extend("x-unit" = "currency"))]
    pub total_energy_cost_at_most: Option<f64>,
    /// Largest excess of a requested input over its limit \[kW\].
    #[schemars(range(min = 0.0), example = 0.0)]
    pub input_violation_kw_at_most: Option<f64>,
    /// The cost of a day above that of its optimum with perfect knowledge; for buildings of at most 500 zones times steps a day.
    #[schemars(range(min = 0.0), example = 30.0, extend("x-unit" = "dimensionless"))]
    pub regret_at_most: Option<f64>,
    /// Heat brought in and taken out before the first occupied time of the day: the controller acts ahead \[kWh\].
    #[schemars(range(min = 0.0), example = 1.0)]
    pub early_kwh_at_least: Option<f64>,
    /// Spectral radius of the controller, where it has one.
    #[schemars(range(min = 0.0), example = 0.9, extend("x-unit" = "dimensionless"))]
    pub spectral_radius_at_most: Option<f64>,
    /// The number of these days on which the controller may fall back on the plan of the day before.
    #[schemars(example = 0)]
    pub fallbacks_at_most: Option<usize>,
    /// Whether the cost of the common plan never rises from one round of messages to the next.
    #[schemars(example = true)]
    pub exchange_never_rises: Option<bool>,
    /// Relative cost of the zones' common plan above that of the centralised one; with `compare = true` of a distributed
    /// controller.
    #[schemars(range(min = 0.0), example = 0.01, extend("x-unit" = "dimensionless"))]
    pub above_centralised_at_most: Option<f64>,
}

/// Bounds on the key figures of a zone. Each is judged on every day after `after_iterations` of `[expect.building]`: the worst
/// one counts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExpectedZone {
    /// Name of the zone.
    #[schemars(example = &"office")]
    pub zone: String,
    /// Root of the mean squared error while occupied \[K\].
    #[serde(default)]
    #[schemars(range(min = 0.0), example = 0.6, extend("x-unit" = "K"))]
    pub tracking_rmse_c_at_most: Option<f64>,
    /// Deviation beyond the comfort band while occupied \[K·h a day\].
    #[serde(default)]
    #[schemars(range(min = 0.0), example = 1.2, extend("x-unit" = "K·h a day"))]
    pub discomfort_k_h_at_most: Option<f64>,
    /// Heat brought in and taken out \[kWh a day\].
    #[serde(default)]
    #[schemars(range(min = 0.0), example = 8.0, extend("x-unit" = "kWh a day"))]
    pub energy_kwh_at_most: Option<f64>,
    /// Cost of the electricity for this heat \[currency a day\]; with a `[tariff]`.
    #[serde(default)]
    #[schemars(example = 1.0, extend("x-unit" = "currency a day"))]
    pub energy_cost_at_most: Option<f64>,
}

impl ExpectedZone {
    /// Every bound by its key.
    pub fn bounds(&self) -> [(&'static str, Option<f64>); 4] {
        [
            ("tracking_rmse_c_at_most", self.tracking_rmse_c_at_most),
            ("discomfort_k_h_at_most", self.discomfort_k_h_at_most),
            ("energy_kwh_at_most", self.energy_kwh_at_most),
            ("energy_cost_at_most", self.energy_cost_at_most),
        ]
    }
}

/// A vehicle reaches its goal (its lane, or the far side of an intersection), within a window of time if one is stated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Completes {
    /// Name of the vehicle.
    #[schemars(example = &"ego")]
    pub vehicle: String,
    /// The earliest time allowed \[s\].
    #[serde(default)]
    #[schemars(range(min = 0.0), example = 1.0)]
    pub after_s: Option<f64>,
    /// The latest time allowed \[s\].
    #[serde(default)]
    #[schemars(range(min = 0.0), example = 6.0)]
    pub before_s: Option<f64>,
}

/// Bounds on the smallest and the largest speed of a vehicle over the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExpectedSpeed {
    /// Name of the vehicle.
    #[schemars(example = &"ego")]
    pub vehicle: String,
    /// Its smallest speed must be below this: it slowed down \[m/s\].
    #[serde(default)]
    #[schemars(example = 0.8)]
    pub min_below_mps: Option<f64>,
    /// Its smallest speed must be above this: it did not slow down further \[m/s\].
    #[serde(default)]
    #[schemars(example = 0.2)]
    pub min_above_mps: Option<f64>,
    /// Its largest speed must be below this: it did not go faster \[m/s\].
    #[serde(default)]
    #[schemars(example = 1.4)]
    pub max_below_mps: Option<f64>,
    /// Its largest speed must be above this: it went faster \[m/s\].
    #[serde(default)]
    #[schemars(example = 1.1)]
    pub max_above_mps: Option<f64>,
}

/// Bounds on the peaks of the accelerations and of the jerk of a vehicle over the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExpectedComfort {
    /// Name of the vehicle.
    #[schemars(example = &"ego")]
    pub vehicle: String,
    /// The largest magnitude of its acceleration along its heading, when it speeds up and when it brakes \[m/s²\].
    #[serde(default)]
    #[schemars(range(min = 0.0), example = 2.0)]
    pub acceleration_at_most_mps2: Option<f64>,
    /// The largest deceleration along its heading \[m/s²\].
    #[serde(default)]
    #[schemars(range(min = 0.0), example = 1.5)]
    pub braking_at_most_mps2: Option<f64>,
    /// The largest magnitude of its jerk, the change of acceleration from one tick to the next over a tick \[m/s³\].
    #[serde(default)]
    #[schemars(range(min = 0.0), example = 10.0)]
    pub jerk_at_most_mps3: Option<f64>,
    /// The largest magnitude of its lateral acceleration, speed times yaw rate \[m/s²\].
    #[serde(default)]
    #[schemars(range(min = 0.0), example = 1.5)]
    pub lateral_acceleration_at_most_mps2: Option<f64>,
}

/// Bounds on a metric: of the run, of a vehicle, or of all vehicles. A metric without a value satisfies its bounds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExpectedMetric {
    /// Name of the metric, as in reports; the reference lists all.
    #[schemars(example = &"peak_braking_mps2")]
    pub name: String,
    /// Name of the vehicle, for a metric of vehicles; without it, the bounds hold for every vehicle.
    #[serde(default)]
    #[schemars(example = &"ego")]
    pub vehicle: Option<String>,
    /// The largest value allowed, in the unit of the metric.
    #[serde(default)]
    #[schemars(example = 2.0, extend("x-unit" = "that of the metric"))]
    pub at_most: Option<f64>,
    /// The smallest value allowed, in the unit of the metric.
    #[serde(default)]
    #[schemars(example = 0.5, extend("x-unit" = "that of the metric"))]
    pub at_least: Option<f64>,
    /// The value of a flag.
    #[serde(default)]
    #[schemars(example = true)]
    pub is: Option<bool>,
}

/// A vehicle lets another one go first where their routes cross or merge: the other one enters the conflict zone first. If the vehicle
/// keeps the rules of the road, it must have slowed down for that, or left a gap of at least 1 s at full size between them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExpectedYield {
    /// Name of the vehicle that waits.
    #[schemars(example = &"ego")]
    pub vehicle: String,
    /// Name of the vehicle that goes first.
    #[schemars(example = &"human")]
    pub to: String,
}
