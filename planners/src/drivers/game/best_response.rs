//! Best responses: the intention that serves a player best, given the other's.
//!
//! Intentions are probabilities to pass in [0.05, 0.95] ("the extreme events are eliminated"). A utility may have two local
//! maxima in the own probability (it does in some 3 % of games), so a gradient ascent, as the source proposes, may stop at
//! the lesser one. A grid finds the best cell, and a golden-section search the maximum inside it.

use super::payoff::Player;

/// The lowest intention, a probability to pass.
pub const MIN_INTENTION: f64 = 0.05;
/// The highest intention, a probability to pass.
pub const MAX_INTENTION: f64 = 0.95;
/// Number of grid points from [`MIN_INTENTION`] to [`MAX_INTENTION`].
pub(super) const GRID_POINTS: usize = 91;
/// Their distance.
pub(super) const GRID_CELL: f64 = 0.01;
/// Every how many grid points a first look is taken: local maxima are farther apart than that.
const COARSE_STRIDE: usize = 3;
/// Steps of the golden section from the strides on both sides to the square root of the rounding error.
const SECTION_STEPS: usize = 34;

/// Lowest and highest intention in hundredths.
pub(super) const HUNDREDTHS: [i32; 2] = [5, 95];

/// The intention at a grid point.
pub(super) fn intention(point: usize) -> f64 {
    f64::from(HUNDREDTHS[0] + point as i32) / 100.0
}

/// The intention that serves `player` best if the other passes with probability `other`.
pub fn best_response(player: &Player, other: f64) -> f64 {
    let best = best_of((0..GRID_POINTS).step_by(COARSE_STRIDE).map(|point| player.utility(intention(point), other)));
    reply_near(player, other, intention(COARSE_STRIDE * best))
}

/// The best response on the grid to the grid's intention `other`, as an index.
pub(super) fn grid_response(player: &Player, other: usize) -> usize {
    let [lowest, highest] = HUNDREDTHS;
    let (other, stride) = (lowest + other as i32, COARSE_STRIDE as i32);
    let first = player.best_of((lowest..=highest).step_by(COARSE_STRIDE), other);
    let around = (first + 1 - stride).max(lowest)..=(first + stride - 1).min(highest);
    (player.best_of(around, other) - lowest) as usize
}

/// The best response within a stride of a guess.
pub(super) fn reply_near(player: &Player, other: f64, guess: f64) -> f64 {
    maximum(|own| player.utility(own, other), guess, COARSE_STRIDE as f64 * GRID_CELL, SECTION_STEPS)
}

/// The place of the maximum of `f` within `reach` of `guess`, where `f` has one (golden section).
pub(super) fn maximum(f: impl Fn(f64) -> f64, guess: f64, reach: f64, steps: usize) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut low, mut high) = ((guess - reach).max(MIN_INTENTION), (guess + reach).min(MAX_INTENTION));
    let ends = [low, high];
    let (mut left, mut right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut at_left, mut at_right) = (f(left), f(right));
    for _ in 0..steps {
        if at_left < at_right {
            (low, left, at_left) = (left, right, at_right);
            right = low + GOLDEN * (high - low);
            at_right = f(right);
        } else {
            (high, right, at_right) = (right, left, at_left);
            left = high - GOLDEN * (high - low);
            at_left = f(left);
        }
    }
    let inside = 0.5 * (low + high);
    let found = [inside, ends[0], ends[1], guess];
    found[best_of(found.iter().map(|at| f(*at)))]
}

/// The index of the largest number; the first of equals.
pub(super) fn best_of(values: impl Iterator<Item = f64>) -> usize {
    let mut best = (0, f64::NEG_INFINITY);
    for (index, value) in values.enumerate() {
        if value > best.1 {
            best = (index, value);
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drivers::game::payoff::{Stakes, THEORY, TabulatedTheory};
    use crate::drivers::game::prospect::ProspectTheory;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]

        #[test]
        fn nothing_on_a_finer_grid_is_better(turn in 0.05..19.0, accident in 0.5..5.0, other in 0.05..0.95) {
            let player = THEORY.player(Stakes { turn, accident });
            let best = player.utility(best_response(&player, other), other);
            for own in (0..=9000).map(|i| MIN_INTENTION + f64::from(i) * 1e-4) {
                prop_assert!(player.utility(own, other) <= best + 1e-9 * (1.0 + best.abs()), "{own}");
            }
        }

        #[test]
        fn the_grid_s_response_is_the_best_one_in_its_cell(turn in 0.05..19.0, accident in 0.5..5.0, other in 0_usize..91) {
            let player = THEORY.player(Stakes { turn, accident });
            let (on_grid, exact) = (grid_response(&player, other), best_response(&player, intention(other)));
            let loss = player.utility(exact, intention(other)) - player.utility(intention(on_grid), intention(other));
            prop_assert!((0.0..1e-3 * (1.0 + turn)).contains(&loss), "{loss}");
        }
    }

    /// Without distortion of probabilities utilities are linear in the own probability, so responses are bounds, and they
    /// change where both bounds are worth the same: `(1 − o) 3x = o (M − x)`.
    #[test]
    fn undistorted_responses_change_where_the_other_makes_one_indifferent() {
        let theory = TabulatedTheory::new(ProspectTheory::EXPECTED);
        for (turn, accident) in [(1.0, 2.0), (0.5, 3.0), (2.0, 4.0)] {
            let player = theory.player(Stakes { turn, accident });
            let indifferent = 3.0 * turn / (2.0 * turn + accident);
            assert_eq!(best_response(&player, indifferent - 0.01), MAX_INTENTION);
            assert_eq!(best_response(&player, indifferent + 0.01), MIN_INTENTION);
        }
    }
}
