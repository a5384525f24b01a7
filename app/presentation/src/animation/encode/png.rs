//! A filmstrip: pictures beside and below one another in one PNG.

use rayon::prelude::*;

use crate::animation::pictures::Pictures;
use crate::plot::png_of;

/// Number of pictures in a filmstrip, and of those side by side.
const COUNT: usize = 8;
const COLUMNS: usize = 2;
/// Space between pictures \[px\].
const GAP_PX: usize = 6;
const PAPER: u8 = 0xFF;

/// A filmstrip as PNG: pictures at equal intervals of time, including the first and the last.
pub fn filmstrip(pictures: &dyn Pictures) -> Result<Vec<u8>, png::EncodingError> {
    let [width, height] = pictures.size().map(|part| part as usize);
    let last = pictures.count() - 1;
    let mut shown: Vec<usize> = (0..COUNT).map(|index| index * last / (COUNT - 1)).collect();
    shown.dedup();
    let drawn: Vec<Vec<u8>> = shown.par_iter().filter_map(|index| pictures.draw(*index)).collect();
    let along = |count: usize, side: usize| count * side + (count - 1) * GAP_PX;
    let (columns, rows) = (COLUMNS.min(drawn.len()).max(1), drawn.len().div_ceil(COLUMNS).max(1));
    let [wide, high] = [along(columns, width), along(rows, height)];
    let mut strip = vec![PAPER; 3 * wide * high];
    for (index, pixels) in drawn.iter().enumerate() {
        let (left, top) = (index % COLUMNS * (width + GAP_PX), index / COLUMNS * (height + GAP_PX));
        for (row, line) in pixels.chunks_exact(3 * width).enumerate() {
            strip[3 * ((top + row) * wide + left)..][..3 * width].copy_from_slice(line);
        }
    }
    png_of((wide as u32, high as u32), &strip)
}
