//! In which format an animation is written: the ending of its file decides.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use thiserror::Error;

use super::encode::has_ffmpeg;

/// The formats of animations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnimationFormat {
    /// A GIF that repeats for ever.
    Gif,
    /// A lossless WebP that repeats for ever.
    WebP,
    /// Eight pictures beside and below one another.
    Filmstrip,
    /// A film, by `ffmpeg`.
    Mp4,
}

/// A file that an animation is written to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AnimationFile {
    path: PathBuf,
    format: AnimationFormat,
}

/// Why no animation can be written to a file of that name.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum AnimationFormatError {
    /// The ending of the file's name stands for no format.
    #[error("`{path}` has no ending of an animation; use .gif, .webp, .png (a filmstrip) or .mp4 (through ffmpeg)")]
    UnknownEnding {
        /// Path of the file.
        path: String,
    },
    /// MP4 needs a program that is not there.
    #[error("`{path}` needs the program ffmpeg, which is not on the path; use .gif, .webp or .png (a filmstrip)")]
    NoFfmpeg {
        /// Path of the file.
        path: String,
    },
}

impl AnimationFile {
    /// A file that is written as GIF, whatever its name.
    pub fn gif(path: PathBuf) -> AnimationFile {
        AnimationFile { path, format: AnimationFormat::Gif }
    }

    /// Path of the file.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_decides_and_an_unknown_one_is_refused_with_the_list() {
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
