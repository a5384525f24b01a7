//! WebP, lossless: each picture is encoded by `image-webp`, which writes single pictures, and put into the container of an
//! animation.
//!
//! Source: Google, "WebP Container Specification" (RFC 9649, section 2.7): `RIFF` with the chunks `VP8X`, `ANIM`, and an
//! `ANMF` for each picture.

use image_webp::{ColorType, EncoderParams, EncodingError, WebPEncoder};
use rayon::prelude::*;

use super::film::{Change, Film};

/// Flags of the chunk `VP8X`: the file has an animation, and transparent pixels.
const ANIMATED_AND_TRANSPARENT: u8 = 0b0001_0010;
/// Bytes of a file before its first chunk.
const RIFF_HEADER_BYTES: usize = 12;

/// A film as a WebP that repeats forever.
pub fn webp(film: &Film) -> Result<Vec<u8>, EncodingError> {
    let frames = (0..film.count()).into_par_iter().map(|index| frame(film, &film.change(index)));
    let frames = frames.collect::<Result<Vec<Vec<u8>>, EncodingError>>()?;
    let [width, height] = film.size;
    let header = [&[ANIMATED_AND_TRANSPARENT, 0, 0, 0], &three_bytes(width - 1)[..], &three_bytes(height - 1)].concat();
    // Background colour, which viewers ignore, and unlimited repetitions.
    let animation = [0xFF, 0xFF, 0xFF, 0xFF, 0, 0];
    let chunks = [chunk(b"VP8X", &header), chunk(b"ANIM", &animation), frames.concat()].concat();
    Ok(chunk(b"RIFF", &[&b"WEBP"[..], &chunks].concat()))
}

fn frame(film: &Film, change: &Change) -> Result<Vec<u8>, EncodingError> {
    let rgba = |pixel: &Option<u8>| match pixel {
        Some(index) => {
            let [red, green, blue] = film.colours[usize::from(*index)];
            [red, green, blue, 255]
        }
        None => [0; 4],
    };
    let pixels: Vec<u8> = change.pixels.iter().flat_map(rgba).collect();
    let ([left, top], [width, height]) = (change.corner, change.size);
    // Flat areas often compress better without prediction from their neighbours.
    let encoded = |use_predictor_transform: bool| {
        let mut parameters = EncoderParams::default();
        parameters.use_predictor_transform = use_predictor_transform;
        let mut still = Vec::new();
        let mut encoder = WebPEncoder::new(&mut still);
        encoder.set_params(parameters);
        encoder.encode(&pixels, width, height, ColorType::Rgba8).map(|()| still)
    };
    let (plain, predicted) = (encoded(false)?, encoded(true)?);
    let still = if predicted.len() < plain.len() { predicted } else { plain };
    let milliseconds = (1000.0 * change.shown_s).round() as u32;
    let place = [left / 2, top / 2, width - 1, height - 1, milliseconds].map(three_bytes).concat();
    // Transparent pixels keep the previous picture.
    let content = [&place[..], &[0], &still[RIFF_HEADER_BYTES.min(still.len())..]].concat();
    Ok(chunk(b"ANMF", &content))
}

/// A chunk: name, length, content, and a byte if the length is odd.
fn chunk(name: &[u8; 4], content: &[u8]) -> Vec<u8> {
    let length = (content.len() as u32).to_le_bytes();
    let padding = vec![0; content.len() % 2];
    [&name[..], &length, content, &padding].concat()
}

fn three_bytes(number: u32) -> [u8; 3] {
    let [low, middle, high, _] = number.to_le_bytes();
    [low, middle, high]
}
