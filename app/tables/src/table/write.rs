//! Writes a table, a row group at a time.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use interplay_files::WholeFile;
use parquet::basic::Compression;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::{Type, TypePtr};

use super::{ROWS_PER_GROUP, TableColumn, checksums, column_type};
use crate::cell::{Cell, TableError, TableSchema};

/// A table that is being written. It appears at its path when it is complete.
pub struct TableWriter {
    target: PathBuf,
    writer: SerializedFileWriter<WholeFile>,
    schema: TableSchema,
    group: Vec<TableColumn>,
    rows: usize,
    /// Checksums of the names and of all columns of all written groups.
    checksums: String,
}

impl TableWriter {
    /// Begins a table with these columns and this metadata.
    pub fn new(target: &Path, schema: TableSchema, about: &[(&str, String)]) -> Result<TableWriter, TableError> {
        let file = WholeFile::begin(target).map_err(TableError::file("write", target))?;
        let failed = TableError::table::<ParquetError>("write", target);
        let types = schema.iter().map(|(name, kind)| column_type(name, *kind)).collect::<Result<Vec<TypePtr>, _>>();
        let root = types.and_then(|types| Type::group_type_builder("run").with_fields(types).build());
        let about = about.iter().map(|(key, value)| KeyValue::new((*key).to_owned(), value.clone())).collect();
        // The contents of the file depend neither on the time nor on the machine. This variant of LZ4 allocates through
        // Rust, so that a process without memory ends with exit code 3; the C binding of zstd would panic.
        let properties = WriterProperties::builder()
            .set_created_by(format!("{}{}", checksums::WRITER, env!("CARGO_PKG_VERSION")))
            .set_compression(Compression::LZ4_RAW)
            .set_key_value_metadata(Some(about));
        let root = Arc::new(root.map_err(&failed)?);
        let writer = SerializedFileWriter::new(file, root, Arc::new(properties.build())).map_err(&failed)?;
        let group = schema.iter().map(|(_, kind)| TableColumn::empty(*kind)).collect();
        let checksums = checksums::of_names(&schema);
        Ok(TableWriter { target: target.to_owned(), writer, schema, group, rows: 0, checksums })
    }

    /// Appends a row: one value for each column, in order.
    pub fn push(&mut self, cells: impl IntoIterator<Item = Cell>) -> Result<(), TableError> {
        for (column, cell) in self.group.iter_mut().zip(cells) {
            column.push(cell);
        }
        self.rows += 1;
        if self.rows == ROWS_PER_GROUP { self.end_group() } else { Ok(()) }
    }

    fn end_group(&mut self) -> Result<(), TableError> {
        if self.rows == 0 {
            return Ok(());
        }
        let write = |writer: &mut SerializedFileWriter<WholeFile>, columns: &[TableColumn]| {
            let mut group = writer.next_row_group()?;
            let mut columns = columns.iter();
            while let Some(mut writer) = group.next_column()? {
                if let Some(column) = columns.next() {
                    write_column(&mut writer, column)?;
                }
                writer.close()?;
            }
            group.close().map(drop)
        };
        write(&mut self.writer, &self.group).map_err(TableError::table("write", &self.target))?;
        self.checksums.extend(self.group.iter().map(checksums::of_column));
        self.group = self.schema.iter().map(|(_, kind)| TableColumn::empty(*kind)).collect();
        self.rows = 0;
        Ok(())
    }

    /// Completes the table and moves it to its path.
    pub fn finish(mut self) -> Result<(), TableError> {
        self.end_group()?;
        self.writer.append_key_value_metadata(KeyValue::new(checksums::NOTE.to_owned(), self.checksums));
        let file = self.writer.into_inner().map_err(TableError::table("write", &self.target))?;
        file.replace().map_err(TableError::file("write", &self.target))
    }
}

fn write_column(writer: &mut SerializedColumnWriter<'_>, column: &TableColumn) -> Result<(), ParquetError> {
    fn levels<T>(values: &[Option<T>]) -> Vec<i16> {
        values.iter().map(|value| i16::from(value.is_some())).collect()
    }
    match column {
        TableColumn::Flags(all) => {
            let values: Vec<bool> = all.iter().copied().flatten().collect();
            writer.typed::<BoolType>().write_batch(&values, Some(&levels(all)), None)?;
        }
        TableColumn::Counts(all) => {
            let values: Vec<i64> = all.iter().flatten().map(|value| value.cast_signed()).collect();
            writer.typed::<Int64Type>().write_batch(&values, Some(&levels(all)), None)?;
        }
        TableColumn::Numbers(all) => {
            let values: Vec<f64> = all.iter().copied().flatten().collect();
            writer.typed::<DoubleType>().write_batch(&values, Some(&levels(all)), None)?;
        }
        TableColumn::Texts(all) => {
            let values: Vec<ByteArray> = all.iter().flatten().map(|text| ByteArray::from(text.as_str())).collect();
            writer.typed::<ByteArrayType>().write_batch(&values, Some(&levels(all)), None)?;
        }
    }
    Ok(())
}
