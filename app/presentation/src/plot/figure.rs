//! A figure: what Plotters can draw, as SVG and as PNG, and the font of its labels.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use plotters::coord::Shift;
use plotters::drawing::DrawingAreaErrorKind;
use plotters::prelude::*;
use plotters::style::register_font;
use thiserror::Error;

use crate::font::FONT_BYTES;

/// Width and height of a figure: pixels of the PNG, and points of the SVG.
const SIZE_PX: (u32, u32) = (1200, 520);
/// The font of all labels.
pub(super) const FONT: &str = "sans-serif";

/// Why a figure was not made.
#[derive(Debug, Error)]
pub enum PlotError {
    /// A file or folder cannot be written.
    #[error("cannot write the plots to {}: {reason}; name another folder", folder.display())]
    Unwritable {
        /// Path of the folder.
        folder: PathBuf,
        /// The message of the operating system.
        reason: io::Error,
    },
    /// The drawing itself failed.
    #[error("cannot draw {name}: {reason}")]
    Drawing {
        /// Name of the figure.
        name: String,
        /// The message of Plotters.
        reason: String,
    },
}

/// The result of drawing on any backend.
pub(super) type Drawn<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

/// A figure that can be drawn on any backend.
pub(super) trait Figure {
    /// Width and height \[points, and pixels of the PNG\].
    fn size(&self) -> (u32, u32) {
        SIZE_PX
    }

    /// Draws it.
    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Drawn<B>;
}

/// Creates the folder for the plots.
pub(super) fn make_folder(folder: &Path) -> Result<(), PlotError> {
    fs::create_dir_all(folder).map_err(|reason| PlotError::Unwritable { folder: folder.to_owned(), reason })
}

/// Registers the font in Plotters, once. Returns whether it is registered.
pub(super) fn register() -> bool {
    static REGISTERED: LazyLock<bool> = LazyLock::new(|| register_font(FONT, FontStyle::Normal, FONT_BYTES).is_ok());
    *REGISTERED
}

/// The figure as SVG.
pub(super) fn svg(name: &str, figure: &impl Figure) -> Result<String, PlotError> {
    let failed = |reason: String| PlotError::Drawing { name: name.to_owned(), reason };
    if !register() {
        return Err(failed("the font is broken".to_owned()));
    }
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, figure.size()).into_drawing_area();
        figure.draw(&area).and_then(|()| area.present()).map_err(|error| failed(error.to_string()))?;
    }
    Ok(svg)
}

/// Writes `name.svg` and `name.png`.
pub(super) fn save(folder: &Path, name: &str, figure: &impl Figure) -> Result<[PathBuf; 2], PlotError> {
    let [vector, raster] = ["svg", "png"].map(|ending| folder.join(format!("{name}.{ending}")));
    let unwritable = |reason| PlotError::Unwritable { folder: folder.to_owned(), reason };
    interplay_files::write(&vector, svg(name, figure)?.as_bytes()).map_err(unwritable)?;
    let png = png_of(figure.size(), &pixels(name, figure)?).map_err(|error| unwritable(io::Error::other(error)))?;
    interplay_files::write(&raster, &png).map_err(unwritable)?;
    Ok([vector, raster])
}

/// The figure as red, green and blue bytes, row by row from the top.
fn pixels(name: &str, figure: &impl Figure) -> Result<Vec<u8>, PlotError> {
    let failed = |reason: String| PlotError::Drawing { name: name.to_owned(), reason };
    let (width, height) = figure.size();
    let mut pixels = vec![0; 3 * width as usize * height as usize];
    {
        let area = BitMapBackend::with_buffer(&mut pixels, (width, height)).into_drawing_area();
        figure.draw(&area).and_then(|()| area.present()).map_err(|error| failed(error.to_string()))?;
    }
    Ok(pixels)
}

/// Pixels as a PNG file. Plotters' own encoder would add a second version of the `image` crate, beside Rerun's.
fn png_of((width, height): (u32, u32), pixels: &[u8]) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(file)
}
