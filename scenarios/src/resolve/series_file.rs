//! Tables of series that a scenario names: their text, their rows, and the row at which the run begins.

use interplay_building::calendar::local_days;
use interplay_building::series::{HeldSeries, SeriesColumn, SeriesError, SeriesTable};

use crate::format::read::regular_file::read_regular;
use crate::format::read::stated_path::{base_in_words, path_beside};
use crate::format::read::text_line::{line_of, line_without_text};
use crate::format::read::tree::TomlNode;
use crate::model::building::config::DAY_S;
use crate::model::scenario::Scenario;
use crate::text::error::{Fault, Place, quoted};

/// The largest table that is read; a year of minutes needs less \[bytes\].
const MAX_FILE_BYTES: u64 = 1 << 27;

/// A table that a scenario names.
pub(crate) struct SeriesFile {
    /// Its name in errors.
    pub title: String,
    /// Its absolute path.
    pub found: String,
    pub table: SeriesTable,
    text: String,
    /// Errors in it are listed after those in the scenario, by this rank.
    rank: usize,
    /// Its type, in words.
    what: &'static str,
}

/// The row of a table at which a run begins, and its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RunStart {
    /// Midnight at the start of the first day, after that of the table's first \[s\].
    pub start_s: f64,
    /// The same midnight in days since noon of the 1st of January 2000, if a date is known.
    pub local_days: Option<f64>,
}

impl SeriesFile {
    /// Reads the table that is called `file` at the key `path`. `what` is its type: `table of prices`.
    pub fn read(file: &str, path: &str, tree: &TomlNode, what: &'static str, rank: usize) -> Result<Self, Fault> {
        let place = tree.place_of(path);
        let beside = path_beside(place, file);
        let title = beside.display().to_string();
        let refused = |reason: String| {
            Fault::at(place, "this file", format!("cannot read {}: {reason}", quoted(&title)))
                .help(base_in_words(place))
        };
        let bytes = read_regular(&beside, MAX_FILE_BYTES).map_err(|error| refused(error.to_string()))?;
        let bytes = bytes.ok_or_else(|| refused(format!("it is larger than 128 MiB, and no {what} is")))?;
        let text = String::from_utf8(bytes).map_err(|_| refused("it is not UTF-8 text".to_owned()))?;
        let found = std::path::absolute(&beside).unwrap_or(beside).to_string_lossy().into_owned();
        let empty = SeriesTable {
            first_s: 0.0,
            interval_s: 1.0,
            first_day: None,
            columns: Vec::new(),
            header_line: 1,
            lines: Vec::new(),
            cell_lines: Vec::new(),
        };
        let mut file = Self { title, found, table: empty, text, rank, what };
        file.table = SeriesTable::parse(&file.text)
            .map_err(|error| file.refused(&error, &line_without_text(&file.title, error.line, rank)))?;
        Ok(file)
    }

    /// The fault of the table, at its line.
    pub fn fault(&self, error: &SeriesError) -> Fault {
        self.refused(error, &self.line(error.line))
    }

    fn refused(&self, error: &SeriesError, place: &Place) -> Fault {
        let message = format!("{} is not a {}: line {}: {}", quoted(&self.title), self.what, error.line, error.problem);
        let help = "the first line names the columns, the first of them `hour`, `time_s` or one of dates; then come rows at \
                    equal intervals";
        Fault::at(place, "this line", message).help(help)
    }

    /// A remark on a line of the table.
    pub fn remark(&self, remark: &SeriesError) -> Fault {
        let message = format!("{}: line {}: {}", quoted(&self.title), remark.line, remark.problem);
        Fault::at(&self.line(remark.line), "this line", message)
    }

    fn line(&self, line: usize) -> Place {
        line_of(&self.title, &self.text, line, self.rank)
    }

    /// The start of the run: on the date of the scenario's calendar if the table has dates, or else on the table's first day.
    pub fn start(&self, scenario: &Scenario, skip_days: usize) -> RunStart {
        // A text that is not a date is refused by the check of the calendar.
        let stated = scenario.calendar.as_ref().and_then(|calendar| calendar.first_date().ok().flatten());
        let first_days = self.table.first_day.map(local_days);
        let stated_days = stated.map(local_days);
        let start_days = stated_days.zip(first_days).map_or(0.0, |(run, table)| run - table) + skip_days as f64;
        let local_days = first_days.map(|first| first + start_days).or(stated_days);
        RunStart { start_s: start_days * DAY_S, local_days }
    }

    /// A column as a series since the first midnight of the run, each of whose values holds until the next.
    ///
    /// # Errors
    /// A missing value, and a table that does not cover `days` days and does not repeat.
    pub fn held(&self, column: &SeriesColumn, start_s: f64, days: usize, repeats: bool) -> Result<HeldSeries, Fault> {
        let SeriesTable { first_s, interval_s, lines, .. } = &self.table;
        if let Some(line) = self.table.missing_line(column) {
            let problem = format!("`{}` is missing", column.title);
            return Err(self.fault(&SeriesError { line, problem }));
        }
        let series = HeldSeries {
            first_s: first_s - start_s,
            interval_s: *interval_s,
            cyclic: repeats,
            values: column.values.clone(),
        };
        let end_s = series.first_s + series.values.len() as f64 * interval_s;
        if repeats || (series.first_s <= 1e-6 && end_s >= days as f64 * DAY_S - 1e-6) {
            return Ok(series);
        }
        let problem = format!(
            "the table covers the hours {:.2} to {:.2} of the run, which takes {}; lower `iterations`, change `skip_days`, or state \
             `repeats = true`",
            series.first_s / 3600.0,
            end_s / 3600.0,
            24 * days
        );
        Err(self.fault(&SeriesError { line: lines.last().copied().unwrap_or(1), problem }))
    }
}
