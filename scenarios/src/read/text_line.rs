//! Lines of files that a scenario names, as places of errors.

use crate::error::{Document, Place};

/// A line of a text, counted from 1. Documents of a higher `rank` are listed later.
pub(crate) fn line_of(title: &str, text: &str, line: usize, rank: usize) -> Place {
    let ends = text.match_indices('\n').map(|(end, _)| end + 1);
    let start = [0].into_iter().chain(ends).nth(line.saturating_sub(1)).unwrap_or(text.len());
    let length = text[start..].find(['\r', '\n']).unwrap_or(text.len() - start);
    let document = Document::new(title, text, rank);
    Place::new(&document, start..start + length)
}
