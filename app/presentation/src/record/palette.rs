//! The colours of recordings: those of the whole project, and of what only recordings draw.

use super::re_sdk_types::components::Color;
use crate::palette::{self, GREEN, ORANGE, PURPLE, SKY};

pub use crate::palette::{NamedColour, vehicle_colours};

/// Something went wrong: a plan that is only a fallback. Vermillion, which no vehicle has.
pub const FAILURE: NamedColour = palette::VERMILLION;
/// The surface of the road.
pub const ASPHALT: NamedColour = NamedColour { rgb: [0x2B, 0x2E, 0x33], word: "grey" };
/// Edges and lane markings.
pub const MARKING: NamedColour = NamedColour { rgb: [0xA8, 0xAC, 0xB3], word: "light grey" };
/// What belongs to nobody.
pub const NEUTRAL: NamedColour = NamedColour { rgb: [0xDD, 0xDD, 0xDD], word: "white" };
/// One more curve on a dark ground.
const YELLOW: NamedColour = NamedColour { rgb: [0xF0, 0xE4, 0x42], word: "yellow" };

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

/// Colours of a planner's numbers, by their place among those that share a panel.
pub fn series(index: usize) -> NamedColour {
    let palette = [GREEN, ORANGE, SKY, PURPLE, YELLOW, NEUTRAL, FAILURE];
    palette[index % palette.len()]
}
