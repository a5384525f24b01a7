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
mod budget_limits;
mod building;
mod building_plant;
mod changed;
mod classes;
mod commented;
mod conflict_zones;
mod consistency;
mod counterfactual;
mod degrees;
mod embedded;
mod error;
mod expansion;
mod expect;
mod files;
mod foreign_kind;
mod lane_reference;
mod load;
mod merge;
mod name;
mod narrowest_lane;
mod overrides;
mod placement;
mod plain_text;
mod plan_deadlines;
mod plan_file;
mod plant;
mod readable;
mod real_time;
mod reference;
mod registry;
mod regular_file;
mod remark;
mod remarks;
mod resolve;
mod road;
mod scenario;
mod scenario_file;
mod schema;
mod schema_check;
mod seed_dependence;
mod source;
mod standard_changes;
mod start;
mod start_jitter;
mod stated;
mod stated_path;
mod sweep_plan;
mod swept_width;
mod tariff_file;
mod text_line;
mod timetable;
mod tree;
mod vehicle_config;
mod vehicle_defaults;
mod weather;
mod weather_file;
mod weights;
mod write;

pub use budget::RunCost;
pub use budget_limits::BudgetLimits;
pub use building::{BuildingConfig, FloorPlan, Grid, Preset};
pub use building_plant::{BuildingPlant, NetworkPlantConfig, SocketPlantConfig};
pub use classes::{NamedScale, ScenarioScale, VehicleClass};
pub use conflict_zones::ConflictZone;
pub use counterfactual::{Counterfactual, CounterfactualConfig};
pub use embedded::{Embedded, embedded};
pub use error::{Fault, LoadError};
pub use expect::{
    BuildingExpect, Completes, CompletionShift, CounterfactualExpect, Expect, ExpectedComfort, ExpectedSpeed,
    ExpectedYield, ExpectedZone,
};
pub use files::{files, files_below};
pub use lane_reference::LaneReference;
pub use load::{from_text, load};
pub use overrides::Override;
pub use plain_text::is_plain;
pub use plant::{Dynamic, Kinematic, Plant};
pub use readable::readable;
pub use real_time::{Deadline, RealTime};
pub use reference::key_reference;
pub use registry::{Registry, RegistryError};
pub use regular_file::{open_regular, read_regular};
pub use remark::{ScenarioRemark, ScenarioRemarks};
pub use road::*;
pub use scenario::{GoalConfig, Scenario, Vehicle};
pub use scenario_file::ScenarioFile;
pub use schema::schema;
pub use source::Source;
pub use standard_changes::StandardChange;
pub use start::StartConfig;
pub use start_jitter::StartJitter;
pub use stated::Stated;
pub use sweep_plan::{RunRefusals, SweepPlan, SweepPoint, embedded_plans};
pub use timetable::TimetableError;
pub use vehicle_config::VehicleConfig;
pub use vehicle_defaults::{GoalDefaults, VehicleDefaults};
pub use weather::{EpwFile, EpwWeather, Synthetic, WeatherConfig, WeatherSource};
pub use weights::Weights;
