//! The trajectory problem that every planner poses: deciding vehicles that obey the bicycle (eq. 6.10) and boxes on input and
//! speed (eq. 6.9), and a list of [`Term`]s: costs (eq. 6.6) and soft constraints (eq. 6.7, 6.8 and others).
//!
//! Only boxes are hard. They are linear in the inputs (speed is linear in acceleration), so any mixture of two
//! admissible input sequences is admissible. Everything else is a soft row `c(x) + s ≥ 0, s ≥ 0` with the cost
//! `linear·s + quadratic·s²`: with a `linear` weight above the multiplier this is exact, i.e. the row holds at the optimum
//! whenever it can (Nocedal and Wright, section 17.2). The states follow from the inputs. So the cost of an input
//! sequence is one number, and it is its own merit function.

use super::cost::Cost;
use super::iterate::Iterate;
use super::participant::Participant;
use super::terms::{MAX_ROWS_PER_STAGE, RowTerm, Shape, Subject, Term, TrajectoryTerm};
use crate::Input;
use crate::vehicle::PoseExpansion;

/// A trajectory problem: deciding vehicles, and the list of terms that make its cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Number of steps `N`.
    pub horizon: usize,
    /// The deciding vehicles, at least one.
    pub participants: Vec<Participant>,
    /// In how many first steps all participants have the same inputs. 0 for different vehicles; otherwise they are one vehicle, in
    /// as many futures, with the same start, model and bounds.
    pub shared_steps: usize,
    /// Costs and soft constraints of the vehicles, which they name by their index.
    pub terms: Vec<Term>,
}

impl Problem {
    /// Rolls the inputs of an iterate out into its states, and finds their Frenet coordinates on curved routes.
    pub fn roll_out(&self, iterate: &mut Iterate) {
        iterate.states.resize_with(self.participants.len(), Vec::new);
        iterate.frenet.resize_with(self.participants.len(), Vec::new);
        for (i, participant) in self.participants.iter().enumerate() {
            participant.roll_out(&iterate.inputs[i], &mut iterate.states[i], &mut iterate.frenet[i]);
        }
    }

    /// The admissible iterate nearest to a guess (per participant, inputs).
    pub fn start(&self, guess: &[Vec<Input>]) -> Iterate {
        let of = |i: usize| guess.get(i).map(Vec::as_slice).unwrap_or_default();
        let inputs = self.participants.iter().enumerate().map(|(i, participant)| {
            let shared = of(0).iter().take(self.shared_steps);
            let wanted: Vec<Input> = shared.chain(of(i).iter().skip(self.shared_steps)).copied().collect();
            participant.admissible(&wanted, self.horizon)
        });
        let mut iterate = Iterate::of_inputs(inputs.collect());
        self.roll_out(&mut iterate);
        iterate
    }

    /// The terms that are stage rows. Each has as many blocks in the QP subproblem as rows at a stage, in this order.
    pub(in crate::trajectory) fn row_terms(&self) -> impl Iterator<Item = &dyn RowTerm> {
        self.terms.iter().filter_map(|term| match term.shape() {
            Shape::Rows(rows) => Some(rows),
            _ => None,
        })
    }

    /// Whether deciding vehicles keep apart from each other.
    pub(super) fn has_pairs(&self) -> bool {
        self.row_terms().any(|rows| rows.subject().other.is_some())
    }

    /// The cost of a guess after it was made admissible.
    pub fn cost_of(&self, guess: &[Vec<Input>]) -> f64 {
        self.cost(&self.start(guess)).total
    }

    /// The cost of an iterate whose states were rolled out.
    pub fn cost(&self, iterate: &Iterate) -> Cost {
        let (mut cost, mut rows_at_stage) = (Cost::default(), StageRows::default());
        for vehicle in 0..self.participants.len() {
            self.add_vehicle_cost(vehicle, iterate, &mut rows_at_stage, &mut cost);
        }
        for term in &self.terms {
            match term.shape() {
                Shape::Rows(rows) if rows.subject().other.is_some() => {
                    for stage in self.first_stage(rows.subject())..self.horizon {
                        add_rows(rows, stage, iterate, &mut rows_at_stage, &mut cost);
                    }
                }
                Shape::Trajectory(row) => add_trajectory_row(row, iterate, &mut cost),
                _ => {}
            }
        }
        cost
    }

    /// The cost of one vehicle's own terms, without those that couple it to another deciding vehicle.
    pub fn own_cost(&self, vehicle: usize, iterate: &Iterate) -> f64 {
        let mut cost = Cost::default();
        self.add_vehicle_cost(vehicle, iterate, &mut StageRows::default(), &mut cost);
        for term in &self.terms {
            match term.shape() {
                Shape::Trajectory(row) if row.vehicle() == vehicle => add_trajectory_row(row, iterate, &mut cost),
                _ => {}
            }
        }
        cost.total
    }

    /// The first stage at which rows on a subject exist: before it, every input that they depend on is known.
    pub(super) fn first_stage(&self, subject: Subject) -> usize {
        let first = |vehicle: usize| self.participants[vehicle].first();
        subject.other.map_or(first(subject.vehicle), |other| first(subject.vehicle).min(first(other)))
    }

    /// What one vehicle's own terms of every stage cost.
    fn add_vehicle_cost(&self, vehicle: usize, iterate: &Iterate, rows_at_stage: &mut StageRows, cost: &mut Cost) {
        let (own, first) = (Subject { vehicle, other: None }, self.participants[vehicle].first());
        for stage in 0..self.horizon {
            if stage >= first {
                let [_, change_rad] = self.input_change(vehicle, stage, iterate);
                cost.total += TURN_WEIGHT * self.participants[vehicle].excess_turn_rad(stage, change_rad).powi(2);
            }
            for term in &self.terms {
                match term.shape() {
                    Shape::InputChange(comfort) if comfort.vehicle == vehicle && stage >= first => {
                        comfort.add_value(self.input_change(vehicle, stage, iterate), &mut cost.total);
                    }
                    Shape::StateCost(term) if term.vehicle() == vehicle => {
                        term.add_value(stage, iterate, &mut cost.total);
                    }
                    Shape::Rows(rows) if stage >= first && rows.subject() == own => {
                        add_rows(rows, stage, iterate, rows_at_stage, cost);
                    }
                    _ => {}
                }
            }
        }
    }

    /// `u_t − u_{t−1}` at a stage.
    pub(super) fn input_change(&self, vehicle: usize, stage: usize, iterate: &Iterate) -> [f64; 2] {
        let inputs = &iterate.inputs[vehicle];
        let before = if stage == 0 { &self.participants[vehicle].previous_input } else { &inputs[stage - 1] };
        let (now, before) = (inputs[stage].to_array(), before.to_array());
        [now[0] - before[0], now[1] - before[1]]
    }
}

/// Cost of a squared change of the steering angle beyond what the wheels can turn in a step \[1/rad²\]: 0.01 rad cost as much as a
/// corner of a real car that is a centimetre off the road at one stage.
pub(super) const TURN_WEIGHT: f64 = 1e5;

/// Room for the rows of one term at one stage.
type StageRows = [PoseExpansion; MAX_ROWS_PER_STAGE];

fn add_rows(rows: &dyn RowTerm, stage: usize, iterate: &Iterate, room: &mut StageRows, cost: &mut Cost) {
    let (penalty, violation) = (rows.penalty(), rows.violation());
    let (count, mut values) = (rows.rows_per_stage(), [0.0; MAX_ROWS_PER_STAGE]);
    rows.evaluate(stage, iterate, &mut room[..count], &mut values[..count]);
    for value in &values[..count] {
        cost.add_row(&penalty, violation, *value);
    }
}

fn add_trajectory_row(row: &dyn TrajectoryTerm, iterate: &Iterate, cost: &mut Cost) {
    let excess = row.excess(&iterate.states[row.vehicle()]);
    cost.add_trajectory_row(&row.penalty(), row.violation(), -excess);
}
