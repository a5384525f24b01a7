//! Requests to the game, and its pages.

use interplay_scenarios::Scenario;
use tokio::sync::{mpsc, oneshot};

use crate::protocol::ServerMessage;
use crate::session::ScoreRow;

pub(super) enum Request {
    /// A page has connected; the game answers with its number.
    Join {
        seat: Option<String>,
        outgoing: mpsc::Sender<String>,
        number: oneshot::Sender<u64>,
    },
    Said {
        page: u64,
        text: String,
    },
    Leave {
        page: u64,
    },
    /// A page requests the animation of the run; the answer has the written and the played scenario.
    Animation {
        answer: oneshot::Sender<Option<[Scenario; 2]>>,
    },
    /// The measures of planners from the same start.
    Others {
        run: u64,
        rows: Vec<ScoreRow>,
    },
    Stop,
}

pub(super) struct PageAtGame {
    pub number: u64,
    /// The seat in its address.
    pub seat: Option<String>,
    outgoing: mpsc::Sender<String>,
}

impl PageAtGame {
    /// A page with a unique number.
    pub fn new(number: u64, seat: Option<String>, outgoing: mpsc::Sender<String>) -> PageAtGame {
        PageAtGame { number, seat, outgoing }
    }

    /// Queues a message. Returns false if the queue of the page is full or closed.
    pub fn send(&self, message: &ServerMessage) -> bool {
        let Ok(text) = serde_json::to_string(message) else { return true };
        self.outgoing.try_send(text).is_ok()
    }
}
