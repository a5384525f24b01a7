//! Files of animations, their formats, and the errors of writing them. The ending of the file name decides the format.

use std::io;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use thiserror::Error;

use super::encode::has_ffmpeg;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnimationFormat {
    /// A GIF that repeats forever.
    Gif,
    /// A lossless WebP that repeats forever.
    WebP,
    /// Eight pictures beside and below one another.
    Filmstrip,
    /// A film, by `ffmpeg`.
    Mp4,
}

/// The output file of an animation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AnimationFile {
    path: PathBuf,
    format: AnimationFormat,
}

/// Why the name of a file does not select a usable format.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum AnimationFormatError {
    /// The ending of the file name is not that of a format.
    #[error("`{path}` does not end like an animation; use .gif, .webp, .png (a filmstrip) or .mp4 (through ffmpeg)")]
    UnknownEnding { path: String },
    /// MP4 needs ffmpeg, which is not installed.
    #[error("`{path}` needs the program ffmpeg, which is not on the path; use .gif, .webp or .png (a filmstrip)")]
    NoFfmpeg { path: String },
}

impl AnimationFile {
    /// A GIF file, regardless of its ending.
    pub fn gif(path: PathBuf) -> AnimationFile {
        AnimationFile { path, format: AnimationFormat::Gif }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The format that it is written in.
    pub fn format(&self) -> AnimationFormat {
        self.format
    }
}

impl FromStr for AnimationFile {
    type Err = AnimationFormatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let path = PathBuf::from(text);
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let format = match ending.as_deref() {
            Some("gif") => AnimationFormat::Gif,
            Some("webp") => AnimationFormat::WebP,
            Some("png") => AnimationFormat::Filmstrip,
            Some("mp4") if has_ffmpeg() => AnimationFormat::Mp4,
            Some("mp4") => return Err(AnimationFormatError::NoFfmpeg { path: text.to_owned() }),
            _ => return Err(AnimationFormatError::UnknownEnding { path: text.to_owned() }),
        };
        Ok(AnimationFile { path, format })
    }
}

/// Why an animation was not written. An existing file is unchanged.
#[derive(Debug, Error)]
pub enum AnimationError {
    /// The run has neither vehicles nor a building to draw.
    #[error("nothing to animate: the run has neither vehicles nor rooms")]
    Nothing,
    /// An encoder failed.
    #[error("cannot encode the animation: {0}")]
    Encoding(Box<dyn std::error::Error + Send + Sync>),
    /// ffmpeg failed.
    #[error("cannot make the film: {0}")]
    Film(io::Error),
    /// The file cannot be written.
    #[error("cannot write the animation {}: {reason}; choose another path", path.display())]
    Unwritable { path: PathBuf, reason: io::Error },
}

impl AnimationError {
    pub(super) fn encoding(error: impl std::error::Error + Send + Sync + 'static) -> AnimationError {
        AnimationError::Encoding(Box::new(error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_selects_the_format_and_unknown_endings_are_refused() {
        let format = |text: &str| text.parse::<AnimationFile>().map(|file| file.format());
        assert_eq!(format("a/run.gif"), Ok(AnimationFormat::Gif));
        assert_eq!(format("run.WebP"), Ok(AnimationFormat::WebP));
        assert_eq!(format("run.png"), Ok(AnimationFormat::Filmstrip));
        for text in ["run.avi", "run", ".gif", ""] {
            let error = format(text).expect_err("no format").to_string();
            assert!([".gif", ".webp", ".png", ".mp4"].iter().all(|ending| error.contains(ending)), "{error}");
        }
    }
}
