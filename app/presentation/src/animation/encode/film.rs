//! All pictures of an animation with one palette, and the changes from each picture to the next.

use rayon::prelude::*;

use super::quantise::ColourTable;
use crate::animation::pictures::Pictures;
use crate::animation::timing::{LAST_PICTURE_S, PICTURE_S};
use crate::palette::Colour;

/// Distance between the pictures that determine the palette.
const PALETTE_STRIDE: usize = 9;

/// Pictures with a common palette.
pub struct Film {
    /// Width and height \[px\].
    pub size: [u32; 2],
    /// At most 127 colours.
    pub colours: Vec<Colour>,
    /// The index of every pixel of every picture.
    pictures: Vec<Vec<u8>>,
}

/// The part of a picture that differs from the one before.
pub struct Change {
    /// Upper left corner \[px\]; both are even.
    pub corner: [u32; 2],
    /// Width and height \[px\].
    pub size: [u32; 2],
    /// The index of each pixel; `None` where it is unchanged.
    pub pixels: Vec<Option<u8>>,
    /// Duration of the picture \[s\].
    pub shown_s: f64,
}

impl Film {
    /// Draws all pictures in parallel; `None` if their size is zero.
    pub fn draw(pictures: &dyn Pictures) -> Option<Film> {
        let count = pictures.count();
        let samples: Vec<usize> = (0..count).step_by(PALETTE_STRIDE).chain([count - 1]).collect();
        let samples = samples.into_par_iter().map(|index| pictures.draw(index)).collect::<Option<Vec<Vec<u8>>>>()?;
        let table = ColourTable::quantise(&samples, &pictures.exact_colours());
        drop(samples);
        let drawn = |index: usize| Some(table.indices(&pictures.draw(index)?));
        let drawn = (0..count).into_par_iter().map(drawn).collect::<Option<Vec<Vec<u8>>>>()?;
        Some(Film { size: pictures.size(), colours: table.colours, pictures: drawn })
    }

    /// Number of pictures.
    pub fn count(&self) -> usize {
        self.pictures.len()
    }

    /// The part of a picture that differs from the previous one; the whole first picture.
    pub fn change(&self, index: usize) -> Change {
        let [width, height] = self.size.map(|part| part as usize);
        let now = &self.pictures[index];
        let shown_s = if index + 1 == self.count() { LAST_PICTURE_S } else { PICTURE_S };
        let Some(before) = index.checked_sub(1).map(|before| &self.pictures[before]) else {
            let pixels = now.iter().map(|pixel| Some(*pixel)).collect();
            return Change { corner: [0, 0], size: self.size, pixels, shown_s };
        };
        let differs = |x: usize, y: usize| now[y * width + x] != before[y * width + x];
        let rows: Vec<usize> =
            (0..height).filter(|y| now[y * width..][..width] != before[y * width..][..width]).collect();
        let [top, bottom] = [rows.first(), rows.last()].map(|row| row.copied().unwrap_or_default());
        let columns = || 0..width;
        let left = columns().find(|x| rows.iter().any(|y| differs(*x, *y))).unwrap_or_default();
        let right = columns().rev().find(|x| rows.iter().any(|y| differs(*x, *y))).unwrap_or_default();
        // In WebP, the corners of a changed part have even coordinates.
        let (left, top) = (left & !1, top & !1);
        let pixel = |x: usize, y: usize| differs(x, y).then(|| now[y * width + x]);
        let pixels =
            (top..=bottom).flat_map(|y| (left..=right).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect();
        let size = [(right - left + 1) as u32, (bottom - top + 1) as u32];
        Change { corner: [left as u32, top as u32], size, pixels, shown_s }
    }
}
