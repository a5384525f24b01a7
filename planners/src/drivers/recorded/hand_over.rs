//! When a recorded vehicle gets a driver, and which.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::Record;
use crate::drivers::drive::{Drive, DriverKind};
use crate::drivers::human::Style;
use crate::drivers::{human, idm};
use crate::plan::certificate::touches_ahead;
use crate::{Agent, Body, Scene, Trajectory};

/// A driver looks this far ahead along the record, for real cars \[s\].
const LOOK_S: f64 = 2.5;
/// Space around others without which the record is not followed on, for real cars \[m\].
const SPACE_M: f64 = 0.5;
/// Who was never faster than this wants to be so fast, for real cars \[m/s\].
const LEAST_WANTED_MPS: f64 = 8.0;

/// Who takes over from a record, and when.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HandOver {
    /// The driver who takes over.
    #[schemars(example = json!("human"))]
    pub to: Successor,
    /// The style of a human who takes over; normal by default.
    #[serde(default)]
    #[schemars(example = &"nice")]
    pub style: Option<Style>,
    /// When: at a time \[s\], or `"disturbed"`: as soon as the record would lead into another vehicle within 2.5 s of a real car, which is
    /// expected to keep its speed.
    #[schemars(example = json!("disturbed"))]
    pub when: HandOverTime,
}

/// The kind of driver who takes over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Successor {
    /// A human.
    Human,
    /// The intelligent driver model.
    Idm,
}

/// When a record ends for its vehicle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum HandOverTime {
    /// At a time \[s\].
    At(#[schemars(range(min = 0.0))] f64),
    /// By the word `disturbed`: when a vehicle is in its way.
    Word(String),
}

/// The word for a record that would lead into another vehicle.
const DISTURBED: &str = "disturbed";

impl HandOver {
    /// Whether its time is a number or the word that there is.
    pub(super) fn is_sound(&self) -> bool {
        !matches!(&self.when, HandOverTime::Word(word) if word != DISTURBED)
    }

    /// Whether the driver takes over now; if a vehicle is in the way, with its name in words.
    pub(super) fn is_due(&self, record: &Record, scene: &Scene) -> Option<String> {
        let time_s = scene.step_s * scene.tick as f64;
        match &self.when {
            HandOverTime::At(at_s) => (time_s + 1e-9 >= *at_s).then(|| "its time has come".to_owned()),
            HandOverTime::Word(_) => {
                let other = disturbance(record, scene, time_s)?;
                Some(format!("{other} is in its way"))
            }
        }
    }

    /// The driver, who has not planned yet.
    pub(super) fn driver(&self, scene: &Scene) -> Box<dyn Drive> {
        let times = scene.ego.body.real_ratio().sqrt();
        match self.to {
            Successor::Human => {
                let style = Some(self.style.unwrap_or(Style::Normal));
                human::Settings { style, reaction_s: human::REACTION_S * times, ..human::Settings::default() }.driver()
            }
            Successor::Idm => idm::Settings::literature().scaled(scene.ego.body.real_ratio()).driver(),
        }
    }
}

/// The speed that a driver wants who takes over: the highest one of the record \[m/s\].
pub(super) fn wanted_mps(record: &Record, body: &Body) -> f64 {
    record.fastest_mps().max(LEAST_WANTED_MPS * body.real_ratio().sqrt())
}

/// Into whom the record would lead soon.
fn disturbance(record: &Record, scene: &Scene, time_s: f64) -> Option<String> {
    let ratio = scene.ego.body.real_ratio();
    let stages = ((LOOK_S * ratio.sqrt() / scene.step_s).round() as usize).clamp(1, scene.horizon.max(1));
    let states = (0..=stages).map_while(|stage| record.state_at(time_s + scene.step_s * stage as f64));
    let motion = Trajectory { states: states.collect(), ..Trajectory::default() };
    let inflated = |other: &Agent| {
        let Body { front_m, rear_m, width_m, .. } = other.body;
        let space_m = SPACE_M * ratio;
        let body =
            Body { front_m: front_m + space_m, rear_m: rear_m + space_m, width_m: width_m + space_m, ..other.body };
        Agent { body, ..other.clone() }
    };
    scene.others.iter().find(|other| touches_ahead(scene, &motion, &inflated(other))).map(|other| other.name.clone())
}
