//! The band of a plan: a translucent area between two lines in the colour of the vehicle.
//!
//! On asphalt the translucent colours alone are not distinguishable. The solid colours of the lines are (`palette.rs`).

use super::canvas::{Canvas, Ink, LineEnd};
use crate::palette::Colour;

const OPACITY: f64 = 0.42;
/// Width of the lines \[px\].
const LINE_PX: f64 = 2.0;

pub fn ink(colour: Colour) -> Ink {
    Ink::translucent(colour, OPACITY)
}

/// Draws a band of a width along a line \[px\].
pub fn draw(canvas: &mut Canvas, line: &[[f64; 2]], width: f64, colour: Colour) {
    canvas.line(line, width, LineEnd::Round, ink(colour));
    let away = 0.5 * (width - LINE_PX).max(0.0);
    for side in [-1.0, 1.0] {
        canvas.line(&beside(line, side * away), LINE_PX, LineEnd::Flat, colour);
    }
}

/// A line at a distance beside another one, to its right where y points down.
fn beside(line: &[[f64; 2]], distance: f64) -> Vec<[f64; 2]> {
    let place = |index: usize| {
        let (before, after) = (line[index.saturating_sub(1)], line[(index + 1).min(line.len() - 1)]);
        let along = [after[0] - before[0], after[1] - before[1]];
        let length = libm::hypot(along[0], along[1]).max(1e-9);
        [line[index][0] - distance * along[1] / length, line[index][1] + distance * along[0] / length]
    };
    (0..line.len()).map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::{ASPHALT, BLUE};

    /// Both edges of a band have the solid colour of its vehicle, and its middle is translucent.
    #[test]
    fn the_band_of_a_plan_has_edges_in_its_colour() {
        let mut canvas = Canvas::new([100, 60], ASPHALT).expect("a size");
        draw(&mut canvas, &[[10.0, 30.0], [50.0, 30.0], [90.0, 30.0]], 14.0, BLUE.rgb);
        let pixels = canvas.into_rgb();
        let at = |x: usize, y: usize| [0, 1, 2].map(|part| pixels[3 * (100 * y + x) + part]);
        assert_eq!((at(50, 23), at(50, 36), at(50, 20)), (BLUE.rgb, BLUE.rgb, ASPHALT));
        let middle = ink(BLUE.rgb).over(ASPHALT);
        assert!(at(50, 30).iter().zip(middle).all(|(a, b)| a.abs_diff(b) <= 1), "{:?} {middle:?}", at(50, 30));
    }
}
