//! A person at the wheel.
//!
//! ```text
//! page -> wishes -> session: input at every plan -> Simulation::step -> moment -> page
//!                         \-> record of inputs -> a scenario that repeats the run, bit for bit
//! ```
//!
//! A [`Session`] is a run with people in it and knows no network: a script plays it as well ([`play_script`]). The server brings
//! wishes from pages to a session, and moments back.

mod kept;
mod menu;
mod protocol;
mod script;
mod server;
mod session;
mod study;

pub use kept::{keep, write};
pub use protocol::{PageMessage, ServerMessage};
pub use script::{ScriptError, ScriptLine, play_script, read_script};
pub use server::{PlayServer, ServeError, ServeOptions, StopPlay};
pub use session::{Score, ScoreRow, Session, SessionError, Wish, check_seats};
pub use study::{PlannedStudy, Study, StudyError, StudyPlace};
