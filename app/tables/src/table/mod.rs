//! Tables of rows as Parquet files. Only this module depends on Parquet.

mod checksums;
mod guard;
mod read;
mod write;

use parquet::basic::{LogicalType, Repetition, Type as PhysicalType};
use parquet::errors::ParquetError;
use parquet::schema::types::{Type, TypePtr};

pub use read::TableReader;
pub use write::TableWriter;

use crate::cell::{Cell, ColumnKind};

/// Number of rows of a row group, which a reader holds in memory at a time.
pub(crate) const ROWS_PER_GROUP: usize = 10_000;

/// Values of one column, one for each row; `None` is a missing value.
#[derive(Clone, Debug, PartialEq)]
pub enum TableColumn {
    /// True or false.
    Flags(Vec<Option<bool>>),
    /// Whole numbers.
    Counts(Vec<Option<u64>>),
    /// Numbers.
    Numbers(Vec<Option<f64>>),
    /// Texts.
    Texts(Vec<Option<String>>),
}

impl TableColumn {
    /// An empty column of a type.
    pub fn empty(kind: ColumnKind) -> TableColumn {
        match kind {
            ColumnKind::Flag => TableColumn::Flags(Vec::new()),
            ColumnKind::Count => TableColumn::Counts(Vec::new()),
            ColumnKind::Number => TableColumn::Numbers(Vec::new()),
            ColumnKind::Text => TableColumn::Texts(Vec::new()),
        }
    }

    /// Appends a value; a value of another type counts as missing.
    pub fn push(&mut self, cell: Cell) {
        match (self, cell) {
            (TableColumn::Flags(all), Cell::Flag(value)) => all.push(value),
            (TableColumn::Counts(all), Cell::Count(value)) => all.push(value),
            (TableColumn::Numbers(all), Cell::Number(value)) => all.push(value),
            (TableColumn::Texts(all), Cell::Text(value)) => all.push(value),
            (TableColumn::Flags(all), _) => all.push(None),
            (TableColumn::Counts(all), _) => all.push(None),
            (TableColumn::Numbers(all), _) => all.push(None),
            (TableColumn::Texts(all), _) => all.push(None),
        }
    }

    /// The value in a row.
    pub fn cell(&self, row: usize) -> Cell {
        match self {
            TableColumn::Flags(all) => Cell::Flag(all.get(row).copied().flatten()),
            TableColumn::Counts(all) => Cell::Count(all.get(row).copied().flatten()),
            TableColumn::Numbers(all) => Cell::Number(all.get(row).copied().flatten()),
            TableColumn::Texts(all) => Cell::Text(all.get(row).cloned().flatten()),
        }
    }
}

/// Columns of a table, with their names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RowTable {
    /// The columns by name.
    pub columns: Vec<(String, TableColumn)>,
    /// Number of rows.
    pub row_count: usize,
}

/// The type of a column in a file.
fn column_type(name: &str, kind: ColumnKind) -> Result<TypePtr, ParquetError> {
    let (physical, logical) = match kind {
        ColumnKind::Flag => (PhysicalType::BOOLEAN, None),
        ColumnKind::Count => (PhysicalType::INT64, Some(LogicalType::Integer { bit_width: 64, is_signed: false })),
        ColumnKind::Number => (PhysicalType::DOUBLE, None),
        ColumnKind::Text => (PhysicalType::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let builder = Type::primitive_type_builder(name, physical).with_repetition(Repetition::OPTIONAL);
    builder.with_logical_type(logical).build().map(TypePtr::new)
}
