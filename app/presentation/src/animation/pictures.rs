//! A sequence of pictures of one size, each of which can be drawn by itself.

use crate::palette::Colour;

/// Red, green and blue of every pixel, row by row.
pub type Rgb = Vec<u8>;

/// Pictures that are drawn when they are needed, on any thread.
pub trait Pictures: Sync {
    /// How many there are; at least one.
    fn count(&self) -> usize;

    /// Width and height of each, both even \[px\].
    fn size(&self) -> [u32; 2];

    /// Draws one; none if its size is zero.
    fn draw(&self, index: usize) -> Option<Rgb>;

    /// Colours that must stay as they are where there is space for few colours only.
    fn exact_colours(&self) -> Vec<Colour>;
}
