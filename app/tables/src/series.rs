//! Series of a building as a table, CSV or Parquet: one row for each step.
//!
//! The columns of the whole building come first, then those of each zone, such as `office.temperature_c`. Temperatures of zones and walls
//! are those at the start of a step; all other values hold during it. A scenario reads such a table as weather (`rows = "mean-from"`), and
//! `interplay identify` as telemetry.

use interplay_scenarios::Scenario;
use interplay_simulation::frame::{BuildingFrame, Frame, ZoneFrame};
use interplay_simulation::watch::{WatchError, Watcher};

use crate::cell::{Cell, ColumnKind, TableError};
use crate::row_file::{RowFile, TableFile};

/// The columns of the building as a whole.
const BUILDING_COLUMNS: [(&str, ColumnKind); 8] = [
    ("time_s", ColumnKind::Number),
    ("day", ColumnKind::Count),
    ("step", ColumnKind::Count),
    ("outdoor_c", ColumnKind::Number),
    ("forecast_outdoor_c", ColumnKind::Number),
    ("sun_w_per_m2", ColumnKind::Number),
    ("price_per_kwh", ColumnKind::Number),
    ("electric_kw", ColumnKind::Number),
];

type ZoneColumn = (&'static str, fn(&ZoneFrame) -> Option<f64>);

/// The columns of each zone, after its name and a point.
const ZONE_COLUMNS: [ZoneColumn; 8] = [
    ("temperature_c", |zone| Some(zone.temperature_c)),
    ("wanted_c", |zone| zone.reference_c),
    ("band_k", |zone| zone.band_k),
    ("requested_kw", |zone| Some(zone.requested_kw)),
    ("heat_kw", |zone| Some(zone.heat_kw)),
    ("gains_kw", |zone| Some(zone.gains_kw)),
    ("sun_kw", |zone| Some(zone.sun_kw)),
    ("electric_kw", |zone| Some(zone.electric_kw)),
];

/// Writes a row for every step of a building. The file appears when the run is over; an aborted run leaves nothing behind.
pub struct SeriesWriter {
    rows: RowFile,
    step_s: f64,
    steps_per_day: usize,
}

impl SeriesWriter {
    /// Begins a table of the building of a scenario.
    ///
    /// # Errors
    /// If the scenario has no building, or the file cannot be written.
    pub fn begin(target: &TableFile, scenario: &Scenario) -> Result<SeriesWriter, TableError> {
        let network = scenario.building.as_ref().and_then(|building| Some((building, building.network().ok()?)));
        let Some((building, network)) = network else {
            return Err(TableError::Input("the scenario has no building whose series could be written".to_owned()));
        };
        let (zones, walls) = network.names().split_at(network.zone_count());
        let mut columns: Vec<(String, ColumnKind)> =
            BUILDING_COLUMNS.iter().map(|(name, kind)| ((*name).to_owned(), *kind)).collect();
        let of_zone = |zone: &String| ZONE_COLUMNS.map(|(column, _)| (format!("{zone}.{column}"), ColumnKind::Number));
        columns.extend(zones.iter().flat_map(of_zone));
        columns.extend(walls.iter().map(|wall| (format!("{wall}.temperature_c"), ColumnKind::Number)));
        let columns: Vec<(&str, ColumnKind)> = columns.iter().map(|(name, kind)| (name.as_str(), *kind)).collect();
        let rows = RowFile::begin(target, &columns)?;
        Ok(SeriesWriter { rows, step_s: building.step_s, steps_per_day: building.steps_per_day() })
    }

    fn cells(&self, frame: &BuildingFrame) -> Vec<Cell> {
        let number = |value: f64| Cell::Number(value.is_finite().then_some(value));
        let step = frame.day * self.steps_per_day + frame.step;
        let mut cells = vec![
            number(step as f64 * self.step_s),
            Cell::Count(Some(frame.day as u64)),
            Cell::Count(Some(frame.step as u64)),
            number(frame.ambient_c),
            number(frame.forecast_c),
            number(frame.sun_w_per_m2),
            Cell::Number(frame.price_per_kwh),
            number(frame.zones.iter().map(|zone| zone.electric_kw).sum()),
        ];
        let of_zone = |zone: &ZoneFrame| ZONE_COLUMNS.map(|(_, value)| value(zone).map_or(Cell::Number(None), number));
        cells.extend(frame.zones.iter().flat_map(of_zone));
        cells.extend(frame.walls_c.iter().map(|wall_c| number(*wall_c)));
        cells
    }
}

impl Watcher for SeriesWriter {
    fn tick(&mut self, frame: &Frame) -> Result<(), WatchError> {
        let Some(building) = &frame.building else { return Ok(()) };
        let cells = self.cells(building);
        self.rows.push(cells)
    }

    fn finish(self: Box<Self>) -> Result<(), WatchError> {
        self.rows.finish()
    }
}

#[cfg(test)]
mod tests {
    use std::path::{Path, PathBuf};

    use interplay_scenarios::from_text;
    use interplay_simulation::run::run;

    use super::*;
    use crate::table::{TableColumn, TableReader};

    const BUILDING: &str = "title = 'house'\nshows = 'series'\niterations = 2\n\
        calendar = { first_day = '2026-07-06' }\ntariff = { prices_per_kwh = [0.2, 0.4] }\n\
        [building]\nstep_s = 1800.0\n[[building.zone]]\nname = 'a, b'\nlimit_kw = 1.0\n\
        [[building.zone.window]]\narea_m2 = 2.0\nfacing_deg = 180.0\n\
        [[building.wall]]\nbetween = ['a, b', 'ambient']\nresistance_k_per_kw = 30.0\ncapacity_kj_per_k = 900.0\n";
    const WALL: &str = "wall 1 (`a, b` - `ambient`).temperature_c";

    /// The tables of a run, CSV and Parquet.
    fn written(folder: &Path, name: &str, text: &str) -> [PathBuf; 2] {
        let scenario = from_text(&folder.join("house.toml").to_string_lossy(), text, &[]).expect("a scenario");
        let paths = ["csv", "parquet"].map(|ending| folder.join(format!("{name}.{ending}")));
        let watchers = paths.iter().map(|path| {
            let target: TableFile = path.to_string_lossy().parse().expect("an ending of a table");
            Box::new(SeriesWriter::begin(&target, &scenario).expect("writable")) as Box<dyn Watcher>
        });
        run("house", &scenario, watchers.collect()).expect("a run");
        paths
    }

    fn numbers(parquet: &Path, title: &str) -> Vec<Option<f64>> {
        let reader = TableReader::open(parquet).expect("a table");
        let table = reader.group(0, &[title.to_owned()]).expect("readable");
        let [(_, TableColumn::Numbers(values))] = table.columns.as_slice() else { panic!("no numbers: {title}") };
        values.clone()
    }

    #[test]
    fn the_table_of_a_run_reads_back_as_weather() {
        let folder = tempfile::tempdir().expect("a folder");
        let [csv, first] = written(folder.path(), "first", BUILDING);
        let text = std::fs::read_to_string(csv).expect("written");
        let head: Vec<&str> = text.lines().take(2).collect();
        assert!(
            head[0].starts_with("time_s,day,step,outdoor_c,") && head[0].contains(",\"a, b.heat_kw\","),
            "{}",
            head[0]
        );
        assert!(head[1].starts_with("0,0,0,") && text.lines().count() == 97, "{}", head[1]);
        assert_eq!(numbers(&first, "price_per_kwh")[..5], [0.2, 0.2, 0.4, 0.4, 0.2].map(Some));
        assert_eq!((numbers(&first, "a, b.temperature_c")[0], numbers(&first, WALL)[0]), (Some(28.0), Some(28.0)));
        assert!(numbers(&first, "a, b.sun_kw").iter().flatten().any(|kw| *kw > 0.05), "the window lets the sun in");
        // Under the recorded weather of the first run, the outdoor temperatures are bit-identical.
        let again = format!(
            "{BUILDING}[weather]\nkind = 'csv'\nfile = 'first.csv'\nrows = 'mean-from'\n\
             latitude_deg = 0.0\nlongitude_deg = 103.5\ntime_zone_h = 8.0\n"
        );
        let [_, second] = written(folder.path(), "second", &again);
        for title in ["outdoor_c", "sun_w_per_m2"] {
            assert_eq!(numbers(&second, title), numbers(&first, title), "{title}");
        }
    }
}
