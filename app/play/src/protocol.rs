//! What pages and server say to each other: one JSON document a message.

use interplay_presentation::stage::{Stage, StageMoment};
use serde::{Deserialize, Serialize};

use crate::session::{PlayGoal, Score};
use crate::study::StudyPlace;

/// What a page says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum PageMessage {
    /// A scenario and a seat were chosen.
    Start {
        /// The name of the scenario.
        scenario: String,
        /// The vehicle.
        seat: String,
    },
    /// What the person wishes from now on.
    Input {
        /// The number of the message.
        #[serde(default)]
        seq: u64,
        /// Share of the strongest braking (negative) or acceleration.
        acceleration: f64,
        /// Share of the largest steering angle, positive to the left.
        steering: f64,
        /// Whether the lane is kept, and steering is a wish to change sideways.
        #[serde(default)]
        assist: bool,
    },
    /// Time stands still, or goes on.
    Pause {
        /// Whether it stands still.
        paused: bool,
    },
    /// The same start again.
    Restart,
    /// Some seconds back.
    Rewind {
        /// How many.
        seconds: f64,
    },
    /// A planner takes the wheel, or the person again.
    HandOver {
        /// The kind of planner; without it the person.
        to: Option<String>,
    },
    /// How fast time passes: 1 is as it is.
    Rate {
        /// Simulated seconds in a second.
        ratio: f64,
    },
    /// Another seat, from the start again.
    Seat {
        /// The vehicle.
        seat: String,
    },
    /// The next scenario of the list.
    Next,
    /// Back to the menu.
    Menu,
    /// The run ends here.
    End,
    /// A person agrees to take part in the study.
    Agree,
    /// A person takes part no longer.
    Leave,
    /// Asks for an answer, to measure how long that takes.
    Echo {
        /// The page's clock \[ms\].
        at: f64,
    },
}

/// A scenario of the menu.
#[derive(Clone, Debug, Serialize)]
pub struct MenuScenario {
    /// Its name.
    pub name: String,
    /// Its title.
    pub title: String,
    /// What it shows.
    pub shows: String,
    /// The vehicles that a person can drive.
    pub seats: Vec<String>,
}

/// A family of the menu.
#[derive(Clone, Debug, Serialize)]
pub struct MenuFamily {
    /// Its name.
    pub family: String,
    /// Its first scenario's title.
    pub title: String,
    /// Its scenarios.
    pub scenarios: Vec<MenuScenario>,
}

/// A scenario and a seat.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Chosen {
    /// The name of the scenario.
    pub scenario: String,
    /// The vehicle.
    pub seat: String,
}

/// What the server says.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum ServerMessage {
    /// What there is to be played.
    Menu {
        /// The families of scenarios.
        families: Vec<MenuFamily>,
        /// What was asked for on the command line, or is being played.
        chosen: Option<Chosen>,
    },
    /// A world before its first tick.
    World {
        /// The name of the scenario.
        scenario: String,
        /// The vehicle of this page.
        seat: String,
        /// The vehicles that a person can drive.
        seats: Vec<String>,
        /// What is drawn.
        #[serde(flatten)]
        stage: Box<Stage>,
        /// What the seat wants.
        goal: PlayGoal,
        /// The same as a sentence.
        help: String,
        /// Where the vehicles start: x, y, heading and speed.
        states: Vec<[f64; 4]>,
        /// The kind of planner that takes the wheel if the person hands it over.
        co_driver: Option<&'static str>,
        /// In a study, where in it the person is: nothing is told of who drives how.
        study: Option<StudyPlace>,
    },
    /// A tick.
    Frame {
        /// Its number.
        tick: usize,
        /// Simulated time at its end \[s\].
        time_s: f64,
        /// Simulated seconds that a second should have.
        real: f64,
        /// Simulated seconds that the last seconds had, as a share of that.
        dilation: f64,
        /// Whether time stands still.
        paused: bool,
        /// `you`, or the kind of planner that has the wheel.
        driven_by: String,
        /// The vehicle of this page.
        seat: String,
        /// The number of the last input that was applied.
        ack: u64,
        /// What is seen.
        #[serde(flatten)]
        moment: Box<StageMoment>,
    },
    /// How it went.
    Score {
        /// The person's run beside those of planners.
        #[serde(flatten)]
        score: Score,
        /// Where what was played is kept.
        saved: Option<String>,
        /// The moving picture of the run.
        animation: Option<String>,
    },
    /// In a study: before the first run, between two of them and after the last.
    Study {
        /// Where in it the person is.
        #[serde(flatten)]
        place: StudyPlace,
    },
    /// A request that is not possible.
    Refused {
        /// Why.
        text: String,
    },
    /// The server ends.
    Bye {
        /// Why.
        text: String,
    },
    /// The answer to an echo.
    Echo {
        /// The page's clock \[ms\].
        at: f64,
    },
}
