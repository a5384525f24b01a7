//! Which optimum: descents from several guesses, and to the other sides of ellipses. The cheapest wins.

use super::exploration::{Bar, Exploration};
use super::optimiser::Optimiser;
use super::optimum::{DescentError, Optimum};
use super::other_side::look_to_other_sides;
use crate::Input;
use crate::trajectory::problem::Problem;
use crate::trajectory::stage::StageSolver;

impl<S: StageSolver> Optimiser<S> {
    /// Descends from the first guess; if that fails or ends on a violated safety row or road edge (a stationary point
    /// inside an ellipse: it happens), or if `look_around` asks for it, from the others too. The cheapest optimum wins.
    ///
    /// # Errors
    /// That of the first guess, if every guess fails.
    pub fn best_of(
        &mut self,
        problem: &Problem,
        guesses: &[Vec<Vec<Input>>],
        look_around: bool,
    ) -> Result<Optimum, DescentError> {
        let Some((first, others)) = guesses.split_first() else { return Err(DescentError::NotFinite) };
        let mut best = self.descend(problem, first);
        if self.looks_to_other_sides {
            best = best.map(|optimum| look_to_other_sides(self, problem, optimum));
        }
        if self.tolerances.trust(&best) && !look_around {
            return best;
        }
        for guess in others {
            // In trouble nothing is given up early.
            let gives_up = self.tolerances.trust(&best);
            match &mut best {
                Ok(held) => {
                    if let Ok(found) = self.explore(problem, guess, Bar { cost: held.bar(), gives_up }) {
                        found.improve(held);
                    }
                }
                Err(_) => {
                    let found = self.explore(problem, guess, Bar { cost: f64::INFINITY, gives_up: false });
                    if let Ok(Exploration::Cheaper(found)) = found {
                        best = Ok(found);
                    }
                }
            }
        }
        best
    }
}
