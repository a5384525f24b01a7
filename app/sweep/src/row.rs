//! One run of a sweep as a row of plain values.

use std::collections::BTreeMap;

use interplay_scenarios::SweepPoint;
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;

use crate::key::RunKey;

/// One run. Only the last three values differ when it is made again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepRow {
    /// Digest of all that decides the result.
    pub key: RunKey,
    /// The version of the program.
    pub version: String,
    /// The scenario's name.
    pub scenario: String,
    /// The scenario's family.
    pub family: String,
    /// Who drives the other vehicles, as the plan names it.
    pub style: String,
    /// Who drives the ego, as the plan names it.
    pub planner: String,
    /// The sample: rows of one scenario, style and sample are a pair for two planners.
    pub sample: u64,
    /// The seed of the run.
    pub seed: u64,
    /// What varies, by its path.
    pub inputs: BTreeMap<String, Json>,
    /// Why there is no result.
    pub error: Option<String>,
    /// The result; none with an error.
    #[serde(default)]
    pub result: Option<RunResult>,
    /// Wall time of the run \[s\]; not reproducible.
    pub wall_s: f64,
    /// Median time of the ego's plans \[ms\]; not reproducible.
    pub plan_median_ms: Option<f64>,
    /// 99th percentile of the times of the ego's plans \[ms\]; not reproducible.
    pub plan_p99_ms: Option<f64>,
}

/// What a run amounts to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunResult {
    /// Digest of all states, bit for bit.
    pub digest: String,
    /// Simulated time \[s\].
    pub simulated_s: f64,
    /// Whether every expectation of the scenario held. They are about the drivers that its file states.
    pub passed: bool,
    /// What was measured of vehicles; none without any.
    pub traffic: Option<TrafficResult>,
    /// What was measured of a building; none without one.
    pub building: Option<BuildingResult>,
}

/// What a run amounts to for its vehicles.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TrafficResult {
    /// Whether the ego does its task without touching anybody; without a task, whether it touches nobody.
    pub success: bool,
    /// The kind of the ego's driver.
    pub driver: String,
    /// Whether the ego started elsewhere than at its goal.
    pub has_task: bool,
    /// When the ego reached its goal \[s\].
    pub completed_s: Option<f64>,
    /// Whether the ego has a task and never does it, though nobody touches anybody.
    pub deadlock: bool,
    /// How many others have a task.
    pub others_with_task: u64,
    /// How many of them did it.
    pub others_completed: u64,
    /// How many contacts there were.
    pub contacts: u64,
    /// Whether the ego was in any of them.
    pub ego_contact: bool,
    /// Whether in its first contact the ego moved towards the other at least as fast as the other towards it.
    pub contact_by_ego: bool,
    /// Whether the scenario's expectations of order and right of way hold and nobody touches anybody; none without such
    /// expectations. They are about the drivers that the file states.
    #[serde(default)]
    pub order_kept: Option<bool>,
    /// When the ego's first contact was \[s\].
    pub ego_contact_s: Option<f64>,
    /// The largest impulse of a contact \[N s\].
    pub impulse_ns: Option<f64>,
    /// Names from the front of the road to its rear, at the end; at an intersection, in the order of crossing.
    pub order: Vec<String>,
    /// The place of the ego, from 1: in the order, or on a network one more than the conflict zones in which another went first.
    pub ego_place: u64,
    /// In how many conflict zones another vehicle went before the ego.
    pub ego_yields: u64,
    /// In how many conflict zones the ego went before another vehicle.
    pub others_yield: u64,
    /// Smallest distance of the ego's footprint to another \[m\].
    pub ego_gap_m: Option<f64>,
    /// Smallest distance of any two footprints \[m\].
    pub smallest_gap_m: Option<f64>,
    /// Shortest time to collision of any two vehicles \[s\]; none if no two were on a collision course.
    pub time_to_collision_s: Option<f64>,
    /// Mean absolute acceleration of the ego \[m/s²\].
    pub mean_abs_acceleration: f64,
    /// Mean absolute jerk of the ego \[m/s³\].
    pub mean_abs_jerk: f64,
    /// Largest magnitude of the ego's acceleration \[m/s²\].
    pub peak_acceleration_mps2: f64,
    /// Largest deceleration of the ego \[m/s²\].
    pub peak_braking_mps2: f64,
    /// The same as a share of the strongest braking that the ego is capable of.
    #[serde(default)]
    pub peak_braking_share: f64,
    /// Whether the ego brakes hard: with at least 75 % of its strongest braking.
    #[serde(default)]
    pub hard_braking: bool,
    /// Largest magnitude of the ego's jerk \[m/s³\].
    pub peak_jerk_mps3: f64,
    /// Largest magnitude of the ego's lateral acceleration \[m/s²\].
    pub peak_lateral_acceleration_mps2: f64,
    /// Lowest speed of the ego \[m/s\].
    pub min_speed_mps: f64,
    /// Highest speed of the ego \[m/s\].
    pub max_speed_mps: f64,
    /// Largest distance of a corner of the ego beyond an edge of its road \[m\].
    pub off_road_m: f64,
    /// Whether that is more than 3 % of the width of its body: 5 cm of a car.
    #[serde(default)]
    pub leaves_road: bool,
    /// Largest speed of the ego above the limit of its lane \[m/s\]; none without limits.
    pub speeding_mps: Option<f64>,
    /// Largest deceleration of any other vehicle \[m/s²\].
    pub others_peak_braking_mps2: Option<f64>,
    /// Whether any other vehicle brakes hard.
    #[serde(default)]
    pub others_hard_braking: bool,
    /// How many plans the ego made.
    pub plans: u64,
    /// How many of them failed and were replaced by a fallback.
    pub plans_failed: u64,
    /// How many are not optimal, because their optimiser reached the limit of its work.
    pub plans_unfinished: u64,
    /// How many plans of the others failed.
    pub others_plans_failed: u64,
}

/// What a run amounts to for a building, over all its days.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BuildingResult {
    /// The word for its controller.
    pub controller: String,
    /// How many days there were.
    pub days: u64,
    /// On how many of them the controller had no plan of its own.
    pub fallbacks: u64,
    /// The energy of all days \[kWh\].
    pub energy_kwh: f64,
    /// The electricity that the equipment took for it on all days \[kWh\]; without a heat pump as much as the heat.
    #[serde(default)]
    pub electricity_kwh: f64,
    /// What the electricity of all days cost \[currency\]; none without a tariff.
    #[serde(default)]
    pub bill: Option<f64>,
    /// The currency of the bill; none without a tariff.
    #[serde(default)]
    pub currency: Option<String>,
    /// The discomfort of all days \[K h\].
    pub discomfort_k_h: f64,
    /// The cost of the last day.
    pub last_cost: f64,
}

impl SweepRow {
    /// The same result as a row of another run of the same key: another plan, or another arm of the plan that changes the same, may
    /// have made it.
    #[must_use]
    pub(crate) fn labelled(self, point: SweepPoint) -> SweepRow {
        let SweepPoint { scenario, family, style, planner, sample, seed, inputs, .. } = point;
        SweepRow { scenario, family, style, planner, sample, seed, inputs: inputs.into_iter().collect(), ..self }
    }

    /// Whether the run is worth looking at: it has no result, or the ego did not do its task without contact; without vehicles,
    /// an expectation failed.
    pub fn is_failure(&self) -> bool {
        self.result.as_ref().is_none_or(|result| match &result.traffic {
            Some(traffic) => !traffic.success,
            None => !result.passed,
        })
    }
}
