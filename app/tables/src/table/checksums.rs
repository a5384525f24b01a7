//! Checksums of the columns of a table, stored in the file's metadata: a file with a flipped bit may still be readable.
//!
//! There is one for the names of all columns, and one for each column of each row group, in order. Tables of other programs have none.

use parquet::file::metadata::FileMetaData;

use super::TableColumn;
use crate::cell::TableSchema;

/// The metadata key of the checksums, eight hexadecimal digits each.
pub(super) const NOTE: &str = "interplay:checksums";
/// Prefix of the name of the program that writes them. Another program that rewrites the rows may keep the checksums.
pub(super) const WRITER: &str = "interplay ";
const DIGITS: usize = 8;

/// The checksum of a column of a row group.
pub(super) fn of_column(column: &TableColumn) -> String {
    match column {
        TableColumn::Flags(all) => of_values(all.iter().map(|value| value.map(|value| [u8::from(value)]))),
        TableColumn::Counts(all) => of_values(all.iter().map(|value| value.map(u64::to_le_bytes))),
        TableColumn::Numbers(all) => of_values(all.iter().map(|value| value.map(f64::to_le_bytes))),
        TableColumn::Texts(all) => of_values(all.iter().map(Option::as_ref)),
    }
}

/// The checksum of values as bytes, some of which may be missing.
fn of_values<B: AsRef<[u8]>>(values: impl Iterator<Item = Option<B>>) -> String {
    let mut hasher = crc32fast::Hasher::new();
    for value in values {
        let bytes = value.as_ref().map_or(&[][..], AsRef::as_ref);
        hasher.update(&[u8::from(value.is_some())]);
        hasher.update(&bytes.len().to_le_bytes());
        hasher.update(bytes);
    }
    format!("{:0DIGITS$x}", hasher.finalize())
}

/// The checksum of the column names: without it, a column with a damaged name would count as missing.
pub(super) fn of_names(schema: &TableSchema) -> String {
    of_values(schema.iter().map(|(name, _)| Some(name)))
}

pub(super) struct Checksums(Option<String>);

impl Checksums {
    pub fn of_file(about: &FileMetaData) -> Checksums {
        let is_own = about.created_by().is_some_and(|writer| writer.starts_with(WRITER));
        let notes = about.key_value_metadata().filter(|_| is_own);
        Checksums(notes.and_then(|notes| notes.iter().find(|note| note.key == NOTE)?.value.clone()))
    }

    /// Whether a column matches its checksum; `index` counts all columns of all row groups. True if the file has no checksums.
    pub fn agree(&self, index: usize, column: &TableColumn) -> bool {
        let Some(all) = &self.0 else { return true };
        let start = (index + 1) * DIGITS;
        all.get(start..start + DIGITS).is_some_and(|stated| stated == of_column(column))
    }

    /// Whether the column names match their checksum.
    pub fn agree_on_names(&self, schema: &TableSchema) -> bool {
        self.0.as_ref().is_none_or(|all| all.get(..DIGITS).is_some_and(|stated| stated == of_names(schema)))
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::super::{RowTable, TableWriter};
    use crate::cell::{Cell, ColumnKind};

    #[test]
    fn a_flipped_bit_in_a_name_never_hides_a_column() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("runs.parquet");
        let schema = vec![("ego_yields".to_owned(), ColumnKind::Flag), ("gap_m".to_owned(), ColumnKind::Number)];
        let mut writer = TableWriter::new(&path, schema, &[]).expect("a table");
        writer.push([Cell::Flag(Some(true)), Cell::Number(Some(0.5))]).expect("a row");
        writer.finish().expect("written");
        let whole = fs::read(&path).expect("there");
        let names = ["ego_yields".to_owned(), "gap_m".to_owned()];
        let rows = RowTable::read(&path, &names).expect("sound");
        let places = whole.windows(10).enumerate().filter(|(_, word)| word == b"ego_yields").map(|(at, _)| at);
        let places: Vec<usize> = places.collect();
        assert!(!places.is_empty());
        for bit in places.iter().flat_map(|at| 8 * at..8 * (at + 10)) {
            let mut flipped = whole.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            fs::write(&path, flipped).expect("written");
            assert!(RowTable::read(&path, &names).map_or(true, |read| read == rows), "bit {bit}");
        }
    }

    #[test]
    fn a_flipped_bit_in_the_values_never_changes_a_row() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("runs.parquet");
        let kinds = [ColumnKind::Flag, ColumnKind::Count, ColumnKind::Number, ColumnKind::Text];
        let names: Vec<String> = ["arrives", "plans", "gap_m", "style"].map(str::to_owned).into();
        let schema = names.iter().cloned().zip(kinds).collect();
        let mut writer = TableWriter::new(&path, schema, &[]).expect("a table");
        for row in 0..20_u32 {
            let style = Some(row).filter(|row| row % 3 > 0).map(|row| format!("style {row}"));
            let number = Cell::Number(Some(f64::from(row) * 0.37));
            let cells = [Cell::Flag(Some(row % 2 == 0)), Cell::Count(Some(row.into())), number, Cell::Text(style)];
            writer.push(cells).expect("a row");
        }
        writer.finish().expect("written");
        let (whole, rows) = (fs::read(&path).expect("there"), RowTable::read(&path, &names).expect("sound"));
        let footer = u32::from_le_bytes(whole[whole.len() - 8..whole.len() - 4].try_into().expect("four bytes"));
        let mut refused = 0;
        for bit in 32..8 * (whole.len() - 8 - footer as usize) {
            let mut flipped = whole.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            fs::write(&path, flipped).expect("written");
            match RowTable::read(&path, &names) {
                Ok(read) => assert_eq!(read, rows, "bit {bit}"),
                Err(_) => refused += 1,
            }
        }
        assert!(refused > 1000, "{refused}");
    }
}
