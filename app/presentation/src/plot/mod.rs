//! Figures as SVG and PNG, with a font inside the binary. Only this module names Plotters.
//!
//! One function draws both, so they show the same. Most figures are a [`Drawing`], the result of a pure function:
//! [`Panels`] of curves, a [`FootprintPlot`] of footprints, or a [`TextTable`] of words.

mod axis;
mod bars;
mod drawing;
mod figure;
mod footprints;
mod identification;
mod legend;
mod panels;
pub mod style;
mod table;

pub use bars::{IntervalBar, IntervalBars};
pub use drawing::Drawing;
pub use figure::PlotError;
pub use footprints::{FootprintPlot, FootprintSnapshot, FootprintVehicle};
pub use identification::identification;
pub use panels::{Curve, Marks, Panel, Panels};
pub use table::TextTable;
