//! Drawings as SVG and PNG. Only this module names Plotters, which draws the same marks in both formats.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use plotters::coord::Shift;
use plotters::drawing::DrawingAreaErrorKind;
use plotters::prelude::*;
use plotters::style::register_font;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use thiserror::Error;

use super::drawing::{Drawing, Mark, Side};
use super::style::{Colour, Dash};

/// DejaVu Sans as a TrueType file, the font of all pictures.
pub(crate) static FONT_BYTES: &[u8] = include_bytes!("../../../../assets/fonts/DejaVuSans.ttf");
/// The name by which Plotters knows the font.
const FONT: &str = "sans-serif";
/// Lines are split at corners whose turning angle has a smaller cosine, where Plotters would draw spikes on wide lines.
const MIN_UNSPLIT_TURN_COS: f64 = 0.7;

/// Why a picture was not made.
#[derive(Debug, Error)]
pub enum PlotError {
    /// A file or folder cannot be written.
    #[error("cannot write the plots to {}: {reason}; name another folder", folder.display())]
    Unwritable {
        folder: PathBuf,
        /// The message of the operating system.
        reason: io::Error,
    },
    /// Plotters cannot draw the picture.
    #[error("cannot draw the picture: {0}")]
    Drawing(String),
}

type Drawn<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

impl Drawing {
    /// The picture as SVG.
    ///
    /// # Errors
    /// [`PlotError::Drawing`].
    pub fn svg(&self) -> Result<String, PlotError> {
        if !register() {
            return Err(PlotError::Drawing("the font is broken".to_owned()));
        }
        let mut svg = String::new();
        self.draw_on(&SVGBackend::with_string(&mut svg, self.size).into_drawing_area())?;
        Ok(svg)
    }

    /// Writes `name.svg` and `name.png` into a folder, which is created if necessary. Returns their paths.
    pub fn save(&self, folder: &Path, name: &str) -> Result<[PathBuf; 2], PlotError> {
        let [vector, raster] = ["svg", "png"].map(|ending| folder.join(format!("{name}.{ending}")));
        let unwritable = |reason| PlotError::Unwritable { folder: folder.to_owned(), reason };
        std::fs::create_dir_all(folder).map_err(unwritable)?;
        interplay_files::write(&vector, self.svg()?.as_bytes()).map_err(unwritable)?;
        let png = png_of(self.size, &self.pixels()?).map_err(|error| unwritable(io::Error::other(error)))?;
        interplay_files::write(&raster, &png).map_err(unwritable)?;
        Ok([vector, raster])
    }

    /// Red, green and blue of every pixel, row by row from the top.
    fn pixels(&self) -> Result<Vec<u8>, PlotError> {
        let (width, height) = self.size;
        let mut pixels = vec![0; 3 * width as usize * height as usize];
        self.draw_on(&BitMapBackend::with_buffer(&mut pixels, self.size).into_drawing_area())?;
        Ok(pixels)
    }

    fn draw_on<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Result<(), PlotError> {
        let drawn: Drawn<B> =
            area.fill(&WHITE).and_then(|()| self.marks.iter().try_for_each(|mark| draw_mark(area, mark)));
        drawn.and_then(|()| area.present()).map_err(|error| PlotError::Drawing(error.to_string()))
    }
}

/// Pixels (red, green, blue) as a PNG file. Plotters' own encoder would add a second version of the `image` crate, beside Rerun's.
pub(crate) fn png_of((width, height): (u32, u32), pixels: &[u8]) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(file)
}

/// Registers the font in Plotters, once. Returns whether it is registered.
fn register() -> bool {
    static REGISTERED: LazyLock<bool> = LazyLock::new(|| register_font(FONT, FontStyle::Normal, FONT_BYTES).is_ok());
    *REGISTERED
}

/// The width of words \[px\].
pub(super) fn width_of(words: &str, size: f64) -> f64 {
    register();
    let measured = (FONT, size).into_font().box_size(words);
    measured.map_or(0.55 * size * words.chars().count() as f64, |(width, _)| f64::from(width))
}

fn draw_mark<B: DrawingBackend>(area: &DrawingArea<B, Shift>, mark: &Mark) -> Drawn<B> {
    match mark {
        Mark::Fill { ring, colour, opacity } => {
            area.draw(&Polygon::new(ring.iter().map(pixel).collect::<Vec<_>>(), rgb(*colour).mix(*opacity).filled()))
        }
        Mark::Line { points, style } => {
            let stroke = rgb(style.colour).stroke_width(style.width);
            pieces(points, style.dash).into_iter().try_for_each(|piece| area.draw(&PathElement::new(piece, stroke)))
        }
        Mark::Disc { centre, radius, colour } => area.draw(&Circle::new(pixel(centre), *radius, rgb(*colour).filled())),
        Mark::Text { at, words, size, colour, side } => {
            let anchor = match side {
                Side::Left => HPos::Left,
                Side::Middle => HPos::Center,
                Side::Right => HPos::Right,
            };
            let colour = rgb(*colour);
            let style = (FONT, *size).into_font().color(&colour).pos(Pos::new(anchor, VPos::Center));
            area.draw(&Text::new(words.as_str(), pixel(at), style))
        }
    }
}

fn rgb([red, green, blue]: Colour) -> RGBColor {
    RGBColor(red, green, blue)
}

fn pixel(&[x, y]: &[f64; 2]) -> (i32, i32) {
    (x.round() as i32, y.round() as i32)
}

/// The pieces in which a line is drawn: dashes without sharp corners.
fn pieces(points: &[[f64; 2]], dash: Dash) -> Vec<Vec<(i32, i32)>> {
    let dashes = if dash == Dash::Solid { vec![points.to_vec()] } else { dashes(points, dash.pattern()) };
    let whole = dashes.into_iter().flat_map(|dash| split_at_corners(&dash));
    whole
        .map(|piece| {
            let mut pixels: Vec<(i32, i32)> = piece.iter().map(pixel).collect();
            pixels.dedup();
            pixels
        })
        .filter(|piece| piece.len() > 1)
        .collect()
}

/// Cuts a line into dashes.
fn dashes(points: &[[f64; 2]], pattern: &[f64]) -> Vec<Vec<[f64; 2]>> {
    let (mut found, mut phase, mut left) = (Vec::new(), 0, pattern[0]);
    let mut dash: Vec<[f64; 2]> = points.first().copied().into_iter().collect();
    for pair in points.windows(2) {
        let [[mut x, mut y], [end_x, end_y]] = [pair[0], pair[1]];
        loop {
            let rest = libm::hypot(end_x - x, end_y - y);
            if rest <= left {
                left -= rest;
                dash.push([end_x, end_y]);
                break;
            }
            let share = left / rest;
            (x, y) = (x + share * (end_x - x), y + share * (end_y - y));
            dash.push([x, y]);
            if phase % 2 == 0 {
                found.push(std::mem::take(&mut dash));
            }
            phase = (phase + 1) % pattern.len();
            left = pattern[phase];
            dash = vec![[x, y]];
        }
    }
    if phase % 2 == 0 {
        found.push(dash);
    }
    found
}

fn split_at_corners(points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let mut found = vec![points.iter().take(1).copied().collect::<Vec<_>>()];
    for (index, &point) in points.iter().enumerate().skip(1) {
        if let Some(piece) = found.last_mut() {
            piece.push(point);
        }
        let next = points.get(index + 1);
        if next.is_some_and(|&next| is_sharp(points[index - 1], point, next)) {
            found.push(vec![point]);
        }
    }
    found
}

fn is_sharp(before: [f64; 2], here: [f64; 2], after: [f64; 2]) -> bool {
    let (a, b) = ([here[0] - before[0], here[1] - before[1]], [after[0] - here[0], after[1] - here[1]]);
    let lengths = libm::hypot(a[0], a[1]) * libm::hypot(b[0], b[1]);
    a[0] * b[0] + a[1] * b[1] < MIN_UNSPLIT_TURN_COS * lengths
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_have_the_lengths_of_the_pattern_and_lie_on_the_line() {
        let line = [[0.0, 0.0], [30.0, 0.0], [30.0, 18.0], [90.0, 18.0]];
        let found = dashes(&line, &[6.0, 3.0]);
        let length = |dash: &Vec<[f64; 2]>| -> f64 {
            dash.windows(2).map(|pair| libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1])).sum()
        };
        assert_eq!(found.len(), 12);
        assert!((found.iter().map(length).sum::<f64>() - 72.0).abs() < 1e-9);
        let on_line = |[x, y]: [f64; 2]| (y == 0.0 && x <= 30.0) || x == 30.0 || y == 18.0;
        assert!(found.iter().flatten().all(|point| on_line(*point)));
    }

    #[test]
    fn a_line_is_split_at_sharp_corners() {
        let zigzag = [[0.0, 0.0], [10.0, 0.0], [20.0, 1.0], [20.0, 30.0], [19.0, 0.0]];
        let split = split_at_corners(&zigzag);
        assert_eq!(split.iter().map(Vec::len).collect::<Vec<_>>(), [3, 2, 2]);
    }

    #[test]
    fn longer_words_are_wider() {
        assert!(width_of("iiii", 20.0) < width_of("WWWW", 20.0));
        assert!(width_of("speed", 20.0) < width_of("speed", 30.0));
    }
}
