//! Texts with aligned columns.

use std::fmt::{self, Write};

use comfy_table::{CellAlignment, Table, presets};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Align {
    Left,
    Right,
}

/// The text that `write` writes. Writing to a text cannot fail.
pub(super) fn written(write: impl FnOnce(&mut String) -> fmt::Result) -> String {
    let mut text = String::new();
    let _ = write(&mut text);
    text
}

/// Writes the lines of a table, indented.
pub(super) fn write_table(
    text: &mut String,
    header: &[(&str, Align)],
    rows: impl IntoIterator<Item = Vec<String>>,
) -> fmt::Result {
    lines(header, rows).iter().try_for_each(|line| writeln!(text, "  {line}"))
}

/// The lines of a table, one for the header and one for each row: two spaces between columns, none at the end of a line.
pub(super) fn lines(header: &[(&str, Align)], rows: impl IntoIterator<Item = Vec<String>>) -> Vec<String> {
    let mut table = Table::new();
    let single_line = |word: String| word.replace(char::is_control, " ");
    let rows = rows.into_iter().map(|row| row.into_iter().map(single_line).collect::<Vec<String>>());
    table.load_preset(presets::NOTHING).set_header(header.iter().map(|(title, _)| *title)).add_rows(rows);
    for ((_, align), column) in header.iter().zip(table.column_iter_mut()) {
        column.set_padding((0, 2)).set_cell_alignment(match align {
            Align::Left => CellAlignment::Left,
            Align::Right => CellAlignment::Right,
        });
    }
    table.lines().map(|line| line.trim_end().to_owned()).collect()
}

/// The lines of a table at most `width` wide, if its columns allow it. Columns that do not fit follow below, after a repeated first
/// column, separated by an empty line.
pub(super) fn lines_within(width: usize, header: &[(&str, Align)], rows: &[Vec<String>]) -> Vec<String> {
    const GAP: usize = 2;
    let widths: Vec<usize> = (0..header.len())
        .map(|at| {
            let words = rows.iter().filter_map(|row| row.get(at)).map(String::as_str).chain([header[at].0]);
            GAP + words.map(|word| word.chars().count()).max().unwrap_or(0)
        })
        .collect();
    let mut parts: Vec<Vec<usize>> = vec![vec![0]];
    let mut used = widths.first().copied().unwrap_or(0);
    for (at, column) in widths.iter().enumerate().skip(1) {
        let part = parts.last_mut().filter(|part| part.len() == 1 || used + column <= width + GAP);
        if let Some(part) = part {
            part.push(at);
            used += column;
        } else {
            parts.push(vec![0, at]);
            used = widths[0] + column;
        }
    }
    let part_lines = parts.iter().map(|part| {
        let header: Vec<(&str, Align)> = part.iter().map(|at| header[*at]).collect();
        lines(&header, rows.iter().map(|row| part.iter().filter_map(|at| row.get(*at).cloned()).collect()))
    });
    part_lines.collect::<Vec<_>>().join(&String::new())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_that_do_not_fit_are_printed_below_the_others() {
        let header = ["who", "first", "second", "third"].map(|title| (title, Align::Left));
        let rows = [["a", "1", "2", "3"].map(str::to_owned).to_vec()];
        let found = lines_within(19, &header, &rows);
        assert_eq!(found, ["who  first  second", "a    1      2", "", "who  third", "a    3"]);
        assert_eq!(lines_within(80, &header, &rows), lines(&header, rows.iter().cloned()));
        assert_eq!(lines_within(3, &header[..2], &rows), ["who  first", "a    1"]);
    }

    #[test]
    fn columns_are_as_wide_as_their_widest_word() {
        let rows = [["grün", "1.5"], ["b\nc", "10.25"]].map(|row| row.map(str::to_owned).to_vec());
        let lines = lines(&[("name", Align::Left), ("m", Align::Right), ("more", Align::Left)], rows);
        assert_eq!(lines, ["name      m  more", "grün    1.5", "b c   10.25"]);
    }
}
