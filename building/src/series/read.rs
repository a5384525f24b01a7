//! Tables of series as comma-separated values.
//!
//! The first line that does not begin with `#` is the header: the title of the times, then a title for each series. Times are hours
//! (`hour`) or seconds (`time_s`) since the first midnight, or dates with a time; they rise by equal intervals. Fields are separated by
//! commas, semicolons or tabs, and may be quoted; decimals may have a comma where it separates nothing. Cells that are empty, `NA`,
//! `NaN` or, as Home Assistant writes, `unavailable` are missing.

use csv::{ReaderBuilder, StringRecord, Trim};
use interplay_common::cell::shown_cell;
use jiff::civil::{Date, Weekday};

use super::clock::{RowTime, TimeForm};
use super::home_assistant::{Export, is_without_value};

/// The most that the interval between two rows may differ from the first one, as a share of it.
const MAX_JITTER: f64 = 0.01;
/// By how much clocks are put back and forward \[s\].
const HOUR_S: f64 = 3600.0;
/// How long a value holds in a table of one row \[s\].
const ONLY_ROW_S: f64 = 3600.0;

/// A table of series.
#[derive(Clone, Debug, PartialEq)]
pub struct SeriesTable {
    /// Time of the first row since the midnight before it \[s\], or since the first midnight where times are counted from there.
    pub first_s: f64,
    /// Time between two rows \[s\].
    pub interval_s: f64,
    /// The day of the first row, where times are dates.
    pub first_day: Option<Date>,
    /// The series, in the order of the header.
    pub columns: Vec<SeriesColumn>,
    /// The line of the header, from one.
    pub header_line: usize,
    /// The line of each row, from one; in an export of Home Assistant, that of the last change of a state.
    pub lines: Vec<usize>,
    /// In an export of Home Assistant, the line that states each cell of each row; empty otherwise.
    pub cell_lines: Vec<Vec<usize>>,
}

/// A series of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct SeriesColumn {
    /// Its title, without spaces around it.
    pub title: String,
    /// Its values; NaN where they are missing.
    pub values: Vec<f64>,
}

/// Why a table of series cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {problem}")]
pub struct SeriesError {
    /// The line, from one.
    pub line: usize,
    /// What is wrong, and what would work.
    pub problem: String,
}

impl SeriesError {
    fn new(line: usize, problem: impl Into<String>) -> Self {
        Self { line, problem: problem.into() }
    }
}

impl SeriesTable {
    /// Reads a table.
    ///
    /// # Errors
    /// [`SeriesError`] with the line, for a table without rows, a time or number that is none, and times that do not rise by equal
    /// intervals.
    pub fn parse(text: &str) -> Result<Self, SeriesError> {
        // Carriage returns would make the reader count lines wrongly.
        let Some(export) = Export::read(text) else {
            return Self::of_table(&text.trim_start_matches('\u{feff}').replace("\r\n", "\n"), false);
        };
        let table = Self::of_table(&export.table, true)?;
        let cell_lines: Vec<Vec<usize>> = table.lines.iter().map(|line| export.lines[line - 2].clone()).collect();
        let lines = cell_lines.iter().map(|lines| lines.iter().copied().max().unwrap_or(1)).collect();
        Ok(Self { lines, cell_lines, ..table })
    }

    /// Reads a table with plain ends of lines. In one that is made of the states of entities, all states that are not numbers are missing.
    fn of_table(text: &str, are_states: bool) -> Result<Self, SeriesError> {
        let before = text.lines().take_while(|line| line.starts_with('#') || line.trim().is_empty()).count();
        let Some(header_line) = text.lines().nth(before) else {
            return Err(SeriesError::new(1, "the table is empty: its first line must be a header"));
        };
        let separator = separator(header_line);
        let (records, lines) = records(text, before, separator)?;
        let (Some(header), Some(rows)) = (records.first(), records.get(1..).filter(|rows| !rows.is_empty())) else {
            return Err(SeriesError::new(before + 1, "there are no rows below the header"));
        };
        let form = TimeForm::of(header.get(0).unwrap_or_default());
        let row_lines = lines[1..].to_vec();
        let times = times(form, rows, &row_lines)?;
        let mut columns: Vec<SeriesColumn> =
            header.iter().skip(1).map(|title| SeriesColumn { title: title.to_owned(), values: Vec::new() }).collect();
        if columns.is_empty() {
            return Err(SeriesError::new(before + 1, "the header names no series beside the times"));
        }
        let row_lines: Vec<usize> = times.iter().map(|(_, row)| row_lines[*row]).collect();
        for ((_, row), line) in times.iter().zip(&row_lines) {
            let row = &rows[*row];
            for (index, column) in columns.iter_mut().enumerate() {
                let cell = row.get(index + 1).unwrap_or_default();
                let title = &column.title;
                let problem =
                    || SeriesError::new(*line, format!("{} is {}, not a number", shown_cell(title), shown_cell(cell)));
                let value = number(cell, separator).or(are_states.then_some(f64::NAN));
                column.values.push(value.ok_or_else(problem)?);
            }
        }
        let first = times[0].0;
        let first_s = first.local.map_or(first.elapsed_s, |(_, since_midnight_s)| since_midnight_s);
        Ok(Self {
            first_s,
            interval_s: interval_s(&times),
            first_day: first.local.map(|(day, _)| day),
            columns,
            header_line: before + 1,
            lines: row_lines,
            cell_lines: Vec::new(),
        })
    }

    /// The series of that title, without regard to case.
    pub fn column(&self, title: &str) -> Option<&SeriesColumn> {
        self.columns.iter().find(|column| column.title.eq_ignore_ascii_case(title.trim()))
    }

    /// The titles of all series.
    pub fn titles(&self) -> Vec<&str> {
        self.columns.iter().map(|column| column.title.as_str()).collect()
    }

    /// The line of the first missing value of a series.
    pub fn missing_line(&self, column: &SeriesColumn) -> Option<usize> {
        let row = column.values.iter().position(|value| value.is_nan())?;
        let index = self.columns.iter().position(|other| other.title == column.title);
        let of_cell = index.and_then(|index| self.cell_lines.get(row)?.get(index)).copied();
        Some(of_cell.unwrap_or(self.lines[row]))
    }
}

/// What separates the fields of a header.
fn separator(header: &str) -> u8 {
    let count = |separator: char| header.chars().filter(|character| *character == separator).count();
    [(';', b';'), ('\t', b'\t')].into_iter().find(|(separator, _)| count(*separator) > 0).map_or(b',', |(_, byte)| byte)
}

/// The header and the rows, with their lines.
fn records(text: &str, before: usize, separator: u8) -> Result<(Vec<StringRecord>, Vec<usize>), SeriesError> {
    let start: usize = text.split_inclusive('\n').take(before).map(str::len).sum();
    let mut reader = ReaderBuilder::new()
        .delimiter(separator)
        .trim(Trim::All)
        .has_headers(false)
        .comment(Some(b'#'))
        .from_reader(&text.as_bytes()[start..]);
    let (mut records, mut lines) = (Vec::new(), Vec::new());
    for record in reader.records() {
        let line_of = |position: Option<&csv::Position>| before + position.map_or(1, |at| at.line() as usize);
        match record {
            Ok(record) => {
                lines.push(line_of(record.position()));
                records.push(record);
            }
            Err(error) => {
                let problem = match error.kind() {
                    csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                        format!("the row has {len} fields, and the header {expected_len}")
                    }
                    _ => error.to_string(),
                };
                return Err(SeriesError::new(line_of(error.position()), problem));
            }
        }
    }
    Ok((records, lines))
}

/// The times of a table at equal intervals, each with its row. Where clocks without an offset from UTC are put back, the first of two
/// hours of the same name counts; where they are put forward, the row before the hour that is left out holds during it.
fn times(form: TimeForm, rows: &[StringRecord], lines: &[usize]) -> Result<Vec<(RowTime, usize)>, SeriesError> {
    let mut times: Vec<(RowTime, usize)> = Vec::with_capacity(rows.len());
    for (index, (row, line)) in rows.iter().zip(lines).enumerate() {
        let text = row.get(0).unwrap_or_default();
        let wrong =
            || SeriesError::new(*line, format!("the time is {}; it must be {}", shown_cell(text), form.wanted()));
        let time = form.read(text).ok_or_else(wrong)?;
        if let Some((before, held)) = times.last().copied() {
            let (wanted_s, found_s) = (interval_s(&times), time.elapsed_s - before.elapsed_s);
            let wanted_s = if times.len() < 2 { found_s } else { wanted_s };
            if may_change_clocks(&time) && (wanted_s - HOUR_S - 1e-6..=1e-6).contains(&found_s) {
                continue;
            }
            if may_change_clocks(&time) && (found_s - wanted_s - HOUR_S).abs() <= MAX_JITTER * wanted_s {
                let later = |step: usize| {
                    let by_s = step as f64 * wanted_s;
                    let local = before.local.map(|(day, since_midnight_s)| (day, since_midnight_s + by_s));
                    (RowTime { elapsed_s: before.elapsed_s + by_s, local, ..before }, held)
                };
                times.extend((1..=(HOUR_S / wanted_s).round() as usize).map(later));
                times.push((time, index));
                continue;
            }
            if found_s <= 0.0 || (found_s - wanted_s).abs() > MAX_JITTER * wanted_s {
                let problem = format!(
                    "the time {} is {} after that of the row above; rows must follow each other every {}",
                    shown_cell(text),
                    duration(found_s),
                    duration(wanted_s.abs())
                );
                return Err(SeriesError::new(*line, problem));
            }
        }
        times.push((time, index));
    }
    Ok(times)
}

/// Whether clocks may be put back or forward at a time without an offset from UTC: in the night of a Sunday of spring or autumn.
fn may_change_clocks(time: &RowTime) -> bool {
    time.local.is_some_and(|(day, since_midnight_s)| {
        !time.is_absolute
            && day.weekday() == Weekday::Sunday
            && [3, 4, 9, 10, 11].contains(&day.month())
            && since_midnight_s <= 4.0 * HOUR_S
    })
}

/// The time between the first two rows \[s\].
fn interval_s(times: &[(RowTime, usize)]) -> f64 {
    match times {
        [(first, _), (second, _), ..] => second.elapsed_s - first.elapsed_s,
        _ => ONLY_ROW_S,
    }
}

fn duration(seconds: f64) -> String {
    if seconds.abs() >= 3600.0 { format!("{} h", seconds / 3600.0) } else { format!("{seconds} s") }
}

/// The number in a cell, NaN where it is missing; `None` where it is neither.
fn number(cell: &str, separator: u8) -> Option<f64> {
    let is_missing = |word: &str| ["na", "nan", "null", "-"].contains(&word) || is_without_value(word);
    if cell.is_empty() || is_missing(&cell.to_ascii_lowercase()) {
        return Some(f64::NAN);
    }
    let parsed = if separator == b',' { cell.parse() } else { cell.replace(',', ".").parse() };
    parsed.ok().filter(|value: &f64| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn separators_decimal_signs_and_quotes_do_not_change_a_table() {
        let plain = SeriesTable::parse("hour,a,b\n0,1.5,2\n0.25,,3\n").expect("a table");
        assert_eq!((plain.first_s, plain.interval_s, plain.titles()), (0.0, 900.0, vec!["a", "b"]));
        assert!(plain.columns[0].values[1].is_nan());
        assert_eq!(plain.missing_line(&plain.columns[0]), Some(3));
        for other in [
            "\u{feff}# made by hand\r\n\r\n\"hour\";\"a\";\"b\"\r\n0;1,5;2\r\n0,25;NA;3\r\n".replace("0,25", "0.25"),
            "time_s\ta\tb\n0\t1.5\t2\n900\t-\t3\n".to_owned(),
        ] {
            let table = SeriesTable::parse(&other).expect("a table");
            assert_eq!((table.first_s, table.interval_s, table.titles()), (0.0, 900.0, vec!["a", "b"]), "{other}");
            assert_eq!(table.columns[1], plain.columns[1], "{other}");
        }
    }

    #[test]
    fn dates_are_on_the_clocks_of_the_first_row() {
        let text = "time,a\n2026-10-24T23:00+02:00,1\n2026-10-25T00:00+02:00,2\n2026-10-25T01:00+02:00,3\n\
                    2026-10-25T02:00+02:00,4\n2026-10-25T02:00+01:00,5\n2026-10-25T03:00+01:00,6\n";
        let table = SeriesTable::parse(text).expect("an hour that comes twice has two offsets");
        assert_eq!((table.first_s, table.interval_s), (23.0 * 3600.0, 3600.0));
        assert_eq!(table.first_day.map(|day| day.to_string()).as_deref(), Some("2026-10-24"));
        assert_eq!(
            SeriesTable::parse("t,a\n24.10.2026 00:15,1\n24.10.2026 00:30,1\n").map(|t| t.interval_s),
            Ok(900.0)
        );
    }

    /// On 2026-10-25 the clocks of Europe show the hour from 2 to 3 twice, on 2026-03-29 not at all.
    #[test]
    fn hours_of_local_clocks_stay_where_they_are_around_a_change() {
        let rows = |day: &str, hours: &[f64]| -> String {
            let row = |hour: &f64| format!("{day} {:02}:{:02},{hour}\n", hour.floor(), 60.0 * hour.fract());
            hours.iter().map(row).collect()
        };
        for (day, hours, values) in [
            ("2026-10-25", vec![0.0, 1.0, 2.0, 2.0, 3.0, 4.0], vec![0.0, 1.0, 2.0, 3.0, 4.0]),
            ("2026-10-25", vec![1.5, 2.0, 2.5, 2.0, 2.5, 3.0], vec![1.5, 2.0, 2.5, 3.0]),
            ("2026-03-29", vec![0.0, 1.0, 3.0, 4.0], vec![0.0, 1.0, 1.0, 3.0, 4.0]),
        ] {
            let table = SeriesTable::parse(&format!("time,a\n{}", rows(day, &hours))).expect("a table");
            assert_eq!(table.columns[0].values, values, "{day}");
        }
        let monday = format!("time,a\n{}", rows("2026-10-26", &[0.0, 1.0, 1.0, 2.0]));
        assert_eq!(SeriesTable::parse(&monday).expect_err("a row twice").line, 4);
    }

    #[test]
    fn lines_are_counted_with_carriage_returns_and_times_since_1970_are_read() {
        let error = SeriesTable::parse("hour,a\r\n0,1\r\n1,x\r\n").expect_err("x is wrong");
        assert_eq!(error.line, 3);
        for text in ["time,a\n1783296000,1\n1783299600,2\n", "time,a\n1783296000000,1\n1783299600000,2\n"] {
            let table = SeriesTable::parse(text).expect("a table");
            assert_eq!((table.first_s, table.interval_s), (0.0, 3600.0));
            assert_eq!(table.first_day.map(|day| day.to_string()).as_deref(), Some("2026-07-06"));
        }
    }

    #[test]
    fn every_fault_of_a_table_is_reported_with_its_line() {
        for (text, line, words) in [
            ("", 1, "empty"),
            ("hour,a\n", 1, "no rows"),
            ("hour\n0\n", 1, "names no series"),
            ("hour,a\n0,x\n", 2, "`a` is `x`"),
            ("hour,a\n0,1\n1,2\n3,4\n", 4, "2 h after that of the row above; rows must follow each other every 1 h"),
            ("hour,a\n0,1\n0,2\n", 3, "0 s after"),
            ("time,a\n0,1\n", 2, "numbers of hours stand in a column `hour`"),
            ("hour,a\n0,1,2\n", 2, "3 fields"),
            ("# one\n# two\nhour,a\n0,1\nnoon,2\n", 5, "`noon`"),
        ] {
            let error = SeriesTable::parse(text).expect_err(text);
            assert!(error.line == line && error.problem.contains(words), "{text:?}: {error}");
        }
    }
}
