//! Pictures as files: GIF, WebP, a filmstrip as PNG, and MP4 by ffmpeg.

mod film;
mod quantise;
mod webp;

pub use film::{Film, filmstrip, gif, has_ffmpeg, mp4};
pub use webp::webp;
