//! Sequences of pictures of one size, each of which can be drawn by itself.

use super::caption::BAR;
use crate::palette::Colour;

/// Red, green and blue of every pixel, row by row.
pub type Rgb = Vec<u8>;

/// Pictures that are drawn on demand, on any thread.
pub trait Pictures: Sync {
    /// Number of pictures, at least one.
    fn count(&self) -> usize;

    /// Width and height of each picture, both even \[px\].
    fn size(&self) -> [u32; 2];

    /// Draws a picture; `None` if its size is zero.
    fn draw(&self, index: usize) -> Option<Rgb>;

    /// Colours that must stay exact in formats with few colours.
    fn exact_colours(&self) -> Vec<Colour>;
}

/// Two sequences of pictures, one after the other.
pub struct PictureSequence<'a> {
    first: &'a dyn Pictures,
    second: &'a dyn Pictures,
}

impl<'a> PictureSequence<'a> {
    /// Joins two sequences; the lower pictures get a bar below.
    pub fn new(first: &'a dyn Pictures, second: &'a dyn Pictures) -> PictureSequence<'a> {
        PictureSequence { first, second }
    }
}

impl Pictures for PictureSequence<'_> {
    fn count(&self) -> usize {
        self.first.count() + self.second.count()
    }

    fn size(&self) -> [u32; 2] {
        let ([wide, high], [width, height]) = (self.first.size(), self.second.size());
        [wide.max(width), high.max(height)]
    }

    fn draw(&self, index: usize) -> Option<Rgb> {
        let (pictures, index) = match index.checked_sub(self.first.count()) {
            None => (self.first, index),
            Some(index) => (self.second, index),
        };
        let mut drawn = pictures.draw(index)?;
        // All pictures have the same width, so missing rows are appended.
        let pixels = self.size().map(|part| part as usize);
        let missing = (pixels[0] * pixels[1]).saturating_sub(drawn.len() / 3);
        drawn.extend(std::iter::repeat_n(BAR, missing).flatten());
        Some(drawn)
    }

    fn exact_colours(&self) -> Vec<Colour> {
        self.first.exact_colours().into_iter().chain(self.second.exact_colours()).collect()
    }
}
