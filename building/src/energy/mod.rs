//! The electricity and the money that heat costs: tariffs, and heat pumps whose efficiency depends on the weather.
//!
//! ```text
//! electric power  P = |u| / COP(T₀)                     money  Σ price · P · h
//! W_u(t)         = W_u · price(t) / mean price · mean COP / COP(T₀(t))
//! ```
//!
//! Controllers use the second line: the quadratic cost of heat in (3.2) is larger in an hour in which heat is
//! expensive. The problem stays convex, and a constant price and COP do not change it.

mod heat_pump;
mod tariff;

pub use heat_pump::{CopPoint, HeatPump};
pub(crate) use tariff::mean_size;
pub use tariff::{EnergySupply, Tariff, TariffError};
