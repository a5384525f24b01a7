//! Reads a table, whole or a row group at a time.

use std::cell::Cell;
use std::fs::File;
use std::panic::{self, AssertUnwindSafe};
use std::path::{Path, PathBuf};
use std::sync::Once;

use parquet::basic::{LogicalType, Type as PhysicalType};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, DataType};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;

use super::checksums::Checksums;
use super::{RowTable, TableColumn};
use crate::cell::{ColumnKind, TableError, TableSchema};

/// An open table.
pub struct TableReader {
    path: PathBuf,
    reader: SerializedFileReader<File>,
    checksums: Checksums,
}

impl TableReader {
    pub fn open(path: &Path) -> Result<TableReader, TableError> {
        let file = File::open(path).map_err(TableError::file("read", path))?;
        let opened = guarded(|| SerializedFileReader::new(file)).ok_or_else(|| strange(path, DAMAGED))?;
        let reader = opened.map_err(TableError::table("read", path))?;
        let checksums = Checksums::of_file(reader.metadata().file_metadata());
        let reader = TableReader { path: path.to_owned(), reader, checksums };
        let is_sound = reader.has_places() && reader.checksums.agree_on_names(&reader.schema()?);
        if is_sound { Ok(reader) } else { Err(strange(path, DAMAGED)) }
    }

    /// Whether all columns have a nonnegative position and size: on a damaged file with negative ones the library aborts the process.
    fn has_places(&self) -> bool {
        let groups = self.reader.metadata().row_groups().iter();
        groups.flat_map(|group| group.columns()).all(|column| {
            let places = [column.data_page_offset(), column.compressed_size(), column.num_values()];
            places.into_iter().chain(column.dictionary_page_offset()).all(|number| number >= 0)
        })
    }

    /// The columns.
    ///
    /// # Errors
    /// If a column has a type that tables of rows do not have.
    pub fn schema(&self) -> Result<TableSchema, TableError> {
        let columns = self.reader.metadata().file_metadata().schema_descr().columns();
        let kinds = columns.iter().map(|column| {
            let kind = match column.physical_type() {
                // Other programs give this type to a column without values.
                PhysicalType::INT32 if is_null(column) => ColumnKind::Text,
                PhysicalType::BOOLEAN => ColumnKind::Flag,
                PhysicalType::INT64 => ColumnKind::Count,
                PhysicalType::DOUBLE => ColumnKind::Number,
                PhysicalType::BYTE_ARRAY => ColumnKind::Text,
                other => {
                    return Err(strange(&self.path, &format!("the column `{}` has the type {other}", column.name())));
                }
            };
            if column.max_def_level() > 1 || column.max_rep_level() > 0 {
                return Err(strange(&self.path, &format!("the column `{}` is nested", column.name())));
            }
            Ok((column.name().to_owned(), kind))
        });
        kinds.collect()
    }

    /// The value of a metadata key of the file.
    pub fn about(&self, key: &str) -> Option<String> {
        let all = self.reader.metadata().file_metadata().key_value_metadata()?;
        all.iter().find(|entry| entry.key == key)?.value.clone()
    }

    pub fn group_count(&self) -> usize {
        self.reader.num_row_groups()
    }

    /// One row group: the columns of these names, in this order; missing columns are left out.
    pub fn group(&self, group: usize, names: &[String]) -> Result<RowTable, TableError> {
        guarded(|| self.decoded(group, names)).ok_or_else(|| strange(&self.path, DAMAGED))?
    }

    fn decoded(&self, group: usize, names: &[String]) -> Result<RowTable, TableError> {
        let failed = TableError::table::<ParquetError>("read", &self.path);
        let schema = self.schema()?;
        let reader = self.reader.get_row_group(group).map_err(&failed)?;
        let row_count = usize::try_from(reader.metadata().num_rows()).unwrap_or(0);
        let mut columns = Vec::new();
        for name in names {
            let Some(at) = schema.iter().position(|(known, _)| known == name) else { continue };
            let column = reader.get_column_reader(at).and_then(|column| read_column(column, row_count));
            let column = column.map_err(&failed)?;
            if !self.checksums.agree(group * schema.len() + at, &column) {
                return Err(strange(
                    &self.path,
                    &format!("its column `{name}` is not as it was written; make the table again"),
                ));
            }
            columns.push((name.clone(), column));
        }
        Ok(RowTable { columns, row_count })
    }
}

/// The message for a table that cannot be decoded.
const DAMAGED: &str = "it is damaged";

fn strange(path: &Path, what: &str) -> TableError {
    TableError::Input(format!("`{}` is not a table of runs: {what}", path.display()))
}

/// Whether the type of a column allows only missing values.
fn is_null(column: &ColumnDescriptor) -> bool {
    column.logical_type_ref() == Some(&LogicalType::Unknown)
}

fn read_column(column: ColumnReader, rows: usize) -> Result<TableColumn, ParquetError> {
    let text = |bytes: ByteArray| String::from_utf8_lossy(bytes.data()).into_owned();
    match column {
        ColumnReader::BoolColumnReader(reader) => Ok(TableColumn::Flags(values(reader, rows, |value| value)?)),
        ColumnReader::Int64ColumnReader(reader) => {
            Ok(TableColumn::Counts(values(reader, rows, |value: i64| value.cast_unsigned())?))
        }
        ColumnReader::DoubleColumnReader(reader) => Ok(TableColumn::Numbers(values(reader, rows, |value| value)?)),
        ColumnReader::Int32ColumnReader(reader) => {
            Ok(TableColumn::Texts(values(reader, rows, |value: i32| value.to_string())?))
        }
        ColumnReader::ByteArrayColumnReader(reader) => Ok(TableColumn::Texts(values(reader, rows, text)?)),
        _ => Err(ParquetError::General("a column of an unknown type".to_owned())),
    }
}

/// All values of a column of a row group.
fn values<D: DataType, T>(
    mut reader: ColumnReaderImpl<D>,
    rows: usize,
    convert: impl Fn(D::T) -> T,
) -> Result<Vec<Option<T>>, ParquetError> {
    let (mut found, mut levels) = (Vec::new(), Vec::new());
    let mut all = Vec::with_capacity(rows);
    while all.len() < rows {
        found.clear();
        levels.clear();
        let (records, _, _) = reader.read_records(rows - all.len(), Some(&mut levels), None, &mut found)?;
        if records == 0 {
            return Err(ParquetError::General(format!("a column ends after {} of {rows} rows", all.len())));
        }
        let mut found = found.drain(..);
        if levels.is_empty() {
            // A column without missing values has no definition levels.
            all.extend(found.map(|value| Some(convert(value))));
        } else {
            all.extend(levels.iter().map(|level| if *level > 0 { found.next().map(&convert) } else { None }));
        }
    }
    Ok(all)
}

impl RowTable {
    /// Reads the columns of these names of a whole file.
    ///
    /// # Errors
    /// If the file cannot be read or is not a table of rows.
    pub fn read(path: &Path, names: &[String]) -> Result<RowTable, TableError> {
        let reader = TableReader::open(path)?;
        let mut whole = RowTable::default();
        for group in 0..reader.group_count() {
            let part = reader.group(group, names)?;
            whole.row_count += part.row_count;
            if whole.columns.is_empty() {
                whole.columns = part.columns;
                continue;
            }
            for ((_, column), (_, more)) in whole.columns.iter_mut().zip(part.columns) {
                column.append(more);
            }
        }
        Ok(whole)
    }

    pub fn column(&self, name: &str) -> Option<&TableColumn> {
        self.columns.iter().find(|(known, _)| known == name).map(|(_, column)| column)
    }
}

impl TableColumn {
    fn append(&mut self, more: TableColumn) {
        match (self, more) {
            (TableColumn::Flags(all), TableColumn::Flags(more)) => all.extend(more),
            (TableColumn::Counts(all), TableColumn::Counts(more)) => all.extend(more),
            (TableColumn::Numbers(all), TableColumn::Numbers(more)) => all.extend(more),
            (TableColumn::Texts(all), TableColumn::Texts(more)) => all.extend(more),
            // A column has one type in all row groups of a file.
            _ => {}
        }
    }
}

thread_local! {
    /// Whether this thread is decoding a table.
    static DECODES: Cell<bool> = const { Cell::new(false) };
}
/// One hook of the process reports panics; ours forwards those that do not come from decoding.
static HOOK: Once = Once::new();

/// The result of `decode`, or `None` if it panics; such a panic prints nothing.
pub(super) fn guarded<T>(decode: impl FnOnce() -> T) -> Option<T> {
    HOOK.call_once(|| {
        let report = panic::take_hook();
        panic::set_hook(Box::new(move |panic| {
            if !DECODES.get() {
                report(panic);
            }
        }));
    });
    DECODES.set(true);
    // The table is not used after a panic.
    let decoded = panic::catch_unwind(AssertUnwindSafe(decode));
    DECODES.set(false);
    decoded.ok()
}
