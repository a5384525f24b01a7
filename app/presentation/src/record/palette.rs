//! The colours of recordings: those of the whole project, and additional ones that only recordings need.

use super::re_sdk_types::components::Color;
use crate::palette::{self, ASPHALT, Colour, GREEN, ORANGE, PURPLE, SKY};

pub use crate::palette::{NamedColour, vehicle_colours};

/// Colour of failures, such as a fallback plan: vermillion, which no vehicle has.
pub const FAILURE: NamedColour = palette::VERMILLION;
/// Colour of the bounds of the comfort band.
pub const MARKING: NamedColour = NamedColour { rgb: [0xA8, 0xAC, 0xB3], word: "light grey" };
/// Colour of marks that belong to no vehicle or zone.
pub const NEUTRAL: NamedColour = NamedColour { rgb: [0xDD, 0xDD, 0xDD], word: "white" };
/// One more curve on a dark ground.
const YELLOW: NamedColour = NamedColour { rgb: [0xF0, 0xE4, 0x42], word: "yellow" };

impl NamedColour {
    /// The colour, opaque.
    pub fn solid(self) -> Color {
        self.translucent(0xFF)
    }

    /// The translucent colour; `opacity` 255 is opaque.
    pub fn translucent(self, opacity: u8) -> Color {
        let [red, green, blue] = self.rgb;
        Color::from_unmultiplied_rgba(red, green, blue, opacity)
    }

    /// A lighter shade, for words on a dark ground.
    pub fn for_labels(self) -> Color {
        opaque(self.rgb.map(|part| part.saturating_add((0xFF - part) / 4 * 3)))
    }

    /// The colour mixed with that of the road, opaque; `share` 1 is the colour itself.
    pub fn on_asphalt(self, share: f64) -> Color {
        let mixed = |part: usize| share * f64::from(self.rgb[part]) + (1.0 - share) * f64::from(ASPHALT[part]);
        opaque([0, 1, 2].map(|part| mixed(part).round() as u8))
    }
}

/// A colour for the viewer.
pub fn opaque([red, green, blue]: Colour) -> Color {
    Color::from_rgb(red, green, blue)
}

/// Colours of zones, in their order; they repeat after the last.
pub fn zone(index: usize) -> NamedColour {
    [GREEN, ORANGE, SKY, PURPLE, YELLOW][index % 5]
}

/// Colours of the quantities of a planner, by their index in their panel.
pub fn series(index: usize) -> NamedColour {
    let palette = [GREEN, ORANGE, SKY, PURPLE, YELLOW, NEUTRAL, FAILURE];
    palette[index % palette.len()]
}
