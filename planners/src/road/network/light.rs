//! Traffic lights at the ends of lanes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

/// What a traffic light shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LightColour {
    /// No vehicle passes.
    #[default]
    Red,
    /// Green comes at once; no vehicle passes yet.
    RedAmber,
    /// Red comes at once: a vehicle that can stop in comfort stops.
    Amber,
    /// Free, with regard to those who go first.
    Green,
    /// It is switched off: the sign at the end of the lane counts.
    Off,
}

/// A part of the cycle of a traffic light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LightPhase {
    /// What it shows to those who come to it.
    #[schemars(example = json!("green"))]
    pub colour: LightColour,
    /// For how long \[s\].
    #[schemars(range(min = 0.001, max = 10_000.0), example = 20.0)]
    pub duration_s: f64,
}

/// The cycle of a traffic light: phases that follow each other for ever.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LightCycle {
    /// The phases, in order; a light without any is off.
    pub phases: Vec<LightPhase>,
    /// When the first phase begins; cycles before it count, too \[s\].
    pub offset_s: f64,
}

/// Times that differ by less are equal \[s\].
const TIME_TOLERANCE_S: f64 = 1e-9;

impl LightCycle {
    /// The colour of the light at a time \[s\].
    pub fn colour_at(&self, time_s: f64) -> LightColour {
        let cycle_s: f64 = self.phases.iter().map(|phase| phase.duration_s).sum();
        if cycle_s <= 0.0 {
            return LightColour::Off;
        }
        let mut left_s = (time_s - self.offset_s + TIME_TOLERANCE_S).rem_euclid(cycle_s);
        for phase in &self.phases {
            if left_s < phase.duration_s {
                return phase.colour;
            }
            left_s -= phase.duration_s;
        }
        self.phases.last().map_or(LightColour::Off, |phase| phase.colour)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_phases_of_a_traffic_light_repeat() {
        let phase = |colour, duration_s| LightPhase { colour, duration_s };
        use LightColour::{Amber, Green, Red};
        let phases = vec![phase(Green, 10.0), phase(Amber, 3.0), phase(Red, 12.0)];
        let light = LightCycle { phases, offset_s: 4.0 };
        let colours = [4.0, 13.9, 14.0, 17.0, 28.9, 29.0, 3.9, 0.0].map(|time_s| light.colour_at(time_s));
        assert_eq!(colours, [Green, Green, Amber, Red, Red, Green, Red, Red]);
        assert_eq!(LightCycle::default().colour_at(1.0), LightColour::Off);
    }
}
