//! The scenario file of Interplay: its format, its checks, and the authored files themselves.
//!
//! A file is TOML. It goes through one mechanism, whoever wrote it:
//!
//! ```text
//! text -> tree with places -> merged with what it extends -> changed by --set
//!      -> checked against the JSON Schema (keys, types, ranges)
//!      -> Scenario -> checked for meaning (positions, names, times)
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
mod commented;
mod embedded;
mod error;
mod expect;
mod files;
mod jitter;
mod load;
mod meaning;
mod merge;
mod nearest;
mod overrides;
mod plant;
mod road;
mod scenario;
mod schema;
mod shape;
mod source;
mod tree;

pub use building::{Building, EpwFile, FloorPlan, Grid, Preset, Synthetic, Weather};
pub use commented::commented;
pub use embedded::{Embedded, embedded};
pub use error::{LoadError, Problem};
pub use expect::{BuildingExpect, Completes, Expect, SpeedRange};
pub use files::files;
pub use load::{from_text, load};
pub use overrides::Override;
pub use plant::{Dynamic, Kinematic, Plant};
pub use road::{Branch, Intersection, Lanes, RampMerge, Road};
pub use scenario::{Goal, Scenario, StartJitter, Vehicle, Weights};
pub use schema::{driver_kinds, schema};
pub use source::Source;
