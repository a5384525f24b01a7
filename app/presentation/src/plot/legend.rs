//! Legends: above the plots, where they hide nothing.

use super::drawing::{Drawing, MEDIUM, Side, width_of};
use super::style::{Colour, LineStyle};

/// What stands for a thing in a legend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Sample {
    /// A piece of its line.
    Line(LineStyle),
    /// A piece of its surface.
    Patch(Colour),
}

/// Height of a row of a legend \[px\].
const ROW: f64 = 34.0;
const SAMPLE: f64 = 46.0;
const GAP: f64 = 10.0;
const BETWEEN: f64 = 34.0;

/// The names of what a picture shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Legend {
    entries: Vec<(Sample, String)>,
}

impl Legend {
    /// Adds a name unless it is there already, or empty.
    pub fn add(&mut self, sample: Sample, name: &str) {
        if !name.is_empty() && self.entries.iter().all(|(_, known)| known != name) {
            self.entries.push((sample, name.to_owned()));
        }
    }

    /// Both together.
    pub fn with(mut self, other: &Legend) -> Legend {
        other.entries.iter().for_each(|(sample, name)| self.add(*sample, name));
        self
    }

    /// Whether two names have the same sample.
    pub fn is_ambiguous(&self) -> bool {
        let samples = || self.entries.iter().map(|(sample, _)| sample).enumerate();
        samples().any(|(index, sample)| samples().take(index).any(|(_, before)| before == sample))
    }

    /// Each entry with its row and where it begins, in a space that is `width` wide.
    fn places(&self, width: f64) -> Vec<(usize, f64)> {
        let (mut row, mut x) = (0, 0.0);
        let place = |(_, name): &(Sample, String)| {
            let wide = SAMPLE + GAP + width_of(name, MEDIUM);
            if x > 0.0 && x + wide > width {
                (row, x) = (row + 1, 0.0);
            }
            let place = (row, x);
            x += wide + BETWEEN;
            place
        };
        self.entries.iter().map(place).collect()
    }

    /// How high it is in a space that is `width` wide.
    pub fn height(&self, width: f64) -> f64 {
        self.places(width).last().map_or(0.0, |(row, _)| (row + 1) as f64 * ROW + GAP)
    }

    /// Draws it with its upper left corner at a place.
    pub fn draw(&self, drawing: &mut Drawing, [left, top]: [f64; 2], width: f64) {
        for ((sample, name), (row, x)) in self.entries.iter().zip(self.places(width)) {
            let (x, y) = (left + x, top + (row as f64 + 0.5) * ROW);
            match sample {
                Sample::Line(style) => drawing.line(vec![[x, y], [x + SAMPLE, y]], *style),
                Sample::Patch(colour) => drawing.block([x, y - 10.0], [x + SAMPLE, y + 10.0], *colour),
            }
            drawing.text([x + SAMPLE + GAP, y], Side::Left, MEDIUM, name.as_str());
        }
    }
}
