//! A table of text with a header: finds columns, converts fields to numbers and times, and locates invalid fields.

use csv::{ReaderBuilder, StringRecord, Trim};

use super::error::{Problem, TelemetryError, listed};
use super::mapping::{Mapping, TimeAxis};
use super::units::{DecimalSign, TableForm};
use crate::series::clock::{self, ClockTime, NamedZone, seconds_since_1970};
use crate::series::home_assistant::{Export, is_without_value};

/// A table of text; every row has as many fields as the header.
pub(super) struct Table<'a> {
    file: &'a str,
    form: &'a TableForm,
    lines: Lines<'a>,
    header: Vec<String>,
    computed: Vec<Computed>,
    pub rows: Vec<Row>,
    /// The export of which the table is made, if it is one of Home Assistant.
    pub export: Option<&'a Export>,
}

/// A column that is the mean of others, times a factor.
struct Computed {
    name: String,
    members: Vec<Column>,
    factor: f64,
}

/// A row and the line on which it starts, from 1.
pub(super) struct Row {
    line: usize,
    fields: StringRecord,
}

/// A column that the mapping names: of the table, or beyond its width a computed one.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Column(usize);

impl<'a> Table<'a> {
    /// Splits `text` into rows and fields.
    pub fn split(file: &'a str, text: &'a str, mapping: &'a Mapping) -> Result<Self, TelemetryError> {
        let form = &mapping.table;
        // Some programs begin files with a byte-order mark.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let lines = Lines::new(text);
        // The schema of the mapping requires an ASCII character.
        let separator = u8::try_from(form.separator).unwrap_or(b',');
        let skipped = lines.start_of(form.skip_rows + 1);
        let rest = text.get(skipped..).unwrap_or_default();
        let mut reader =
            ReaderBuilder::new().delimiter(separator).trim(Trim::All).has_headers(false).from_reader(rest.as_bytes());
        let mut rows = reader.records().map(|record| match record {
            Ok(fields) => Ok(Row { line: lines.number(fields.position(), skipped), fields }),
            Err(error) => {
                let text = format!("the row cannot be read: {}", reason(&error));
                let problem = Problem::new(text, "every row needs as many fields as the header");
                Err(TelemetryError::new(file, Some((lines.number(error.position(), skipped), 1)), problem))
            }
        });
        let needs = "it needs a header and at least two rows";
        let empty = || TelemetryError::new(file, None, Problem::new("the table is empty", needs));
        let header = rows.next().ok_or_else(empty)??.fields.iter().map(str::to_owned).collect();
        let rows = rows.collect::<Result<Vec<_>, _>>()?;
        if rows.is_empty() {
            return Err(empty());
        }
        let mut table = Self { file, form, lines, header, computed: Vec::new(), rows, export: None };
        for computed in &mapping.columns {
            let role = format!("part of {}", computed.name);
            let members = computed.mean_of.iter().map(|name| table.column_of_table(name, &role));
            let members = members.collect::<Result<Vec<_>, _>>()?;
            if table.column(&computed.name, "").is_ok() {
                let fault = "the name of another column already";
                return Err(table.wrong_column(&computed.name, "a computed column", fault));
            }
            table.computed.push(Computed { name: computed.name.trim().into(), members, factor: computed.factor });
        }
        Ok(table)
    }

    /// Finds a column; `role` says in error messages what the column is for. Spaces around titles and names are ignored.
    pub fn column(&self, name: &str, role: &str) -> Result<Column, TelemetryError> {
        match self.computed.iter().position(|computed| computed.name == name.trim()) {
            Some(index) => Ok(Column(self.header.len() + index)),
            None => self.column_of_table(name, role),
        }
    }

    fn column_of_table(&self, name: &str, role: &str) -> Result<Column, TelemetryError> {
        let mut found =
            self.header.iter().enumerate().filter(|(_, title)| *title == name.trim()).map(|(index, _)| index);
        let fault = match (found.next(), found.next()) {
            (Some(index), None) => return Ok(Column(index)),
            (None, _) => "not in the header",
            (Some(_), Some(_)) => "in the header twice",
        };
        Err(self.wrong_column(name, role, fault))
    }

    fn wrong_column(&self, name: &str, role: &str, fault: &str) -> TelemetryError {
        let header = listed(&self.header);
        let problem = Problem::new(
            format!("column `{name}`, wanted as {role}, is {fault}"),
            format!("the header has {header}; check `table.separator` if this is one column"),
        );
        TelemetryError::new(self.file, Some((self.form.skip_rows + 1, 1)), problem)
    }

    /// The text of a field; of a computed column, that of its first source.
    pub fn text<'r>(&self, row: &'r Row, column: Column) -> &'r str {
        let column = self.first_of(column);
        row.fields.get(column.0).unwrap_or_default()
    }

    /// The column itself, or the first one of those from which it is computed.
    fn first_of(&self, column: Column) -> Column {
        let computed = column.0.checked_sub(self.header.len()).and_then(|index| self.computed.get(index));
        computed.and_then(|computed| computed.members.first()).copied().unwrap_or(column)
    }

    /// A field as a number; `None` if it marks a missing value.
    pub fn number(&self, row: &Row, column: Column) -> Result<Option<f64>, TelemetryError> {
        let computed = column.0.checked_sub(self.header.len()).and_then(|index| self.computed.get(index));
        let Some(computed) = computed else { return self.number_of_table(row, column) };
        let mut sum = 0.0;
        for &member in &computed.members {
            match self.number_of_table(row, member)? {
                Some(value) => sum += value,
                None => return Ok(None),
            }
        }
        Ok(Some(computed.factor * sum / computed.members.len() as f64))
    }

    fn number_of_table(&self, row: &Row, column: Column) -> Result<Option<f64>, TelemetryError> {
        let text = self.text(row, column);
        let is_unavailable = self.export.is_some() && is_without_value(text);
        if text.is_empty() || is_unavailable || self.form.missing.iter().any(|missing| missing == text) {
            return Ok(None);
        }
        let parsed = match self.form.decimal {
            DecimalSign::Point => text.parse::<f64>(),
            DecimalSign::Comma => text.replace(',', ".").parse(),
        };
        match parsed {
            Ok(value) if value.is_finite() => Ok(Some(value)),
            _ => {
                let remedy = "write a number like 21.5 (`table.decimal` sets the decimal sign), or list the text in `table.missing`";
                let text = format!("`{text}` in column `{}` is not a number", self.title(column));
                Err(self.at(row, column, Problem::new(text, remedy)))
            }
        }
    }

    /// A field as a time. `zone` is the time zone of times without an offset, and `after` the time of the row before.
    pub fn time(
        &self,
        row: &Row,
        column: Column,
        (axis, zone): (&TimeAxis, Option<&NamedZone>),
        after: Option<ClockTime>,
    ) -> Result<ClockTime, TelemetryError> {
        let (text, format) = (self.text(row, column), axis.format.as_str());
        let number = |unit_s: f64| {
            let number = text.parse().ok().filter(|time: &f64| time.is_finite());
            number.map(|number| ClockTime { elapsed_s: number * unit_s, offset_s: 0.0 })
        };
        let parsed = || clock::parsed(format, text);
        let time = match (format, zone) {
            ("seconds", _) => number(1.0),
            ("hours", _) => number(3600.0),
            (_, None) => parsed().and_then(|parsed| ClockTime::stated(&parsed)),
            (_, Some(zone)) => {
                let shown = parsed().and_then(|parsed| parsed.to_datetime().ok());
                let time = |shown| {
                    let offset_s = zone.offset_s(shown, after.map(|after| after.elapsed_s))?;
                    Some(ClockTime { elapsed_s: seconds_since_1970(shown) - offset_s, offset_s })
                };
                if let Some((shown, None)) = shown.map(|shown| (shown, time(shown))) {
                    let zone = axis.zone.as_deref().unwrap_or_default();
                    let text = format!("clocks of {zone} never showed {shown}: they were put forward");
                    let remedy = "leave `time.zone` out if these clocks are not put forward and back, or correct it";
                    return Err(self.at(row, column, Problem::new(text, remedy)));
                }
                shown.and_then(time)
            }
        };
        time.ok_or_else(|| {
            let remedy = match clock::format_with_offset(format, text) {
                Some(format) => {
                    format!("it has an offset from UTC: set `time.format` to `{format}`, in place of a `time.zone`")
                }
                None => "set `time.format` to the form of the column, for example `%Y-%m-%d %H:%M:%S`".into(),
            };
            let text = format!("`{text}` in column `{}` is not a time of the form `{format}`", self.title(column));
            self.at(row, column, Problem::new(text, remedy))
        })
    }

    /// The error for `problem` in the field at `row` and `column`.
    pub fn at(&self, row: &Row, column: Column, problem: Problem) -> TelemetryError {
        let column = self.first_of(column);
        let place = match self.export {
            Some(export) => export.place(row.line, column.0),
            None => Some((row.line, field_start(self.lines.text(row.line), self.form.separator, column.0))),
        };
        TelemetryError::new(self.file, place, problem)
    }

    /// The name of a column.
    pub fn title(&self, column: Column) -> String {
        self.header.get(self.first_of(column).0).cloned().unwrap_or_default()
    }
}

/// A text and where its lines begin. (The reader counts lines too, but one short after a carriage return.)
struct Lines<'a> {
    text: &'a str,
    starts: Vec<usize>,
}

impl<'a> Lines<'a> {
    fn new(text: &'a str) -> Self {
        let starts = std::iter::once(0).chain(text.match_indices('\n').map(|(newline, _)| newline + 1)).collect();
        Self { text, starts }
    }

    /// The line, from 1, on which a row starts; the reader's positions may lie before the end of the line above.
    /// What is read began at byte `from`.
    fn number(&self, position: Option<&csv::Position>, from: usize) -> usize {
        let byte = from + position.and_then(|position| usize::try_from(position.byte()).ok()).unwrap_or(0);
        let rest = self.text.get(byte..).unwrap_or_default();
        let start = byte + (rest.len() - rest.trim_start_matches(['\r', '\n']).len());
        self.starts.partition_point(|&line| line <= start)
    }

    /// The byte at which a line, from 1, begins; the end of the text beyond its last line.
    fn start_of(&self, number: usize) -> usize {
        self.starts.get(number.saturating_sub(1)).copied().unwrap_or(self.text.len())
    }

    fn text(&self, number: usize) -> &'a str {
        let start = number.checked_sub(1).and_then(|index| self.starts.get(index)).copied().unwrap_or(0);
        self.text.get(start..).and_then(|rest| rest.lines().next()).unwrap_or_default()
    }
}

/// The character, from 1, at which field number `index` of a line starts; separators within quotes separate nothing.
fn field_start(line: &str, separator: char, index: usize) -> usize {
    let (mut quoted, mut fields) = (false, 0);
    for (at, character) in line.chars().enumerate() {
        if fields == index {
            return at + 1;
        }
        match character {
            '"' => quoted = !quoted,
            _ if character == separator && !quoted => fields += 1,
            _ => {}
        }
    }
    line.chars().count() + 1
}

/// The CSV reader's complaint without its position, which the error states in its own form.
fn reason(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("it has {len} fields, the header has {expected_len}")
        }
        _ => error.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::field_start;

    #[test]
    fn the_start_of_a_field_is_found_by_counting_unquoted_separators() {
        assert_eq!(field_start("a;bc;d", ';', 0), 1);
        assert_eq!(field_start("a;bc;d", ';', 1), 3);
        assert_eq!(field_start("ä;\"b;c\";d", ';', 2), 9);
        assert_eq!(field_start("a;b", ';', 5), 4);
    }
}
