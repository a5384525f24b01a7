//! Rows of words in aligned columns.

use comfy_table::{CellAlignment, Table, presets};

/// How the words of a column stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Align {
    Left,
    Right,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_as_wide_as_their_widest_word() {
        let rows = [["grün", "1.5"], ["b\nc", "10.25"]].map(|row| row.map(str::to_owned).to_vec());
        let lines = lines(&[("name", Align::Left), ("m", Align::Right), ("more", Align::Left)], rows);
        assert_eq!(lines, ["name      m  more", "grün    1.5", "b c   10.25"]);
    }
}
