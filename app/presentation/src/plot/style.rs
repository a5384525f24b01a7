//! Colours and line styles of figures: the palette of everything that is drawn, and a dash pattern for each colour, so that
//! prints in grey are legible.

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
    /// Long dashes.
    Long,
    /// Short dashes.
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
