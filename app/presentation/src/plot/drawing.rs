//! A drawing: a picture as a list of marks in pixels, from the back to the front.
//!
//! Every drawing is a pure function from numbers to a [`Drawing`]. Only this module passes it to Plotters, which draws the
//! same marks as SVG and as PNG.

use std::path::{Path, PathBuf};

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::figure::{Drawn, FONT, Figure, PlotError, make_folder, register, save, svg};
use super::style::{BLACK, Colour, Dash, LineStyle, PAPER};
use crate::rectangle::overlap;

/// Size of text on ticks and bodies.
pub const SMALL_TEXT_PX: f64 = 22.0;
/// Size of text in legends and beside axes.
pub const MEDIUM_TEXT_PX: f64 = 24.0;
/// Size of titles.
pub const LARGE_TEXT_PX: f64 = 29.0;
/// Opacity of the paper behind words that may lie on anything.
const PATCH_OPACITY: f64 = 0.9;
/// How far it reaches beyond the words at their sides.
const PATCH_MARGIN_PX: f64 = 4.0;
/// Smallest cosine of the angle by which a line turns at a point without being split there. At sharper corners Plotters would
/// draw spikes on wide lines.
const MIN_UNSPLIT_TURN_COS: f64 = 0.7;

/// A picture as a list of marks, which can be saved as SVG and PNG.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    pub(super) size: (u32, u32),
    pub(super) marks: Vec<Mark>,
}

/// One mark; places are pixels from the upper left corner.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Mark {
    /// A filled polygon.
    Fill { ring: Vec<[f64; 2]>, colour: Colour, opacity: f64 },
    /// A line through points.
    Line { points: Vec<[f64; 2]>, style: LineStyle },
    /// A filled disc.
    Disc { centre: [f64; 2], radius: u32, colour: Colour },
    /// Words.
    Text { at: [f64; 2], words: String, size: f64, colour: Colour, side: Side },
}

/// Horizontal alignment: the part of a text that lies at its place. Vertically this is always the middle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Left,
    Middle,
    Right,
}

impl Drawing {
    /// An empty picture.
    pub(super) fn new(width: f64, height: f64) -> Drawing {
        Drawing { size: (width.ceil() as u32, height.ceil() as u32), marks: Vec::new() }
    }

    pub(super) fn fill(&mut self, ring: Vec<[f64; 2]>, colour: Colour, opacity: f64) {
        self.marks.push(Mark::Fill { ring, colour, opacity });
    }

    /// A filled rectangle between two corners.
    pub(super) fn block(&mut self, [x, y]: [f64; 2], [right, bottom]: [f64; 2], colour: Colour) {
        self.fill(vec![[x, y], [right, y], [right, bottom], [x, bottom]], colour, 1.0);
    }

    pub(super) fn line(&mut self, points: Vec<[f64; 2]>, style: LineStyle) {
        self.marks.push(Mark::Line { points, style });
    }

    pub(super) fn disc(&mut self, centre: [f64; 2], radius: u32, colour: Colour) {
        self.marks.push(Mark::Disc { centre, radius, colour });
    }

    pub(super) fn text(&mut self, at: [f64; 2], side: Side, size: f64, words: impl Into<String>) {
        self.coloured_text(at, side, size, words, BLACK);
    }

    pub(super) fn coloured_text(
        &mut self,
        at: [f64; 2],
        side: Side,
        size: f64,
        words: impl Into<String>,
        colour: Colour,
    ) {
        self.marks.push(Mark::Text { at, words: words.into(), size, colour, side });
    }

    /// Small words where no other words are, otherwise nothing; on a patch of paper if they are to be read on any ground.
    pub(super) fn text_where_free(&mut self, at: [f64; 2], side: Side, words: &str, colour: Colour, on_patch: bool) {
        let mark = Mark::Text { at, words: words.to_owned(), size: SMALL_TEXT_PX, colour, side };
        let Some((_, covered)) = text_box(&mark) else { return };
        if self.marks.iter().filter_map(text_box).any(|(_, others)| overlap(covered, others)) {
            return;
        }
        if on_patch {
            // Letters are higher than the box that must stay free of others.
            let [left, right] = [covered[0] - PATCH_MARGIN_PX, covered[2] + PATCH_MARGIN_PX];
            let [top, bottom] = [at[1] - 0.5 * SMALL_TEXT_PX, at[1] + 0.55 * SMALL_TEXT_PX];
            self.fill(vec![[left, top], [right, top], [right, bottom], [left, bottom]], PAPER, PATCH_OPACITY);
        }
        self.marks.push(mark);
    }

    /// Words that cannot be read: they lie on other words, or beyond the edge. Text is a little lower than its line.
    #[cfg(test)]
    pub(crate) fn illegible(&self) -> Vec<String> {
        let boxes: Vec<(&str, [f64; 4])> = self.marks.iter().filter_map(text_box).collect();
        let mut found = Vec::new();
        for (index, (words, covered)) in boxes.iter().enumerate() {
            let [left, top, right, bottom] = covered;
            let [width, height] = [self.size.0, self.size.1].map(f64::from);
            if *left < 0.0 || *top < 0.0 || *right > width || *bottom > height {
                found.push(format!("`{words}` lies beyond the edge"));
            }
            for (other, others) in &boxes[..index] {
                if overlap(*covered, *others) {
                    found.push(format!("`{words}` lies on `{other}`"));
                }
            }
        }
        found
    }

    /// Number of marks.
    pub fn mark_count(&self) -> usize {
        self.marks.len()
    }

    /// All words of the picture, for whoever cannot see it.
    pub fn words(&self) -> Vec<&str> {
        let words = self.marks.iter().filter_map(|mark| match mark {
            Mark::Text { words, .. } => Some(words.as_str()),
            _ => None,
        });
        words.collect()
    }

    /// The picture as SVG.
    ///
    /// # Errors
    /// [`PlotError::Drawing`].
    pub fn svg(&self) -> Result<String, PlotError> {
        svg("the picture", self)
    }

    /// Writes `name.svg` and `name.png` into a folder, which is created if necessary. Returns their paths.
    ///
    /// # Errors
    /// [`PlotError`].
    pub fn save(&self, folder: &Path, name: &str) -> Result<[PathBuf; 2], PlotError> {
        make_folder(folder)?;
        save(folder, name, self)
    }
}

/// The words of a mark and what they cover: left, top, right, bottom.
fn text_box(mark: &Mark) -> Option<(&str, [f64; 4])> {
    let Mark::Text { at: [x, y], words, size, side, .. } = mark else { return None };
    let (wide, high) = (width_of(words, *size), 0.6 * size);
    let left = match side {
        Side::Left => *x,
        Side::Middle => x - 0.5 * wide,
        Side::Right => x - wide,
    };
    Some((words, [left, y - 0.5 * high, left + wide, y + 0.5 * high]))
}

/// How wide words are \[px\].
pub(super) fn width_of(words: &str, size: f64) -> f64 {
    register();
    let measured = (FONT, size).into_font().box_size(words);
    measured.map_or(0.55 * size * words.chars().count() as f64, |(width, _)| f64::from(width))
}

impl Figure for Drawing {
    fn size(&self) -> (u32, u32) {
        self.size
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Drawn<B> {
        area.fill(&WHITE)?;
        self.marks.iter().try_for_each(|mark| draw_mark(area, mark))
    }
}

fn draw_mark<B: DrawingBackend>(area: &DrawingArea<B, Shift>, mark: &Mark) -> Drawn<B> {
    match mark {
        Mark::Fill { ring, colour, opacity } => {
            area.draw(&Polygon::new(ring.iter().map(pixel).collect::<Vec<_>>(), rgb(*colour).mix(*opacity).filled()))
        }
        Mark::Line { points, style } => {
            let stroke = rgb(style.colour).stroke_width(style.width);
            pieces(points, style.dash).into_iter().try_for_each(|piece| area.draw(&PathElement::new(piece, stroke)))
        }
        Mark::Disc { centre, radius, colour } => area.draw(&Circle::new(pixel(centre), *radius, rgb(*colour).filled())),
        Mark::Text { at, words, size, colour, side } => {
            let anchor = match side {
                Side::Left => HPos::Left,
                Side::Middle => HPos::Center,
                Side::Right => HPos::Right,
            };
            let colour = rgb(*colour);
            let style = (FONT, *size).into_font().color(&colour).pos(Pos::new(anchor, VPos::Center));
            area.draw(&Text::new(words.as_str(), pixel(at), style))
        }
    }
}

fn rgb([red, green, blue]: Colour) -> RGBColor {
    RGBColor(red, green, blue)
}

fn pixel(&[x, y]: &[f64; 2]) -> (i32, i32) {
    (x.round() as i32, y.round() as i32)
}

/// The pieces in which a line is drawn: dashes, and no sharp corners.
fn pieces(points: &[[f64; 2]], dash: Dash) -> Vec<Vec<(i32, i32)>> {
    let dashes = if dash == Dash::Solid { vec![points.to_vec()] } else { dashes(points, dash.pattern()) };
    let whole = dashes.into_iter().flat_map(|dash| split_at_corners(&dash));
    whole
        .map(|piece| {
            let mut pixels: Vec<(i32, i32)> = piece.iter().map(pixel).collect();
            pixels.dedup();
            pixels
        })
        .filter(|piece| piece.len() > 1)
        .collect()
}

/// Cuts a line into dashes.
fn dashes(points: &[[f64; 2]], pattern: &[f64]) -> Vec<Vec<[f64; 2]>> {
    let (mut found, mut phase, mut left) = (Vec::new(), 0, pattern[0]);
    let mut dash: Vec<[f64; 2]> = points.first().copied().into_iter().collect();
    for pair in points.windows(2) {
        let [[mut x, mut y], [end_x, end_y]] = [pair[0], pair[1]];
        loop {
            let rest = libm::hypot(end_x - x, end_y - y);
            if rest <= left {
                left -= rest;
                dash.push([end_x, end_y]);
                break;
            }
            let share = left / rest;
            (x, y) = (x + share * (end_x - x), y + share * (end_y - y));
            dash.push([x, y]);
            if phase % 2 == 0 {
                found.push(std::mem::take(&mut dash));
            }
            phase = (phase + 1) % pattern.len();
            left = pattern[phase];
            dash = vec![[x, y]];
        }
    }
    if phase % 2 == 0 {
        found.push(dash);
    }
    found
}

fn split_at_corners(points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let mut found = vec![points.iter().take(1).copied().collect::<Vec<_>>()];
    for (index, &point) in points.iter().enumerate().skip(1) {
        if let Some(piece) = found.last_mut() {
            piece.push(point);
        }
        let next = points.get(index + 1);
        if next.is_some_and(|&next| is_sharp(points[index - 1], point, next)) {
            found.push(vec![point]);
        }
    }
    found
}

fn is_sharp(before: [f64; 2], here: [f64; 2], after: [f64; 2]) -> bool {
    let (a, b) = ([here[0] - before[0], here[1] - before[1]], [after[0] - here[0], after[1] - here[1]]);
    let lengths = libm::hypot(a[0], a[1]) * libm::hypot(b[0], b[1]);
    a[0] * b[0] + a[1] * b[1] < MIN_UNSPLIT_TURN_COS * lengths
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The dashes of a line are as long together as the pattern says, and lie on it.
    #[test]
    fn dashes_have_their_share_of_the_line() {
        let line = [[0.0, 0.0], [30.0, 0.0], [30.0, 18.0], [90.0, 18.0]];
        let found = dashes(&line, &[6.0, 3.0]);
        let length = |dash: &Vec<[f64; 2]>| -> f64 {
            dash.windows(2).map(|pair| libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1])).sum()
        };
        assert_eq!(found.len(), 12);
        assert!((found.iter().map(length).sum::<f64>() - 72.0).abs() < 1e-9);
        let on_line = |[x, y]: [f64; 2]| (y == 0.0 && x <= 30.0) || x == 30.0 || y == 18.0;
        assert!(found.iter().flatten().all(|point| on_line(*point)));
    }

    #[test]
    fn a_line_is_split_where_it_turns_back() {
        let zigzag = [[0.0, 0.0], [10.0, 0.0], [20.0, 1.0], [20.0, 30.0], [19.0, 0.0]];
        let split = split_at_corners(&zigzag);
        assert_eq!(split.iter().map(Vec::len).collect::<Vec<_>>(), [3, 2, 2]);
    }

    #[test]
    fn longer_words_are_wider() {
        assert!(width_of("iiii", 20.0) < width_of("WWWW", 20.0));
        assert!(width_of("speed", 20.0) < width_of("speed", 30.0));
    }
}
