//! Starts outside of the ellipses: where the motions of deciding vehicles lead into one another, one of them gives way first.

use super::motions::for_each_motion;
use crate::Input;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::problem::Problem;
use crate::trajectory::terms::{RowTerm, Term};

/// A guess that enters an ellipse by no more than this (of `1 − d²`) is a start as it is: its first step leads out.
const MAX_ENTRY: f64 = 1e-2;

impl Problem {
    /// A guess (per participant, inputs) whose motions do not lead into one another, as far as simple motions do that.
    ///
    /// Deep inside an ellipse a descent is caught: the linear rows of stages before its centre point one way out and those of stages
    /// behind it the other, and each step is cut short. So the cheapest of the simple motions replaces a guess in which a vehicle
    /// enters the ellipse around another deciding one, until none does or no simple motion costs less. Other guesses stay, made
    /// admissible.
    pub fn start_outside(&self, guess: &[Vec<Input>]) -> Vec<Vec<Input>> {
        let mut start = self.start(guess);
        let mut least = self.cost(&start).total;
        // One of the vehicles moves at a time, the others go on, brake or accelerate.
        for _ in 0..self.participants.len() {
            if !self.overlaps(&start) {
                break;
            }
            let (planned, before) = (start.clone(), least);
            for_each_motion(self, Some(&planned), |iterate| {
                let cost = self.cost(iterate).total;
                if cost < least {
                    least = cost;
                    start.clone_from(iterate);
                }
            });
            if least == before {
                break;
            }
        }
        start.inputs
    }

    /// Whether a vehicle enters the ellipse around another deciding one.
    fn overlaps(&self, iterate: &Iterate) -> bool {
        self.terms.iter().any(|term| {
            let Term::Separation(pair) = term else { return false };
            pair.ellipses.iter().enumerate().any(|(stage, ellipse)| {
                let position = pair.relative_position(stage, iterate);
                position.is_some_and(|position| ellipse.distance(position, [0.0; 2]).squared < 1.0 - MAX_ENTRY)
            })
        })
    }
}
