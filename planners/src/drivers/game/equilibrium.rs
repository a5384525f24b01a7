//! The game's two solutions.
//!
//! [`leader_follower`] is the source's procedure (eq. 8.8, 8.9), which it calls a Nash equilibrium: the ego chooses the
//! `p_e` that serves it best when the other answers with its best response. That is Stackelberg's solution.
//!
//! [`nash`] is a pair from which neither gains by deviating alone: a fixed point of `p ↦ reply_e(reply_s(p))`. As
//! utilities are not concave in the own probability, responses may jump, so that an equilibrium need not exist; with the
//! stakes that occur one nearly always does. The map is followed over the grid, and where it crosses the diagonal the
//! crossing is refined and checked. Of several equilibria the source wants the mixed one: that with more
//! intentions off their bounds wins, then the risk-dominant one (Harsanyi and Selten: the larger product of what the
//! players lose by turning to the other end). Should there be none, the pair on the grid that tempts least is returned;
//! [`GameSolution::temptation`] tells.

use super::best_response::{
    GRID_CELL, GRID_POINTS, MAX_INTENTION, MIN_INTENTION, best_of, best_response, grid_response, intention, maximum,
    reply_near,
};
use super::payoff::Player;

/// Utilities closer than this are equal.
const MAX_EQUILIBRIUM_TEMPTATION: f64 = 1e-9;
/// Steps of the leader's golden section: to some 10⁻⁴.
const LEADER_REFINEMENT_STEPS: usize = 10;
/// Most steps towards a crossing.
const CROSSING_BISECTION_STEPS: usize = 24;

/// The solution of a game: an intention of each player, with what it is worth to them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GameSolution {
    /// Probability with which the ego passes, `p_e`.
    pub ego: f64,
    /// Probability with which the other passes, `p_s`.
    pub other: f64,
    /// Utilities of the ego and of the other.
    pub utilities: [f64; 2],
    /// By how much the ego and the other could gain by deviating alone; both zero in an equilibrium.
    pub temptation: [f64; 2],
}

/// The ego leads, the other follows (eq. 8.8, 8.9).
///
/// The grid finds where maxima are. It rounds responses, and utilities may be steep in them, so that which maximum is the
/// highest is told by exact responses.
pub fn leader_follower(ego: &Player, other: &Player) -> GameSolution {
    let rough: [f64; GRID_POINTS] =
        std::array::from_fn(|own| ego.utility(intention(own), intention(grid_response(other, own))));
    let led = |own: f64| ego.utility(own, best_response(other, own));
    let peaks: Vec<f64> = (0..GRID_POINTS).filter(|own| is_peak(&rough, *own)).map(intention).collect();
    let highest = peaks.get(best_of(peaks.iter().map(|own| led(*own)))).copied().unwrap_or(MIN_INTENTION);
    let own = maximum(led, highest, GRID_CELL, LEADER_REFINEMENT_STEPS);
    solution(ego, other, own, best_response(other, own))
}

/// Whether no neighbour has a larger value.
fn is_peak(values: &[f64], index: usize) -> bool {
    let before = index.checked_sub(1).map(|before| values[before]);
    [before, values.get(index + 1).copied()].into_iter().flatten().all(|beside| beside <= values[index])
}

/// A Nash equilibrium in mixed strategies: no player gains by another intention while the other keeps its own.
pub fn nash(ego: &Player, other: &Player) -> GameSolution {
    let answers = [ego, other].map(|player| std::array::from_fn(|point| intention(grid_response(player, point))));
    let around = |own: f64| {
        let theirs = reply_near(other, own, between(&answers[1], own));
        reply_near(ego, theirs, between(&answers[0], theirs)) - own
    };
    let mut best: Option<(Rank, GameSolution)> = None;
    for bracket in crossings(&answers) {
        let own = root(around, bracket);
        let found = solution(ego, other, own, best_response(other, own));
        let rank = Rank::evaluate(ego, other, &found);
        let tempting = found.temptation.iter().any(|gain| *gain > MAX_EQUILIBRIUM_TEMPTATION);
        if !tempting && best.as_ref().is_none_or(|(held, _)| rank.beats(held)) {
            best = Some((rank, found));
        }
    }
    best.map_or_else(|| least_tempting(ego, other), |(_, found)| found)
}

/// What a pair of intentions is worth to both, and how much it tempts them.
pub(super) fn solution(ego: &Player, other: &Player, own: f64, theirs: f64) -> GameSolution {
    let utilities = [ego.utility(own, theirs), other.utility(theirs, own)];
    let best = [ego.utility(best_response(ego, theirs), theirs), other.utility(best_response(other, own), own)];
    let temptation = [best[0] - utilities[0], best[1] - utilities[1]].map(|gain| gain.max(0.0));
    GameSolution { ego: own, other: theirs, utilities, temptation }
}

/// A response between two grid points, if responses do not jump there.
fn between(answers: &[f64; GRID_POINTS], to: f64) -> f64 {
    let scaled = ((to - MIN_INTENTION) / GRID_CELL).clamp(0.0, (GRID_POINTS - 1) as f64);
    let point = (scaled as usize).min(GRID_POINTS - 2);
    let share = scaled - point as f64;
    (1.0 - share) * answers[point] + share * answers[point + 1]
}

/// Where the responses to responses cross the diagonal: intervals of the ego's intention.
fn crossings([ego, other]: &[[f64; GRID_POINTS]; 2]) -> Vec<[f64; 2]> {
    let above = |point: usize| between(ego, other[point]) - intention(point);
    // What a grid response says is true to half a cell.
    let touches = |point: usize| above(point).abs() < GRID_CELL;
    let mut found: Vec<[f64; 2]> = Vec::new();
    for point in 0..GRID_POINTS {
        let crosses = point + 1 < GRID_POINTS && above(point) * above(point + 1) < 0.0;
        if !(touches(point) || crosses) {
            continue;
        }
        let low = intention(point.saturating_sub(1));
        let high = intention((point + 1).min(GRID_POINTS - 1));
        match found.last_mut() {
            Some(last) if last[1] >= low => last[1] = high,
            _ => found.push([low, high]),
        }
    }
    found
}

/// A root of `f` in an interval by regula falsi (Illinois); an end where `f` vanishes, or is least if it does not change sign.
fn root(f: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    let (mut at_low, mut at_high) = (f(low), f(high));
    if at_low * at_high >= 0.0 {
        return if at_low.abs() <= at_high.abs() { low } else { high };
    }
    let mut kept = 0;
    for _ in 0..CROSSING_BISECTION_STEPS {
        let middle = low - at_low * (high - low) / (at_high - at_low);
        let at_middle = f(middle);
        if at_middle.abs() < MAX_EQUILIBRIUM_TEMPTATION {
            return middle;
        }
        if at_middle * at_low > 0.0 {
            (low, at_low) = (middle, at_middle);
            at_high *= if kept == 1 { 0.5 } else { 1.0 };
            kept = 1;
        } else {
            (high, at_high) = (middle, at_middle);
            at_low *= if kept == -1 { 0.5 } else { 1.0 };
            kept = -1;
        }
    }
    0.5 * (low + high)
}

/// What decides between equilibria.
#[derive(Clone, Copy, Debug)]
struct Rank {
    /// How many intentions are off their bounds.
    mixed: usize,
    /// The product of what the players lose by turning to the other end.
    risk: f64,
}

impl Rank {
    fn evaluate(ego: &Player, other: &Player, at: &GameSolution) -> Rank {
        let inside = |p: f64| p > MIN_INTENTION + GRID_CELL / 10.0 && p < MAX_INTENTION - GRID_CELL / 10.0;
        let turned = |p: f64| if p > 0.5 { MIN_INTENTION } else { MAX_INTENTION };
        let losses = [
            at.utilities[0] - ego.utility(turned(at.ego), at.other),
            at.utilities[1] - other.utility(turned(at.other), at.ego),
        ];
        let mixed = [at.ego, at.other].into_iter().filter(|p| inside(*p)).count();
        Rank { mixed, risk: losses[0] * losses[1] }
    }

    fn beats(&self, held: &Rank) -> bool {
        (self.mixed, self.risk) > (held.mixed, held.risk)
    }
}

/// The pair on the grid whose larger temptation is least.
fn least_tempting(ego: &Player, other: &Player) -> GameSolution {
    let mut best = GameSolution { temptation: [f64::INFINITY; 2], ..GameSolution::default() };
    let worst = |at: &GameSolution| at.temptation[0].max(at.temptation[1]);
    let responses = |player: &Player| -> [f64; GRID_POINTS] {
        std::array::from_fn(|point| player.utility(best_response(player, intention(point)), intention(point)))
    };
    let (ego_best, other_best) = (responses(ego), responses(other));
    for i in 0..GRID_POINTS {
        for j in 0..GRID_POINTS {
            let (own, theirs) = (intention(i), intention(j));
            let utilities = [ego.utility(own, theirs), other.utility(theirs, own)];
            let temptation = [ego_best[j] - utilities[0], other_best[i] - utilities[1]].map(|gain| gain.max(0.0));
            let at = GameSolution { ego: own, other: theirs, utilities, temptation };
            if worst(&at) < worst(&best) {
                best = at;
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drivers::game::payoff::{Stakes, THEORY};
    use crate::drivers::game::prospect::ProspectTheory;
    use proptest::prelude::*;

    /// Stakes of the ego and the other as they arise from intentions.
    fn stakes() -> impl Strategy<Value = [Stakes; 2]> {
        let p = || MIN_INTENTION..MAX_INTENTION;
        (p(), p(), p(), prop::sample::select(vec![1.0, 2.0, 3.0])).prop_map(|(own, seen, theirs, accident)| {
            [Stakes { turn: own / theirs, accident }, Stakes { turn: theirs / seen, accident }]
        })
    }

    /// What a deviation gains, by the definition and not by the tables.
    fn gain(stakes: Stakes, own: f64, other: f64, instead: f64) -> f64 {
        let theory = ProspectTheory::default();
        theory.utility(&mut stakes.lottery(instead, other)) - theory.utility(&mut stakes.lottery(own, other))
    }

    fn deviations() -> impl Iterator<Item = f64> {
        (0..=450).map(|i| MIN_INTENTION + 0.002 * f64::from(i))
    }

    fn solved(stakes: [Stakes; 2], by: fn(&Player, &Player) -> GameSolution) -> GameSolution {
        by(&THEORY.player(stakes[0]), &THEORY.player(stakes[1]))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        #[test]
        fn no_player_gains_by_leaving_an_equilibrium_alone(stakes in stakes()) {
            let at = solved(stakes, nash);
            prop_assert!(at.temptation.iter().all(|gain| *gain <= MAX_EQUILIBRIUM_TEMPTATION), "{at:?}");
            for instead in deviations() {
                let gains = [
                    gain(stakes[0], at.ego, at.other, instead),
                    gain(stakes[1], at.other, at.ego, instead),
                ];
                prop_assert!(gains.iter().all(|gain| *gain < 1e-6), "{at:?}: {instead} gains {gains:?}");
            }
        }

        /// The leader could have chosen the equilibrium's intention too.
        #[test]
        fn a_leader_is_served_no_worse_than_in_an_equilibrium(stakes in stakes()) {
            let (led, at) = (solved(stakes, leader_follower), solved(stakes, nash));
            prop_assert!(led.utilities[0] >= at.utilities[0] - 1e-4 * (1.0 + stakes[0].turn), "{led:?}, {at:?}");
        }

        #[test]
        fn a_leader_gains_nothing_by_another_intention(stakes in stakes(), instead in MIN_INTENTION..MAX_INTENTION) {
            let [ego, other] = stakes.map(|stakes| THEORY.player(stakes));
            let led = leader_follower(&ego, &other);
            prop_assert_eq!(led.temptation[1], 0.0, "the follower follows");
            // The optimum on the grid may miss a maximum next to a jump of the responses by part of a cell.
            let margin = 2e-2 * (1.0 + stakes[0].turn);
            prop_assert!(ego.utility(instead, best_response(&other, instead)) <= led.utilities[0] + margin);
        }
    }

    #[test]
    fn a_player_waits_if_waiting_costs_it_little() {
        let (eager, patient) = (Stakes { turn: 6.0, accident: 2.0 }, Stakes { turn: 0.2, accident: 2.0 });
        for by in [leader_follower, nash] {
            let at = solved([eager, patient], by);
            assert_eq!((at.ego, at.other), (MAX_INTENTION, MIN_INTENTION));
            let at = solved([patient, eager], by);
            assert_eq!((at.ego, at.other), (MIN_INTENTION, MAX_INTENTION));
        }
    }

    #[test]
    fn a_pair_that_tempts_least_is_what_it_says() {
        let stakes = [Stakes { turn: 1.0, accident: 2.0 }, Stakes { turn: 0.7, accident: 2.0 }];
        let [ego, other] = stakes.map(|stakes| THEORY.player(stakes));
        let at = least_tempting(&ego, &other);
        assert!((at.utilities[0] - ego.utility(at.ego, at.other)).abs() < 1e-15);
        assert!(at.temptation.iter().all(|gain| (0.0..1e-2).contains(gain)), "{at:?}");
        assert!(nash(&ego, &other).temptation.iter().all(|gain| *gain <= MAX_EQUILIBRIUM_TEMPTATION));
    }
}
