//! Legends, which are drawn above the plots so that they cover no curves.

use super::backend::width_of;
use super::drawing::{Drawing, MEDIUM_TEXT_PX, Side};
use super::style::{Colour, LineStyle};

/// The sample of an entry of a legend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Sample {
    /// A line in its style.
    Line(LineStyle),
    /// A rectangle in its colour.
    Patch(Colour),
}

/// Height of a row of entries.
const ROW_HEIGHT_PX: f64 = 34.0;
/// Width of the sample of a line or surface.
const SAMPLE_WIDTH_PX: f64 = 46.0;
/// Space between a sample and its name, and below the legend.
const GAP_PX: f64 = 10.0;
/// Space between two entries in a row.
const ENTRY_SPACING_PX: f64 = 34.0;

/// The legend of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Legend {
    entries: Vec<(Sample, String)>,
}

impl Legend {
    /// Adds an entry unless its name is empty or already there.
    pub fn add(&mut self, sample: Sample, name: &str) {
        if !name.is_empty() && self.entries.iter().all(|(_, known)| known != name) {
            self.entries.push((sample, name.to_owned()));
        }
    }

    /// This legend with the names of another one added.
    pub fn with(mut self, other: &Legend) -> Legend {
        other.entries.iter().for_each(|(sample, name)| self.add(*sample, name));
        self
    }

    /// Whether two names have the same sample.
    pub fn is_ambiguous(&self) -> bool {
        let samples = || self.entries.iter().map(|(sample, _)| sample).enumerate();
        samples().any(|(index, sample)| samples().take(index).any(|(_, before)| before == sample))
    }

    /// The row and the x coordinate of each entry, if the width is at most `width` pixels.
    fn places(&self, width: f64) -> Vec<(usize, f64)> {
        let (mut row, mut x) = (0, 0.0);
        let place = |(_, name): &(Sample, String)| {
            let wide = SAMPLE_WIDTH_PX + GAP_PX + width_of(name, MEDIUM_TEXT_PX);
            if x > 0.0 && x + wide > width {
                (row, x) = (row + 1, 0.0);
            }
            let place = (row, x);
            x += wide + ENTRY_SPACING_PX;
            place
        };
        self.entries.iter().map(place).collect()
    }

    /// Height of the legend in pixels if its width is at most `width`.
    pub fn height(&self, width: f64) -> f64 {
        self.places(width).last().map_or(0.0, |(row, _)| (row + 1) as f64 * ROW_HEIGHT_PX + GAP_PX)
    }

    /// Draws the legend with its upper left corner at the given place.
    pub fn draw(&self, drawing: &mut Drawing, [left, top]: [f64; 2], width: f64) {
        for ((sample, name), (row, x)) in self.entries.iter().zip(self.places(width)) {
            let (x, y) = (left + x, top + (row as f64 + 0.5) * ROW_HEIGHT_PX);
            match sample {
                Sample::Line(style) => drawing.line(vec![[x, y], [x + SAMPLE_WIDTH_PX, y]], *style),
                Sample::Patch(colour) => drawing.block([x, y - 10.0], [x + SAMPLE_WIDTH_PX, y + 10.0], *colour),
            }
            drawing.text([x + SAMPLE_WIDTH_PX + GAP_PX, y], Side::Left, MEDIUM_TEXT_PX, name.as_str());
        }
    }
}
