//! The one room that names Plotters: figures as SVG and PNG, labelled with a font inside the binary.
//!
//! A figure is drawn by one function for both, so that the two show the same. Most are a [`Drawing`], which pure functions
//! make: [`Panels`] of curves, a [`FootprintPlot`] of footprints, a [`TextTable`] of words.

mod axis;
mod drawing;
mod footprints;
mod identification;
mod legend;
mod panels;
pub mod style;
mod table;

use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::{fs, io};

use plotters::coord::Shift;
use plotters::drawing::DrawingAreaErrorKind;
use plotters::prelude::*;
use plotters::style::register_font;
use thiserror::Error;

pub use drawing::Drawing;
pub use footprints::{FootprintPlot, FootprintSnapshot, Strip};
pub use identification::identification;
pub use panels::{Curve, Panel, Panels};
pub use table::TextTable;

/// Width and height of a figure \[points, and pixels of the PNG\].
const SIZE: (u32, u32) = (1200, 520);
/// The font of all labels.
const FONT: &str = "sans-serif";
static FONT_BYTES: &[u8] = include_bytes!("../../../../assets/fonts/DejaVuSans.ttf");

/// Colours of Okabe and Ito, which survive colour blindness.
const BLUE: RGBColor = RGBColor(0x00, 0x72, 0xB2);
const ORANGE: RGBColor = RGBColor(0xE6, 0x9F, 0x00);
const GREEN: RGBColor = RGBColor(0x00, 0x9E, 0x73);
const GREY: RGBColor = RGBColor(0x66, 0x66, 0x66);

/// Why a figure was not made.
#[derive(Debug, Error)]
pub enum PlotError {
    /// The disk refuses it.
    #[error("cannot write the plots to {}: {reason}; name another folder", folder.display())]
    Unwritable {
        /// Where they should go.
        folder: PathBuf,
        /// What the system says.
        reason: io::Error,
    },
    /// The drawing itself failed.
    #[error("cannot draw {name}: {reason}")]
    Drawing {
        /// The figure.
        name: String,
        /// What Plotters says.
        reason: String,
    },
}

/// What drawing returns, whatever it is drawn on.
type Drawn<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

/// A figure that can be drawn on anything.
trait Figure {
    /// Width and height \[points, and pixels of the PNG\].
    fn size(&self) -> (u32, u32) {
        SIZE
    }

    /// Draws it.
    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Drawn<B>;
}

/// Makes the folder in which plots go.
fn make_folder(folder: &Path) -> Result<(), PlotError> {
    fs::create_dir_all(folder).map_err(|reason| PlotError::Unwritable { folder: folder.to_owned(), reason })
}

/// Makes the font known to Plotters, once; whether that works.
fn register() -> bool {
    static REGISTERED: LazyLock<bool> = LazyLock::new(|| register_font(FONT, FontStyle::Normal, FONT_BYTES).is_ok());
    *REGISTERED
}

/// The figure as SVG.
fn svg(name: &str, figure: &impl Figure) -> Result<String, PlotError> {
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
fn save(folder: &Path, name: &str, figure: &impl Figure) -> Result<[PathBuf; 2], PlotError> {
    let [vector, raster] = ["svg", "png"].map(|ending| folder.join(format!("{name}.{ending}")));
    let unwritable = |reason| PlotError::Unwritable { folder: folder.to_owned(), reason };
    fs::write(&vector, svg(name, figure)?).map_err(unwritable)?;
    {
        let failed = |reason: String| PlotError::Drawing { name: name.to_owned(), reason };
        let area = BitMapBackend::new(&raster, figure.size()).into_drawing_area();
        figure.draw(&area).and_then(|()| area.present()).map_err(|error| failed(error.to_string()))?;
    }
    Ok([vector, raster])
}

impl Drawing {
    /// The picture as SVG.
    ///
    /// # Errors
    /// [`PlotError::Drawing`].
    pub fn svg(&self) -> Result<String, PlotError> {
        svg("the picture", self)
    }

    /// Writes `name.svg` and `name.png` into a folder, which is made if it is not there; says where.
    ///
    /// # Errors
    /// [`PlotError`].
    pub fn save(&self, folder: &Path, name: &str) -> Result<[PathBuf; 2], PlotError> {
        make_folder(folder)?;
        save(folder, name, self)
    }
}

/// Smallest and largest of the finite values, with a margin.
fn range(values: impl IntoIterator<Item = f64>) -> std::ops::Range<f64> {
    let finite = values.into_iter().filter(|value| value.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if low > high {
        return 0.0..1.0;
    }
    let margin = (0.05 * (high - low)).max(1e-6);
    low - margin..high + margin
}
