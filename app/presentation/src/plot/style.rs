//! Colours and line styles of figures: the palette of everything that is drawn, and a dash pattern for each colour, so that
//! prints in grey are legible.

use super::backend::width_of;
use super::drawing::{Drawing, MEDIUM_TEXT_PX, Side};
use crate::palette;
pub use crate::palette::Colour;

/// Colour of text and axes.
pub const BLACK: Colour = [0x1A, 0x1A, 0x1A];
/// Colour of less important curves and marks.
pub const GREY: Colour = [0x80, 0x80, 0x80];
/// Colour of grid lines.
pub const PALE: Colour = [0xDD, 0xDD, 0xDD];
/// Colour of the header of tables.
pub const SURFACE: Colour = [0xEE, 0xEE, 0xEE];
/// Colour of the background.
pub const PAPER: Colour = [0xFF, 0xFF, 0xFF];
/// Colour of limits, and of the path of the ego as in the dissertation.
pub const VERMILLION: Colour = palette::VERMILLION.rgb;
/// Colour of the ego.
pub const ORANGE: Colour = palette::ORANGE.rgb;
/// Colour of the first of the other vehicles.
pub const BLUE: Colour = palette::BLUE.rgb;

/// The dash pattern of a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dash {
    /// A solid line.
    #[default]
    Solid,
    Long,
    Short,
    /// Long and short dashes in turn.
    Mixed,
}

impl Dash {
    /// Lengths of dashes and gaps in turn \[px\]; empty for a solid line.
    pub fn pattern(self) -> &'static [f64] {
        match self {
            Dash::Solid => &[],
            Dash::Long => &[14.0, 7.0],
            Dash::Short => &[4.0, 6.0],
            Dash::Mixed => &[16.0, 6.0, 4.0, 6.0],
        }
    }
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineStyle {
    pub colour: Colour,
    /// Dash pattern of the line.
    pub dash: Dash,
    /// Width of the line \[px\].
    pub width: u32,
}

impl LineStyle {
    /// A line of ordinary width.
    pub const fn new(colour: Colour, dash: Dash) -> LineStyle {
        LineStyle { colour, dash, width: 3 }
    }

    /// The same style with a thin line.
    pub const fn thin(self) -> LineStyle {
        LineStyle { width: 2, ..self }
    }
}

/// Style of a limit that must not be passed.
pub const LIMIT: LineStyle = LineStyle::new(VERMILLION, Dash::Short).thin();
/// Style of a reference or a prediction, drawn beside the actual value.
pub const WANTED: LineStyle = LineStyle::new(BLACK, Dash::Long).thin();

/// Line styles of several curves of one kind, which differ in colour and dashes; the sequence repeats after the last.
pub fn line_styles() -> impl Iterator<Item = LineStyle> {
    let line_styles = [
        LineStyle::new(ORANGE, Dash::Solid),
        LineStyle::new(BLUE, Dash::Long),
        LineStyle::new(palette::GREEN.rgb, Dash::Mixed),
        LineStyle::new(palette::PURPLE.rgb, Dash::Short),
        LineStyle::new(palette::SKY.rgb, Dash::Solid),
        LineStyle::new(palette::OLIVE.rgb, Dash::Long),
    ];
    line_styles.into_iter().cycle()
}

/// The sample of an entry of a legend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Sample {
    Line(LineStyle),
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
