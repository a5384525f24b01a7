//! A run with people in some seats.

mod live;
mod score;
mod seat;
#[cfg(test)]
mod tests;

pub(crate) use live::seats_of;
pub use live::{Session, check_seats};
pub(crate) use score::{PlayGoal, planner_rows, planners_beside_person};
pub use score::{Score, ScoreRow};
pub use seat::{Controls, SessionError};
