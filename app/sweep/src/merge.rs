//! Merges the tables of all shards into one, sorted by key.

use std::fs;
use std::path::{Path, PathBuf};

use interplay_tables::{Cell, ColumnKind, RowTable, TableReader, TableSchema, TableWriter};

use crate::column::TIMINGS;
use crate::error::SweepError;
use crate::shard::Shard;
use crate::sweep::{PLAN_NOTE, RUNS_FILE, SHARD_NOTE, table_path};

/// The outcome of a merge.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MergedSweep {
    /// Path of the merged table.
    pub table: PathBuf,
    /// Number of rows.
    pub rows: usize,
    /// Number of shards.
    pub shards: u32,
    /// Number of rows of the table that was replaced, if one existed.
    pub replaced: Option<usize>,
}

/// Merges the tables of all shards in a folder into `target`, by default `runs.parquet` in this folder. A folder without shards
/// must contain that table itself. Without `timings`, the columns that are not reproducible are left out.
///
/// Only one row group of each shard is in memory at a time.
///
/// # Errors
/// If shards are missing or belong to different plans, or if files cannot be read or written.
pub fn merge(folder: &Path, target: Option<&Path>, timings: bool) -> Result<MergedSweep, SweepError> {
    let sources = sources(folder)?;
    let target = target.map_or_else(|| folder.join(RUNS_FILE), Path::to_owned);
    if let Some(source) = sources.iter().find(|source| is_same(source, &target)) {
        return Err(SweepError::Input(format!("`{}` is what would be merged; choose another file", source.display())));
    }
    let replaced = if target.exists() { Some(row_count(&target)?) } else { None };
    let readers = sources.iter().map(|path| TableReader::open(path)).collect::<Result<Vec<TableReader>, _>>()?;
    let Some(first) = readers.first() else { return Err(SweepError::Input("there is nothing to merge".to_owned())) };
    let schema = first.schema()?;
    for (index, (reader, path)) in readers.iter().zip(&sources).enumerate() {
        let named = Shard { index: index as u32 + 1, count: sources.len() as u32 }.to_string();
        let stated = reader.about(SHARD_NOTE).unwrap_or_default();
        if sources.len() > 1 && stated != named {
            let message = format!("`{}` is not shard {named} but {stated}; make that shard again", path.display());
            return Err(SweepError::Input(message));
        }
        if reader.about(PLAN_NOTE) != first.about(PLAN_NOTE) || reader.schema()? != schema {
            let [one, other] = [&sources[0], path].map(|path| path.display());
            let message = format!("`{one}` and `{other}` are of different plans; run the shards of one plan again");
            return Err(SweepError::Input(message));
        }
    }
    let kept = |name: &str| timings || !TIMINGS.contains(&name);
    let schema: TableSchema = schema.into_iter().filter(|(name, _)| kept(name)).collect();
    let plan = first.about(PLAN_NOTE).unwrap_or_default();
    let about = [(PLAN_NOTE, plan), (SHARD_NOTE, Shard::WHOLE.to_string())];
    let rows = merge_tables(readers, schema, &target, &about)?;
    Ok(MergedSweep { table: target, rows, shards: sources.len() as u32, replaced })
}

/// The number of rows of a table that would be replaced.
///
/// # Errors
/// If the file is not a table of runs, since the merge would destroy it.
fn row_count(target: &Path) -> Result<usize, SweepError> {
    let table = RowTable::read(target, &["key".to_owned()]).ok().filter(|table| !table.columns.is_empty());
    table.map(|table| table.row_count).ok_or_else(|| {
        SweepError::Input(format!("`{}` exists and is not a table of runs; choose another file", target.display()))
    })
}

fn is_same(source: &Path, target: &Path) -> bool {
    fs::canonicalize(source).is_ok_and(|source| fs::canonicalize(target).is_ok_and(|target| source == target))
}

/// The tables of all shards in a folder.
fn sources(folder: &Path) -> Result<Vec<PathBuf>, SweepError> {
    let failed = SweepError::file("read", folder);
    let mut counts: Vec<u32> = Vec::new();
    for entry in fs::read_dir(folder).map_err(&failed)? {
        let name = entry.map_err(&failed)?.file_name().to_string_lossy().into_owned();
        let shard = name.strip_prefix("shard-").and_then(|rest| rest.strip_suffix(".parquet"));
        let shard = shard.and_then(|shard| shard.replacen("-of-", "/", 1).parse::<Shard>().ok());
        counts.extend(shard.map(|shard| shard.count));
    }
    counts.sort_unstable();
    counts.dedup();
    match counts.as_slice() {
        [] if folder.join(RUNS_FILE).is_file() => Ok(vec![folder.join(RUNS_FILE)]),
        [] => Err(SweepError::Input(format!("there are no rows in `{}`", folder.display()))),
        [count] => {
            let paths: Vec<PathBuf> =
                (1..=*count).map(|index| table_path(folder, Shard { index, count: *count })).collect();
            match paths.iter().position(|path| !path.is_file()) {
                None => Ok(paths),
                Some(missing) => Err(SweepError::Input(format!(
                    "shard {} of {count} is missing in `{}`; `interplay sweep PLAN --out {} --shard {}/{count}` makes it",
                    missing + 1,
                    folder.display(),
                    folder.display(),
                    missing + 1
                ))),
            }
        }
        several => {
            let divisions: Vec<String> = several.iter().map(|count| format!("of {count}")).collect();
            Err(SweepError::Input(format!(
                "there are shards {} in `{}`; remove the tables of all but one division",
                divisions.join(" and "),
                folder.display()
            )))
        }
    }
}

/// Reads a table from its first row to its last.
struct Cursor {
    reader: TableReader,
    names: Vec<String>,
    group: usize,
    table: RowTable,
    row: usize,
}

impl Cursor {
    fn new(reader: TableReader, schema: &TableSchema) -> Result<Cursor, SweepError> {
        let names = schema.iter().map(|(name, _)| name.clone()).collect();
        let mut cursor = Cursor { reader, names, group: 0, table: RowTable::default(), row: 0 };
        cursor.fill()?;
        Ok(cursor)
    }

    /// Reads the next row group, if all rows in memory have been written.
    fn fill(&mut self) -> Result<(), SweepError> {
        while self.row >= self.table.row_count && self.group < self.reader.group_count() {
            self.table = self.reader.group(self.group, &self.names)?;
            self.group += 1;
            self.row = 0;
        }
        Ok(())
    }

    /// The key of the next row; none at the end.
    fn key(&self) -> Option<String> {
        if self.row >= self.table.row_count {
            return None;
        }
        match self.table.columns.first().map(|(_, column)| column.cell(self.row)) {
            Some(Cell::Text(key)) => key,
            _ => None,
        }
    }

    fn take(&mut self) -> Result<Vec<Cell>, SweepError> {
        let cells = self.table.columns.iter().map(|(_, column)| column.cell(self.row)).collect();
        self.row += 1;
        self.fill()?;
        Ok(cells)
    }
}

/// Writes the rows of all tables in the order of their keys. All rows of one key are in one shard and keep their order.
fn merge_tables(
    readers: Vec<TableReader>,
    schema: TableSchema,
    target: &Path,
    about: &[(&str, String)],
) -> Result<usize, SweepError> {
    if schema.first().is_none_or(|(name, kind)| name != "key" || *kind != ColumnKind::Text) {
        return Err(SweepError::Input("a table of runs begins with the column `key`".to_owned()));
    }
    let mut cursors: Vec<Cursor> =
        readers.into_iter().map(|reader| Cursor::new(reader, &schema)).collect::<Result<_, _>>()?;
    let mut writer = TableWriter::new(target, schema, about)?;
    let mut count = 0;
    loop {
        let keys = cursors.iter().enumerate().filter_map(|(at, cursor)| Some((cursor.key()?, at)));
        let Some((_, at)) = keys.min() else { break };
        writer.push(cursors[at].take()?)?;
        count += 1;
    }
    writer.finish()?;
    Ok(count)
}
