//! A footprint: a filled rectangle with a windscreen and a number.

use super::super::drawing::{Drawing, SMALL_TEXT_PX, Side, width_of};
use super::super::style::{BLACK, Colour, Dash, LineStyle, PAPER};
use super::data::distance;

/// Draws a footprint; corners are in pixels, in the order of [`super::data::FootprintSnapshot::bodies`].
pub(super) fn draw(drawing: &mut Drawing, corners: [[f64; 2]; 4], colour: Colour, opacity: f64) {
    let [front_right, front_left, rear_right, rear_left] = corners;
    let ring = vec![front_right, front_left, rear_left, rear_right];
    drawing.fill(ring.clone(), colour, opacity);
    let edge = LineStyle { width: 1, ..LineStyle::new(BLACK, Dash::Solid) };
    drawing.line(ring.into_iter().chain([front_right]).collect(), edge);
    let between = |a: [f64; 2], b: [f64; 2]| [a[0] + 0.15 * (b[0] - a[0]), a[1] + 0.15 * (b[1] - a[1])];
    let screen = vec![between(front_right, rear_right), between(front_left, rear_left)];
    drawing.line(screen, edge.thin());
}

/// Black or white, whichever is better read on a colour.
fn readable_on([red, green, blue]: Colour) -> Colour {
    let bright = 0.299 * f64::from(red) + 0.587 * f64::from(green) + 0.114 * f64::from(blue);
    if bright > 125.0 { BLACK } else { PAPER }
}

/// Writes words to the right or the left of a footprint; where it lies, below or above it.
pub(super) fn number_beside(drawing: &mut Drawing, corners: [[f64; 2]; 4], right: bool, words: &str) {
    let middle = |axis: usize| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 4.0;
    let end =
        |axis: usize, sign: f64| corners.iter().map(|corner| sign * corner[axis]).fold(f64::NEG_INFINITY, f64::max);
    let lies = (corners[0][0] - corners[2][0]).abs() > (corners[0][1] - corners[2][1]).abs();
    match (lies, right) {
        (true, true) => {
            drawing.text([middle(0), end(1, 1.0) + 0.5 * SMALL_TEXT_PX], Side::Middle, SMALL_TEXT_PX, words)
        }
        (true, false) => {
            drawing.text([middle(0), -end(1, -1.0) - 0.45 * SMALL_TEXT_PX], Side::Middle, SMALL_TEXT_PX, words)
        }
        (false, true) => drawing.text([end(0, 1.0) + 4.0, middle(1)], Side::Left, SMALL_TEXT_PX, words),
        (false, false) => drawing.text([-end(0, -1.0) - 4.0, middle(1)], Side::Right, SMALL_TEXT_PX, words),
    }
}

/// Writes words onto a footprint if they fit, otherwise above it.
pub(super) fn number(drawing: &mut Drawing, corners: [[f64; 2]; 4], colour: Colour, words: &str) {
    let middle = |axis: usize| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 4.0;
    let (length, width) = (distance(corners[0], corners[2]), distance(corners[0], corners[1]));
    let lies = (corners[0][0] - corners[2][0]).abs() > (corners[0][1] - corners[2][1]).abs();
    let [across, upwards] = if lies { [length, width] } else { [width, length] };
    let fits = width_of(words, SMALL_TEXT_PX) < 0.85 * across && 0.8 * SMALL_TEXT_PX < upwards;
    let above = corners.iter().map(|corner| corner[1]).fold(f64::INFINITY, f64::min) - 0.45 * SMALL_TEXT_PX;
    let beside = corners.iter().map(|corner| corner[0]).fold(f64::NEG_INFINITY, f64::max) + 4.0;
    match (fits, lies) {
        (true, _) => {
            drawing.coloured_text([middle(0), middle(1)], Side::Middle, SMALL_TEXT_PX, words, readable_on(colour))
        }
        (false, true) => drawing.text([middle(0), above], Side::Middle, SMALL_TEXT_PX, words),
        (false, false) => drawing.text([beside, middle(1)], Side::Left, SMALL_TEXT_PX, words),
    }
}
