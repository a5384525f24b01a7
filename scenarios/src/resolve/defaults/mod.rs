//! What a file leaves out, written into it: defaults for all its vehicles, and those of its size.
//!
//! The defaults of the format are those of 1/10 scale cars. A file of another size states its `scale` or the `class` of its
//! vehicles, and whatever else it leaves out is scaled: a length by the ratio `λ` of lengths, a time and a speed by `√λ`, an
//! acceleration by 1, and a weight such that what it weighs costs the same. Two scenarios of which one is the other scaled in
//! this way have the same motion, scaled.
//!
//! - `for_all`: `[defaults]`, laid under every vehicle.
//! - `similarity`: by how much a unit is scaled.
//! - `fill`: the defaults of a table, scaled, where it states nothing.
//! - `people`: what people do on real roads.
//! - `expand`: all that depends on the size of a scenario.

mod expand;
mod fill;
mod for_all;
mod people;
mod similarity;
pub(crate) mod stated_road;

pub(crate) use expand::expand;
pub(crate) use for_all::with_defaults;
