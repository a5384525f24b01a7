//! What a run amounts to: figures, and whether the scenario's expectations held.

mod expectations;
mod junit;
mod suite;
mod summary;

use interplay_planners::State;
use interplay_scenarios::{Scenario, Vehicle};
use serde::Serialize;

pub use expectations::Expectation;
pub use junit::junit;
pub use suite::{Case, table};
pub use summary::summary;

use crate::components::to_nanosecond;
use crate::measure::{Collision, Measures, PhaseDigests, VehicleMeasures};

/// The outcome of one run; its serialisation is the output contract of `--json`.
#[derive(Clone, Debug, Serialize)]
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
    /// What was expected.
    pub expectations: Vec<Expectation>,
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
    pub fn new(name: &str, scenario: &Scenario, measures: &Measures, wall_s: f64) -> Self {
        let vehicles = scenario.vehicles.iter().zip(&measures.vehicles);
        let vehicles = vehicles
            .map(|(vehicle, measured)| VehicleReport::new(&vehicle.name, vehicle.driver.kind(), measured))
            .collect();
        let phase_digests = measures.digest.phases();
        let mut report = Report {
            scenario: name.to_owned(),
            passed: true,
            seed: scenario.seed,
            simulated_s: to_nanosecond(scenario.step_s * scenario.tick_count() as f64),
            wall_s,
            digest: phase_digests.physics.clone(),
            phase_digests,
            collisions: measures.collisions.clone(),
            min_gap_m: measures.gap.smallest_m,
            order: order(scenario, measures),
            vehicles,
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
