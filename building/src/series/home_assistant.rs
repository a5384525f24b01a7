//! The history that Home Assistant exports: a row for each change of a state, `entity_id,state,last_changed`.

use std::collections::BTreeMap;

use csv::{ReaderBuilder, Trim};

use super::clock::TimeForm;

/// Time between two rows of the table that is made \[s\].
const INTERVAL_S: f64 = 300.0;
/// The most rows of that table: ten years.
const MAX_ROWS: f64 = 1_100_000.0;
/// The columns of an export.
const COLUMNS: [&str; 3] = ["entity_id", "state", "last_changed"];

/// States of an entity that has no value.
const WITHOUT_VALUE: [&str; 2] = ["unavailable", "unknown"];

/// Whether a state says that its entity has no value.
pub(crate) fn is_without_value(state: &str) -> bool {
    WITHOUT_VALUE.contains(&state)
}

/// An export as a table with a column `time`, every five minutes, and one for each entity, whose state holds until it changes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Export {
    /// The export, with plain ends of lines.
    stated: String,
    /// The table, with states as they are stated.
    pub table: String,
    /// For each row of the table and each entity, the line of the export that states it, from one.
    pub lines: Vec<Vec<usize>>,
}

impl Export {
    /// The export; `None` for any other table.
    pub fn read(text: &str) -> Option<Export> {
        let stated = text.trim_start_matches('\u{feff}').replace("\r\n", "\n");
        let changes = changes(&stated)?;
        let end_s = |of: fn(&[Change]) -> Option<&Change>| {
            let times = changes.values().filter_map(|states| Some(of(states)?.time_s));
            times.fold(f64::NEG_INFINITY, f64::max)
        };
        let first_s = (end_s(|states| states.first()) / INTERVAL_S).ceil() * INTERVAL_S;
        let rows = ((end_s(|states| states.last()) - first_s) / INTERVAL_S).floor() + 1.0;
        if !(1.0..=MAX_ROWS).contains(&rows) {
            return None;
        }
        let names: Vec<&str> = changes.keys().map(String::as_str).collect();
        let mut table = format!("time,{}\n", names.join(","));
        let mut lines = Vec::with_capacity(rows as usize);
        for row in 0..rows as usize {
            let time_s = first_s + row as f64 * INTERVAL_S;
            table += &time_s.to_string();
            let held = changes.values().map(|states| {
                let after = states.partition_point(|change| change.time_s <= time_s);
                // Every entity has a state at the first row.
                &states[after.saturating_sub(1)]
            });
            let mut line_of_each = Vec::with_capacity(names.len());
            for change in held {
                table.push(',');
                table += &change.state;
                line_of_each.push(change.line);
            }
            lines.push(line_of_each);
            table.push('\n');
        }
        Some(Export { stated, table, lines })
    }

    /// Line and column of the export, from one, that state a field of the table: of the row below the header on `line` of the table, and
    /// the field of that index. `None` for a time, which the export does not state.
    pub fn place(&self, line: usize, field: usize) -> Option<(usize, usize)> {
        let stated_line = *self.lines.get(line.checked_sub(2)?)?.get(field.checked_sub(1)?)?;
        let text = self.stated.lines().nth(stated_line - 1)?;
        let before = text.split_inclusive(',').next()?;
        Some((stated_line, before.chars().count() + 1))
    }
}

/// A state of an entity from a time on.
#[derive(Clone, Debug, PartialEq)]
struct Change {
    time_s: f64,
    /// The field of the table.
    state: String,
    /// The line of the export, from one.
    line: usize,
}

/// The changes of each entity, in order of time; `None` if the text is not an export.
fn changes(text: &str) -> Option<BTreeMap<String, Vec<Change>>> {
    let mut reader = ReaderBuilder::new().trim(Trim::All).from_reader(text.as_bytes());
    if reader.headers().ok()?.iter().ne(COLUMNS) {
        return None;
    }
    let mut changes: BTreeMap<String, Vec<Change>> = BTreeMap::new();
    for record in reader.records() {
        let record = record.ok()?;
        let time_s = TimeForm::Calendar.read(record.get(2)?)?.elapsed_s;
        let line = record.position().map_or(1, |at| at.line() as usize);
        let change = Change { time_s, state: field(record.get(1)?), line };
        changes.entry(record.get(0)?.to_owned()).or_default().push(change);
    }
    changes.values_mut().for_each(|states| states.sort_by(|one, other| one.time_s.total_cmp(&other.time_s)));
    Some(changes)
}

/// A state as a field of a table: a number, or a text, which may need quotes.
fn field(state: &str) -> String {
    match state.parse::<f64>() {
        Ok(number) if number.is_finite() => number.to_string(),
        // A row of the table is one line.
        _ if state.contains([',', '"', '\n']) => format!("\"{}\"", state.replace('"', "\"\"").replace('\n', " ")),
        _ => state.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::SeriesTable;
    use super::*;

    #[test]
    fn an_export_of_home_assistant_is_a_table_of_held_states() {
        let text = "entity_id,state,last_changed\nsensor.room,20.5,2026-01-05T00:00:00.000Z\n\
                    sensor.heat,1.5,2026-01-05T00:02:10.500Z\nsensor.room,unavailable,2026-01-05T00:11:00Z\n\
                    sensor.room,21,2026-01-05T00:16:00Z\n";
        let table = SeriesTable::parse(text).expect("a table");
        assert_eq!((table.titles(), table.interval_s), (vec!["sensor.heat", "sensor.room"], 300.0));
        assert_eq!(table.first_day.map(|day| day.to_string()).as_deref(), Some("2026-01-05"));
        let room = &table.column("sensor.room").expect("a column").values;
        assert!(room[..2] == [20.5, 20.5] && room[2].is_nan() && room.len() == 3, "{room:?}");
    }
    #[test]
    fn a_state_is_found_in_the_line_that_states_it() {
        let text = "entity_id,state,last_changed\r\nsensor.room,20.5,2026-01-05T00:00:00Z\r\n\
                    light.hall,\"on, dimmed\",2026-01-05T00:00:00Z\r\nsensor.room,unavailable,2026-01-05T00:04:00Z\r\n\
                    sensor.room,21,2026-01-05T00:10:00Z\r\n";
        let export = Export::read(text).expect("an export");
        let rows: Vec<&str> = export.table.lines().skip(1).map(|row| row.split_once(',').expect("a time").1).collect();
        assert_eq!(rows, ["\"on, dimmed\",20.5", "\"on, dimmed\",unavailable", "\"on, dimmed\",21"]);
        assert_eq!(export.lines, [[3, 2], [3, 4], [3, 5]]);
        assert_eq!(export.place(3, 2), Some((4, 13)), "the row at 00:05");
        assert_eq!([export.place(3, 0), export.place(1, 1), export.place(9, 1)], [None; 3]);
        let table = SeriesTable::parse(text).expect("a table");
        let room = table.column("sensor.room").expect("a column");
        assert!(room.values[1].is_nan());
        assert_eq!(table.missing_line(room), Some(4));
    }
}
