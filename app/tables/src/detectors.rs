//! Counts of detectors as a table: one row for each detector, lane and interval, and one for all lanes together.

use interplay_scenarios::{DetectorConfig, DetectorLine, LaneReference, Scenario};
use interplay_simulation::frame::Frame;
use interplay_simulation::watch::{WatchError, Watcher};

use crate::cell::{Cell, ColumnKind, TableError};
use crate::row_file::{RowFile, TableFile};

/// The columns. Speeds are averaged over vehicles (`mean_speed_mps`) and harmonically (`space_mean_speed_mps`): the latter is the
/// mean speed of the vehicles on the road, and flow divided by it is their density (Wardrop, 1952).
const COLUMNS: [(&str, ColumnKind); 11] = [
    ("detector", ColumnKind::Text),
    ("lane", ColumnKind::Text),
    ("from_s", ColumnKind::Number),
    ("to_s", ColumnKind::Number),
    ("vehicles", ColumnKind::Count),
    ("flow_per_h", ColumnKind::Number),
    ("mean_speed_mps", ColumnKind::Number),
    ("space_mean_speed_mps", ColumnKind::Number),
    ("density_per_km", ColumnKind::Number),
    ("travel_time_s", ColumnKind::Number),
    ("waiting_outside", ColumnKind::Count),
];

/// The name of all lanes together.
const ALL: &str = "all";
/// Tolerance with which the end of an interval counts as reached \[s\].
const EDGE_TOLERANCE_S: f64 = 1e-9;
/// Minimum speed of a vehicle in a harmonic mean \[m/s\].
const SLOWEST_MPS: f64 = 0.01;

/// Counts the vehicles that pass the detectors of a scenario, and writes a row for every lane and interval.
pub struct DetectorWriter {
    rows: RowFile,
    /// Position \[m\] and speed \[m/s\] of each vehicle at the last tick; none if it was not on the road.
    before: Vec<Option<([f64; 2], f64)>>,
    time_s: f64,
    step_s: f64,
    detectors: Vec<Counting>,
    /// Scheduled entry time of each vehicle that has not entered yet \[s\].
    awaited_s: Vec<Option<f64>>,
}

struct Counting {
    stated: DetectorConfig,
    lanes: Vec<(String, DetectorLine)>,
    after: Option<usize>,
    /// Number of completed intervals.
    over: u32,
    passings: Vec<Passing>,
    /// Time at which each vehicle last passed \[s\].
    passed_s: Vec<Option<f64>>,
}

#[derive(Clone, Copy, Debug)]
struct Passing {
    time_s: f64,
    lane: usize,
    speed_mps: f64,
    travel_time_s: Option<f64>,
}

impl DetectorWriter {
    /// Begins a table of the detector counts of a scenario.
    ///
    /// # Errors
    /// If the scenario has no detectors, or the file cannot be written.
    pub fn begin(target: &TableFile, scenario: &Scenario) -> Result<DetectorWriter, TableError> {
        if scenario.detectors.is_empty() {
            return Err(TableError::Input(
                "the scenario has no `[[detector]]`, so there is nothing to write".to_owned(),
            ));
        }
        let counting = |detector: &DetectorConfig| {
            let line = |lane: &LaneReference| Some((name_of(lane), scenario.detector_line(lane, detector.along_m)?));
            let is_after = |other: &DetectorConfig| detector.after.as_ref() == Some(&other.name);
            Counting {
                stated: detector.clone(),
                lanes: detector.lanes.iter().filter_map(line).collect(),
                after: scenario.detectors.iter().position(is_after),
                over: 0,
                passings: Vec::new(),
                passed_s: vec![None; scenario.vehicles.len()],
            }
        };
        Ok(DetectorWriter {
            rows: RowFile::begin(target, &COLUMNS)?,
            before: Vec::new(),
            time_s: 0.0,
            step_s: scenario.step_s,
            detectors: scenario.detectors.iter().map(counting).collect(),
            awaited_s: scenario.vehicles.iter().map(|vehicle| vehicle.stay.enters_s).collect(),
        })
    }

    /// Number of vehicles that wait outside for room.
    fn outside(&self, time_s: f64) -> u64 {
        self.awaited_s.iter().flatten().filter(|awaited_s| **awaited_s < time_s).count() as u64
    }

    fn count(&mut self, frame: &Frame) {
        for (vehicle, (now, before)) in frame.vehicles.iter().zip(&self.before).enumerate() {
            let Some((from_m, before_mps)) = before.filter(|_| !now.is_absent) else { continue };
            for detector in 0..self.detectors.len() {
                let found = self.detectors[detector]
                    .lanes
                    .iter()
                    .enumerate()
                    .find_map(|(lane, (_, line))| Some((lane, line.passed_at(from_m, now.state.position())?)));
                let Some((lane, share)) = found else { continue };
                let time_s = self.time_s + share * (frame.time_s - self.time_s);
                let speed_mps = before_mps + share * (now.state.speed_mps - before_mps);
                let after = self.detectors[detector].after;
                let began_s = after.and_then(|after| self.detectors[after].passed_s[vehicle]);
                let counting = &mut self.detectors[detector];
                counting.passed_s[vehicle] = Some(time_s);
                let travel_time_s = began_s.map(|began_s| time_s - began_s);
                counting.passings.push(Passing { time_s, lane, speed_mps, travel_time_s });
            }
        }
    }
}

impl Watcher for DetectorWriter {
    fn tick(&mut self, frame: &Frame) -> Result<(), WatchError> {
        if frame.vehicles.is_empty() {
            return Ok(());
        }
        for (awaited_s, vehicle) in self.awaited_s.iter_mut().zip(&frame.vehicles) {
            *awaited_s = awaited_s.filter(|_| vehicle.is_absent);
        }
        self.count(frame);
        let outside = self.outside(frame.time_s);
        for counting in &mut self.detectors {
            while frame.time_s >= counting.edge_s() - EDGE_TOLERANCE_S {
                counting.write(counting.edge_s(), outside, &mut self.rows)?;
            }
        }
        self.time_s = frame.time_s;
        self.before = frame
            .vehicles
            .iter()
            .map(|vehicle| (!vehicle.is_absent).then(|| (vehicle.state.position(), vehicle.state.speed_mps)))
            .collect();
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> Result<(), WatchError> {
        let outside = self.outside(self.time_s);
        // The last frame is of the beginning of the last step.
        let end_s = self.time_s + self.step_s;
        for counting in &mut self.detectors {
            if self.time_s > counting.began_s() + EDGE_TOLERANCE_S {
                let edge_s = counting.edge_s();
                let to_s = if end_s > edge_s - EDGE_TOLERANCE_S { edge_s } else { end_s };
                counting.write(to_s, outside, &mut self.rows)?;
            }
        }
        self.rows.finish()
    }
}

impl Counting {
    /// Start of the interval \[s\].
    fn began_s(&self) -> f64 {
        f64::from(self.over) * self.stated.interval_s
    }

    /// End of the interval \[s\].
    fn edge_s(&self) -> f64 {
        f64::from(self.over + 1) * self.stated.interval_s
    }

    /// Writes the rows of the interval that ends, and begins the next.
    fn write(&mut self, to_s: f64, outside: u64, rows: &mut RowFile) -> Result<(), WatchError> {
        let passings: Vec<Passing> =
            self.passings.extract_if(.., |passing| passing.time_s < to_s + EDGE_TOLERANCE_S).collect();
        for (index, (name, _)) in self.lanes.iter().enumerate() {
            let here: Vec<Passing> = passings.iter().filter(|passing| passing.lane == index).copied().collect();
            rows.push(self.row(name, to_s, outside, &here))?;
        }
        if self.lanes.len() > 1 {
            rows.push(self.row(ALL, to_s, outside, &passings))?;
        }
        self.over += 1;
        Ok(())
    }

    fn row(&self, lane: &str, to_s: f64, outside: u64, passings: &[Passing]) -> [Cell; COLUMNS.len()] {
        let count = passings.len() as f64;
        let mean = |sum: f64| (count > 0.0).then(|| sum / count);
        let mean_mps = mean(passings.iter().map(|passing| passing.speed_mps).sum());
        let slowness_spm = mean(passings.iter().map(|passing| 1.0 / passing.speed_mps.max(SLOWEST_MPS)).sum());
        let flow_per_h = 3600.0 * count / (to_s - self.began_s());
        let times_s: Vec<f64> = passings.iter().filter_map(|passing| passing.travel_time_s).collect();
        let travel_time_s = (!times_s.is_empty()).then(|| times_s.iter().sum::<f64>() / times_s.len() as f64);
        [
            Cell::Text(Some(self.stated.name.clone())),
            Cell::Text(Some(lane.to_owned())),
            Cell::Number(Some(self.began_s())),
            Cell::Number(Some(to_s)),
            Cell::Count(Some(passings.len() as u64)),
            Cell::Number(Some(flow_per_h)),
            Cell::Number(mean_mps),
            Cell::Number(slowness_spm.map(|spm| 1.0 / spm)),
            Cell::Number(Some(slowness_spm.map_or(0.0, |spm| flow_per_h * spm / 3.6))),
            Cell::Number(travel_time_s),
            Cell::Count(Some(outside)),
        ]
    }
}

fn name_of(lane: &LaneReference) -> String {
    match lane {
        LaneReference::Number(number) => number.to_string(),
        LaneReference::Name(name) => name.clone(),
    }
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::from_text;
    use interplay_simulation::run::run;

    use super::*;

    /// Cars at 20 m/s with headways of 2 s: 1800 an hour, 25 a kilometre, 5 s for 100 m.
    #[test]
    fn uniform_traffic_gives_its_exact_flow_and_density() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("counts.csv");
        let text = "title = 'even'\nshows = 'even traffic'\nscale = 'full'\nduration_s = 64.0\nstep_s = 0.1\n\
            road = { kind = 'lanes', lane_count = 2, lane_width_m = 3.5 }\ndefaults = { driver = { kind = 'idm' } }\n\
            [[vehicle]]\nname = 'ego'\nstart = { lane = 1, along_m = 900.0, speed_mps = 20.0 }\n\
            [[flow]]\nname = 'west'\nvehicles_per_h = 1800\nheadways = 'even'\nfrom = [0]\nspeed_mps = 20.0\n\
            [[detector]]\nname = 'a'\nlanes = [0, 1]\nalong_m = 20.0\ninterval_s = 20.0\n\
            [[detector]]\nname = 'b'\nlanes = [0]\nalong_m = 120.0\ninterval_s = 40.0\nafter = 'a'\n\
            [[detector]]\nname = 'c'\nlanes = [0]\nalong_m = 20.0\ninterval_s = 0.7\n";
        let scenario = from_text("even.toml", text, &[]).expect("a scenario");
        let target: TableFile = path.to_string_lossy().parse().expect("an ending of a table");
        let writer = DetectorWriter::begin(&target, &scenario).expect("writable");
        run("even", &scenario, vec![Box::new(writer)]).expect("a run");
        let text = std::fs::read_to_string(path).expect("written");
        let rows: Vec<Vec<&str>> = text.lines().skip(1).map(|line| line.split(',').collect()).collect();
        let row = |detector: &str, lane: &str, from_s: &str| {
            let found = rows.iter().find(|row| row[..3] == [detector, lane, from_s]).expect("a row");
            found[4..].iter().map(|cell| cell.parse::<f64>().unwrap_or(f64::NAN)).collect::<Vec<f64>>()
        };
        let near = |found: f64, wanted: f64, by: f64| assert!((found - wanted).abs() <= by, "{found} {wanted}");
        let a = row("a", "0", "20");
        near(a[0], 10.0, 1.0);
        near(a[2], 20.0, 1.5);
        near(a[4], a[1] / 3.6 / a[3], 1e-6);
        assert_eq!(row("a", "1", "20")[0], 0.0, "the other lane is empty");
        assert_eq!(row("a", "all", "20")[0], a[0]);
        near(row("b", "0", "0")[5], 5.0, 0.4);
        // At one detector the total does not depend on the intervals.
        let all = |detector: &str| -> f64 {
            let of_lane = rows.iter().filter(|row| row[..2] == [detector, "0"]);
            of_lane.map(|row| row[4].parse::<f64>().unwrap_or(f64::NAN)).sum()
        };
        assert_eq!(all("a"), all("c"));
    }
}
