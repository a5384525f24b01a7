//! Traffic signs.

use interplay_planners::road::network::LightColour;

use super::super::xml::{Element, Unread};
use crate::text::error::Fault;

/// A traffic sign, which may have several parts.
pub(crate) struct Sign {
    pub id: String,
    pub meanings: Vec<SignMeaning>,
}

/// The meaning of a sign for drivers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum SignMeaning {
    /// No faster than this \[m/s\].
    SpeedLimit(f64),
    /// Stop, and give way.
    Stop,
    /// Every approach has a stop sign.
    AllWayStop,
    /// Give way.
    Yield,
    /// Others give way.
    Priority,
    /// Something else, by the number of the sign.
    Other(String),
}

/// Speed limits by country, by the sign numbers of its law.
const SPEED_LIMITS: [&str; 5] = ["274", "274.1", "R2-1", "r301", "C14"];
const STOPS: [&str; 3] = ["206", "R1-1", "r2"];
/// The plaque below the stop signs of an all-way stop, by its number in the United States and its names in CommonRoad.
const ALL_WAY_STOPS: [&str; 2] = ["R1-3", "R1-3P"];
const YIELDS: [&str; 3] = ["205", "R1-2", "r1"];
const PRIORITIES: [&str; 3] = ["301", "306", "r3"];
/// The largest number on a sign that is read as metres per second.
const MAX_LIMIT_MPS: f64 = 100.0;

impl Sign {
    pub(super) fn read(element: Element<'_>) -> Result<Sign, Fault> {
        let meanings = element.children("trafficSignElement").map(|element| {
            let number = element.child("trafficSignID").map_or("", |number| number.text());
            let value: Option<f64> = element.child("additionalValue").and_then(|value| value.text().parse().ok());
            let limit = value.filter(|limit| *limit > 0.0 && *limit <= MAX_LIMIT_MPS);
            match (limit, number) {
                (Some(limit_mps), number) if SPEED_LIMITS.contains(&number) => SignMeaning::SpeedLimit(limit_mps),
                (_, number) if STOPS.contains(&number) => SignMeaning::Stop,
                (_, number) if ALL_WAY_STOPS.contains(&number) => SignMeaning::AllWayStop,
                (_, number) if YIELDS.contains(&number) => SignMeaning::Yield,
                (_, number) if PRIORITIES.contains(&number) => SignMeaning::Priority,
                (_, number) => SignMeaning::Other(number.to_owned()),
            }
        });
        Ok(Sign { id: element.required_attribute("id")?.to_owned(), meanings: meanings.collect() })
    }
}

pub(crate) struct Light {
    pub id: String,
    /// Its colours in order, each for a number of steps.
    pub phases: Vec<(LightColour, f64)>,
    /// When the first phase begins, in steps.
    pub offset: f64,
    pub is_active: bool,
}

impl Light {
    const READ: [&'static str; 5] = ["cycle", "position", "direction", "active", "color"];

    pub(super) fn read(element: Element<'_>, unread: &mut Unread) -> Result<Light, Fault> {
        let cycle = element.child("cycle");
        let elements = cycle.iter().flat_map(|cycle| cycle.children("cycleElement"));
        let phase = |element: Element<'_>| -> Result<(LightColour, f64), Fault> {
            let colour = element.required("color")?;
            let shown = match colour.text() {
                "red" => LightColour::Red,
                "redYellow" => LightColour::RedAmber,
                "yellow" => LightColour::Amber,
                "green" => LightColour::Green,
                "inactive" => LightColour::Off,
                other => return Err(colour.fault("no colour", format!("a traffic light shows {other:?}"))),
            };
            Ok((shown, element.required("duration")?.number()?))
        };
        let phases = elements.map(phase).collect::<Result<Vec<_>, Fault>>()?;
        let offset = cycle.and_then(|cycle| cycle.child("timeOffset")).map(|offset| offset.number()).transpose()?;
        unread.count_beyond(element, &Light::READ);
        Ok(Light {
            id: element.required_attribute("id")?.to_owned(),
            phases,
            offset: offset.unwrap_or(0.0),
            is_active: element.child("active").is_none_or(|active| active.text() != "false"),
        })
    }
}
