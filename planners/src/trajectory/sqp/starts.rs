//! Which optimum: descents from several guesses, and to the other sides of ellipses ([`super::other_side`]). The cheapest wins.

use super::optimiser::{DescentError, Optimiser, Optimum, Statistics};
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
        if self.looks_across {
            best = best.map(|optimum| self.look_across(problem, optimum));
        }
        if self.tolerances.trust(&best) && !look_around {
            return best;
        }
        for guess in others {
            // In trouble nothing is given up early.
            let goal = match &best {
                Ok(held) if self.tolerances.trust(&best) => held.below(),
                _ => f64::INFINITY,
            };
            let found = self.explore(problem, guess, goal);
            match (&mut best, found) {
                (Ok(best), found) => self.keep_cheaper(best, found),
                (Err(_), Ok(found)) => {
                    best = Ok(found);
                    self.adopt();
                }
                (Err(_), Err(_)) => {}
            }
        }
        best
    }

    /// Takes what was found after another optimum if it is cheaper; the work is counted either way.
    pub(super) fn keep_cheaper(&mut self, best: &mut Optimum, found: Result<Optimum, DescentError>) {
        let Ok(found) = found else { return };
        let mut work = best.statistics;
        work.add(&found.statistics);
        if found.cost.total < best.below() {
            let residual = found.statistics.residual;
            *best = Optimum { statistics: Statistics { residual, ..work }, ..found };
            self.adopt();
        } else {
            best.statistics = Statistics { residual: best.statistics.residual, ..work };
        }
    }
}

impl Optimum {
    /// What another optimum has to cost less than.
    pub(super) fn below(&self) -> f64 {
        self.cost.total - 1e-9 * (1.0 + self.cost.total.abs())
    }
}
