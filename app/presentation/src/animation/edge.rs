//! How a vehicle out of view is marked: an arrow at the edge with its name and distance.

use super::camera::CameraView;
use super::canvas::{Align, Canvas, Ink};
use super::letters::width_of;
use super::title::{BAR, WORDS};
use crate::edge_mark::EdgeMark;
use crate::palette::Colour;
use crate::rectangle::{Rectangle, overlap};

/// Length of an arrow and size of its words \[px\].
const ARROW_PX: f64 = 16.0;
const LABEL_PX: f64 = 14.0;
/// Space between an arrow and its words \[px\].
const BETWEEN_PX: f64 = 6.0;

/// Draws a mark in the colour of its vehicle, its words off what is `taken` where there is space. Returns left, top, right and
/// bottom of the words \[px\].
pub fn draw(canvas: &mut Canvas, view: &CameraView, mark: &EdgeMark, colour: Colour, taken: &[Rectangle]) -> Rectangle {
    let [dx, dy] = mark.toward;
    let point = |ahead: f64, left: f64| [mark.at[0] + ahead * dx - left * dy, mark.at[1] + ahead * dy + left * dx];
    let arrow = |half: f64| [point(half, 0.0), point(-half, 0.85 * half), point(-half, -0.85 * half)];
    canvas.fill(&arrow(0.5 * ARROW_PX + 3.0), WORDS);
    canvas.fill(&arrow(0.5 * ARROW_PX), colour);
    let (wide, high) = (width_of(&mark.words, LABEL_PX) + 10.0, LABEL_PX + 4.0);
    let away = 0.5 * ARROW_PX + BETWEEN_PX;
    let middle = [mark.at[0] - dx * (away + 0.5 * wide), mark.at[1] - dy * (away + 0.5 * high)];
    let half = [0.5 * wide + 2.0, 0.5 * high + 2.0];
    // Beside the arrow toward the middle of the view, else above or below.
    let place = |beside: f64| {
        let wanted = [middle[0], middle[1] + beside * (high + 8.0)];
        let inside = |axis: usize| wanted[axis].clamp(half[axis], (view.size_px[axis] - half[axis]).max(half[axis]));
        let [x, y] = [inside(0), inside(1)];
        [x - 0.5 * wide, y - 0.5 * high, x + 0.5 * wide, y + 0.5 * high]
    };
    let is_free = |place: &Rectangle| !taken.iter().any(|other| overlap(*place, *other));
    let places = [0.0, -1.0, 1.0, -2.0, 2.0].map(place);
    let [l, t, r, b] = places.into_iter().find(is_free).unwrap_or(places[0]);
    canvas.fill_rounded(&[[l, t], [r, t], [r, b], [l, b]], 5.0, Ink::veiled(BAR, 0.82));
    canvas.text([0.5 * (l + r), 0.5 * (t + b)], Align::Middle, LABEL_PX, &mark.words, WORDS);
    [l, t, r, b]
}
