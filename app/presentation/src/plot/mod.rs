//! Pictures as SVG and PNG, with a font inside the binary.
//!
//! A picture is a `Drawing`, the result of a pure function: `Panels` of curves, a `FootprintPlot`, `IntervalBars`, or a
//! `TextTable`.

mod axis;
mod backend;
mod bars;
mod drawing;
mod footprints;
mod identification;
mod panels;
pub(crate) mod style;
mod table;

pub use backend::PlotError;
pub(crate) use backend::{FONT_BYTES, png_of};
pub(crate) use bars::{IntervalBar, IntervalBars};
pub(crate) use drawing::Drawing;
pub(crate) use footprints::{FootprintPlot, FootprintSnapshot, FootprintVehicle};
pub use identification::identification;
pub(crate) use panels::{Curve, Panel, Panels};
pub(crate) use table::TextTable;
