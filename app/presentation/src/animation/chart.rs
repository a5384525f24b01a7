//! A small chart of quantities over the hours of a day.

use super::canvas::{Align, Canvas, LineEnd};
use crate::palette::{Colour, one_decimal};

const WORDS: Colour = [0x2A, 0x2C, 0x30];
const GRID: Colour = [0xDD, 0xDD, 0xDA];
const CURSOR: Colour = [0x8A, 0x8D, 0x92];
const SIZE_PX: f64 = 13.0;
const DASH_PX: f64 = 5.0;
/// Numbers of an axis that reaches less far than this have two decimals.
const FINE_REACH: f64 = 1.0;
/// Share of the range that is left free above and below the curves.
const HEADROOM: f64 = 0.08;

/// A chart: its position in the picture, and the ranges of its axes.
pub struct Chart {
    /// Left, top, right and bottom of the axes \[px\].
    pub place: [f64; 4],
    /// Least and greatest value of the horizontal axis.
    pub across: [f64; 2],
    /// Least and greatest value of the curves.
    pub up: [f64; 2],
}

impl Chart {
    /// The pixel of a point \[px\].
    pub fn pixel(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, top, right, bottom] = self.place;
        let share = (x - self.across[0]) / (self.across[1] - self.across[0]);
        let reach = (self.up[1] - self.up[0]).max(1e-6);
        let low = self.up[0] - HEADROOM * reach;
        let height = (y - low) / ((1.0 + 2.0 * HEADROOM) * reach);
        [left + share * (right - left), bottom - height * (bottom - top)]
    }

    pub fn draw_axes(&self, canvas: &mut Canvas, title: &str) {
        let [left, top, right, bottom] = self.place;
        canvas.text([left - 34.0, top - 13.0], Align::Left, SIZE_PX + 1.0, title, WORDS);
        for hour in [0.0, 6.0, 12.0, 18.0, 24.0] {
            let [x, _] = self.pixel([hour, self.up[0]]);
            canvas.line(&[[x, top], [x, bottom]], 1.0, LineEnd::Flat, GRID);
            canvas.text([x, bottom + 10.0], Align::Middle, SIZE_PX, &format!("{hour:.0} h"), WORDS);
        }
        for value in self.up {
            let [_, y] = self.pixel([0.0, value]);
            canvas.line(&[[left, y], [right, y]], 1.0, LineEnd::Flat, GRID);
            let words = match self.up[1] - self.up[0] {
                reach if reach < FINE_REACH => format!("{value:.2}").replace('-', "−"),
                _ => one_decimal(value),
            };
            canvas.text([left - 6.0, y], Align::Right, SIZE_PX, &words, WORDS);
        }
    }

    /// Draws a curve until an hour, with a dot at its end.
    pub fn draw_past(&self, canvas: &mut Canvas, points: &[[f64; 2]], hour: f64, colour: Colour) {
        let past: Vec<[f64; 2]> =
            points.iter().filter(|[at, _]| *at <= hour + 1e-9).map(|point| self.pixel(*point)).collect();
        canvas.line(&past, 2.4, LineEnd::Round, colour);
        if let Some(last) = past.last() {
            canvas.disc(*last, 4.0, colour);
        }
    }

    pub fn dashed(&self, canvas: &mut Canvas, points: &[[f64; 2]], width: f64, colour: Colour) {
        let (mut run, mut dash) = (0.0, Vec::new());
        for point in points.windows(2).flat_map(|pair| between(self.pixel(pair[0]), self.pixel(pair[1]))) {
            if let Some(last) = dash.last() {
                let [x, y]: [f64; 2] = *last;
                run += libm::hypot(point[0] - x, point[1] - y);
            }
            dash.push(point);
            if run >= DASH_PX {
                canvas.line(&dash, width, LineEnd::Flat, colour);
                run = -DASH_PX;
            }
            if !(0.0..DASH_PX).contains(&run) {
                dash = vec![point];
            }
        }
    }

    /// Draws an upright line at the present.
    pub fn draw_cursor(&self, canvas: &mut Canvas, hour: f64) {
        let [x, _] = self.pixel([hour, self.up[0]]);
        canvas.line(&[[x, self.place[1]], [x, self.place[3]]], 1.0, LineEnd::Flat, CURSOR);
    }
}

/// Points a pixel apart.
fn between(from: [f64; 2], to: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    let count = libm::hypot(to[0] - from[0], to[1] - from[1]).ceil().clamp(1.0, 1e4) as usize;
    (0..=count).map(move |part| {
        let share = part as f64 / count as f64;
        [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]))
    })
}
