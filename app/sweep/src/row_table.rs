//! Rows of a sweep as a table.

use std::path::Path;

use interplay_scenarios::RegisteredMetrics;
use interplay_tables::{TableSchema, TableWriter};

use crate::column::{cells, schema};
use crate::error::SweepError;
use crate::row::SweepRow;

/// Writes rows as a table; `inputs` are the columns of the varied inputs, and `registered` metrics add columns.
pub(crate) fn write_rows(
    target: &Path,
    inputs: &TableSchema,
    registered: &RegisteredMetrics,
    about: &[(&str, String)],
    rows: impl Iterator<Item = Result<SweepRow, SweepError>>,
) -> Result<usize, SweepError> {
    let columns = schema(inputs, registered);
    let mut writer = TableWriter::new(target, columns.clone(), about)?;
    let mut count = 0;
    for row in rows {
        writer.push(cells(&row?, &columns, inputs))?;
        count += 1;
    }
    writer.finish()?;
    Ok(count)
}
