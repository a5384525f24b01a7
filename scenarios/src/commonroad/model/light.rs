//! Traffic lights: a cycle of colours, in steps of time.

use interplay_planners::road::network::LightColour;

use super::super::xml::{Element, Unread};
use crate::text::error::Fault;

/// A traffic light.
pub(crate) struct Light {
    pub id: String,
    /// Its colours in order, each for a number of steps.
    pub phases: Vec<(LightColour, f64)>,
    /// When the first phase begins, in steps.
    pub offset: f64,
    /// Whether it works.
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
