//! What the two players of the game have at stake (Table 8.2), and what a pair of intentions is worth to one of them.
//!
//! Both players are alike. With the own stake `x`, a player who yields while the other passes loses `x`, one who passes
//! while the other yields gains `x`, both lose `2x` if both yield, and `M` in the accident:
//!
//! | own \ other | yields | passes |
//! |---|---|---|
//! | yields | −2x | −x |
//! | passes | x | −M |
//!
//! The stakes depend on ratios of what the players are believed to intend: `r_e = p_e / p̃_s|e` for the ego,
//! `r_s = p̃_s|e / p̃_e|s` for the other. As printed, `x = r`. As probabilities are clipped to [0.05, 0.95], such a stake
//! reaches 19, `M` must be of the same order, and the accident is often better than yielding. In the corrected form
//! `x = (M/2) r/(1 + r)`, which is at most `0.475 M`.
//!
//! # Fast evaluation
//!
//! With three losses `v₁ ≤ v₂ ≤ v₃` at cumulated probabilities `c₁ ≤ c₂ ≤ c₃`, eq. 8.7 is
//! `U = v(x) w⁺(p (1 − o)) + (v₁ − v₂) w⁻(c₁) + (v₂ − v₃) w⁻(c₂) + v₃ w⁻(c₃)`: four weights, read from tables. All
//! probabilities on a grid of hundredths are multiples of 10⁻⁴, which are the nodes of the tables; between them a cubic
//! Hermite polynomial interpolates to 10⁻⁹.

use super::prospect::{Outcome, ProspectTheory, weighting, weighting_slope};

/// Nodes of the weight tables per unit of probability.
const TABLE_NODES: usize = 10_000;
/// Closer to 0 or 1 than this the weights are too steep for the tables.
const STEEP_END: f64 = 2e-3;

/// The stakes of one player, from which its payoffs follow (Table 8.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stakes {
    /// What passing first gains and waiting loses, `x`.
    pub turn: f64,
    /// What the accident loses, `M`.
    pub accident: f64,
}

/// The three ways to lose.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Loss {
    /// Both players yield.
    Stalemate,
    /// The player yields and the other passes.
    Wait,
    /// Both players pass: the accident.
    Accident,
}

impl Stakes {
    /// The stakes as the source prints them: `x` is the ratio of the intentions.
    pub fn of_ratio(ratio: f64, accident: f64) -> Self {
        Stakes { turn: ratio, accident }
    }

    /// Stakes in the corrected form: `x = (M/2) r/(1 + r)` of the ratio `r`, so that `2x < M` and the accident is the worst
    /// outcome at every ratio.
    pub fn bounded(ratio: f64, accident: f64) -> Self {
        Stakes { turn: 0.5 * accident * ratio / (1.0 + ratio), accident }
    }

    /// The payoff matrix: `[own][other]`, yielding first.
    pub fn payoffs(&self) -> [[f64; 2]; 2] {
        [[-2.0 * self.turn, -self.turn], [self.turn, -self.accident]]
    }

    /// The lottery that a player faces who passes with probability `own` while the other does with `other` (Table 8.3).
    pub fn lottery(&self, own: f64, other: f64) -> [Outcome; 4] {
        let [[stalemate, wait], [turn, accident]] = self.payoffs();
        [
            Outcome { payoff: stalemate, probability: (1.0 - own) * (1.0 - other) },
            Outcome { payoff: wait, probability: (1.0 - own) * other },
            Outcome { payoff: turn, probability: own * (1.0 - other) },
            Outcome { payoff: accident, probability: own * other },
        ]
    }

    /// The losses, worst first.
    fn losses(&self) -> [(f64, Loss); 3] {
        let [[stalemate, wait], [_, accident]] = self.payoffs();
        let mut losses = [(stalemate, Loss::Stalemate), (wait, Loss::Wait), (accident, Loss::Accident)];
        losses.sort_by(|a, b| a.0.total_cmp(&b.0));
        losses
    }
}

/// A weighting function as a table with slopes.
#[derive(Clone, Debug)]
struct Weights {
    exponent: f64,
    /// Value at `i · 10⁻⁴`, and the slope times the spacing.
    nodes: Vec<[f64; 2]>,
    /// The values alone, for scans of the grid.
    values: Vec<f64>,
}

impl Weights {
    fn new(exponent: f64) -> Self {
        let spacing = 1.0 / TABLE_NODES as f64;
        let node = |i: usize| {
            let p = i as f64 * spacing;
            let slope = if i == 0 || i == TABLE_NODES { 0.0 } else { spacing * weighting_slope(p, exponent) };
            [weighting(p, exponent), slope]
        };
        let nodes: Vec<[f64; 2]> = (0..=TABLE_NODES).map(node).collect();
        Weights { exponent, values: nodes.iter().map(|[value, _]| *value).collect(), nodes }
    }

    #[inline(always)]
    fn at_node(&self, ten_thousandths: i32) -> f64 {
        self.values[ten_thousandths as usize]
    }

    #[inline(always)]
    fn at(&self, p: f64) -> f64 {
        if !(STEEP_END..=1.0 - STEEP_END).contains(&p) {
            return weighting(p, self.exponent);
        }
        let scaled = p * TABLE_NODES as f64;
        let index = scaled as usize;
        let t = scaled - index as f64;
        let ([left, left_slope], [right, right_slope]) = (self.nodes[index], self.nodes[index + 1]);
        let rise = right - left;
        let (bend, twist) = (3.0 * rise - 2.0 * left_slope - right_slope, left_slope + right_slope - 2.0 * rise);
        left + t * (left_slope + t * (bend + t * twist))
    }
}

/// Prospect theory with tabulated decision weights: how both players value lotteries.
#[derive(Clone, Debug)]
pub struct TabulatedTheory {
    theory: ProspectTheory,
    gains: Weights,
    losses: Weights,
}

impl TabulatedTheory {
    /// Tabulates the weights of a theory; takes a few milliseconds.
    pub fn new(theory: ProspectTheory) -> Self {
        TabulatedTheory { theory, gains: Weights::new(theory.gamma), losses: Weights::new(theory.eta) }
    }

    /// A player who values the lotteries of its stakes by this theory.
    pub fn player(&self, stakes: Stakes) -> Player<'_> {
        let losses = stakes.losses();
        let [worst, middle, least] = losses.map(|(payoff, _)| self.theory.value(payoff));
        Player {
            theory: self,
            gain: self.theory.value(stakes.turn),
            steps: [worst - middle, middle - least, least],
            ranking: losses.map(|(_, loss)| loss),
            accident: self.theory.value(-stakes.accident),
        }
    }
}

/// The utility function of one player.
#[derive(Clone, Copy, Debug)]
pub struct Player<'a> {
    theory: &'a TabulatedTheory,
    /// Value `v(x)` of passing first.
    gain: f64,
    /// `v₁ − v₂, v₂ − v₃, v₃`.
    steps: [f64; 3],
    ranking: [Loss; 3],
    /// Value `v(−M)` of the accident.
    accident: f64,
}

impl Player<'_> {
    /// The value of the accident, `v(−M)`.
    pub fn accident_value(&self) -> f64 {
        self.accident
    }

    /// `U` of eq. 8.7 for a player who passes with probability `own` while the other does with `other`.
    pub fn utility(&self, own: f64, other: f64) -> f64 {
        let mut cumulated = 0.0;
        let mut utility = self.gain * self.theory.gains.at(own * (1.0 - other));
        for (loss, step) in self.ranking.iter().zip(self.steps) {
            cumulated += match loss {
                Loss::Stalemate => (1.0 - own) * (1.0 - other),
                Loss::Wait => (1.0 - own) * other,
                Loss::Accident => own * other,
            };
            utility += step * self.theory.losses.at(cumulated);
        }
        utility
    }

    /// Of some intentions in hundredths, the best response to `other` hundredths; the first of equals.
    #[inline(always)]
    pub fn best_of(&self, own: impl Iterator<Item = i32>, other: i32) -> i32 {
        // A cumulated probability is `base + own · slope` ten-thousandths.
        let (mut base, mut slope) = (0, 0);
        let lines = self.ranking.map(|loss| {
            let (more, steeper) = match loss {
                Loss::Stalemate => (100 * (100 - other), other - 100),
                Loss::Wait => (100 * other, -other),
                Loss::Accident => (0, other),
            };
            (base, slope) = (base + more, slope + steeper);
            (base, slope)
        });
        let mut best = (0, f64::NEG_INFINITY);
        for own in own {
            let mut utility = self.gain * self.theory.gains.at_node(own * (100 - other));
            for ((base, slope), step) in lines.iter().zip(self.steps) {
                utility += step * self.theory.losses.at_node(base + own * slope);
            }
            if utility > best.1 {
                best = (own, utility);
            }
        }
        best.0
    }
}

/// Shared by several tests, as tabulating takes a while.
#[cfg(test)]
pub(super) static THEORY: std::sync::LazyLock<TabulatedTheory> =
    std::sync::LazyLock::new(|| TabulatedTheory::new(ProspectTheory::default()));

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn stakes() -> impl Strategy<Value = Stakes> {
        (0.05..19.0, 0.5..60.0).prop_map(|(turn, accident)| Stakes { turn, accident })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn the_tables_agree_with_the_definition(stakes in stakes(), own in 0.05..0.95, other in 0.05..0.95) {
            let theory = ProspectTheory::default();
            let (fast, slow) = (THEORY.player(stakes).utility(own, other), theory.utility(&mut stakes.lottery(own, other)));
            prop_assert!((fast - slow).abs() < 1e-7 * (1.0 + slow.abs()), "{fast} against {slow}");
        }

        #[test]
        fn the_best_of_the_grid_is_the_best_by_definition(stakes in stakes(), other in 5..=95) {
            let theory = ProspectTheory::default();
            let utility = |own: i32| {
                theory.utility(&mut stakes.lottery(f64::from(own) / 100.0, f64::from(other) / 100.0))
            };
            let found = utility(THEORY.player(stakes).best_of(5..=95, other));
            let best = (5..=95).map(utility).fold(f64::NEG_INFINITY, f64::max);
            prop_assert!(found >= best - 1e-9 * (1.0 + best.abs()), "{found} against {best}");
        }
    }

    proptest! {
        #[test]
        fn with_bounded_stakes_the_accident_is_worst(ratio in 1e-3..1e3, accident in 1e-3..1e3) {
            let [[stalemate, wait], [turn, crash]] = Stakes::bounded(ratio, accident).payoffs();
            prop_assert!([stalemate, wait, turn].iter().all(|payoff| *payoff > crash));
        }

        /// Gains and losses are powers of the same exponent, so the scale of the payoffs divides out.
        #[test]
        fn with_bounded_stakes_only_the_ratio_matters(ratio in 0.05..19.0, accident in 0.1..50.0, other in 0.05..0.95) {
            let share = |accident: f64| {
                let player = THEORY.player(Stakes::bounded(ratio, accident));
                (player.utility(1.0, other) - player.utility(0.0, other)) / player.accident_value()
            };
            prop_assert!((share(accident) - share(4.0)).abs() < 1e-9);
        }
    }

    #[test]
    fn the_payoffs_are_those_of_the_table() {
        let payoffs = Stakes { turn: 0.5, accident: 2.0 }.payoffs();
        assert_eq!(payoffs, [[-1.0, -0.5], [0.5, -2.0]]);
    }

    #[test]
    fn the_probabilities_of_a_lottery_add_up_to_one() {
        let lottery = Stakes { turn: 1.0, accident: 2.0 }.lottery(0.3, 0.8);
        assert!((lottery.iter().map(|outcome| outcome.probability).sum::<f64>() - 1.0).abs() < 1e-15);
    }
}
