//! Logit replies: a player passes the more probably, the more passing is worth to it (corrected form).
//!
//! ```text
//! p_i = σ((U_i(1, p_j) − U_i(0, p_j)) / (τ |v(−M)|)),  σ(z) = 1/(1 + e^(−z))
//! ```
//!
//! A pair in which both probabilities are the reply to each other is a quantal response equilibrium (McKelvey and Palfrey,
//! 1995). Best replies as printed are steps, so the solution lies on a bound nearly always; logit replies are smooth.

use super::payoff::Player;
use super::reply::{MAX_INTENTION, MIN_INTENTION};

/// Share of the way to the reply that an iteration goes: undamped iterations may alternate between two pairs.
const DAMPING: f64 = 0.5;
/// Most iterations; some 30 suffice at `τ = 0.5`.
const MAX_ITERATIONS: usize = 200;
/// Changes below this end the iteration.
const TOLERANCE: f64 = 1e-10;

/// The logit reply to an intention of the other, before it is clipped; `temperature` is `τ`.
pub fn logit_reply(player: &Player, other: f64, temperature: f64) -> f64 {
    let advantage = player.utility(1.0, other) - player.utility(0.0, other);
    1.0 / (1.0 + libm::exp(-advantage / (temperature * player.accident_value().abs())))
}

/// The mutual logit replies `[p_e, p_s]`, clipped to the bounds of intentions, by damped iteration from ½.
pub fn quantal_response(ego: &Player, other: &Player, temperature: f64) -> [f64; 2] {
    let reply = |player: &Player, to: f64| logit_reply(player, to, temperature).clamp(MIN_INTENTION, MAX_INTENTION);
    let (mut own, mut theirs) = (0.5, 0.5);
    for _ in 0..MAX_ITERATIONS {
        let change = [reply(ego, theirs) - own, reply(other, own) - theirs];
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
    use crate::game::payoff::{Stakes, THEORY};
    use proptest::prelude::*;

    const TEMPERATURE: f64 = 0.5;

    proptest! {
        #[test]
        fn a_logit_reply_is_a_probability_inside_its_bounds(ratio in 1e-3..1e3, other in 0.05..0.95) {
            let reply = logit_reply(&THEORY.player(Stakes::bounded(ratio, 4.0)), other, TEMPERATURE);
            prop_assert!(MIN_INTENTION < reply && reply < MAX_INTENTION, "{reply}");
        }

        #[test]
        fn at_any_temperature_a_logit_reply_is_inside_zero_and_one(
            ratio in 0.05..19.0, other in 0.05..0.95, temperature in 0.1..5.0,
        ) {
            let reply = logit_reply(&THEORY.player(Stakes::bounded(ratio, 4.0)), other, temperature);
            prop_assert!(0.0 < reply && reply < 1.0, "{reply}");
        }

        #[test]
        fn who_has_more_at_stake_passes_more_probably(ratio in 0.05..19.0, more in 1.01..3.0, other in 0.05..0.95) {
            let reply = |ratio: f64| logit_reply(&THEORY.player(Stakes::bounded(ratio, 4.0)), other, TEMPERATURE);
            prop_assert!(reply(more * ratio) > reply(ratio));
        }

        #[test]
        fn who_expects_the_other_to_pass_passes_less_probably(ratio in 0.05..19.0, other in 0.05..0.9, more in 0.01..0.05) {
            let player = THEORY.player(Stakes::bounded(ratio, 4.0));
            prop_assert!(logit_reply(&player, other + more, TEMPERATURE) < logit_reply(&player, other, TEMPERATURE));
        }

        #[test]
        fn the_solution_is_a_pair_of_mutual_replies(ratios in [0.05..19.0, 0.05..19.0]) {
            let [ego, other] = ratios.map(|ratio| THEORY.player(Stakes::bounded(ratio, 4.0)));
            let [own, theirs] = quantal_response(&ego, &other, TEMPERATURE);
            prop_assert!((logit_reply(&ego, theirs, TEMPERATURE) - own).abs() < 1e-6);
            prop_assert!((logit_reply(&other, own, TEMPERATURE) - theirs).abs() < 1e-6);
        }
    }
}
