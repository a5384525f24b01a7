//! Recorded traffic as plain values: lanes with their bounds, and vehicles with their positions at each time step.
//!
//! It is not a scenario, because it has no drivers. It is the input for comparing driver models with people, and for
//! fitting models to people.

use std::path::Path;

use crate::format::read::regular_file::read_regular;
use crate::format::read::text_line::line_of;
use crate::resolve::records;
use crate::text::error::{Fault, LoadError, quoted};

/// A vehicle, with where it was.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordedTraffic {
    /// Its name among benchmarks, or that of its file.
    pub name: String,
    /// Length of a step of time \[s\].
    pub step_s: f64,
    /// The lanes; none where a record has no map.
    pub lanes: Vec<RecordedLane>,
    /// The vehicles, in the order of the file.
    pub vehicles: Vec<RecordedVehicle>,
}

/// A lane between two bounds. Other lanes are named by their index in [`RecordedTraffic::lanes`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordedLane {
    /// Its name in the record.
    pub id: String,
    /// The points of its left bound, in the direction of driving \[m\].
    pub left: Vec<[f64; 2]>,
    /// The points of its right bound \[m\].
    pub right: Vec<[f64; 2]>,
    /// The lanes that begin where it ends.
    pub successors: Vec<usize>,
    /// The lanes that end where it begins.
    pub predecessors: Vec<usize>,
    /// The highest speed that is permitted on it, where that is stated \[m/s\].
    pub speed_limit_mps: Option<f64>,
}

impl RecordedLane {
    /// Whether a position is between the bounds of the lane \[m\].
    pub fn contains(&self, place: [f64; 2]) -> bool {
        is_inside(self.left.iter().chain(self.right.iter().rev()).copied(), place)
    }
}

/// Whether a ray from a place crosses an outline an odd number of times.
pub(crate) fn is_inside(corners: impl Iterator<Item = [f64; 2]> + Clone, [x, y]: [f64; 2]) -> bool {
    let next = corners.clone().cycle().skip(1);
    let crosses = |[from, to]: [[f64; 2]; 2]| {
        (from[1] > y) != (to[1] > y) && x < from[0] + (y - from[1]) / (to[1] - from[1]) * (to[0] - from[0])
    };
    corners.zip(next).filter(|(from, to)| crosses([*from, *to])).count() % 2 == 1
}

/// A recorded vehicle with its states.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordedVehicle {
    /// Its name in the record.
    pub id: String,
    /// What sort of vehicle it is, in a word of CommonRoad: `car`, `truck`, `bus`, and so on.
    pub kind: String,
    /// Length of its body \[m\].
    pub length_m: f64,
    /// Width of its body \[m\].
    pub width_m: f64,
    /// Where the middle of its body was, in the order of time.
    pub moments: Vec<RecordedMoment>,
}

/// The state of a vehicle at one time step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RecordedMoment {
    /// Number of the step of time.
    pub step: i64,
    /// Position of the middle of the body in world coordinates \[m\].
    pub position: [f64; 2],
    /// Direction of the body \[rad\].
    pub heading_rad: f64,
    /// Speed along that direction, as the record states it \[m/s\].
    pub speed_mps: f64,
}

/// The largest table that is read \[bytes\].
const MAX_FILE_BYTES: u64 = 1 << 28;
/// Size of the bodies of a table, which states none: a compact car's \[m\].
const BODY_M: [f64; 2] = [4.5, 1.8];
/// Times that differ from whole steps by more than this share of a step are between two steps.
const STEP_TOLERANCE: f64 = 0.05;
/// Shortest and longest step of time \[s\].
const STEPS_S: [f64; 2] = [0.01, 2.0];

/// Reads recorded traffic from a table with the columns `id`, `time_s`, `x_m`, `y_m`, `heading_rad` and `speed_mps`.
///
/// # Errors
/// If the file cannot be read or is not such a table, with the line.
pub fn recorded_traffic_in_table(path: &Path) -> Result<RecordedTraffic, LoadError> {
    let name = path.display().to_string();
    let refused = |message: String| LoadError::new(name.clone(), vec![Fault::new(message)]);
    let bytes = read_regular(path, MAX_FILE_BYTES)
        .map_err(|error| refused(format!("cannot read {}: {error}", quoted(&name))))?
        .ok_or_else(|| refused(format!("{} is larger than 256 MiB", quoted(&name))))?;
    let text = String::from_utf8(bytes).map_err(|_| refused(format!("{} is not UTF-8 text", quoted(&name))))?;
    recorded_traffic_in_text(&name, &text)
}

/// Reads recorded traffic from the text of such a table; `name` is what errors call it.
///
/// # Errors
/// As [`recorded_traffic_in_table`].
pub fn recorded_traffic_in_text(name: &str, text: &str) -> Result<RecordedTraffic, LoadError> {
    let refused = |(line, problem): (usize, String)| {
        let message = format!("{} is not a table of recorded vehicles: line {line}: {problem}", quoted(name));
        let help = format!(
            "the first line is `{},{}`, then there is a row for each moment",
            records::ID_COLUMN,
            records::COLUMNS.join(",")
        );
        LoadError::new(name, vec![Fault::at(&line_of(name, text, line, 1), "this line", message).help(help)])
    };
    let rows = records::parse(text).map_err(refused)?;
    let spacings_s = rows.values().flat_map(|rows| rows.windows(2).map(|pair| pair[1][0] - pair[0][0]));
    let shortest_s = spacings_s.fold(f64::INFINITY, f64::min);
    if !(STEPS_S[0]..=STEPS_S[1]).contains(&shortest_s) {
        let problem = format!("rows of a vehicle must be from {} to {} s apart", STEPS_S[0], STEPS_S[1]);
        return Err(refused((1, problem)));
    }
    let vehicle = |(id, rows): (String, Vec<[f64; 5]>)| {
        let moments = rows.into_iter().filter_map(|[time_s, x_m, y_m, heading_rad, speed_mps]| {
            let step = (time_s / shortest_s).round();
            let is_on_step = (time_s / shortest_s - step).abs() <= STEP_TOLERANCE;
            let moment = RecordedMoment { step: step as i64, position: [x_m, y_m], heading_rad, speed_mps };
            is_on_step.then_some(moment)
        });
        let moments = moments.collect();
        RecordedVehicle { id, kind: "car".to_owned(), length_m: BODY_M[0], width_m: BODY_M[1], moments }
    };
    let vehicles = rows.into_iter().map(vehicle).collect();
    Ok(RecordedTraffic { name: name.to_owned(), step_s: shortest_s, lanes: Vec::new(), vehicles })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lane_contains_the_points_between_its_bounds() {
        let (left, right) = (vec![[0.0, 4.0], [20.0, 4.0]], vec![[0.0, 0.0], [7.0, 0.0], [20.0, 0.0]]);
        let lane = RecordedLane { left, right, ..RecordedLane::default() };
        assert!(lane.contains([5.0, 1.0]) && !lane.contains([5.0, 4.5]));
    }

    #[test]
    fn a_table_of_records_becomes_vehicles_at_time_steps() {
        let text =
            "id,time_s,x_m,y_m,heading_rad,speed_mps\na,0.0,0,0,0,5\na,0.2,1,0,0,5\nb,0.4,9,1,0,3\nb,0.6,9.6,1,0,3\n";
        let traffic = recorded_traffic_in_text("t.csv", text).expect("a table");
        let steps: Vec<i64> = traffic.vehicles.iter().flat_map(|it| it.moments.iter().map(|at| at.step)).collect();
        assert_eq!((traffic.vehicles.len(), steps), (2, vec![0, 1, 2, 3]));
    }

    #[test]
    fn an_error_in_a_table_of_records_names_its_line() {
        let text = "id,time_s,x_m,y_m,heading_rad,speed_mps\na,0.0,0,0,0,5\na,0.2,no,0,0,5\n";
        let error = recorded_traffic_in_text("t.csv", text).expect_err("no number");
        assert_eq!(error.faults()[0].line_and_column().map(|(line, _)| line), Some(3));
        assert!(recorded_traffic_in_text("t.csv", "id,time_s,x_m,y_m,heading_rad,speed_mps\na,0,0,0,0,5\n").is_err());
    }
}
