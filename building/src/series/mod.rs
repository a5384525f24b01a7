//! Series of values at equal intervals, and the tables that state them: prices, weather, heat of people.

pub(crate) mod clock;
mod gaps;
mod held;
mod read;
mod row_time;

pub use gaps::{bridge, gaps};
pub use held::HeldSeries;
pub use read::{SeriesColumn, SeriesError, SeriesTable};
