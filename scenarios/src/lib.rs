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

mod building;
mod changed;
mod classes;
mod commented;
mod conflict_zones;
mod consistency;
mod counterfactual;
mod embedded;
mod error;
mod expect;
mod files;
mod load;
mod merge;
mod name;
mod overrides;
mod placement;
mod plant;
mod road;
mod scenario;
mod schema;
mod schema_check;
mod source;
mod standard_changes;
mod start;
mod start_jitter;
mod tree;
mod weather;
mod weather_file;

pub use building::{BuildingConfig, FloorPlan, Grid, Preset};
pub use classes::{GoalDefaults, NamedScale, ScenarioScale, VehicleClass, VehicleDefaults};
pub use commented::commented;
pub use conflict_zones::ConflictZone;
pub use counterfactual::Counterfactual;
pub use embedded::{Embedded, embedded};
pub use error::{Fault, LoadError};
pub use expect::{
    BuildingExpect, Completes, CompletionShift, CounterfactualExpect, Expect, ExpectedComfort, ExpectedSpeed,
    ExpectedYield,
};
pub use files::files;
pub use load::{from_text, load};
pub use overrides::Override;
pub use plant::{Dynamic, Kinematic, Plant};
pub use road::{Branch, CurveLaneEnd, CurvePiece, Intersection, Lanes, RampMerge, Road, RoadCurve};
pub use scenario::{GoalConfig, Scenario, Vehicle, Weights};
pub use schema::{controller_kinds, driver_kinds, schema};
pub use source::Source;
pub use standard_changes::{StandardChange, standard_changes};
pub use start_jitter::StartJitter;
pub use weather::{EpwFile, Synthetic, WeatherConfig};
