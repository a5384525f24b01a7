//! GIF: one palette for all pictures, and only the changed part of each.

use std::borrow::Cow;

use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use rayon::prelude::*;

use super::film::Film;

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
