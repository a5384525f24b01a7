//! What the game is asked for, and the pages that ask.

use interplay_scenarios::Scenario;
use tokio::sync::{mpsc, oneshot};

use crate::protocol::ServerMessage;
use crate::session::ScoreRow;

/// What the game is asked for.
pub(super) enum Request {
    /// A page is there; it is told its number.
    Join { seat: Option<String>, outgoing: mpsc::Sender<String>, number: oneshot::Sender<u64> },
    /// A page says something.
    Said { page: u64, text: String },
    /// A page is gone.
    Leave { page: u64 },
    /// Somebody wants the moving picture of the run: the scenario as it is written, and as it was played.
    Animation { answer: oneshot::Sender<Option<[Scenario; 2]>> },
    /// Planners have driven from the same start.
    Others { run: u64, rows: Vec<ScoreRow> },
    /// The server ends.
    Stop,
}

/// A page.
pub(super) struct PageAtGame {
    pub number: u64,
    /// The seat that its address names.
    pub seat: Option<String>,
    outgoing: mpsc::Sender<String>,
}

impl PageAtGame {
    /// A page with a number of its own.
    pub fn new(number: u64, seat: Option<String>, outgoing: mpsc::Sender<String>) -> PageAtGame {
        PageAtGame { number, seat, outgoing }
    }

    /// Sends a message; a page for whom too many wait is gone.
    pub fn send(&self, message: &ServerMessage) -> bool {
        let Ok(text) = serde_json::to_string(message) else { return true };
        // A tick that does not arrive is followed by others; what else does not arrive would be missing.
        self.outgoing.try_send(text).is_ok()
    }
}
