//! Lines of data files that a scenario names, as places of errors.

use crate::text::error::{Document, Place};

/// A wrong line of a file, counted from 1: errors show its number, but not its text. A scenario may name any file, and its user may not
/// be its author.
pub(crate) fn line_without_text(title: &str, line: usize, rank: usize) -> Place {
    let above = line.saturating_sub(1);
    let document = Document::new(title, &format!("{}{NOT_SHOWN}", "\n".repeat(above)), rank);
    Place::new(&document, above..above + NOT_SHOWN.len())
}

/// The text that errors show in place of a line.
const NOT_SHOWN: &str = "(not shown)";

/// A line of a text, counted from 1. Documents of a higher `rank` are listed later.
pub(crate) fn line_of(title: &str, text: &str, line: usize, rank: usize) -> Place {
    let ends = text.match_indices('\n').map(|(end, _)| end + 1);
    let start = [0].into_iter().chain(ends).nth(line.saturating_sub(1)).unwrap_or(text.len());
    let length = text[start..].find(['\r', '\n']).unwrap_or(text.len() - start);
    let document = Document::new(title, text, rank);
    Place::new(&document, start..start + length)
}
