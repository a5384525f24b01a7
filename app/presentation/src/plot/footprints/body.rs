//! A footprint: the body of a vehicle with its windows, and a number.

use super::super::backend::width_of;
use super::super::drawing::{Drawing, SMALL_TEXT_PX, Side};
use super::super::style::{BLACK, Colour, Dash, LineStyle, PAPER};
use super::data::distance;
use crate::body::{BodyPaint, BodyPart, BodyStyle, body_parts};
use crate::rectangle::rounded_corners;

const CORNER_POINTS: usize = 5;
/// Opacity of the windows of a pale footprint, so that its number can be read on them.
const PALE_GLASS_OPACITY: f64 = 0.2;

/// Draws a footprint; corners are in pixels, in the order of [`super::data::FootprintSnapshot::bodies`].
pub(super) fn draw(drawing: &mut Drawing, corners: [[f64; 2]; 4], style: BodyStyle, colour: Colour, opacity: f64) {
    let [front_right, front_left, rear_right, rear_left] = corners;
    let width_px = distance(front_right, front_left);
    let place = |[along, across]: [f64; 2]| {
        let weights = [(1.0 + along) * (1.0 - across), (1.0 + along) * (1.0 + across), (1.0 - along) * (1.0 - across)];
        let rest = (1.0 - along) * (1.0 + across);
        [0, 1].map(|axis| {
            let ahead = weights[0] * front_right[axis] + weights[1] * front_left[axis];
            0.25 * (ahead + weights[2] * rear_right[axis] + rest * rear_left[axis])
        })
    };
    for (index, BodyPart { ring, radius, paint }) in body_parts(style).into_iter().enumerate() {
        let ring: Vec<[f64; 2]> = ring.into_iter().map(place).collect();
        let ring = rounded(&ring, radius * width_px);
        let is_pale_glass = paint == BodyPaint::Glass && opacity < 1.0;
        let opacity = if is_pale_glass { PALE_GLASS_OPACITY } else { opacity };
        drawing.fill(ring.clone(), paint.colour(colour), opacity);
        if index == 0 {
            let edge = LineStyle { width: 1, ..LineStyle::new(BLACK, Dash::Solid) };
            drawing.line(ring.iter().chain(&ring[..1]).copied().collect(), edge);
        }
    }
}

/// A polygon whose corners are curves of some points.
fn rounded(ring: &[[f64; 2]], radius: f64) -> Vec<[f64; 2]> {
    let curve = |[start, here, end]: [[f64; 2]; 3]| {
        (0..CORNER_POINTS).map(move |point| {
            let t = point as f64 / (CORNER_POINTS - 1) as f64;
            [0, 1].map(|axis| {
                let (first, last) = ((1.0 - t) * start[axis], t * end[axis]);
                (1.0 - t) * first + 2.0 * t * (1.0 - t) * here[axis] + t * last
            })
        })
    };
    rounded_corners(ring, radius).flat_map(curve).collect()
}

/// Black or white, whichever is more legible on a colour.
fn readable_on([red, green, blue]: Colour) -> Colour {
    let bright = 0.299 * f64::from(red) + 0.587 * f64::from(green) + 0.114 * f64::from(blue);
    if bright > 125.0 { BLACK } else { PAPER }
}

/// Writes words to the right or the left of an upright footprint, or below or above a horizontal one, if there is space.
pub(super) fn number_beside(drawing: &mut Drawing, corners: [[f64; 2]; 4], right: bool, words: &str) {
    let middle = |axis: usize| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 4.0;
    let end =
        |axis: usize, sign: f64| corners.iter().map(|corner| sign * corner[axis]).fold(f64::NEG_INFINITY, f64::max);
    let lies = (corners[0][0] - corners[2][0]).abs() > (corners[0][1] - corners[2][1]).abs();
    match (lies, right) {
        (true, true) => write(drawing, [middle(0), end(1, 1.0) + 0.6 * SMALL_TEXT_PX], Side::Middle, words),
        (true, false) => write(drawing, [middle(0), -end(1, -1.0) - 0.55 * SMALL_TEXT_PX], Side::Middle, words),
        (false, true) => write(drawing, [end(0, 1.0) + 6.0, middle(1)], Side::Left, words),
        (false, false) => write(drawing, [-end(0, -1.0) - 6.0, middle(1)], Side::Right, words),
    }
}

fn write(drawing: &mut Drawing, at: [f64; 2], side: Side, words: &str) {
    drawing.text_where_free(at, side, words, BLACK, true);
}

/// Writes words onto a footprint if they fit, otherwise above or beside it, if there is space.
pub(super) fn number(drawing: &mut Drawing, corners: [[f64; 2]; 4], colour: Colour, words: &str) {
    let middle = |axis: usize| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 4.0;
    let (length, width) = (distance(corners[0], corners[2]), distance(corners[0], corners[1]));
    let lies = (corners[0][0] - corners[2][0]).abs() > (corners[0][1] - corners[2][1]).abs();
    let [across, upwards] = if lies { [length, width] } else { [width, length] };
    let fits = width_of(words, SMALL_TEXT_PX) < 0.85 * across && 0.8 * SMALL_TEXT_PX < upwards;
    let above = corners.iter().map(|corner| corner[1]).fold(f64::INFINITY, f64::min) - 0.55 * SMALL_TEXT_PX;
    let beside = corners.iter().map(|corner| corner[0]).fold(f64::NEG_INFINITY, f64::max) + 6.0;
    match (fits, lies) {
        (true, _) => drawing.text_where_free([middle(0), middle(1)], Side::Middle, words, readable_on(colour), false),
        (false, true) => write(drawing, [middle(0), above], Side::Middle, words),
        (false, false) => write(drawing, [beside, middle(1)], Side::Left, words),
    }
}
