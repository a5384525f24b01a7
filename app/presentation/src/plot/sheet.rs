//! Sheets: tables as pictures.

use super::ink::{Dash, GREY, Ink, SURFACE};
use super::sketch::{LARGE, MEDIUM, Side, Sketch, width_of};

const MARGIN: f64 = 30.0;
const TITLE: f64 = 56.0;
const ROW: f64 = 42.0;
const BETWEEN: f64 = 44.0;

/// A table of words.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sheet {
    /// What it is.
    pub title: String,
    /// What stands above the columns.
    pub header: Vec<String>,
    /// The rows.
    pub rows: Vec<Vec<String>>,
}

impl Sheet {
    /// A table of these words.
    pub fn new<const N: usize>(title: impl Into<String>, header: [&str; N], rows: Vec<[String; N]>) -> Sheet {
        let rows = rows.into_iter().map(|row| row.to_vec()).collect();
        Sheet { title: title.into(), header: header.map(str::to_owned).to_vec(), rows }
    }

    /// The picture.
    pub fn sketch(&self) -> Sketch {
        let widths: Vec<f64> = (0..self.header.len()).map(|column| self.column_width(column)).collect();
        let table: f64 = widths.iter().map(|width| width + BETWEEN).sum();
        let width = (2.0 * MARGIN + table).max(2.0 * MARGIN + width_of(&self.title, LARGE)).max(700.0);
        let height = TITLE + (self.rows.len() + 1) as f64 * ROW + 0.5 * MARGIN;
        let mut sketch = Sketch::new(width, height);
        sketch.text([MARGIN, 0.5 * TITLE], Side::Left, LARGE, self.title.as_str());
        sketch.block([MARGIN, TITLE], [width - MARGIN, TITLE + ROW], SURFACE);
        for (row, words) in std::iter::once(&self.header).chain(&self.rows).enumerate() {
            let (mut x, y) = (MARGIN + 0.5 * BETWEEN, TITLE + (row as f64 + 0.5) * ROW);
            for (word, width) in words.iter().zip(&widths) {
                sketch.text([x, y], Side::Left, MEDIUM, word.as_str());
                x += width + BETWEEN;
            }
        }
        for line in [TITLE, TITLE + ROW, TITLE + (self.rows.len() + 1) as f64 * ROW] {
            sketch.line(vec![[MARGIN, line], [width - MARGIN, line]], Ink::new(GREY, Dash::Solid).thin());
        }
        sketch
    }

    fn column_width(&self, column: usize) -> f64 {
        let words = std::iter::once(&self.header).chain(&self.rows).filter_map(|row| row.get(column));
        words.map(|word| width_of(word, MEDIUM)).fold(0.0, f64::max)
    }
}
