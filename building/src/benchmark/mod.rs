//! The key performance indicators of BOPTEST, from the measurements of one of its test cases.
//!
//! ```text
//! tdis  ∫ max(T_lower − T, 0) + max(T − T_upper, 0) dt    summed over zone signals, divided by the number of zones  [K·h/zone]
//! idis  ∫ max(C − C_upper, 0) dt                           likewise                                                  [ppm·h/zone]
//! ener  ∫ P dt / A        cost  ∫ p P dt / A + ∫ p_w V dt / A        emis  ∫ e P dt / A        [kWh/m², currency/m², kg/m²]
//! pele, pgas, pdih        largest mean of all power of a carrier in a quarter of an hour / A   [kW/m²]
//! ```
//!
//! `A` is the floor area. Integrals use the trapezoidal rule over the times of the measurements, as BOPTEST's
//! `kpis/kpi_calculator.py` does; prices and emission factors are those at the same times.
//!
//! Source: Blum et al., "Building optimization testing framework (BOPTEST) for simulation-based benchmarking of control strategies in
//! buildings", Journal of Building Performance Simulation 14(5), 2021.

mod indicators;
mod measurements;

pub use indicators::Indicators;
pub use measurements::{AirQuality, Carrier, MeasuredRun, MeasurementError, PowerSignal, ThermalZone, Water};
