//! A drawing: a picture as a list of marks in pixels, from the back to the front.
//!
//! Every drawing is a pure function from numbers to a [`Drawing`], which `backend.rs` writes as SVG and as PNG.

use super::backend::width_of;
use super::style::{BLACK, Colour, LineStyle, PAPER};
use crate::rectangle::overlap;

/// Size of text on ticks and bodies.
pub const SMALL_TEXT_PX: f64 = 22.0;
/// Size of text in legends and beside axes.
pub const MEDIUM_TEXT_PX: f64 = 24.0;
pub const LARGE_TEXT_PX: f64 = 29.0;
/// Width of pictures with plots.
pub const WIDTH_PX: f64 = 1400.0;
/// Space at the left of a plot, for the tick labels of its y axis.
pub const LEFT_MARGIN_PX: f64 = 92.0;
/// Space at the other sides of a picture.
pub const MARGIN_PX: f64 = 30.0;
/// Height of the line with the title.
pub const TITLE_HEIGHT_PX: f64 = 48.0;
/// Height of the tick labels of the x axis.
pub const TICK_LABEL_HEIGHT_PX: f64 = 34.0;
/// Height of the line with the name of the x axis.
pub const X_LABEL_HEIGHT_PX: f64 = 38.0;
/// Opacity of the patch of paper behind words on other marks.
const PATCH_OPACITY: f64 = 0.9;
/// Margin of the patch at the sides of the words.
const PATCH_MARGIN_PX: f64 = 4.0;

/// A picture as a list of marks, which can be saved as SVG and PNG.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    pub(super) size: (u32, u32),
    pub(super) marks: Vec<Mark>,
}

/// One mark; places are pixels from the upper left corner.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Mark {
    Fill { ring: Vec<[f64; 2]>, colour: Colour, opacity: f64 },
    Line { points: Vec<[f64; 2]>, style: LineStyle },
    Disc { centre: [f64; 2], radius: u32, colour: Colour },
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

    /// Adds small words unless they would overlap other words; on a patch of paper to be legible on any ground.
    pub(super) fn text_where_free(&mut self, at: [f64; 2], side: Side, words: &str, colour: Colour, on_patch: bool) {
        let mark = Mark::Text { at, words: words.to_owned(), size: SMALL_TEXT_PX, colour, side };
        let Some((_, covered)) = text_box(&mark) else { return };
        if self.marks.iter().filter_map(text_box).any(|(_, others)| overlap(covered, others)) {
            return;
        }
        if on_patch {
            // Letters extend above the box that is tested for overlaps.
            let [left, right] = [covered[0] - PATCH_MARGIN_PX, covered[2] + PATCH_MARGIN_PX];
            let [top, bottom] = [at[1] - 0.5 * SMALL_TEXT_PX, at[1] + 0.55 * SMALL_TEXT_PX];
            self.fill(vec![[left, top], [right, top], [right, bottom], [left, bottom]], PAPER, PATCH_OPACITY);
        }
        self.marks.push(mark);
    }

    /// Illegible words: those that overlap others or reach beyond the edge. The box of a text is lower than its line height.
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

    #[cfg(test)]
    pub fn mark_count(&self) -> usize {
        self.marks.len()
    }

    /// All words of the picture, as its alternative text.
    pub fn words(&self) -> Vec<&str> {
        let words = self.marks.iter().filter_map(|mark| match mark {
            Mark::Text { words, .. } => Some(words.as_str()),
            _ => None,
        });
        words.collect()
    }
}

/// The words of a mark and their box: left, top, right, bottom.
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
