//! A table that a run writes row by row, as CSV or Parquet.

use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::str::FromStr;

use interplay_files::{NewFolders, WholeFile};
use interplay_simulation::watch::WatchError;
use thiserror::Error;

use crate::cell::{Cell, ColumnKind, TableError, TableSchema};
use crate::table::TableWriter;

/// The formats of tables that a run writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableFormat {
    Csv,
    Parquet,
}

/// A file to which a run writes rows; its extension states its format.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableFile {
    path: PathBuf,
    format: TableFormat,
}

/// A file whose extension is not that of a table.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("`{0}` has no ending of a table; use .csv or .parquet")]
pub struct TableFormatError(String);

impl TableFile {
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file of a run in the folder of a sweep, by the key of the run.
    pub fn of_run(folder: &Path, key: impl std::fmt::Display) -> TableFile {
        let path = folder.join("trajectories").join(format!("{key}.parquet"));
        TableFile { path, format: TableFormat::Parquet }
    }
}

impl FromStr for TableFile {
    type Err = TableFormatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let path = PathBuf::from(text);
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let format = match ending.as_deref() {
            Some("csv") => TableFormat::Csv,
            Some("parquet") => TableFormat::Parquet,
            _ => return Err(TableFormatError(text.to_owned())),
        };
        Ok(TableFile { path, format })
    }
}

/// Rows that are being written. The file appears when it is complete; an aborted run leaves nothing behind.
pub(crate) struct RowFile {
    rows: Rows,
    folders: NewFolders,
}

enum Rows {
    Csv(PathBuf, BufWriter<WholeFile>),
    Parquet(Box<TableWriter>),
}

impl RowFile {
    /// Begins a table with these columns.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn begin(target: &TableFile, columns: &[(&str, ColumnKind)]) -> Result<RowFile, TableError> {
        let path = target.path();
        interplay_files::check(path).map_err(TableError::file("write", path))?;
        let folders = NewFolders::make_above(path).map_err(TableError::file("write", path))?;
        let rows = match target.format {
            TableFormat::Csv => {
                let mut file = BufWriter::new(WholeFile::begin(path).map_err(TableError::file("write", path))?);
                let names: Vec<String> = columns.iter().map(|(name, _)| quoted(name)).collect();
                writeln!(file, "{}", names.join(",")).map_err(TableError::file("write", path))?;
                Rows::Csv(path.to_owned(), file)
            }
            TableFormat::Parquet => {
                let schema: TableSchema = columns.iter().map(|(name, kind)| ((*name).to_owned(), *kind)).collect();
                Rows::Parquet(Box::new(TableWriter::new(path, schema, &[])?))
            }
        };
        Ok(RowFile { rows, folders })
    }

    /// Appends a row: one value for each column, in order.
    pub fn push(&mut self, cells: impl IntoIterator<Item = Cell>) -> Result<(), WatchError> {
        match &mut self.rows {
            Rows::Csv(path, file) => {
                let cells: Vec<String> = cells.into_iter().map(|cell| in_csv(&cell)).collect();
                writeln!(file, "{}", cells.join(",")).map_err(TableError::file("write", path))?;
            }
            Rows::Parquet(table) => table.push(cells)?,
        }
        Ok(())
    }

    pub fn finish(self) -> Result<(), WatchError> {
        match self.rows {
            Rows::Csv(path, file) => {
                let whole = file.into_inner().map_err(std::io::IntoInnerError::into_error);
                whole.and_then(WholeFile::replace).map_err(TableError::file("write", &path))?;
            }
            Rows::Parquet(table) => table.finish()?,
        }
        self.folders.keep();
        Ok(())
    }
}

/// A value in CSV. Numbers have as many digits as are needed to read the same number again.
fn in_csv(cell: &Cell) -> String {
    match cell {
        Cell::Flag(value) => value.map(|value| value.to_string()),
        Cell::Count(value) => value.map(|value| value.to_string()),
        Cell::Number(value) => value.map(|value| value.to_string()),
        Cell::Text(value) => value.as_deref().map(quoted),
    }
    .unwrap_or_default()
}

/// A text, in quotes where CSV needs them.
fn quoted(text: &str) -> String {
    if text.contains(['"', ',', '\n', '\r']) {
        return format!("\"{}\"", text.replace('"', "\"\""));
    }
    text.to_owned()
}
