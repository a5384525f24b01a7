//! Messages between pages and server, one JSON document each.

use interplay_presentation::stage::{Stage, StageFrame};
use interplay_scenarios::{Registry, embedded};
use serde::{Deserialize, Serialize};

use crate::session::{PlayGoal, Score, seats_of};
use crate::study::StudyPlace;

/// A message of a page.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum PageMessage {
    /// Starts a scenario in a seat.
    Start {
        /// The name of the scenario.
        scenario: String,
        /// The vehicle.
        seat: String,
    },
    /// Sets the controls of the person.
    Input {
        /// Number of the message.
        #[serde(default)]
        seq: u64,
        /// Share of the strongest braking (negative) or acceleration.
        acceleration: f64,
        /// Share of the largest steering angle, positive to the left.
        steering: f64,
        /// Whether the lane is kept automatically; steering then moves the vehicle sideways.
        #[serde(default)]
        assist: bool,
    },
    /// Pauses or resumes.
    Pause {
        /// Whether to pause.
        paused: bool,
    },
    /// Restarts the scenario.
    Restart,
    /// Rewinds.
    Rewind {
        /// Time to go back \[s\].
        seconds: f64,
    },
    /// Hands the wheel to a planner, or back to the person.
    HandOver {
        /// The kind of planner; `None` for the person.
        to: Option<String>,
    },
    /// Sets the rate of time.
    Rate {
        /// Simulated seconds per second.
        ratio: f64,
    },
    /// Restarts in another seat.
    Seat {
        /// The vehicle.
        seat: String,
    },
    /// Starts the next scenario of the menu.
    Next,
    /// Returns to the menu.
    Menu,
    /// Ends the run.
    End,
    /// The person agrees to take part in the study.
    Agree,
    /// The person leaves the study.
    Leave,
    /// Requests an answer, to measure the latency.
    Echo {
        /// Clock of the page \[ms\].
        at: f64,
    },
}

#[derive(Clone, Debug, Serialize)]
pub(crate) struct MenuScenario {
    pub name: String,
    pub title: String,
    pub shows: String,
    /// The vehicles that a person can drive.
    pub seats: Vec<String>,
}

#[derive(Clone, Debug, Serialize)]
pub(crate) struct MenuFamily {
    pub family: String,
    /// The title of the first scenario.
    pub title: String,
    pub scenarios: Vec<MenuScenario>,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct Chosen {
    pub scenario: String,
    pub seat: String,
}

/// A message of the server.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub(crate) enum ServerMessage {
    Menu {
        families: Vec<MenuFamily>,
        /// The scenario of the command line, or the present one.
        chosen: Option<Chosen>,
    },
    /// The world before the first tick.
    World {
        scenario: String,
        seat: String,
        /// The vehicles that a person can drive.
        seats: Vec<String>,
        #[serde(flatten)]
        stage: Box<Stage>,
        goal: PlayGoal,
        /// What the scenario shows.
        help: String,
        /// Initial states of the vehicles: x, y, heading and speed.
        states: Vec<[f64; 4]>,
        /// The kind of planner that takes the wheel if the person hands it over.
        co_driver: Option<&'static str>,
        /// The progress in a study, in which the page does not show the drivers.
        study: Option<StudyPlace>,
    },
    /// The state after a tick.
    Frame {
        tick: usize,
        /// Simulated time at its end \[s\].
        time_s: f64,
        /// The requested rate of time.
        real: f64,
        /// The actual rate of time, as a share of the requested one.
        dilation: f64,
        paused: bool,
        /// `you`, or the kind of planner at the wheel.
        driven_by: String,
        seat: String,
        /// The number of the last applied controls.
        ack: u64,
        #[serde(flatten)]
        stage_frame: Box<StageFrame>,
    },
    /// The score of a finished run.
    Score {
        #[serde(flatten)]
        score: Score,
        /// The path of the saved run.
        saved: Option<String>,
        /// The address of the animation of the run.
        animation: Option<String>,
    },
    /// In a study: before the first run, between two of them and after the last.
    Study {
        #[serde(flatten)]
        place: StudyPlace,
    },
    /// A request was refused.
    Refused { text: String },
    /// The server ends.
    Bye { text: String },
    /// The answer to an echo.
    Echo {
        /// Clock of the page \[ms\].
        at: f64,
    },
}

/// The scenarios with vehicles that a person can drive, by family.
#[derive(Clone, Debug)]
pub(crate) struct Menu {
    pub families: Vec<MenuFamily>,
}

impl Menu {
    /// The menu of the scenarios in the binary.
    pub fn of(registry: &Registry) -> Menu {
        let mut families: Vec<MenuFamily> = Vec::new();
        for file in embedded() {
            let Ok(scenario) = registry.load(file.name, &[]) else { continue };
            let seats = seats_of(&scenario);
            if seats.is_empty() {
                continue;
            }
            let family = file.name.split('/').next().unwrap_or(file.name);
            let entry =
                MenuScenario { name: file.name.to_owned(), title: scenario.title, shows: scenario.shows, seats };
            match families.last_mut().filter(|last| last.family == family) {
                Some(last) => last.scenarios.push(entry),
                None => families.push(MenuFamily {
                    family: family.to_owned(),
                    title: entry.title.clone(),
                    scenarios: vec![entry],
                }),
            }
        }
        Menu { families }
    }

    /// The scenario after the named one, and its first seat. The first scenario follows the last.
    pub fn after(&self, name: &str) -> Option<(String, String)> {
        let all: Vec<&MenuScenario> = self.families.iter().flat_map(|family| &family.scenarios).collect();
        let next = all.iter().position(|entry| entry.name == name).map_or(0, |place| (place + 1) % all.len());
        all.get(next).map(|entry| (entry.name.clone(), entry.seats[0].clone()))
    }
}
