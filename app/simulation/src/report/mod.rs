//! What a run amounts to: figures, and whether the scenario's expectations held.

mod building;
mod expectations;

use interplay_planners::State;
use interplay_scenarios::{Scenario, Vehicle};
use serde::{Serialize, Serializer};
use xxhash_rust::xxh3::xxh3_128;

pub use building::BuildingReport;
pub use expectations::Expectation;

use crate::components::to_nanosecond;
use crate::measure::{BuildingMeasures, Collision, Measures, PhaseDigests, VehicleMeasures};

/// The outcome of one run; its serialisation is the output contract of `--json`. What is about vehicles is left out of
/// that without vehicles, and `building` without a building.
#[derive(Clone, Debug, Serialize)]
#[serde(remote = "Report")]
pub struct Report {
    /// Name of the scenario.
    pub scenario: String,
    /// Whether every expectation held.
    pub passed: bool,
    /// The seed of the run.
    pub seed: u64,
    /// Simulated time \[s\].
    pub simulated_s: f64,
    /// Wall time \[s\]; not reproducible.
    pub wall_s: f64,
    /// Digest of all states, bit for bit.
    pub digest: String,
    /// Digests of what each phase produced.
    pub phase_digests: PhaseDigests,
    /// Contacts.
    pub collisions: Vec<Collision>,
    /// Smallest distance of the ego's footprint to another \[m\].
    pub min_gap_m: Option<f64>,
    /// Names from the front of the road to its rear, at the end; at an intersection, in the order of crossing.
    pub order: Vec<String>,
    /// Every vehicle, in the scenario's order.
    pub vehicles: Vec<VehicleReport>,
    /// The building.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub building: Option<BuildingReport>,
    /// What was expected.
    pub expectations: Vec<Expectation>,
}

/// Keys of the serialisation that are about vehicles.
const DRIVING: [&str; 5] = ["phase_digests", "collisions", "min_gap_m", "order", "vehicles"];

impl Serialize for Report {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if !self.vehicles.is_empty() {
            return Report::serialize(self, serializer);
        }
        let mut whole = Report::serialize(self, serde_json::value::Serializer).map_err(serde::ser::Error::custom)?;
        if let Some(object) = whole.as_object_mut() {
            object.retain(|key, _| !DRIVING.contains(&key.as_str()));
        }
        whole.serialize(serializer)
    }
}

/// The outcome for one vehicle.
#[derive(Clone, Debug, Serialize)]
pub struct VehicleReport {
    /// Its name.
    pub name: String,
    /// The word for its driver.
    pub driver: String,
    /// When it reached its goal \[s\].
    pub completed_s: Option<f64>,
    /// Its last state.
    #[serde(rename = "final")]
    pub last: State,
    /// Slowest \[m/s\].
    pub min_speed_mps: f64,
    /// Fastest \[m/s\].
    pub max_speed_mps: f64,
    /// Mean absolute acceleration \[m/s²\].
    pub mean_abs_acceleration: f64,
    /// Mean absolute jerk \[m/s³\].
    pub mean_abs_jerk: f64,
    /// Its planner.
    pub plans: PlansReport,
}

/// How a planner did. Times are wall times and not reproducible.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct PlansReport {
    /// Plans made.
    pub count: usize,
    /// Plans that failed and were replaced by a fallback.
    pub failed: usize,
    /// Median time \[ms\].
    pub median_ms: f64,
    /// 99th percentile \[ms\].
    pub p99_ms: f64,
}

impl Report {
    /// Puts the measures of a run together and judges them.
    pub fn new(
        name: &str,
        scenario: &Scenario,
        (measures, building): (&Measures, Option<&BuildingMeasures>),
        wall_s: f64,
    ) -> Self {
        let vehicles = scenario.vehicles.iter().zip(&measures.vehicles);
        let vehicles = vehicles
            .map(|(vehicle, measured)| VehicleReport::new(&vehicle.name, vehicle.driver.kind(), measured))
            .collect();
        let phase_digests = measures.digest.phases();
        let building = building.map(|measures| BuildingReport::new(scenario, measures));
        let mut report = Report {
            scenario: name.to_owned(),
            passed: true,
            seed: scenario.seed,
            simulated_s: simulated_s(scenario),
            wall_s,
            digest: digest(scenario, &phase_digests, building.as_ref()),
            phase_digests,
            collisions: measures.collisions.clone(),
            min_gap_m: measures.gap.smallest_m,
            order: order(scenario, measures),
            vehicles,
            building,
            expectations: Vec::new(),
        };
        report.expectations = expectations::judge(&scenario.expect, &report);
        report.passed = report.expectations.iter().all(|expectation| expectation.passed);
        report
    }

    /// The outcome for the vehicle of that name.
    pub fn vehicle(&self, name: &str) -> Option<&VehicleReport> {
        self.vehicles.iter().find(|vehicle| vehicle.name == name)
    }
}

/// How long was simulated: until the slower of both clocks is done \[s\].
fn simulated_s(scenario: &Scenario) -> f64 {
    let last = |step_s: f64, count: usize| to_nanosecond(step_s * count as f64);
    let building = scenario.building.as_ref();
    let days_s = building.map_or(0.0, |house| last(house.step_s, scenario.days() * house.steps_per_day()));
    last(scenario.step_s, scenario.tick_count()).max(days_s)
}

/// One digest of all states: that of the vehicles, of the building, or of both.
fn digest(scenario: &Scenario, phases: &PhaseDigests, building: Option<&BuildingReport>) -> String {
    match building.map(|building| &building.digests.balance) {
        None => phases.physics.clone(),
        Some(balance) if scenario.vehicles.is_empty() => balance.clone(),
        Some(balance) => format!("{:032x}", xxh3_128(format!("{}{balance}", phases.physics).as_bytes())),
    }
}

/// Names from the front of the road to its rear; at an intersection, in the order in which they left the conflict zone,
/// and then by how far they still have to go.
fn order(scenario: &Scenario, measures: &Measures) -> Vec<String> {
    let road = &scenario.road;
    let vehicles = scenario.vehicles.iter().zip(&measures.vehicles);
    let place = |(vehicle, measured): (&Vehicle, &VehicleMeasures)| {
        let along = road.corridor(vehicle.road).along(measured.last.position());
        match road.conflict_zone_m(vehicle.road) {
            Some([_, end]) => {
                let never = if along > end { 0.0 } else { f64::INFINITY };
                [measured.completion.completed_s.unwrap_or(never), end - along]
            }
            None => [0.0, -along],
        }
    };
    let mut places: Vec<([f64; 2], &str)> =
        vehicles.map(|(one, seen)| (place((one, seen)), one.name.as_str())).collect();
    places.sort_by(|([a, behind_a], _), ([b, behind_b], _)| a.total_cmp(b).then(behind_a.total_cmp(behind_b)));
    places.into_iter().map(|(_, name)| name.to_owned()).collect()
}

impl VehicleReport {
    fn new(name: &str, driver: &str, measured: &VehicleMeasures) -> Self {
        VehicleReport {
            name: name.to_owned(),
            driver: driver.to_owned(),
            completed_s: measured.completion.completed_s,
            last: measured.last,
            min_speed_mps: measured.speed.min_mps,
            max_speed_mps: measured.speed.max_mps,
            mean_abs_acceleration: measured.comfort.mean_abs_acceleration(),
            mean_abs_jerk: measured.comfort.mean_abs_jerk(),
            plans: PlansReport {
                count: measured.planning.count(),
                failed: measured.planning.failed,
                median_ms: measured.planning.quantile_ms(0.5),
                p99_ms: measured.planning.quantile_ms(0.99),
            },
        }
    }
}
