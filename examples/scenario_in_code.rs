//! A scenario that code makes: a road of lanes with names and two cars, checked like a file, run, and written as a file.
//!
//! ```text
//! cargo run --release --example scenario_in_code
//! ```

#![allow(clippy::print_stdout, reason = "an example prints what it found")]

use interplay_scenarios::{
    GoalConfig, LaneConfig, LaneNetwork, Road, ScenarioFile, StartConfig, Stated, VehicleConfig,
};
use interplay_simulation::run::run;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Two lanes one after the other, as an importer of maps would make them: points in metres, and what follows what.
    let lane = |name: &str, points: &[[f64; 2]]| LaneConfig::through(name, points, 3.5);
    let straight = LaneConfig { successors: vec!["bend".to_owned()], ..lane("straight", &[[0.0, 0.0], [150.0, 0.0]]) };
    let bend = lane("bend", &[[150.0, 0.0], [200.0, 2.0], [250.0, 8.0], [300.0, 18.0]]);
    let vehicle =
        |name: &str, along_m, speed_mps| VehicleConfig::new(name, StartConfig::in_lane("straight", along_m, speed_mps));
    let file = ScenarioFile {
        road: Some(Road::Network(LaneNetwork { lanes: vec![straight, bend] }).into()),
        vehicles: vec![
            // A table states as much as it must: the rest follows from the size of the road, as in a text.
            VehicleConfig {
                driver: Some(Stated::kind("idm").with("headway_s", 1.2)),
                goal: GoalConfig { speed_mps: Some(14.0), ..GoalConfig::default() },
                ..vehicle("ego", 5.0, 12.0)
            },
            vehicle("front", 40.0, 9.0),
        ],
        duration_s: Some(10.0),
        ..ScenarioFile::new("Into a bend", "The ego follows a slower car")
    };
    // An error names the path of the key, such as `vehicle.ego.start.lane`.
    let scenario = file.resolve()?;
    let report = run("bend", &scenario, Vec::new())?;
    for (vehicle, measured) in scenario.vehicles.iter().zip(&report.vehicles) {
        println!("{:6} is {} m wide and driven by {}", measured.name, vehicle.body.width_m, measured.driver);
    }
    println!("collisions: {}; as a file:\n\n{}", report.collisions.len(), file.to_toml());
    Ok(())
}
