//! Sheets: tables as pictures.

use super::drawing::{Drawing, LARGE, MEDIUM, Side, width_of};
use super::style::{Dash, GREY, LineStyle, SURFACE};

const MARGIN: f64 = 30.0;
const TITLE: f64 = 56.0;
const ROW: f64 = 42.0;
const BETWEEN: f64 = 44.0;

/// A table of words.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TextTable {
    /// What it is.
    pub title: String,
    /// What stands above the columns.
    pub header: Vec<String>,
    /// The rows.
    pub rows: Vec<Vec<String>>,
}

impl TextTable {
    /// A table of these words.
    pub fn new<const N: usize>(title: impl Into<String>, header: [&str; N], rows: Vec<[String; N]>) -> TextTable {
        let rows = rows.into_iter().map(|row| row.to_vec()).collect();
        TextTable { title: title.into(), header: header.map(str::to_owned).to_vec(), rows }
    }

    /// The picture.
    pub fn drawing(&self) -> Drawing {
        let widths: Vec<f64> = (0..self.header.len()).map(|column| self.column_width(column)).collect();
        let table: f64 = widths.iter().map(|width| width + BETWEEN).sum();
        let width = (2.0 * MARGIN + table).max(2.0 * MARGIN + width_of(&self.title, LARGE)).max(700.0);
        let height = TITLE + (self.rows.len() + 1) as f64 * ROW + 0.5 * MARGIN;
        let mut drawing = Drawing::new(width, height);
        drawing.text([MARGIN, 0.5 * TITLE], Side::Left, LARGE, self.title.as_str());
        drawing.block([MARGIN, TITLE], [width - MARGIN, TITLE + ROW], SURFACE);
        for (row, words) in std::iter::once(&self.header).chain(&self.rows).enumerate() {
            let (mut x, y) = (MARGIN + 0.5 * BETWEEN, TITLE + (row as f64 + 0.5) * ROW);
            for (word, width) in words.iter().zip(&widths) {
                drawing.text([x, y], Side::Left, MEDIUM, word.as_str());
                x += width + BETWEEN;
            }
        }
        for line in [TITLE, TITLE + ROW, TITLE + (self.rows.len() + 1) as f64 * ROW] {
            drawing.line(vec![[MARGIN, line], [width - MARGIN, line]], LineStyle::new(GREY, Dash::Solid).thin());
        }
        drawing
    }

    fn column_width(&self, column: usize) -> f64 {
        let words = std::iter::once(&self.header).chain(&self.rows).filter_map(|row| row.get(column));
        words.map(|word| width_of(word, MEDIUM)).fold(0.0, f64::max)
    }
}
