//! Animations of runs, seen from above, as files that every browser shows.
//!
//! ```text
//! recorded run -> picture times, views, scenes -> pictures -> palette and changes -> GIF, WebP, PNG, MP4
//! ```
//!
//! A run with vehicles is a top view that follows the interaction, a building is its floor plan over the day, and a run with
//! both shows one after the other. A picture is a function of the recorded run and its index, so pictures are drawn in parallel,
//! and the same run gives the same bytes. Only this folder names `tiny-skia`, `ab_glyph`, `gif` and `image-webp`.

mod building;
mod camera;
mod canvas;
mod caption;
mod chart;
mod driving;
mod encode;
mod file;
mod flow;
mod legend;
mod letters;
mod pictures;
mod ribbon;
mod road;
mod rooms;
mod scene;
#[cfg(test)]
mod tests;
mod timing;
mod vehicle;

pub use file::{AnimationError, AnimationFile, AnimationFormat, AnimationFormatError};

use std::io;

use building::BuildingPictures;
use driving::DrivingPictures;
use encode::Film;
use pictures::{PictureSequence, Pictures};

use crate::figures::RecordedRun;

impl AnimationFile {
    /// Checks that the file can be written, without leaving a file behind.
    ///
    /// # Errors
    /// [`AnimationError::Unwritable`].
    pub fn check(&self) -> Result<(), AnimationError> {
        interplay_files::check(self.path()).map_err(|reason| self.unwritable(reason))
    }

    /// Draws a run and writes the file, whole or not at all; folders are made as needed.
    ///
    /// A run of 12 s takes about 3 s on two cores as a GIF.
    pub fn write(&self, recorded: &RecordedRun) -> Result<(), AnimationError> {
        let content = encoded(recorded, self.format())?;
        interplay_files::write(self.path(), &content).map_err(|reason| self.unwritable(reason))
    }

    fn unwritable(&self, reason: io::Error) -> AnimationError {
        AnimationError::Unwritable { path: self.path().to_owned(), reason }
    }
}

/// An animated run as the bytes of a file.
///
/// # Errors
/// [`AnimationError::Nothing`] for a run with neither vehicles nor rooms, and errors of the encoder.
pub fn encoded(recorded: &RecordedRun, format: AnimationFormat) -> Result<Vec<u8>, AnimationError> {
    match (DrivingPictures::from_run(recorded), BuildingPictures::from_run(recorded)) {
        (Some(road), Some(rooms)) => encode(&PictureSequence::new(&road, &rooms), format),
        (Some(road), None) => encode(&road, format),
        (None, Some(rooms)) => encode(&rooms, format),
        (None, None) => Err(AnimationError::Nothing),
    }
}

/// The last picture of a run with vehicles: its width and height \[px\], and red, green and blue of every pixel, row by row.
pub fn last_picture(recorded: &RecordedRun) -> Option<([u32; 2], Vec<u8>)> {
    let pictures = DrivingPictures::from_run(recorded)?;
    Some((pictures.size(), pictures.draw(pictures.count().checked_sub(1)?)?))
}

fn encode(pictures: &dyn Pictures, format: AnimationFormat) -> Result<Vec<u8>, AnimationError> {
    let film = || Film::draw(pictures).ok_or(AnimationError::Nothing);
    match format {
        AnimationFormat::Gif => encode::gif(&film()?).map_err(AnimationError::encoding),
        AnimationFormat::WebP => encode::webp(&film()?).map_err(AnimationError::encoding),
        AnimationFormat::Filmstrip => encode::filmstrip(pictures).map_err(AnimationError::encoding),
        AnimationFormat::Mp4 => encode::mp4(pictures).map_err(AnimationError::Film),
    }
}
