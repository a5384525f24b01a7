//! Scenarios of Interplay: their file format, its checks, and the authored files themselves.
//!
//! There are two types. A [`ScenarioFile`] contains exactly the keys that are written. A [`Scenario`] is ready to run:
//! every key has a value, each vehicle has a start in world coordinates and a route along a road that was built, and
//! the named files were read. One mechanism leads from the first to the second, for every author of a file:
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

mod commonroad;
mod encounters;
mod format;
mod load;
mod model;
mod plans;
mod resolve;
mod roads;
mod streets;
mod text;
mod write;

pub use commonroad::recorded_traffic::{
    RecordedLane, RecordedMoment, RecordedTraffic, RecordedVehicle, recorded_traffic_in_table, recorded_traffic_in_text,
};
pub use commonroad::{
    CommonRoadExport, DrivenVehicle, Exported, ImportOptions, Imported, Replacement, import_commonroad,
    import_commonroad_file, is_commonroad, recorded_traffic_in_commonroad,
};
pub use encounters::{ENCOUNTER_MANIFEST, ENCOUNTER_VERSION, Encounter, EncounterSplit, PartnerFamily};
pub use format::flow::{FlowConfig, FlowGoal, FlowShare, Headways};
pub use format::obstacle::ObstacleConfig;
pub use format::read::embedded::{Embedded, embedded};
pub use format::read::overrides::Override;
pub use format::read::regular_file::{open_regular, read_regular};
pub use format::read::source::Source;
pub use format::registry::{Registry, RegistryError, schema};
pub use format::scenario_file::ScenarioFile;
pub use format::start::StartConfig;
pub use format::stated::Stated;
pub use format::vehicle_config::{GoalDefaults, VehicleConfig, VehicleDefaults};
pub use format::weather::WeatherConfig;
pub use load::files::{FolderContents, FolderScenario, files, files_below};
pub use load::{from_text, load};
pub use model::building::boptest_plant::{
    BoptestForecast, BoptestIndicators, BoptestInput, BoptestPlantConfig, BoptestPrices, BoptestZone,
};
pub use model::building::config::{BuildingConfig, FloorPlan, Grid, Preset};
pub use model::building::gains::{GainsConfig, RecordedGainsFile};
pub use model::building::plant::{BuildingPlant, NetworkPlantConfig, SocketPlantConfig};
pub use model::building::weather::{CsvWeather, EpwFile, EpwWeather, Synthetic, WeatherSource};
pub use model::classes::{NamedScale, ScenarioScale, VehicleClass};
pub use model::derived::narrowest_lane::{ConflictZone, DetectorLine};
pub use model::derived::task::Task;
pub use model::derived::timetable::TimetableError;
pub use model::expectations::counterfactual::CounterfactualConfig;
pub use model::expectations::expect::{
    BuildingExpect, Completes, CompletionShift, CounterfactualExpect, Expect, ExpectedComfort, ExpectedMetric,
    ExpectedSpeed, ExpectedYield, ExpectedZone,
};
pub use model::expectations::metric_bound::{MetricBound, MetricLimit};
pub use model::metric::{
    Better, DeclaredMetric, MetricComparison, MetricDeclaration, MetricKind, MetricSubject, RegisteredMetrics,
};
pub use model::remark::{ScenarioRemark, ScenarioRemarks};
pub use model::scenario::{BudgetLimits, Counterfactual, Scenario, Stay, Vehicle};
pub use model::traffic::flows::ScenarioFlows;
pub use model::traffic::goal::GoalConfig;
pub use model::traffic::lane_reference::{DetectorConfig, LaneReference};
pub use model::traffic::light::LightConfig;
pub use model::traffic::obstacle::{DeclaredObstacle, ObstacleForm, ObstacleKind, Outline};
pub use model::traffic::plant::{Dynamic, Kinematic, Plant};
pub use model::traffic::real_time::{Deadline, Detail, RealTime};
pub use model::traffic::weights::{StartJitter, Weights};
pub use plans::standard_changes::StandardChange;
pub use plans::{RunRefusals, SweepPlan, SweepPoint, embedded_plans, first_planner, names_matching};
pub use resolve::budget::RunCost;
pub use roads::*;
pub use streets::Street;
pub use text::error::{Fault, LoadError};
pub use text::plain_text::is_plain;
pub use text::readable::readable;
pub use write::reference::key_reference;
