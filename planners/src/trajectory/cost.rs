//! The cost of an iterate, and by how much it violates its constraints.

use super::penalty::Penalty;

/// The kinds of violations that are kept apart, so that a planner can judge a plan by them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Violation {
    /// `1 − d²` of an ellipse that must not be entered \[-\].
    Safety,
    /// How far a corner is beyond a road edge \[m\].
    RoadEdge,
    /// By how much the persuasion row falls short \[m²\].
    Persuasion,
    /// How far a mean speed is out of its bounds \[m/s\].
    MeanSpeed,
}

/// Number of [`Violation`] kinds.
const KINDS: usize = Violation::MeanSpeed as usize + 1;

/// The cost of an iterate, and the largest violation of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Total cost, with the penalties of violations.
    pub total: f64,
    /// The part of the total that is linear in violations of stage rows, `Σ linear·s`.
    pub linear_penalties: f64,
    violations: [f64; KINDS],
}

impl Cost {
    /// The largest violation of a kind; 0 where every row of it holds.
    pub fn violation(&self, kind: Violation) -> f64 {
        self.violations[kind as usize]
    }

    /// The largest violation that makes a plan unsafe: of an ellipse or of a road edge.
    pub fn unsafety(&self) -> f64 {
        self.violation(Violation::Safety).max(self.violation(Violation::RoadEdge))
    }

    /// Adds a stage row `c + s ≥ 0` of value `c`.
    pub(super) fn add_row(&mut self, penalty: &Penalty, kind: Option<Violation>, value: f64) {
        self.linear_penalties += penalty.linear * (-value).max(0.0);
        self.add_trajectory_row(penalty, kind, value);
    }

    /// Adds a row over a whole trajectory, likewise.
    pub(super) fn add_trajectory_row(&mut self, penalty: &Penalty, kind: Option<Violation>, value: f64) {
        self.total += penalty.cost(value);
        if let Some(kind) = kind {
            let largest = &mut self.violations[kind as usize];
            *largest = largest.max(-value);
        }
    }
}
