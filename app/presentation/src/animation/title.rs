//! The bar above every picture: what is shown on the left, and when on the right.

use super::camera::WIDTH_PX;
use super::canvas::{Align, Canvas};
use super::letters::cut;
use crate::palette::Colour;

/// Colours of the bars above and below, and of the words on them.
pub const BAR: Colour = [0x23, 0x26, 0x2B];
pub const WORDS: Colour = [0xF2, 0xF2, 0xEE];
/// Height of the bar above \[px\].
pub const TITLE_PX: f64 = 30.0;
/// Size of words \[px\].
pub const TEXT_PX: f64 = 16.0;
/// Space beside words \[px\].
pub const MARGIN_PX: f64 = 12.0;

/// Draws the bar; the title is cut at `longest_px`.
pub fn draw_title(canvas: &mut Canvas, title: &str, longest_px: f64, clock: &str) {
    canvas.block([0.0, 0.0], [WIDTH_PX, TITLE_PX], BAR);
    let y = 0.5 * TITLE_PX;
    canvas.text([WIDTH_PX - MARGIN_PX, y], Align::Right, TEXT_PX, clock, WORDS);
    canvas.text([MARGIN_PX, y], Align::Left, TEXT_PX, &cut(title, TEXT_PX, longest_px), WORDS);
}
