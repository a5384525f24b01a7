//! Encounters 1 (EN1): a reproducible benchmark of planning among others that react.
//!
//! ```text
//! start -> run with the ego, run without it, the ego alone -> score of the start -> entry -> verified, and a row of the board
//! ```
//!
//! The score of a start compares what the others do with what they do in the same start without the ego, so that only delay and
//! braking that the ego causes count ([`score`]). A planner is a kind of driver, or another program that reads one line of JSON for
//! each plan and answers with one ([`observation`]).

mod board;
mod checks;
mod entry;
mod error;
pub mod formula;
pub mod observation;
mod people;
mod pipe;
mod planner;
pub mod score;
mod start;
mod trace;
mod verify;

pub use board::board;
pub use checks::with_checks;
pub use entry::{BenchEntry, EntryRun, Selection, run_entry};
pub use error::BenchError;
pub use people::{PEOPLE, people_digest};
pub use planner::{InputRow, PlannerSpec};
pub use start::Start;
pub use verify::{Verified, verify};
