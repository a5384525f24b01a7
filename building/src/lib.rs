//! Interplay: zones that interact.
//!
//! Pure functions of plain values, like the planners: nothing here knows of time, files, entities or pictures.

pub mod comfort;
pub mod control;
pub mod discretise;
pub mod identify;
pub mod lifted;
pub mod network;
pub mod occupancy;
mod random;
pub mod weather;
