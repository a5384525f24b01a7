//! Trajectories of all vehicles on the road as a table, CSV or Parquet: one row for each vehicle and tick.
//!
//! Rows are written while the run advances, and the file appears when the run is over.

use std::collections::BTreeMap;

use interplay_simulation::frame::{Frame, Origin, VehicleFrame};
use interplay_simulation::watch::{WatchError, Watcher};

use crate::cell::{Cell, ColumnKind, TableError};
use crate::row_file::{RowFile, TableFile};

/// The columns of a table of trajectories.
const COLUMNS: [(&str, ColumnKind); 12] = [
    ("tick", ColumnKind::Count),
    ("time_s", ColumnKind::Number),
    ("vehicle", ColumnKind::Text),
    ("x_m", ColumnKind::Number),
    ("y_m", ColumnKind::Number),
    ("heading_rad", ColumnKind::Number),
    ("speed_mps", ColumnKind::Number),
    ("acceleration_mps2", ColumnKind::Number),
    ("steering_rad", ColumnKind::Number),
    ("plan_cost", ColumnKind::Number),
    ("plan", ColumnKind::Text),
    ("partner", ColumnKind::Text),
];

/// Writes a row for every vehicle on the road at every tick. The file appears when the run is over; an aborted run leaves nothing behind.
pub struct TrajectoryWriter {
    rows: RowFile,
    /// The partner of each vehicle's planner, by name.
    partners: BTreeMap<String, String>,
}

impl TrajectoryWriter {
    /// Begins a table.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn begin(target: &TableFile) -> Result<TrajectoryWriter, TableError> {
        Ok(TrajectoryWriter { rows: RowFile::begin(target, &COLUMNS)?, partners: BTreeMap::new() })
    }
}

impl Watcher for TrajectoryWriter {
    fn tick(&mut self, frame: &Frame) -> Result<(), WatchError> {
        for vehicle in frame.vehicles.iter().filter(|vehicle| !vehicle.is_absent) {
            if let Some(partner) = vehicle.new_partner() {
                match partner {
                    Some(partner) => self.partners.insert(vehicle.name.clone(), partner.to_owned()),
                    None => self.partners.remove(&vehicle.name),
                };
            }
            let cells = cells(frame, vehicle, self.partners.get(&vehicle.name));
            self.rows.push(cells)?;
        }
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), WatchError> {
        self.rows.finish()
    }
}

/// The row of a vehicle at a tick, in the order of [`COLUMNS`].
fn cells(frame: &Frame, vehicle: &VehicleFrame, partner: Option<&String>) -> [Cell; COLUMNS.len()] {
    let VehicleFrame { name, state, input, origin, .. } = vehicle;
    let number = |value: f64| Cell::Number(value.is_finite().then_some(value));
    [
        Cell::Count(Some(frame.tick as u64)),
        number(frame.time_s),
        Cell::Text(Some(name.clone())),
        number(state.x_m),
        number(state.y_m),
        number(state.heading_rad),
        number(state.speed_mps),
        number(input.acceleration_mps2),
        number(input.steering_rad),
        vehicle.plan_cost().map_or(Cell::Number(None), number),
        Cell::Text(Some(word(*origin).to_owned())),
        Cell::Text(partner.cloned()),
    ]
}

/// The name of a plan's origin.
fn word(origin: Origin) -> &'static str {
    match origin {
        Origin::Planned => "planned",
        Origin::Continued => "continued",
        Origin::Braking => "braking",
        Origin::Evading => "evading",
        Origin::Crashed => "crashed",
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;
    use crate::table::{TableColumn, TableReader};

    fn frame(tick: usize, name: &str) -> Frame {
        let vehicle = VehicleFrame { name: name.to_owned(), ..VehicleFrame::default() };
        Frame { tick, time_s: 0.1 * tick as f64, vehicles: vec![vehicle], ..Frame::default() }
    }

    fn written(file: &str, frames: &[Frame], finishes: bool) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("new").join(file);
        let target: TableFile = path.to_string_lossy().parse().expect("an ending of a table");
        let mut writer = Box::new(TrajectoryWriter::begin(&target).expect("writable"));
        frames.iter().for_each(|frame| writer.tick(frame).expect("written"));
        if finishes {
            writer.finish().expect("written");
        }
        (folder, path)
    }

    #[test]
    fn names_with_commas_are_quoted_and_numbers_read_back_exactly() {
        let (_folder, path) = written("a.csv", &[frame(3, "a, \"b\"")], true);
        let text = std::fs::read_to_string(path).expect("written");
        assert_eq!(text.lines().nth(1), Some("3,0.30000000000000004,\"a, \"\"b\"\"\",0,0,0,0,0,0,,planned,"));
    }

    #[test]
    fn parquet_contains_the_same_rows_as_csv() {
        let (_folder, path) = written("a.parquet", &[frame(0, "a"), frame(1, "a")], true);
        let reader = TableReader::open(&path).expect("a table");
        let table = reader.group(0, &COLUMNS.map(|(name, _)| name.to_owned())).expect("readable");
        assert_eq!(table.row_count, 2);
        let names: Vec<&str> = table.columns.iter().map(|(name, _)| &**name).collect();
        assert_eq!(names, COLUMNS.map(|(name, _)| name));
        assert_eq!(table.columns[0].1, TableColumn::Counts(vec![Some(0), Some(1)]));
    }

    #[test]
    fn an_aborted_run_leaves_no_file() {
        for file in ["a.csv", "a.parquet"] {
            let (folder, path) = written(file, &[frame(0, "a")], false);
            assert!(!path.exists() && folder.path().read_dir().expect("there").next().is_none());
        }
    }
}
