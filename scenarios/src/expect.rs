//! What makes a run pass. Each key that is present is one expectation; what is absent is not judged.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The expectations of a scenario.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Expect {
    /// Whether nobody may touch anybody (`true`), or a collision must happen (`false`).
    pub no_collision: Option<bool>,
    /// Who collides with whom, as pairs of names: these and nobody else. Not together with `no_collision`.
    pub collisions: Option<Vec<[String; 2]>>,
    /// The vehicles from first to last: along the road at the end of the run, or through the conflict zone of an
    /// intersection. Those left out are not judged.
    pub order: Option<Vec<String>>,
    /// The footprint of the ego never comes nearer to another than this \[m\].
    #[schemars(extend("minimum" = 0.0))]
    pub min_gap_m: Option<f64>,
    /// At most so many plans fail, all vehicles together.
    pub plan_failures_at_most: Option<usize>,
    /// Vehicles that must reach their goal, one `[[expect.completes]]` each.
    pub completes: Vec<Completes>,
    /// Bounds on the extremes of speeds over the run, one `[[expect.speed]]` each.
    pub speed: Vec<SpeedRange>,
    /// What the building must achieve.
    pub building: Option<BuildingExpect>,
}

/// Bounds on the key figures of a building. Each is judged on every day after `after_iterations`: the worst one counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BuildingExpect {
    /// How many days are left out at the start, while a controller learns.
    pub after_iterations: usize,
    /// Whether the cost never rises from one of these days to the next.
    pub cost_never_rises: Option<bool>,
    /// Every cost is at most this share of the first day's.
    #[schemars(extend("minimum" = 0.0))]
    pub cost_at_most_share_of_first: Option<f64>,
    /// Root of the mean squared error while occupied \[K\].
    #[schemars(extend("minimum" = 0.0))]
    pub tracking_rmse_c_at_most: Option<f64>,
    /// Deviation beyond the comfort band while occupied \[K·h per zone and day\].
    #[schemars(extend("minimum" = 0.0))]
    pub discomfort_k_h_at_most: Option<f64>,
    /// Heat brought in and taken out \[kWh a day\].
    #[schemars(extend("minimum" = 0.0))]
    pub energy_kwh_at_most: Option<f64>,
    /// Largest excess of a requested input over its limit \[kW\].
    #[schemars(extend("minimum" = 0.0))]
    pub input_violation_kw_at_most: Option<f64>,
    /// How much dearer a day is than the cheapest one that knows everything beforehand.
    #[schemars(extend("minimum" = 0.0))]
    pub regret_at_most: Option<f64>,
    /// Heat brought in and taken out before the first occupied time of the day: the controller acts ahead \[kWh\].
    #[schemars(extend("minimum" = 0.0))]
    pub early_kwh_at_least: Option<f64>,
    /// Spectral radius of the controller, where it has one.
    #[schemars(extend("minimum" = 0.0))]
    pub spectral_radius_at_most: Option<f64>,
    /// On how many of these days the controller may have no plan of its own, all together.
    pub fallbacks_at_most: Option<usize>,
    /// Whether the cost of the common plan never rises from one round of messages to the next.
    pub exchange_never_rises: Option<bool>,
    /// By which share the zones' common plan is dearer than the centralised one; with `compare = true` of a distributed
    /// controller.
    #[schemars(extend("minimum" = 0.0))]
    pub above_centralised_at_most: Option<f64>,
}

/// A vehicle reaches its goal (its lane, or the far side of an intersection), within a window of time if one is stated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Completes {
    /// Name of the vehicle.
    pub vehicle: String,
    /// Not before this time \[s\].
    #[serde(default)]
    #[schemars(extend("minimum" = 0.0))]
    pub after_s: Option<f64>,
    /// Not after this time \[s\].
    #[serde(default)]
    #[schemars(extend("minimum" = 0.0))]
    pub before_s: Option<f64>,
}

/// Bounds on the smallest and the largest speed of a vehicle over the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpeedRange {
    /// Name of the vehicle.
    pub vehicle: String,
    /// Its smallest speed is below this: it did slow down \[m/s\].
    #[serde(default)]
    pub min_below_mps: Option<f64>,
    /// Its smallest speed is above this: it did not slow down further \[m/s\].
    #[serde(default)]
    pub min_above_mps: Option<f64>,
    /// Its largest speed is below this: it did not go faster \[m/s\].
    #[serde(default)]
    pub max_below_mps: Option<f64>,
    /// Its largest speed is above this: it did go faster \[m/s\].
    #[serde(default)]
    pub max_above_mps: Option<f64>,
}
