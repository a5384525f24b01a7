//! A raster picture with anti-aliased shapes, lines and words.
//!
//! Places are pixels from the upper left corner, y downwards.

use tiny_skia::{Color, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Stroke, Transform};

use super::letters::{self, Word};
use crate::palette::Colour;
use crate::rectangle::rounded_corners;

/// Largest magnitude of a coordinate \[px\]: the numbers of the rasteriser have 16 bits before the point.
const MAX_PLACE_PX: f64 = 30_000.0;

/// Horizontal alignment: the part of a text that is drawn at the given position. Vertically, texts are always centred.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// The place is the left end.
    Left,
    /// The place is the middle.
    Middle,
    /// The place is the right end.
    Right,
}

/// The shape of the ends of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineEnd {
    /// Cut off at its last point.
    Flat,
    /// A half circle beyond it.
    Round,
}

/// Colour and opacity of a mark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ink {
    pub colour: Colour,
    /// From 0, invisible, to 1, opaque.
    pub opacity: f64,
}

impl From<Colour> for Ink {
    fn from(colour: Colour) -> Ink {
        Ink { colour, opacity: 1.0 }
    }
}

impl Ink {
    pub fn translucent(colour: Colour, opacity: f64) -> Ink {
        Ink { colour, opacity }
    }

    /// The colour that results on top of another one, rounded.
    pub fn over(self, below: Colour) -> Colour {
        let mixed =
            |part: usize| self.opacity * f64::from(self.colour[part]) + (1.0 - self.opacity) * f64::from(below[part]);
        [0, 1, 2].map(|part| mixed(part).round() as u8)
    }

    fn paint(self) -> Paint<'static> {
        let [red, green, blue] = self.colour;
        let mut paint = Paint { anti_alias: true, ..Paint::default() };
        paint.set_color_rgba8(red, green, blue, (255.0 * self.opacity.clamp(0.0, 1.0)).round() as u8);
        paint
    }
}

pub struct Canvas {
    pixels: Pixmap,
}

impl Canvas {
    /// A picture of one colour; at least one pixel wide and high.
    pub fn new([width, height]: [u32; 2], [red, green, blue]: Colour) -> Option<Canvas> {
        let mut pixels = Pixmap::new(width, height)?;
        pixels.fill(Color::from_rgba8(red, green, blue, 255));
        Some(Canvas { pixels })
    }

    /// Width and height \[px\].
    pub fn size(&self) -> [f64; 2] {
        [f64::from(self.pixels.width()), f64::from(self.pixels.height())]
    }

    /// Red, green and blue of every pixel, row by row.
    pub fn into_rgb(self) -> Vec<u8> {
        self.pixels.data().chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
    }

    /// Copies a picture of the same width into this one, from row `top` on. Rows beyond the lower edge are left out.
    pub fn put(&mut self, other: &Canvas, top: u32) {
        let from = (4 * self.pixels.width() * top) as usize;
        let below = self.pixels.data_mut().get_mut(from..).unwrap_or_default();
        let count = below.len().min(other.pixels.data().len());
        below[..count].copy_from_slice(&other.pixels.data()[..count]);
    }

    pub fn fill(&mut self, ring: &[[f64; 2]], ink: impl Into<Ink>) {
        if self.touches(ring, 0.0) {
            self.fill_path(path(ring, true), ink.into());
        }
    }

    /// Fills a rectangle between its upper left and lower right corner.
    pub fn block(&mut self, [left, top]: [f64; 2], [right, bottom]: [f64; 2], ink: impl Into<Ink>) {
        self.fill(&[[left, top], [right, top], [right, bottom], [left, bottom]], ink);
    }

    /// Fills a polygon whose corners are rounded with a radius \[px\].
    pub fn fill_rounded(&mut self, ring: &[[f64; 2]], radius: f64, ink: impl Into<Ink>) {
        if self.touches(ring, 0.0) {
            self.fill_path(rounded(ring, radius), ink.into());
        }
    }

    /// Draws the outline of a polygon with rounded corners.
    pub fn outline_rounded(&mut self, ring: &[[f64; 2]], radius: f64, width: f64, ink: impl Into<Ink>) {
        if self.touches(ring, width) {
            self.stroke_path(rounded(ring, radius), width, LineEnd::Flat, ink.into());
        }
    }

    pub fn disc(&mut self, [x, y]: [f64; 2], radius: f64, ink: impl Into<Ink>) {
        if self.touches(&[[x, y]], radius) {
            self.fill_path(PathBuilder::from_circle(x as f32, y as f32, radius as f32), ink.into());
        }
    }

    /// Draws a line through points. Pieces that do not reach the picture are left out.
    pub fn line(&mut self, points: &[[f64; 2]], width: f64, end: LineEnd, ink: impl Into<Ink>) {
        let ink = ink.into();
        let mut piece: Vec<[f64; 2]> = Vec::new();
        for pair in points.windows(2) {
            if self.touches(pair, width) {
                if piece.is_empty() {
                    piece.push(pair[0]);
                }
                piece.push(pair[1]);
            } else if !piece.is_empty() {
                self.stroke_path(path(&std::mem::take(&mut piece), false), width, end, ink);
            }
        }
        if piece.len() > 1 {
            self.stroke_path(path(&piece, false), width, end, ink);
        }
    }

    /// Draws the outline of a polygon.
    pub fn outline(&mut self, ring: &[[f64; 2]], width: f64, ink: impl Into<Ink>) {
        if self.touches(ring, width) {
            self.stroke_path(path(ring, true), width, LineEnd::Round, ink.into());
        }
    }

    /// Writes words; `size` is the height of a line \[px\].
    pub fn text(&mut self, at: [f64; 2], align: Align, size: f64, words: &str, ink: impl Into<Ink>) {
        let word = Word::new(words, size);
        let left = match align {
            Align::Left => at[0],
            Align::Middle => at[0] - 0.5 * word.width,
            Align::Right => at[0] - word.width,
        };
        self.fill_path(word.path([left.round(), (at[1] + letters::BASELINE_RATIO * size).round()]), ink.into());
    }

    fn touches(&self, points: &[[f64; 2]], beyond: f64) -> bool {
        let size = self.size();
        (0..2).all(|axis| {
            let low = points.iter().map(|point| point[axis]).fold(f64::INFINITY, f64::min);
            let high = points.iter().map(|point| point[axis]).fold(f64::NEG_INFINITY, f64::max);
            low <= size[axis] + beyond && high >= -beyond
        })
    }

    fn fill_path(&mut self, path: Option<Path>, ink: Ink) {
        if let Some(path) = path {
            self.pixels.fill_path(&path, &ink.paint(), FillRule::Winding, Transform::identity(), None);
        }
    }

    fn stroke_path(&mut self, path: Option<Path>, width: f64, end: LineEnd, ink: Ink) {
        let line_cap = if end == LineEnd::Round { LineCap::Round } else { LineCap::Butt };
        let stroke = Stroke { width: width as f32, line_cap, line_join: LineJoin::Round, ..Stroke::default() };
        if let Some(path) = path {
            self.pixels.stroke_path(&path, &ink.paint(), &stroke, Transform::identity(), None);
        }
    }
}

fn path(points: &[[f64; 2]], closed: bool) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for (index, point) in points.iter().enumerate() {
        let [x, y] = point.map(|part| part.clamp(-MAX_PLACE_PX, MAX_PLACE_PX) as f32);
        if index == 0 { builder.move_to(x, y) } else { builder.line_to(x, y) }
    }
    if closed {
        builder.close();
    }
    builder.finish()
}

/// A polygon whose corners are arcs; an arc takes at most half of an edge.
fn rounded(ring: &[[f64; 2]], radius: f64) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for (index, corner) in rounded_corners(ring, radius).enumerate() {
        let [[x, y], [here_x, here_y], [end_x, end_y]] = corner.map(|point| point.map(|part| part as f32));
        if index == 0 {
            builder.move_to(x, y)
        } else {
            builder.line_to(x, y)
        }
        builder.quad_to(here_x, here_y, end_x, end_y);
    }
    builder.close();
    builder.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_is_filled_and_the_rest_is_unchanged() {
        let mut canvas = Canvas::new([20, 10], [1, 2, 3]).expect("a size");
        canvas.block([5.0, 2.0], [15.0, 8.0], [200, 100, 50]);
        canvas.line(&[[1e9, 1e9], [2e9, 1e9]], 3.0, LineEnd::Round, [9, 9, 9]);
        let pixels = canvas.into_rgb();
        let at = |x: usize, y: usize| [0, 1, 2].map(|part| pixels[3 * (20 * y + x) + part]);
        assert_eq!((at(10, 5), at(4, 5), at(10, 9)), ([200, 100, 50], [1, 2, 3], [1, 2, 3]));
        assert!(Canvas::new([0, 10], [0; 3]).is_none());
    }

    #[test]
    fn a_left_aligned_text_begins_at_its_position() {
        let mut canvas = Canvas::new([200, 40], [255; 3]).expect("a size");
        canvas.text([100.0, 20.0], Align::Left, 20.0, "asks", [0; 3]);
        let pixels = canvas.into_rgb();
        let dark = |from: usize, to: usize| {
            (0..40).flat_map(|y| (from..to).map(move |x| 200 * y + x)).filter(|pixel| pixels[3 * pixel] < 128).count()
        };
        assert_eq!(dark(0, 99), 0);
        assert!(dark(100, 145) > 100);
        assert_eq!(dark(160, 200), 0);
    }
}
