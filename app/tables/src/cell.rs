//! Values of a table, and the types of its columns.

/// The type of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// True or false.
    Flag,
    /// A whole number.
    Count,
    /// A number.
    Number,
    /// A text.
    Text,
}

/// The name and the type of each column of a table.
pub type TableSchema = Vec<(String, ColumnKind)>;

/// A value of a row; `None` is a missing value.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// True or false.
    Flag(Option<bool>),
    /// A whole number.
    Count(Option<u64>),
    /// A number.
    Number(Option<f64>),
    /// A text.
    Text(Option<String>),
}
