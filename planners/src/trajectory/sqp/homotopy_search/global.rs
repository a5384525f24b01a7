//! The global search: descents from everywhere, none of them given up.
//!
//! It begins at every simple motion ([`for_each_motion`]), and at motions of constant inputs by pieces that are spread evenly over
//! all of them by the additive recurrence of Roberts, `x_k = frac(½ + k α)`, `α_j = g^−j` with `g^(d+1) = g + 1`, the
//! generalised golden ratio in `d` dimensions.

use super::motions::for_each_motion;
use crate::Input;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::participant::Participant;
use crate::trajectory::problem::Problem;
use crate::trajectory::sqp::exploration::{Exploration, replace};
use crate::trajectory::sqp::homotopy_class::HomotopyClass;
use crate::trajectory::sqp::optimiser::Optimiser;
use crate::trajectory::sqp::optimum::{DescentError, Optimum, Tolerances};
use crate::trajectory::stage::StageSolver;

/// Number of spread motions.
const SPREAD_MOTIONS: usize = 60;
/// Pieces of constant inputs in each of them.
const PIECES: usize = 5;
/// Inputs of a piece.
const INPUTS: usize = 2;

impl<S: StageSolver> Optimiser<S> {
    /// The cheapest of what a descent found and all optima that the search finds.
    pub(super) fn search_globally(
        &mut self,
        problem: &Problem,
        mut best: Result<Optimum, DescentError>,
    ) -> Result<Optimum, DescentError> {
        let tolerances = Tolerances { work_limit: Tolerances::default().work_limit, ..self.tolerances };
        for start in starts(problem, best.as_ref().ok().map(|optimum| &optimum.iterate)) {
            let bar = self.bar(&best);
            match self.explore_class(problem, start, bar, None, &tolerances) {
                Ok(Exploration::Cheaper(found)) => {
                    replace(&mut best, found);
                }
                Ok(Exploration::Unfinished(mut reached)) if self.is_better(&reached, &best) => {
                    reached.statistics.unfinished = 1;
                    replace(&mut best, reached);
                }
                Ok(Exploration::Dearer(found)) => best.iter_mut().for_each(|held| {
                    let class = |optimum: &Optimum| HomotopyClass::classify(problem, &optimum.iterate);
                    if class(&found) == class(held) {
                        held.add_work(&found.statistics)
                    } else {
                        held.note_rival(&found)
                    }
                }),
                Ok(Exploration::Unfinished(reached)) => {
                    best.iter_mut().for_each(|held| held.add_work(&reached.statistics));
                }
                Err(_) => {}
            }
        }
        best
    }
}

/// Every motion at which the search begins; `planned` is what all vehicles plan so far.
fn starts(problem: &Problem, planned: Option<&Iterate>) -> Vec<Iterate> {
    let mut starts = Vec::new();
    for_each_motion(problem, planned, |iterate| starts.push(iterate.clone()));
    let directions = recurrence(problem.participants.len() * PIECES * INPUTS);
    starts.extend((1..=SPREAD_MOTIONS).map(|k| spread_motion(problem, &directions, k)));
    starts
}

/// The steps `α` of the recurrence, one a dimension.
fn recurrence(dimensions: usize) -> Vec<f64> {
    let exponent = 1.0 / (dimensions as f64 + 1.0);
    // Converges from any start: the slope of the map is far below 1.
    let ratio = (0..60).fold(2.0, |ratio, _| libm::pow(1.0 + ratio, exponent));
    (1..=dimensions).map(|j| libm::pow(ratio, -(j as f64))).collect()
}

/// Motion `k` of the spread motions.
fn spread_motion(problem: &Problem, directions: &[f64], k: usize) -> Iterate {
    let share = |direction: &f64| (0.5 + k as f64 * direction).fract();
    let of = |(participant, directions): (&Participant, &[f64])| -> Vec<Input> {
        let limits = &participant.limits;
        let between = |low: f64, high: f64, share: f64| low + share * (high - low);
        let piece = |pair: &[f64]| Input {
            acceleration_mps2: between(limits.acceleration_min_mps2, limits.acceleration_max_mps2, share(&pair[0])),
            steering_rad: between(-limits.steering_max_rad, limits.steering_max_rad, share(&pair[1])),
        };
        let pieces: Vec<Input> = directions.chunks(INPUTS).map(piece).collect();
        (0..problem.horizon).map(|t| pieces[t * PIECES / problem.horizon]).collect()
    };
    let inputs = problem.participants.iter().zip(directions.chunks(PIECES * INPUTS)).map(of);
    problem.start(&inputs.collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In one dimension the recurrence is that of the golden ratio, in two that of the plastic number.
    #[test]
    fn the_recurrence_is_that_of_generalised_golden_ratios() {
        assert!((recurrence(1)[0] - 0.618_033_988_749_894_8).abs() < 1e-12);
        let plane = recurrence(2);
        assert!((plane[0] - 0.754_877_666_246_692_8).abs() < 1e-12);
        assert!((plane[1] - 0.569_840_290_998_053_3).abs() < 1e-12);
    }
}
