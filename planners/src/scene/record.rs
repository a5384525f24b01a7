//! A motion that was recorded: poses and speeds at times.

use std::f64::consts::TAU;

use crate::{Body, Input, Limits, Scene, State, Trajectory};

/// A recorded motion: states at increasing times, and between them what lies evenly between both.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Times with states, in order; at least one. Headings turn by at most half a turn from one to the next.
    moments: Vec<(f64, State)>,
}

/// Why rows are no record. Rows are counted from 0.
#[derive(Clone, Debug, PartialEq)]
pub enum RecordFault {
    /// There are no rows.
    Empty,
    /// A number of a row is infinite or not a number (NaN).
    NotFinite {
        /// Index of the row.
        row: usize,
    },
    /// The time of a row is not after that of the row before it.
    NotLater {
        /// Index of the row.
        row: usize,
    },
}

/// Slower backward motion is noise of the record: the vehicle stands \[m/s\].
const BACKWARDS_MPS: f64 = 0.2;

/// Times that differ by less are equal \[s\].
const TIME_TOLERANCE_S: f64 = 1e-9;

impl Record {
    /// The record with rows `[time_s, x_m, y_m, heading_rad, speed_mps]`.
    ///
    /// # Errors
    /// [`RecordFault`] for rows without order, and numbers that are not finite.
    pub fn new(rows: &[[f64; 5]]) -> Result<Record, RecordFault> {
        let mut moments: Vec<(f64, State)> = Vec::with_capacity(rows.len());
        for (row, numbers) in rows.iter().enumerate() {
            if numbers.iter().any(|number| !number.is_finite()) {
                return Err(RecordFault::NotFinite { row });
            }
            let [time_s, x_m, y_m, heading_rad, speed_mps] = *numbers;
            let before = moments.last();
            if before.is_some_and(|(before_s, _)| time_s <= before_s + TIME_TOLERANCE_S) {
                return Err(RecordFault::NotLater { row });
            }
            let speed_mps = if speed_mps > -BACKWARDS_MPS { speed_mps.max(0.0) } else { speed_mps };
            let heading_rad = before.map_or(heading_rad, |(_, state)| next_to(heading_rad, state.heading_rad));
            moments.push((time_s, State { x_m, y_m, heading_rad, speed_mps }));
        }
        if moments.is_empty() { Err(RecordFault::Empty) } else { Ok(Record { moments }) }
    }

    /// The first and the last time that it knows \[s\].
    pub fn span_s(&self) -> [f64; 2] {
        [self.moments[0].0, self.moments[self.moments.len() - 1].0]
    }

    /// The state with which it begins.
    pub fn first(&self) -> State {
        self.moments[0].1
    }

    /// The highest speed \[m/s\].
    pub fn fastest_mps(&self) -> f64 {
        self.moments.iter().map(|(_, state)| state.speed_mps).fold(0.0, f64::max)
    }

    /// The positions that it passes, in order \[m\].
    pub fn positions(&self) -> impl Iterator<Item = [f64; 2]> {
        self.moments.iter().map(|(_, state)| state.position())
    }

    /// Whether the record still says at a time where the vehicle is \[s\].
    pub fn holds_at(&self, time_s: f64) -> bool {
        self.state_at(time_s).is_some()
    }

    /// The state at a time: between two moments, position and speed lie evenly between theirs, and the heading takes the shorter
    /// turn. Before the first moment it is the first state. `None` after the last one; but a vehicle that stands then stands for
    /// ever \[s\].
    pub fn state_at(&self, time_s: f64) -> Option<State> {
        let after = self.moments.partition_point(|(at_s, _)| *at_s <= time_s + TIME_TOLERANCE_S);
        let Some((to_s, to)) = self.moments.get(after) else {
            let (last_s, last) = self.moments[self.moments.len() - 1];
            let holds = last.speed_mps == 0.0 || time_s <= last_s + TIME_TOLERANCE_S;
            return holds.then_some(last);
        };
        let Some((from_s, from)) = after.checked_sub(1).map(|before| self.moments[before]) else {
            return Some(*to);
        };
        let share = ((time_s - from_s) / (to_s - from_s)).clamp(0.0, 1.0);
        Some(from.towards(to, share))
    }
}

impl Record {
    /// The input with which a vehicle goes from a state to where the record is a step after a time, as nearly as its limits allow;
    /// `None` where the record ends before that \[s\].
    pub fn input(&self, body: &Body, limits: &Limits, state: &State, [time_s, step_s]: [f64; 2]) -> Option<Input> {
        let next = self.state_at(time_s + step_s)?;
        let acceleration_mps2 = (next.speed_mps - state.speed_mps) / step_s;
        let turn_rad = next_to(next.heading_rad, state.heading_rad) - state.heading_rad;
        let travelled_m = (0.5 * (next.speed_mps + state.speed_mps) * step_s).max(MIN_TRAVEL_M);
        let steering_rad = libm::atan(body.wheelbase_m() * turn_rad / travelled_m);
        let most_rad = limits.steering_max_rad;
        Some(Input {
            acceleration_mps2: acceleration_mps2.clamp(limits.acceleration_min_mps2, limits.acceleration_max_mps2),
            steering_rad: steering_rad.clamp(-most_rad, most_rad),
        })
    }
}

impl Record {
    /// The motion of the planning vehicle of a scene as it is recorded, with its last speed and heading after its end.
    pub(crate) fn onwards(&self, scene: &Scene) -> Trajectory {
        let Scene { ego, step_s, .. } = scene;
        let mut state = ego.state;
        let mut motion = Trajectory { states: vec![state], inputs: Vec::with_capacity(scene.horizon) };
        for step in 0..scene.horizon {
            let times_s = [step_s * (scene.tick + step) as f64, *step_s];
            let (sin, cos) = libm::sincos(state.heading_rad);
            let further_m = step_s * state.speed_mps;
            let steady = State { x_m: state.x_m + further_m * cos, y_m: state.y_m + further_m * sin, ..state };
            motion.inputs.push(self.input(&ego.body, &ego.limits, &state, times_s).unwrap_or_default());
            state = self.state_at(times_s[0] + step_s).unwrap_or(steady);
            motion.states.push(state);
        }
        motion
    }
}

/// Who travels less in a step is taken to stand: its turn is noise of the record \[m\].
const MIN_TRAVEL_M: f64 = 0.05;

/// A heading by full turns nearer to another one \[rad\].
pub fn next_to(heading_rad: f64, other_rad: f64) -> f64 {
    heading_rad + ((other_rad - heading_rad) / TAU).round() * TAU
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turning() -> Record {
        let rows = [[0.0, 0.0, 0.0, 3.0, 2.0], [0.5, -1.0, 0.0, -3.0, 3.0], [1.0, -2.5, 0.0, -3.1, 3.0]];
        Record::new(&rows).expect("a record")
    }

    #[test]
    fn states_are_those_recorded_and_between_them_even() {
        let record = turning();
        assert_eq!(record.state_at(0.0), Some(record.first()));
        let middle = record.state_at(0.25).expect("within the record");
        assert!((middle.x_m + 0.5).abs() < 1e-12 && (middle.speed_mps - 2.5).abs() < 1e-12);
        // From 3.0 to −3.0 rad the shorter turn leads through half a turn.
        assert!((middle.heading_rad - std::f64::consts::PI).abs() < 1e-9);
        assert_eq!(record.state_at(-1.0), Some(record.first()));
        assert_eq!(record.state_at(1.1), None, "it was moving when the record ended");
        assert!(record.holds_at(1.0));
    }

    #[test]
    fn a_record_that_ends_at_rest_stays_at_rest() {
        let parked = Record::new(&[[0.0, 1.0, 2.0, 0.5, 0.0]]).expect("a record");
        assert_eq!(parked.state_at(1e6), Some(parked.first()));
    }

    #[test]
    fn rows_without_order_are_no_record() {
        let row = |time_s: f64| [time_s, 0.0, 0.0, 0.0, 1.0];
        assert_eq!(Record::new(&[]), Err(RecordFault::Empty));
        assert_eq!(Record::new(&[row(0.0), row(0.0)]), Err(RecordFault::NotLater { row: 1 }));
        assert_eq!(Record::new(&[row(0.0), row(f64::NAN)]), Err(RecordFault::NotFinite { row: 1 }));
    }
}
