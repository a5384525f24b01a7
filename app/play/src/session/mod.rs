//! A run with people in it.

mod error;
mod goal;
mod live;
mod score;
mod seat;
#[cfg(test)]
mod tests;

pub use error::SessionError;
pub use goal::PlayGoal;
pub(crate) use live::seats_of;
pub use live::{Session, check_seats};
pub(crate) use score::others;
pub use score::{Score, ScoreRow};
pub use seat::Wish;
