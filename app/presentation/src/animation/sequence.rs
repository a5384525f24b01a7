//! Pictures of a run with vehicles and a building: first the road, then the floor plan.

use super::pictures::{Pictures, Rgb};
use super::title::BAR;
use crate::palette::Colour;

/// One sequence of pictures after another.
pub struct PictureSequence<'a> {
    first: &'a dyn Pictures,
    second: &'a dyn Pictures,
}

impl<'a> PictureSequence<'a> {
    /// Two sequences as one; the pictures of the lower one have a bar below.
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
        // All are equally wide, so that rows follow each other.
        let pixels = self.size().map(|part| part as usize);
        let missing = (pixels[0] * pixels[1]).saturating_sub(drawn.len() / 3);
        drawn.extend(std::iter::repeat_n(BAR, missing).flatten());
        Some(drawn)
    }

    fn exact_colours(&self) -> Vec<Colour> {
        self.first.exact_colours().into_iter().chain(self.second.exact_colours()).collect()
    }
}
