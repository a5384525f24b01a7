//! Series of values at equal intervals, and the tables that state them: prices, weather, heat of people.

pub(crate) mod clock;
mod held;
pub(crate) mod home_assistant;
mod read;

pub use held::{HeldSeries, bridge, gaps};
pub use read::{SeriesColumn, SeriesError, SeriesTable};
