//! Interplay: zones that interact.
//!
//! The crate contains only pure functions of plain values, like the planners: it uses no wall clock, files, entities or pictures.
//!
//! - the building: [`network`] (zones and walls), [`discretise`] (steps of time), [`lifted`] (a day as one linear map)
//! - its disturbances: [`weather`] (files, a synthetic climate, forecasts), [`occupancy`] (people, scheduled and actual)
//! - [`sun`]: where it stands, and its radiation on planes of any orientation
//! - [`comfort`]: the temperatures that are wanted; [`schedule`] and [`calendar`]: by zone and weekday
//! - [`series`]: series at equal intervals, and tables of them
//! - [`benchmark`]: the key performance indicators of BOPTEST, from the measurements of a test case
//! - [`energy`]: what heat takes in electricity and costs in money
//! - [`control`]: controllers that are compared day by day, and the day's optimum
//! - [`day`]: the closed loop of a building and a controller, and the key figures of a day
//! - [`identify`]: thermal parameters from telemetry
//!
//! Temperatures are in °C, differences in K, heat in kW (positive into a zone), energy in kWh, capacities in kJ/K,
//! resistances in K/kW, time in seconds or hours, as the names say. A day's signals are stacked time-major: entry t·n + i
//! is zone i of n in step t.
//!
//! Exponentials and similar functions come from `libm`, random numbers from ChaCha, and products of large matrices are written out (the
//! rounding of nalgebra's products depends on the processor), so that runs are bit-identical on every machine.
//!
//! Equation numbers are those of C. Peng, *Optimization Based Control for Multi-agent System with Interaction* (Berkeley,
//! 2019); "corrected" marks where the printed equation is in error.
//!
//! # A day
//!
//! ```
//! use interplay_building::comfort::Setpoints;
//! use interplay_building::control::Controller;
//! use interplay_building::day::{KeyFigures, Surroundings, run_day};
//! use interplay_building::discretise::Model;
//! use interplay_building::network::Network;
//! use interplay_building::occupancy::Occupancy;
//! use interplay_building::weather::{Climate, Forecast};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let (step_s, steps) = (1800.0, 48);
//! let model = Model::exact(&Network::testbed(), step_s)?;
//! let targets = Setpoints::default().targets(4, step_s, steps)?;
//! let (weather, people) = (Climate::default().weather(1, 5), Occupancy::default().people(4, 1));
//! let surroundings = Surroundings::new(weather, (Forecast::Exact, 1), people, model.network());
//! let mut controller = Controller::IterativeLearning(Default::default()).controller(&model, steps)?;
//!
//! let mut temperatures_c = vec![28.0; 4];
//! let mut costs = Vec::new();
//! for day in 0..5 {
//!     let forecast = surroundings.forecast(&model, steps, day);
//!     let actual = surroundings.actual(&model, steps, day);
//!     let record = run_day(&model, &mut temperatures_c, &mut *controller, &targets, &forecast, &actual)?;
//!     costs.push(KeyFigures::compute(&record, &targets, model.network().limits(), step_s).cost);
//! }
//! assert!(costs[4] < 0.5 * costs[0], "it has learned: {costs:?}");
//! # Ok(())
//! # }
//! ```

pub mod benchmark;
pub mod calendar;
pub mod comfort;
pub mod control;
pub mod day;
pub mod discretise;
pub mod energy;
pub mod identify;
pub mod lifted;
pub mod network;
pub mod occupancy;
pub mod schedule;
pub mod series;
pub mod staged;
pub mod sun;
pub mod weather;
