//! Recorded traffic as plain values: lanes with their bounds, and vehicles with their positions at each time step.
//!
//! It is not a scenario, because it has no drivers. It is the input for comparing driver models with people, and for
//! fitting models to people.

mod table;

pub use table::{recorded_traffic_in_table, recorded_traffic_in_text};

/// Traffic that was recorded.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lane_contains_the_points_between_its_bounds() {
        let (left, right) = (vec![[0.0, 4.0], [20.0, 4.0]], vec![[0.0, 0.0], [7.0, 0.0], [20.0, 0.0]]);
        let lane = RecordedLane { left, right, ..RecordedLane::default() };
        assert!(lane.contains([5.0, 1.0]) && !lane.contains([5.0, 4.5]));
    }
}
