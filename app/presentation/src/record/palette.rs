//! Who is drawn in which colour: the palette of Okabe and Ito, which survives colour blindness.

use super::re_sdk_types::components::Color;
use interplay_scenarios::Scenario;

/// The ego, orange.
const EGO: [u8; 3] = [0xE6, 0x9F, 0x00];

/// The others in the scenario's order; who comes later starts again.
const OTHERS: [([u8; 3], &str); 5] = [
    ([0x56, 0xB4, 0xE9], "sky blue"),
    ([0xCC, 0x79, 0xA7], "purple"),
    ([0x00, 0x9E, 0x73], "green"),
    ([0xF0, 0xE4, 0x42], "yellow"),
    ([0x3B, 0x8F, 0xE0], "blue"),
];

/// Something went wrong: a plan that is only a fallback. Vermillion, which no vehicle has.
pub const FAILURE: NamedColour = NamedColour { rgb: [0xD5, 0x5E, 0x00], word: "vermillion" };
/// The surface of the road.
pub const ASPHALT: NamedColour = NamedColour { rgb: [0x2B, 0x2E, 0x33], word: "grey" };
/// Edges and lane markings.
pub const MARKING: NamedColour = NamedColour { rgb: [0xA8, 0xAC, 0xB3], word: "light grey" };
/// What belongs to nobody.
pub const NEUTRAL: NamedColour = NamedColour { rgb: [0xDD, 0xDD, 0xDD], word: "white" };

/// A colour with the word that a legend uses for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NamedColour {
    rgb: [u8; 3],
    /// What people call it.
    pub word: &'static str,
}

impl NamedColour {
    /// The colour, opaque.
    pub fn solid(self) -> Color {
        self.veiled(0xFF)
    }

    /// The colour, letting through what lies below; `opacity` 255 is opaque.
    pub fn veiled(self, opacity: u8) -> Color {
        let [red, green, blue] = self.rgb;
        Color::from_unmultiplied_rgba(red, green, blue, opacity)
    }

    /// A darker shade of the colour, opaque.
    pub fn dark(self) -> Color {
        let [red, green, blue] = self.rgb.map(|part| part / 5 * 2);
        Color::from_rgb(red, green, blue)
    }
}

/// One colour a vehicle, in the scenario's order.
pub fn vehicle_colours(scenario: &Scenario) -> Vec<NamedColour> {
    let ego = scenario.ego_index();
    let mut others = OTHERS.iter().cycle();
    (0..scenario.vehicles.len())
        .map(|index| match (index == ego, others.clone().next()) {
            (false, Some(&(rgb, word))) => {
                others.next();
                NamedColour { rgb, word }
            }
            _ => NamedColour { rgb: EGO, word: "orange" },
        })
        .collect()
}

/// Colours of a planner's numbers, by their place among those that share a panel.
pub fn series(index: usize) -> NamedColour {
    let palette = [
        NamedColour { rgb: [0x00, 0x9E, 0x73], word: "green" },
        NamedColour { rgb: EGO, word: "orange" },
        NamedColour { rgb: [0x56, 0xB4, 0xE9], word: "sky blue" },
        NamedColour { rgb: [0xCC, 0x79, 0xA7], word: "purple" },
        NamedColour { rgb: [0xF0, 0xE4, 0x42], word: "yellow" },
        NEUTRAL,
        FAILURE,
    ];
    palette[index % palette.len()]
}
