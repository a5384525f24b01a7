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

/// The same history as a table with a column `time`, every five minutes, and one for each entity, whose state holds until it changes.
/// States that are not numbers, such as `unavailable`, are missing. `None` for any other table.
pub(crate) fn table(text: &str) -> Option<String> {
    let mut reader = ReaderBuilder::new().trim(Trim::All).from_reader(text.trim_start_matches('\u{feff}').as_bytes());
    if reader.headers().ok()?.iter().ne(COLUMNS) {
        return None;
    }
    let mut changes: BTreeMap<String, Vec<(f64, String)>> = BTreeMap::new();
    for record in reader.records() {
        let record = record.ok()?;
        let time = TimeForm::Calendar.read(record.get(2)?)?;
        let state = record.get(1)?.parse::<f64>().map_or_else(|_| "NA".to_owned(), |state| state.to_string());
        changes.entry(record.get(0)?.to_owned()).or_default().push((time.elapsed_s, state));
    }
    changes.values_mut().for_each(|states| states.sort_by(|one, other| one.0.total_cmp(&other.0)));
    let first_s = changes.values().filter_map(|states| Some(states.first()?.0)).fold(f64::NEG_INFINITY, f64::max);
    let last_s = changes.values().filter_map(|states| Some(states.last()?.0)).fold(f64::NEG_INFINITY, f64::max);
    let first_s = (first_s / INTERVAL_S).ceil() * INTERVAL_S;
    let rows = ((last_s - first_s) / INTERVAL_S).floor() + 1.0;
    if !(1.0..=MAX_ROWS).contains(&rows) {
        return None;
    }
    let names: Vec<&str> = changes.keys().map(String::as_str).collect();
    let mut made = format!("time,{}\n", names.join(","));
    for row in 0..rows as usize {
        let time_s = first_s + row as f64 * INTERVAL_S;
        made += &time_s.to_string();
        for states in changes.values() {
            let before = states.partition_point(|(changed_s, _)| *changed_s <= time_s);
            made.push(',');
            made += before.checked_sub(1).map_or("NA", |last| &states[last].1);
        }
        made.push('\n');
    }
    Some(made)
}

#[cfg(test)]
mod tests {
    use super::super::SeriesTable;

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
}
