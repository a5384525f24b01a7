//! All pictures of an animation with one palette, and the changes from each picture to the next.

use std::borrow::Cow;
use std::io::{self, Read, Write};
use std::process::{Command, Stdio};

use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use rayon::prelude::*;

use super::quantise::ColourTable;
use crate::animation::pictures::Pictures;
use crate::animation::timing::{LAST_PICTURE_S, PICTURE_S};
use crate::palette::Colour;
use crate::plot::png_of;
use crate::shell::is_on_path;

/// Distance between the pictures that determine the palette.
const PALETTE_STRIDE: usize = 9;

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

/// A film as a GIF that repeats forever.
pub fn gif(film: &Film) -> Result<Vec<u8>, EncodingError> {
    let palette: Vec<u8> = film.colours.iter().flatten().copied().collect();
    let as_before = film.colours.len() as u8;
    // One more entry for the index that means "unchanged".
    let palette = [palette, vec![0; 3]].concat();
    let frame = |index: usize| {
        let change = film.change(index);
        let mut frame = Frame {
            left: change.corner[0] as u16,
            top: change.corner[1] as u16,
            width: change.size[0] as u16,
            height: change.size[1] as u16,
            delay: (100.0 * change.shown_s).round() as u16,
            dispose: DisposalMethod::Keep,
            transparent: Some(as_before),
            buffer: Cow::Owned(change.pixels.into_iter().map(|pixel| pixel.unwrap_or(as_before)).collect()),
            ..Frame::default()
        };
        frame.make_lzw_pre_encoded();
        frame
    };
    let frames: Vec<Frame> = (0..film.count()).into_par_iter().map(frame).collect();
    let [width, height] = film.size.map(|part| u16::try_from(part).unwrap_or(u16::MAX));
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height, &palette)?;
    encoder.set_repeat(Repeat::Infinite)?;
    frames.iter().try_for_each(|frame| encoder.write_lzw_pre_encoded_frame(frame))?;
    drop(encoder);
    Ok(bytes)
}

/// Whether `ffmpeg` is on the path.
pub fn has_ffmpeg() -> bool {
    is_on_path("ffmpeg")
}

pub fn mp4(pictures: &dyn Pictures) -> io::Result<Vec<u8>> {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("animation.mp4");
    let [width, height] = pictures.size();
    let (size, rate) = (format!("{width}x{height}"), format!("{:.3}", 1.0 / PICTURE_S));
    let mut child = Command::new("ffmpeg")
        .args(["-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", &size, "-r", &rate, "-i", "-"])
        .args(["-pix_fmt", "yuv420p", "-movflags", "+faststart"])
        .arg(&file)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()?;
    let written = child.stdin.take().map_or(Ok(()), |mut input| write_all(pictures, &mut input));
    let mut said = String::new();
    if let Some(mut errors) = child.stderr.take() {
        errors.read_to_string(&mut said)?;
    }
    if !child.wait()?.success() {
        let last = said.lines().last().unwrap_or("no message").to_owned();
        return Err(io::Error::other(format!("ffmpeg failed: {last}")));
    }
    written?;
    std::fs::read(file)
}

fn write_all(pictures: &dyn Pictures, input: &mut impl Write) -> io::Result<()> {
    let stays = (LAST_PICTURE_S / PICTURE_S) as usize;
    let last = pictures.count() - 1;
    for index in (0..last).chain(std::iter::repeat_n(last, stays)) {
        input.write_all(&pictures.draw(index).unwrap_or_default())?;
    }
    Ok(())
}

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
