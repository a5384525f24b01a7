//! At most 127 colours for all pictures together: seven bits a pixel, and enough for flat areas with smooth edges.
//!
//! The most frequent colours stay as they are: flat areas have few. The others, most of them on smooth edges, are merged by
//! median cut: the box of colours with the greatest extent is divided at its median until there are enough.

use std::collections::BTreeMap;

use crate::palette::Colour;

/// Most exact colours, including the requested ones.
const MAX_EXACT: usize = 56;
/// Most colours; one more index is left for "unchanged".
const MAX_COLOURS: usize = 127;
/// A colour that covers at least this share of the pixels stays exact.
const MIN_EXACT_SHARE: f64 = 2e-4;
/// Leading bits of red, green and blue that select the nearest colour of the palette.
const BITS: u32 = 5;

/// A palette, with a lookup table from the leading bits of a colour to the index of the nearest colour in the palette.
pub struct ColourTable {
    /// At most 127 colours.
    pub colours: Vec<Colour>,
    exact: BTreeMap<Colour, u8>,
    nearest: Vec<u8>,
}

impl ColourTable {
    /// The table of some pictures, with colours that must stay exact.
    pub fn quantise(pictures: &[Vec<u8>], exact: &[Colour]) -> ColourTable {
        let mut counts: BTreeMap<Colour, usize> = BTreeMap::new();
        for pixels in pictures {
            for run in pixels.as_chunks::<3>().0.chunk_by(|a, b| a == b) {
                *counts.entry(run[0]).or_default() += run.len();
            }
        }
        let all: usize = counts.values().sum();
        let mut frequent: Vec<(Colour, usize)> = counts.iter().map(|(colour, count)| (*colour, *count)).collect();
        frequent.sort_by_key(|(colour, count)| (std::cmp::Reverse(*count), *colour));
        let mut colours: Vec<Colour> = Vec::new();
        let common = frequent.iter().filter(|(_, count)| *count as f64 > MIN_EXACT_SHARE * all as f64);
        for colour in exact.iter().chain(common.map(|(colour, _)| colour)) {
            if !colours.contains(colour) && colours.len() < MAX_EXACT {
                colours.push(*colour);
            }
        }
        let rest: Vec<(Colour, usize)> = frequent.into_iter().filter(|(colour, _)| !colours.contains(colour)).collect();
        let exact: BTreeMap<Colour, u8> =
            colours.iter().enumerate().map(|(index, colour)| (*colour, index as u8)).collect();
        let space = MAX_COLOURS - colours.len();
        colours.extend(median_cut(rest, space));
        let nearest = (0..1_u32 << (3 * BITS)).map(|key| nearest(&colours, centre(key))).collect();
        ColourTable { colours, exact, nearest }
    }

    /// The index of every pixel of a picture.
    pub fn indices(&self, pixels: &[u8]) -> Vec<u8> {
        let mut indices = Vec::with_capacity(pixels.len() / 3);
        for run in pixels.as_chunks::<3>().0.chunk_by(|a, b| a == b) {
            let index = self.exact.get(&run[0]).copied().unwrap_or_else(|| self.nearest[key(run[0])]);
            indices.extend(std::iter::repeat_n(index, run.len()));
        }
        indices
    }
}

fn key(colour: Colour) -> usize {
    colour.iter().fold(0, |key, part| key << BITS | usize::from(part >> (8 - BITS)))
}

/// The colour in the middle of all those with a key.
fn centre(key: u32) -> Colour {
    let part = |shift: u32| (((key >> (shift * BITS)) & ((1 << BITS) - 1)) << (8 - BITS) | 1 << (7 - BITS)) as u8;
    [part(2), part(1), part(0)]
}

fn nearest(colours: &[Colour], to: Colour) -> u8 {
    // Green counts most for the eye, blue least.
    let distance = |colour: &Colour| {
        let off = |part: usize| i32::from(colour[part]) - i32::from(to[part]);
        3 * off(0) * off(0) + 6 * off(1) * off(1) + off(2) * off(2)
    };
    let found = colours.iter().enumerate().min_by_key(|(_, colour)| distance(colour));
    found.map_or(0, |(index, _)| index as u8)
}

/// At most `limit` colours that represent all.
fn median_cut(colours: Vec<(Colour, usize)>, limit: usize) -> Vec<Colour> {
    let mut boxes: Vec<Vec<(Colour, usize)>> = Vec::new();
    if !colours.is_empty() {
        boxes.push(colours);
    }
    while boxes.len() < limit {
        let weight = |part: &Vec<(Colour, usize)>| {
            let pixels: usize = part.iter().map(|(_, count)| count).sum();
            f64::from(extent(part).0) * (pixels as f64).sqrt()
        };
        let largest = boxes.iter().enumerate().filter(|(_, part)| part.len() > 1);
        let Some((index, _)) = largest.max_by(|(_, a), (_, b)| weight(a).total_cmp(&weight(b))) else { break };
        let mut part = boxes.swap_remove(index);
        let axis = extent(&part).1;
        part.sort_by_key(|(colour, _)| (colour[axis], *colour));
        let half = part.iter().map(|(_, count)| count).sum::<usize>() / 2;
        let mut before = 0;
        let median = part.iter().position(|(_, count)| {
            before += count;
            before > half
        });
        let cut = median.unwrap_or_default().clamp(1, part.len() - 1);
        let other = part.split_off(cut);
        boxes.extend([part, other]);
    }
    boxes.iter().map(|part| mean(part)).collect()
}

/// The greatest extent of some colours, and along which part.
fn extent(colours: &[(Colour, usize)]) -> (u8, usize) {
    let of = |axis: usize| {
        let values = || colours.iter().map(|(colour, _)| colour[axis]);
        values().max().unwrap_or_default() - values().min().unwrap_or_default()
    };
    (0..3).map(|axis| (of(axis), axis)).max().unwrap_or_default()
}

fn mean(colours: &[(Colour, usize)]) -> Colour {
    let all: usize = colours.iter().map(|(_, count)| count).sum();
    [0, 1, 2].map(|axis| {
        let sum: usize = colours.iter().map(|(colour, count)| usize::from(colour[axis]) * count).sum();
        (sum / all.max(1)) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantisation_keeps_exact_colours_and_shifts_others_little() {
        let pixels: Vec<u8> =
            (0..60_000_u32).flat_map(|i| [(i % 251) as u8, (i / 251 % 241) as u8, (i % 97) as u8]).collect();
        let table = ColourTable::quantise(std::slice::from_ref(&pixels), &[[230, 159, 0], [1, 2, 3]]);
        assert!(table.colours.len() <= 255);
        let exact = table.indices(&[230, 159, 0, 1, 2, 3]);
        assert_eq!(
            exact.iter().map(|index| table.colours[usize::from(*index)]).collect::<Vec<_>>(),
            [[230, 159, 0], [1, 2, 3]]
        );
        let indices = table.indices(&pixels);
        assert_eq!(indices.len(), 60_000);
        let off = |pixel: usize| {
            let found = table.colours[usize::from(indices[pixel])];
            (0..3).map(|part| found[part].abs_diff(pixels[3 * pixel + part])).max().unwrap_or_default()
        };
        let mean = (0..60_000).map(|pixel| f64::from(off(pixel))).sum::<f64>() / 60_000.0;
        assert!(mean < 24.0, "{mean}");
    }

    #[test]
    fn a_picture_with_few_colours_keeps_all_of_them() {
        let pixels: Vec<u8> = [[9, 8, 7], [1, 1, 1], [200, 100, 0]].concat().repeat(50);
        let table = ColourTable::quantise(std::slice::from_ref(&pixels), &[]);
        let shown: Vec<u8> =
            table.indices(&pixels).iter().flat_map(|index| table.colours[usize::from(*index)]).collect();
        assert_eq!(shown, pixels);
    }
}
