//! Recorded traffic compared with the drivers of Interplay.
//!
//! ```text
//! files -> joined traffic (`traffic`) -> starts in the frame of a lane (`start`) -> predictions (`models`) -> measures (`measure`)
//! ```
//!
//! - [`Recordings`] reads files and folders, joins consecutive windows, and finds the rows that repeat others.
//! - [`compare`] lets models predict the recorded cars from each second on, fitted on one half of the cars and evaluated on the other;
//!   [`leave_one_out`] fits them on all groups but the one on which they are evaluated.
//! - [`fit_driver`] finds the time gap, the comfort and the style with which our human drives like a recorded vehicle.
//!
//! The inputs of a prediction are causal: none of them depends on records after its start.

#![allow(missing_docs, reason = "only this workspace uses the crate; a comment says what a name and its type do not")]

mod compare;
mod driving;
mod error;
mod fit;
mod geometry;
mod measure;
mod models;
mod start;
mod traffic;

pub use compare::{ComparedModel, GroupComparison, PredictionComparison, compare, leave_one_out};
pub use driving::{DrivingDistance, DrivingStatistics, Spread};
pub use error::RecordingsError;
pub use fit::{FittedDriver, fit_driver};
pub use measure::{HorizonErrors, MeasureInterval, ModelMeasures};
pub use models::NamedModel;
pub use traffic::Recordings;
