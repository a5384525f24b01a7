//! Pictures as files: GIF, WebP, a filmstrip as PNG, and MP4 by ffmpeg.

mod film;
mod gif;
mod mp4;
mod png;
mod quantise;
mod webp;

pub use film::Film;
pub use gif::gif;
pub use mp4::{has_ffmpeg, mp4};
pub use png::filmstrip;
pub use webp::webp;
