//! The defaults of a file: those for all its vehicles, and those of its size.
//!
//! The defaults of the format are those of 1/10 scale cars. A file of another size states its `scale` or the `class` of its
//! vehicles, and its other defaults are scaled: a length by the ratio `λ` of lengths, a time and a speed by `√λ`, an
//! acceleration by 1, and a weight such that the weighted term costs the same. Two scenarios of which one is the other scaled in
//! this way have the same motion, scaled.
//!
//! - `for_all`: `[defaults]`, merged under every vehicle.
//! - `driver_kind`: the kind of drivers of which only the style is stated.
//! - `similarity`: the factor by which a unit is scaled.
//! - `fill`: the scaled defaults of a table, for keys that it does not state.
//! - `people`: the behaviour of people on real roads.
//! - `expand`: all that depends on the size of a scenario.

mod driver_kind;
mod expand;
mod fill;
mod for_all;
mod people;
mod similarity;
pub(crate) mod stated_road;

pub(crate) use driver_kind::with_driver_kinds;
pub(crate) use expand::expand;
pub(crate) use for_all::with_defaults;
