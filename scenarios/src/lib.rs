//! The scenario file of Interplay: its format, its checks, and the authored files themselves.
//!
//! A file is TOML. It goes through one mechanism, whoever wrote it:
//!
//! ```text
//! text -> tree with places -> merged with what it extends -> changed by --set
//!      -> checked against the JSON Schema (keys, types, ranges)
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
mod road;
mod scenario;
mod schema;
mod schema_check;
mod seed_dependence;
mod source;
mod standard_changes;
mod start;
mod start_jitter;
mod stated_path;
mod sweep_plan;
mod swept_width;
mod tariff_file;
mod text_line;
mod timetable;
mod tree;
mod vehicle_defaults;
mod weather;
mod weather_file;
mod weights;

pub use budget::RunCost;
pub use budget_limits::BudgetLimits;
pub use building::{BuildingConfig, FloorPlan, Grid, Preset};
pub use building_plant::{BuildingPlant, NetworkPlantConfig, SocketPlantConfig};
pub use classes::{NamedScale, ScenarioScale, VehicleClass};
pub use conflict_zones::ConflictZone;
pub use counterfactual::Counterfactual;
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
pub use road::{
    AllWayStop, Branch, Crossing, CurveLaneEnd, CurvePiece, DrivingDirection, Intersection, LaneConfig, LaneNetwork,
    LanePlaceConfig, LaneWidth, Lanes, MinorRoadRule, NarrowPassage, NeighbourConfig, NeighbourTable, OnRamp,
    ParallelLanes, RampMerge, Road, RoadCurve, Roundabout, TJunction, TwoWayRoad,
};
pub use scenario::{GoalConfig, Scenario, Vehicle};
pub use schema::schema;
pub use source::Source;
pub use standard_changes::StandardChange;
pub use start_jitter::StartJitter;
pub use sweep_plan::{RunRefusals, SweepPlan, SweepPoint, embedded_plans};
pub use timetable::TimetableError;
pub use vehicle_defaults::{GoalDefaults, VehicleDefaults};
pub use weather::{EpwFile, Synthetic, WeatherConfig};
pub use weights::Weights;
