//! A run with people in some seats.

mod live;
mod score;
mod seat;
#[cfg(test)]
mod tests;

pub(crate) use live::{PlayGoal, seats_of};
pub use live::{Session, check_seats};
pub use score::{Score, ScoreRow};
pub(crate) use score::{planner_rows, planners_beside_person};
pub use seat::{Controls, SessionError};
