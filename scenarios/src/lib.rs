//! Scenarios of Interplay: their file format, its checks, and the authored files themselves.
//!
//! There are two types. A [`ScenarioFile`] is what is written, and nothing of what it leaves out. A [`Scenario`] is what is run:
//! everything has a value, each vehicle has a start in world coordinates and a route along a road that was built, and the files
//! that it names were read. One mechanism leads from the first to the second, whoever wrote it:
//!
//! ```text
//! text -> tree with places -> merged with what it extends -> changed by --set
//!      -> checked against the JSON Schema (keys, types, ranges)
//!      -> what it leaves out is added, for its size -> ScenarioFile with everything stated
//!      -> Scenario -> checked for meaning (positions, names, times)
//!      -> and the same for the changed scenario of every counterfactual
//! ```
//!
//! The schema that [`schema`] publishes for editors is the one that the loader checks against, so the two cannot
//! disagree. Every error is located: file, line, column, the offending text, and what would work ([`LoadError`]).
//!
//! ```
//! let scenario = interplay_scenarios::load("lane-change/front-nice", &[])?;
//! assert_eq!(scenario.vehicles.len(), 3);
//! # Ok::<(), interplay_scenarios::LoadError>(())
//! ```
//!
//! Code makes a file from its parts ([`ScenarioFile`], [`VehicleConfig`], [`LaneConfig`]) or from a table of JSON
//! ([`ScenarioFile::from_json`]); what it does not state follows from the size of the scenario, as in a text:
//!
//! ```
//! use interplay_scenarios::{Lanes, Road, ScenarioFile, StartConfig, Stated, VehicleConfig, from_text};
//!
//! let vehicle = |name: &str, along_m| VehicleConfig::new(name, StartConfig::in_lane(0, along_m, 13.9));
//! let file = ScenarioFile {
//!     road: Some(Road::Lanes(Lanes { lane_count: 2, lane_width_m: 3.5 }).into()),
//!     vehicles: vec![
//!         VehicleConfig { driver: Some(Stated::kind("negotiation")), ..vehicle("ego", 0.0) },
//!         vehicle("front", 30.0),
//!     ],
//!     ..ScenarioFile::new("Two cars", "The ego follows")
//! };
//! let scenario = file.resolve()?;
//! assert_eq!((scenario.vehicles[1].start.x_m, scenario.vehicles[1].start.y_m), (30.0, 1.75));
//! assert_eq!(scenario.vehicles[1].body.width_m, 1.8, "lanes of 3.5 m are those of real cars");
//!
//! // Written out, both are the same scenario.
//! for text in [file.to_toml(), scenario.to_file().to_toml()] {
//!     assert_eq!(from_text("two-cars.toml", &text, &[])?, scenario);
//! }
//!
//! // What is wrong is located by the path of its key.
//! let wrong = ScenarioFile { vehicles: vec![vehicle("ego", 0.0), vehicle("front", 3.0)], ..file };
//! let error = wrong.resolve().expect_err("they overlap");
//! assert_eq!(error.faults()[0].file(), Some("vehicle.front.start"));
//! # Ok::<(), interplay_scenarios::LoadError>(())
//! ```

mod budget;
mod check;
mod classes;
mod commonroad;
mod defaults;
mod error;
mod file_format;
mod files;
mod flows;
mod json_schema;
mod load;
mod metric;
mod read;
mod recorded_traffic;
mod registry;
mod resolve;
mod road;
mod scenario;
mod standard_changes;
mod streets;
mod sweep_plan;
mod text;
mod write;

pub use budget::RunCost;
pub use classes::{NamedScale, ScenarioScale, VehicleClass};
pub use commonroad::{
    CommonRoadExport, DrivenVehicle, Exported, ImportOptions, Imported, Replacement, import_commonroad,
    import_commonroad_file, is_commonroad, recorded_traffic_in_commonroad,
};
pub use error::{Fault, LoadError};
pub use file_format::boptest_forecast::BoptestForecast;
pub use file_format::boptest_plant::{BoptestIndicators, BoptestInput, BoptestPlantConfig, BoptestPrices, BoptestZone};
pub use file_format::budget_limits::BudgetLimits;
pub use file_format::building::{BuildingConfig, FloorPlan, Grid, Preset};
pub use file_format::building_plant::{BuildingPlant, NetworkPlantConfig, SocketPlantConfig};
pub use file_format::counterfactual::CounterfactualConfig;
pub use file_format::detail::Detail;
pub use file_format::detector::DetectorConfig;
pub use file_format::expect::{
    BuildingExpect, Completes, CompletionShift, CounterfactualExpect, Expect, ExpectedComfort, ExpectedMetric,
    ExpectedSpeed, ExpectedYield, ExpectedZone,
};
pub use file_format::flow::{FlowConfig, FlowGoal, FlowShare, Headways};
pub use file_format::gains::{GainsConfig, RecordedGainsFile};
pub use file_format::goal::GoalConfig;
pub use file_format::lane_reference::LaneReference;
pub use file_format::light::LightConfig;
pub use file_format::metric_bound::{MetricBound, MetricLimit};
pub use file_format::obstacle::ObstacleConfig;
pub use file_format::plant::{Dynamic, Kinematic, Plant};
pub use file_format::real_time::{Deadline, RealTime};
pub use file_format::scenario_file::ScenarioFile;
pub use file_format::start::StartConfig;
pub use file_format::start_jitter::StartJitter;
pub use file_format::stated::Stated;
pub use file_format::vehicle_config::VehicleConfig;
pub use file_format::vehicle_defaults::{GoalDefaults, VehicleDefaults};
pub use file_format::weather::{CsvWeather, EpwFile, EpwWeather, Synthetic, WeatherConfig, WeatherSource};
pub use file_format::weights::Weights;
pub use files::{files, files_below};
pub use load::{from_text, load};
pub use metric::{
    Better, DeclaredMetric, MetricComparison, MetricDeclaration, MetricKind, MetricSubject, RegisteredMetrics,
};
pub use read::embedded::{Embedded, embedded};
pub use read::overrides::Override;
pub use read::regular_file::{open_regular, read_regular};
pub use read::source::Source;
pub use recorded_traffic::{
    RecordedLane, RecordedMoment, RecordedTraffic, RecordedVehicle, recorded_traffic_in_table, recorded_traffic_in_text,
};
pub use registry::{Registry, RegistryError, schema};
pub use road::*;
pub use scenario::conflict_zones::ConflictZone;
pub use scenario::detector_line::DetectorLine;
pub use scenario::obstacle::{ObstacleForm, ObstacleKind, Outline};
pub use scenario::remark::{ScenarioRemark, ScenarioRemarks};
pub use scenario::timetable::TimetableError;
pub use scenario::{Counterfactual, Scenario, Stay, Vehicle};
pub use standard_changes::StandardChange;
pub use streets::Street;
pub use sweep_plan::{RunRefusals, SweepPlan, SweepPoint, embedded_plans};
pub use text::plain_text::is_plain;
pub use text::readable::readable;
pub use write::reference::key_reference;
