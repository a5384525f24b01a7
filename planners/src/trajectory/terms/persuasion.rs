//! Persuasion: a trajectory that is nearer to one reference than to another (eq. 6.23, corrected: both norms squared),
//!
//! ```text
//! α Σ‖p_t − toward_t‖² − Σ‖p_t − away_t‖² ≤ s,      t = 0…N−1
//! ```
//!
//! For `α = 1` a half-space, for `α > 1` the Apollonius ball with centre `(α·toward − away)/(α − 1)` and radius
//! `√α‖toward − away‖/(α − 1)`: convex both ways. The row is quadratic in the positions, so its expansion is exact: gradient
//! `2(α(p − toward) − (p − away))` and Hessian `2(α − 1)` on the position.

use super::shape::TrajectoryTerm;
use crate::State;
use crate::trajectory::cost::Violation;
use crate::trajectory::penalty::Penalty;
use crate::trajectory::stage::TrajectoryRow;

/// The persuasion constraint: a trajectory is nearer to one reference than to another (eq. 6.20-6.23).
#[derive(Clone, Debug, PartialEq)]
pub struct Persuasion {
    /// Index of the vehicle whose trajectory is constrained.
    pub vehicle: usize,
    /// Reference to approach at `t = 0…N−1` \[m\].
    pub toward: Vec<[f64; 2]>,
    /// Reference to leave at `t = 0…N−1` \[m\].
    pub away: Vec<[f64; 2]>,
    /// Strength `α ≥ 1` of the persuasion.
    pub strength: f64,
    /// Cost of violating the constraint.
    pub penalty: Penalty,
}

impl Persuasion {
    /// The left side of the constraint for given states; at most 0 where it holds \[m²\].
    pub fn value(&self, states: &[State]) -> f64 {
        let squared = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2);
        let references = self.toward.iter().zip(&self.away);
        states
            .iter()
            .zip(references)
            .map(|(state, (toward, away))| {
                self.strength * squared(state.position(), *toward) - squared(state.position(), *away)
            })
            .sum()
    }
}

impl TrajectoryTerm for Persuasion {
    fn vehicle(&self) -> usize {
        self.vehicle
    }

    fn penalty(&self) -> Penalty {
        self.penalty
    }

    fn violation(&self) -> Option<Violation> {
        Some(Violation::Persuasion)
    }

    fn excess(&self, states: &[State]) -> f64 {
        self.value(states)
    }

    fn expand(&self, states: &[State], row: &mut TrajectoryRow) {
        for (stage, state) in states.iter().skip(1).enumerate() {
            let references = self.toward.get(stage + 1).zip(self.away.get(stage + 1));
            (row.gradients[stage], row.bends[stage]) = references.map_or(([0.0; 3], 0.0), |(toward, away)| {
                let p = state.position();
                let slope = |i: usize| 2.0 * (self.strength * (p[i] - toward[i]) - (p[i] - away[i]));
                ([slope(0), slope(1), 0.0], self.strength - 1.0)
            });
        }
    }
}
