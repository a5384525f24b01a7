//! Tables as pictures.

use super::backend::width_of;
use super::drawing::{Drawing, LARGE_TEXT_PX, MEDIUM_TEXT_PX, Side};
use super::style::{Dash, GREY, LineStyle, SURFACE};

/// Space at the sides of the picture.
const MARGIN_PX: f64 = 30.0;
/// Height of the line with the title.
const TITLE_HEIGHT_PX: f64 = 56.0;
const ROW_HEIGHT_PX: f64 = 42.0;
const COLUMN_SPACING_PX: f64 = 44.0;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct TextTable {
    pub title: String,
    pub header: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

impl TextTable {
    pub fn new<const N: usize>(title: impl Into<String>, header: [&str; N], rows: Vec<[String; N]>) -> TextTable {
        let rows = rows.into_iter().map(|row| row.to_vec()).collect();
        TextTable { title: title.into(), header: header.map(str::to_owned).to_vec(), rows }
    }

    /// The same table with its columns as rows.
    pub fn transposed(self) -> TextTable {
        let lines: Vec<Vec<String>> = std::iter::once(self.header).chain(self.rows).collect();
        let count = lines.iter().map(Vec::len).max().unwrap_or(0);
        let column = |at: usize| lines.iter().map(|line| line.get(at).cloned().unwrap_or_default()).collect();
        let mut turned = (0..count).map(column);
        TextTable { title: self.title, header: turned.next().unwrap_or_default(), rows: turned.collect() }
    }

    pub fn drawing(&self) -> Drawing {
        let widths: Vec<f64> = (0..self.header.len()).map(|column| self.column_width(column)).collect();
        let table: f64 = widths.iter().map(|width| width + COLUMN_SPACING_PX).sum();
        let width = (2.0 * MARGIN_PX + table).max(2.0 * MARGIN_PX + width_of(&self.title, LARGE_TEXT_PX)).max(700.0);
        let height = TITLE_HEIGHT_PX + (self.rows.len() + 1) as f64 * ROW_HEIGHT_PX + 0.5 * MARGIN_PX;
        let mut drawing = Drawing::new(width, height);
        drawing.text([MARGIN_PX, 0.5 * TITLE_HEIGHT_PX], Side::Left, LARGE_TEXT_PX, self.title.as_str());
        drawing.block([MARGIN_PX, TITLE_HEIGHT_PX], [width - MARGIN_PX, TITLE_HEIGHT_PX + ROW_HEIGHT_PX], SURFACE);
        for (row, words) in std::iter::once(&self.header).chain(&self.rows).enumerate() {
            let (mut x, y) =
                (MARGIN_PX + 0.5 * COLUMN_SPACING_PX, TITLE_HEIGHT_PX + (row as f64 + 0.5) * ROW_HEIGHT_PX);
            for (word, width) in words.iter().zip(&widths) {
                drawing.text([x, y], Side::Left, MEDIUM_TEXT_PX, word.as_str());
                x += width + COLUMN_SPACING_PX;
            }
        }
        for line in [
            TITLE_HEIGHT_PX,
            TITLE_HEIGHT_PX + ROW_HEIGHT_PX,
            TITLE_HEIGHT_PX + (self.rows.len() + 1) as f64 * ROW_HEIGHT_PX,
        ] {
            drawing.line(vec![[MARGIN_PX, line], [width - MARGIN_PX, line]], LineStyle::new(GREY, Dash::Solid).thin());
        }
        drawing
    }

    fn column_width(&self, column: usize) -> f64 {
        let words = std::iter::once(&self.header).chain(&self.rows).filter_map(|row| row.get(column));
        words.map(|word| width_of(word, MEDIUM_TEXT_PX)).fold(0.0, f64::max)
    }
}
