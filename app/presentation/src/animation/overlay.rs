//! Marks over every picture: the title bar, and arrows at the edge toward vehicles out of view.

use super::camera::{CameraView, WIDTH_PX};
use super::canvas::{Align, Canvas, Ink};
use super::letters::{cut, width_of};
use crate::edge_mark::EdgeMark;
use crate::palette::Colour;
use crate::rectangle::{Rectangle, overlap};

/// Colours of the bars above and below, and of the words on them.
pub const BAR: Colour = [0x23, 0x26, 0x2B];
pub const WORDS: Colour = [0xF2, 0xF2, 0xEE];
/// Height of the bar above \[px\].
pub const TITLE_PX: f64 = 30.0;
/// Size of words \[px\].
pub const TEXT_PX: f64 = 16.0;
/// Space beside words \[px\].
pub const MARGIN_PX: f64 = 12.0;

/// Draws the title bar; the title is cut at `longest_px`.
pub fn draw_title(canvas: &mut Canvas, title: &str, longest_px: f64, clock: &str) {
    canvas.block([0.0, 0.0], [WIDTH_PX, TITLE_PX], BAR);
    let y = 0.5 * TITLE_PX;
    canvas.text([WIDTH_PX - MARGIN_PX, y], Align::Right, TEXT_PX, clock, WORDS);
    canvas.text([MARGIN_PX, y], Align::Left, TEXT_PX, &cut(title, TEXT_PX, longest_px), WORDS);
}

/// Length of an arrow and size of its words \[px\].
const ARROW_PX: f64 = 16.0;
const LABEL_PX: f64 = 14.0;
/// Space between an arrow and its words \[px\].
const BETWEEN_PX: f64 = 6.0;

/// Draws a mark in the colour of its vehicle, with words that avoid the `taken` rectangles if possible. Returns the rectangle of
/// the words.
pub fn draw_edge_mark(
    canvas: &mut Canvas,
    view: &CameraView,
    mark: &EdgeMark,
    colour: Colour,
    taken: &[Rectangle],
) -> Rectangle {
    let [dx, dy] = mark.toward;
    let point = |ahead: f64, left: f64| [mark.at[0] + ahead * dx - left * dy, mark.at[1] + ahead * dy + left * dx];
    let arrow = |half: f64| [point(half, 0.0), point(-half, 0.85 * half), point(-half, -0.85 * half)];
    canvas.fill(&arrow(0.5 * ARROW_PX + 3.0), WORDS);
    canvas.fill(&arrow(0.5 * ARROW_PX), colour);
    let (wide, high) = (width_of(&mark.words, LABEL_PX) + 10.0, LABEL_PX + 4.0);
    let away = 0.5 * ARROW_PX + BETWEEN_PX;
    let middle = [mark.at[0] - dx * (away + 0.5 * wide), mark.at[1] - dy * (away + 0.5 * high)];
    let half = [0.5 * wide + 2.0, 0.5 * high + 2.0];
    // The label lies between the arrow and the middle of the view or, if that is taken, above or below.
    let place = |beside: f64| {
        let wanted = [middle[0], middle[1] + beside * (high + 8.0)];
        let inside = |axis: usize| wanted[axis].clamp(half[axis], (view.size_px[axis] - half[axis]).max(half[axis]));
        let [x, y] = [inside(0), inside(1)];
        [x - 0.5 * wide, y - 0.5 * high, x + 0.5 * wide, y + 0.5 * high]
    };
    let is_free = |place: &Rectangle| !taken.iter().any(|other| overlap(*place, *other));
    let places = [0.0, -1.0, 1.0, -2.0, 2.0].map(place);
    let [l, t, r, b] = places.into_iter().find(is_free).unwrap_or(places[0]);
    canvas.fill_rounded(&[[l, t], [r, t], [r, b], [l, b]], 5.0, Ink::translucent(BAR, 0.82));
    canvas.text([0.5 * (l + r), 0.5 * (t + b)], Align::Middle, LABEL_PX, &mark.words, WORDS);
    [l, t, r, b]
}
