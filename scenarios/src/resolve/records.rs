//! Reads the tables of recorded vehicles that a scenario names when the scenario is loaded; their faults are reported then,
//! with their lines.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use interplay_common::cell::shown_cell;
use interplay_common::spelling::listed;
use serde_json::{Value as Json, json};

use crate::format::read::regular_file::read_regular;
use crate::format::read::stated_path::{base_in_words, path_beside};
use crate::format::read::text_line::line_without_text;
use crate::format::read::tree::TomlNode;
use crate::format::vehicle_config::VehicleConfig;
use crate::text::error::{Fault, quoted};

/// The largest table that is read; a hundred vehicles over ten minutes in steps of 0.1 s take less \[bytes\].
const MAX_FILE_BYTES: u64 = 1 << 26;
/// The largest number in a table, of any unit.
const MAX_NUMBER: f64 = 1e9;
/// Errors in tables are listed after those in the scenario.
const RANK: usize = 1002;
/// The columns of a table, in the order of a driver's `points`.
pub(crate) const COLUMNS: [&str; 5] = ["time_s", "x_m", "y_m", "heading_rad", "speed_mps"];
/// The column that distinguishes vehicles.
pub(crate) const ID_COLUMN: &str = "id";
/// The kind of driver that follows a record.
pub(crate) const KIND: &str = "recorded";
/// The most names of vehicles in an error.
const MAX_NAMES: usize = 12;

/// The rows of each vehicle of a table, by its `id`; without such a column, of one vehicle without a name.
pub(crate) type Records = BTreeMap<String, Vec<[f64; 5]>>;

/// Replaces the names of tables in recorded drivers by their rows, and the files that other drivers name by absolute paths.
///
/// # Errors
/// The faults of the tables.
pub(super) fn read(vehicles: &mut [VehicleConfig], tree: &TomlNode) -> Result<(), Vec<Fault>> {
    let mut tables: BTreeMap<PathBuf, Arc<Records>> = BTreeMap::new();
    let mut faults = Vec::new();
    for (index, vehicle) in vehicles.iter_mut().enumerate() {
        let Some(driver) = vehicle.driver.as_mut() else { continue };
        let file = driver.get("file").and_then(Json::as_str).map(str::to_owned);
        let Some(file) = file.filter(|file| !file.is_empty()) else { continue };
        if driver.get("kind").is_none_or(|kind| kind != KIND) {
            let path = path_beside(tree.place_of(&format!("vehicle.{index}.driver.file")), &file);
            let path = std::fs::canonicalize(&path).unwrap_or(path);
            *driver = std::mem::take(driver).with("file", path.to_string_lossy().into_owned());
            continue;
        }
        let id = driver.get("id").and_then(Json::as_str).map(str::to_owned);
        match rows(&mut tables, &file, id.as_deref(), tree, index) {
            Ok(rows) => {
                driver.take("file");
                driver.take("id");
                *driver = std::mem::take(driver).with("points", json!(rows));
            }
            Err(fault) => faults.push(fault),
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

fn rows(
    tables: &mut BTreeMap<PathBuf, Arc<Records>>,
    file: &str,
    id: Option<&str>,
    tree: &TomlNode,
    index: usize,
) -> Result<Vec<[f64; 5]>, Fault> {
    let place = tree.place_of(&format!("vehicle.{index}.driver.file"));
    let path = path_beside(place, file);
    let title = path.display().to_string();
    let records = match tables.get(&path) {
        Some(known) => Arc::clone(known),
        None => {
            let refused = |reason: String| {
                let message = format!("cannot read {}: {reason}", quoted(&title));
                Fault::at(place, "this file", message).help(base_in_words(place))
            };
            let bytes = read_regular(&path, MAX_FILE_BYTES).map_err(|error| refused(error.to_string()))?;
            let bytes = bytes.ok_or_else(|| refused("it is larger than 64 MiB".to_owned()))?;
            let text = String::from_utf8(bytes).map_err(|_| refused("it is not UTF-8 text".to_owned()))?;
            let records = Arc::new(parse(&text).map_err(|(line, problem)| {
                let message = format!("{} is not a table of recorded vehicles: line {line}: {problem}", quoted(&title));
                let help = format!(
                    "the first line is `{ID_COLUMN},{}`, then there is a row for each moment",
                    COLUMNS.join(",")
                );
                Fault::at(&line_without_text(&title, line, RANK), "this line", message).help(help)
            })?);
            tables.insert(path.clone(), Arc::clone(&records));
            records
        }
    };
    let found = match id {
        Some(id) => records.get(id),
        None if records.len() == 1 => records.values().next(),
        None => None,
    };
    found.cloned().ok_or_else(|| {
        let names: Vec<&str> = records.keys().map(String::as_str).take(MAX_NAMES).collect();
        let key = format!("vehicle.{index}.driver.{}", if id.is_some() { "id" } else { "file" });
        let message = match id {
            Some(id) => format!("{} has no vehicle {}", quoted(&title), quoted(id)),
            None => format!("{} has {} vehicles, and nothing says which", quoted(&title), records.len()),
        };
        Fault::at(tree.place_of(&key), "which vehicle?", message).help(format!("`id` is one of {}", listed(&names)))
    })
}

/// The records of a table; or the line, from 1, and its problem.
pub(crate) fn parse(text: &str) -> Result<Records, (usize, String)> {
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    let mut lines = lines.map(|(index, line)| (index + 1, line.trim())).filter(|(_, row)| !row.is_empty());
    let header: Vec<&str> = lines.next().map_or("", |(_, header)| header).split(',').map(str::trim).collect();
    let column = |name: &str| header.iter().position(|stated| *stated == name);
    let mut places = [0; 5];
    for (place, name) in places.iter_mut().zip(COLUMNS) {
        *place = column(name).ok_or_else(|| (1, format!("it has no column `{name}`")))?;
    }
    let id = column(ID_COLUMN);
    let mut records = Records::new();
    for (line, row) in lines {
        let cells: Vec<&str> = row.split(',').map(str::trim).collect();
        if cells.len() != header.len() {
            return Err((line, format!("it has {} cells, and the header {}", cells.len(), header.len())));
        }
        let mut numbers = [0.0; 5];
        for ((number, place), name) in numbers.iter_mut().zip(places).zip(COLUMNS) {
            let value: Option<f64> = cells[place].parse().ok();
            *number = value.filter(|value| value.abs() <= MAX_NUMBER).ok_or_else(|| {
                (line, format!("`{name}` is {}, which is not a number up to {MAX_NUMBER:.0}", shown_cell(cells[place])))
            })?;
        }
        let rows = records.entry(id.map_or_else(String::new, |id| cells[id].to_owned())).or_default();
        if rows.last().is_some_and(|before: &[f64; 5]| numbers[0] <= before[0]) {
            return Err((line, format!("the time {} s is not after the row before it", numbers[0])));
        }
        rows.push(numbers);
    }
    if records.is_empty() { Err((1, "there are no rows below the header".to_owned())) } else { Ok(records) }
}

#[cfg(test)]
mod tests {
    use super::parse;

    const HEADER: &str = "id,time_s,x_m,y_m,heading_rad,speed_mps\n";

    #[test]
    fn a_table_has_rows_by_vehicle_in_any_order_of_columns() {
        let records = parse(&format!("{HEADER}a,0,1,2,0,5\nb,0,9,9,0,0\na,0.1,1.5,2,0,5\n")).expect("a table");
        assert_eq!(records["a"], [[0.0, 1.0, 2.0, 0.0, 5.0], [0.1, 1.5, 2.0, 0.0, 5.0]]);
        assert_eq!(records["b"].len(), 1);
        let alone = parse("speed_mps,time_s,x_m,y_m,heading_rad,lane\r\n3,0,1,2,0.5,main\r\n").expect("a table");
        assert_eq!(alone[""], [[0.0, 1.0, 2.0, 0.5, 3.0]]);
    }

    #[test]
    fn the_line_at_fault_is_named() {
        let cases = [
            (String::new(), 1, "no column `time_s`"),
            (HEADER.to_owned(), 1, "no rows"),
            (format!("{HEADER}a,0,1,2,0\n"), 2, "5 cells"),
            (format!("{HEADER}a,0,1,2,0,5\n\na,0,1,2,0,5\n"), 4, "not after"),
            (format!("{HEADER}a,0,1,NaN,0,5\n"), 2, "`y_m` is `NaN`"),
            (format!("{HEADER}a,0,1,2,0,inf\n"), 2, "`inf`"),
        ];
        for (text, line, word) in cases {
            let (found, problem) = parse(&text).expect_err(&text);
            assert!(found == line && problem.contains(word), "{text:?}: line {found}: {problem}");
        }
    }
}
