//! Logit responses: a player passes the more probably, the more passing is worth to it (corrected form).
//!
//! ```text
//! p_i = σ((U_i(1, p_j) − U_i(0, p_j)) / (τ |v(−M)|)),  σ(z) = 1/(1 + e^(−z))
//! ```
//!
//! A pair in which both probabilities are the response to each other is a quantal response equilibrium (McKelvey and Palfrey,
//! 1995). Best responses as printed are steps, so the solution lies on a bound nearly always; logit responses are smooth.

use super::best_response::{MAX_INTENTION, MIN_INTENTION};
use super::payoff::Player;

/// Share of the way to the response that an iteration goes: undamped iterations may alternate between two pairs.
const DAMPING: f64 = 0.5;
/// Most iterations; some 30 suffice at `τ = 0.5`.
const MAX_ITERATIONS: usize = 200;
/// Changes below this end the iteration.
const TOLERANCE: f64 = 1e-10;

/// The logit response to an intention of the other, before it is clipped; `temperature` is `τ`.
fn logit_response(player: &Player, other: f64, temperature: f64) -> f64 {
    let advantage = player.utility(1.0, other) - player.utility(0.0, other);
    1.0 / (1.0 + libm::exp(-advantage / (temperature * player.accident_value().abs())))
}

/// The mutual logit responses `[p_e, p_s]`, clipped to the bounds of intentions, by damped iteration from ½.
pub fn quantal_response(ego: &Player, other: &Player, temperature: f64) -> [f64; 2] {
    let response =
        |player: &Player, to: f64| logit_response(player, to, temperature).clamp(MIN_INTENTION, MAX_INTENTION);
    let (mut own, mut theirs) = (0.5, 0.5);
    for _ in 0..MAX_ITERATIONS {
        let change = [response(ego, theirs) - own, response(other, own) - theirs];
        own += DAMPING * change[0];
        theirs += DAMPING * change[1];
        if change.iter().all(|change| change.abs() < TOLERANCE) {
            break;
        }
    }
    [own, theirs]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drivers::game::payoff::{Stakes, THEORY};
    use proptest::prelude::*;

    const TEMPERATURE: f64 = 0.5;

    proptest! {
        #[test]
        fn a_logit_response_is_a_probability_inside_its_bounds(ratio in 1e-3..1e3, other in 0.05..0.95) {
            let response = logit_response(&THEORY.player(Stakes::bounded(ratio, 4.0)), other, TEMPERATURE);
            prop_assert!(MIN_INTENTION < response && response < MAX_INTENTION, "{response}");
        }

        #[test]
        fn at_any_temperature_a_logit_response_is_inside_zero_and_one(
            ratio in 0.05..19.0, other in 0.05..0.95, temperature in 0.1..5.0,
        ) {
            let response = logit_response(&THEORY.player(Stakes::bounded(ratio, 4.0)), other, temperature);
            prop_assert!(0.0 < response && response < 1.0, "{response}");
        }

        #[test]
        fn the_probability_of_passing_grows_with_the_stakes(ratio in 0.05..19.0, more in 1.01..3.0, other in 0.05..0.95) {
            let response = |ratio: f64| logit_response(&THEORY.player(Stakes::bounded(ratio, 4.0)), other, TEMPERATURE);
            prop_assert!(response(more * ratio) > response(ratio));
        }

        #[test]
        fn the_probability_of_passing_falls_with_that_of_the_other(ratio in 0.05..19.0, other in 0.05..0.9, more in 0.01..0.05) {
            let player = THEORY.player(Stakes::bounded(ratio, 4.0));
            prop_assert!(logit_response(&player, other + more, TEMPERATURE) < logit_response(&player, other, TEMPERATURE));
        }

        #[test]
        fn the_solution_is_a_pair_of_mutual_responses(ratios in [0.05..19.0, 0.05..19.0]) {
            let [ego, other] = ratios.map(|ratio| THEORY.player(Stakes::bounded(ratio, 4.0)));
            let [own, theirs] = quantal_response(&ego, &other, TEMPERATURE);
            prop_assert!((logit_response(&ego, theirs, TEMPERATURE) - own).abs() < 1e-6);
            prop_assert!((logit_response(&other, own, TEMPERATURE) - theirs).abs() < 1e-6);
        }
    }
}
