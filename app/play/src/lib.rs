//! Driving in a browser: a person drives a vehicle of a scenario, and the run is saved as a scenario that repeats it.
//!
//! ```text
//! page -> controls -> session: input at every plan -> Simulation::step -> frame -> page
//!                         \-> record of inputs -> a scenario that repeats the run, bit for bit
//! ```
//!
//! A [`Session`] is a run with people in some seats. It does not depend on the network, so a script can play it as well
//! ([`play_script`]). The server passes controls from pages to a session, and frames back.

#![allow(missing_docs, reason = "only this workspace uses the crate; a comment says what a name and its type do not")]

mod protocol;
mod script;
mod server;
mod session;
mod study;

pub use protocol::PageMessage;
pub use script::{ScriptError, ScriptLine, play_script, read_script, save_played, write_played};
pub use server::{PlayServer, ServeError, ServeOptions, StopPlay};
pub use session::{Controls, Score, ScoreRow, Session, SessionError, check_seats};
pub use study::{PlannedStudy, Study, StudyError, StudyPlace};
