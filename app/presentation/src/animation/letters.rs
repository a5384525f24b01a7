//! Words as outlines in the font of all pictures.

use std::sync::LazyLock;

use ab_glyph::{Font, FontRef, OutlineCurve, PxScale, ScaleFont};
use tiny_skia::{Path, PathBuilder};

use crate::plot::FONT_BYTES;

/// Distance of the base line below the middle of a line of text, as a share of the line's height.
pub const BASELINE_RATIO: f64 = 0.31;

static FONT: LazyLock<Option<FontRef<'static>>> = LazyLock::new(|| FontRef::try_from_slice(FONT_BYTES).ok());

/// A text in one font size.
pub struct Word<'a> {
    words: &'a str,
    size: f64,
    /// Width of the words \[px\].
    pub width: f64,
}

impl<'a> Word<'a> {
    /// Measures words; `size` is the height of a line \[px\].
    pub fn new(words: &'a str, size: f64) -> Word<'a> {
        Word { words, size, width: width_of(words, size) }
    }

    /// The outlines of the words from a place on the base line; `None` if they are empty or blank.
    pub fn path(&self, [left, base]: [f64; 2]) -> Option<Path> {
        let font = FONT.as_ref()?;
        let scale = PxScale::from(self.size as f32);
        let scaled = font.as_scaled(scale);
        let factor = scaled.h_scale_factor();
        let mut builder = PathBuilder::new();
        let mut x = left as f32;
        for letter in self.words.chars() {
            let glyph = font.glyph_id(letter);
            if let Some(outline) = font.outline(glyph) {
                let at = |point: ab_glyph::Point| (x + factor * point.x, base as f32 - factor * point.y);
                add(&mut builder, &outline.curves, at);
            }
            x += scaled.h_advance(glyph);
        }
        builder.finish()
    }
}

/// The width of words \[px\].
pub fn width_of(words: &str, size: f64) -> f64 {
    let Some(font) = FONT.as_ref() else { return 0.0 };
    let scaled = font.as_scaled(PxScale::from(size as f32));
    words.chars().map(|letter| f64::from(scaled.h_advance(font.glyph_id(letter)))).sum()
}

/// Words cut off with an ellipsis so that they are not wider than `longest` \[px\].
pub fn cut(words: &str, size: f64, longest: f64) -> String {
    if width_of(words, size) <= longest {
        return words.to_owned();
    }
    let mut kept: Vec<char> = words.chars().collect();
    while !kept.is_empty() {
        kept.pop();
        let shorter = kept.iter().collect::<String>().trim_end().to_owned() + "…";
        if width_of(&shorter, size) <= longest {
            return shorter;
        }
    }
    String::new()
}

fn add(builder: &mut PathBuilder, curves: &[OutlineCurve], at: impl Fn(ab_glyph::Point) -> (f32, f32)) {
    let mut last = None;
    for curve in curves {
        let begin = match curve {
            OutlineCurve::Line(begin, _) | OutlineCurve::Quad(begin, ..) | OutlineCurve::Cubic(begin, ..) => *begin,
        };
        if last != Some(begin) {
            let (x, y) = at(begin);
            builder.move_to(x, y);
        }
        last = Some(match curve {
            OutlineCurve::Line(_, end) => {
                let (x, y) = at(*end);
                builder.line_to(x, y);
                *end
            }
            OutlineCurve::Quad(_, control, end) => {
                let ((a, b), (x, y)) = (at(*control), at(*end));
                builder.quad_to(a, b, x, y);
                *end
            }
            OutlineCurve::Cubic(_, first, second, end) => {
                let ((a, b), (c, d), (x, y)) = (at(*first), at(*second), at(*end));
                builder.cubic_to(a, b, c, d, x, y);
                *end
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_labels_are_cut_off_to_fit() {
        assert_eq!(cut("short", 14.0, 200.0), "short");
        let text = cut("no plan (infeasible: the road is closed)", 14.0, 100.0);
        assert!(text.ends_with('…') && width_of(&text, 14.0) <= 100.0, "{text}");
        assert_eq!(cut("words", 14.0, 1.0), "");
        assert!(width_of("iiii", 20.0) < width_of("WWWW", 20.0));
    }
}
