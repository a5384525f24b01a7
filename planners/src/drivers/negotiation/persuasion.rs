//! Persuasion: a constraint that keeps the plan nearer to cooperation than to the fallback (eq. 6.20-6.23).

use super::settings::Settings;
use super::state::NegotiationState;
use crate::Trajectory;
use crate::trajectory::Penalty;
use crate::trajectory::terms::Persuasion;

/// Below this squared distance of cooperative and conservative plan of a 1/10 scale car the ball has collapsed \[m²\].
const MIN_REFERENCE_DISTANCE_M2: f64 = 1e-3;
/// What falling short costs a 1/10 scale car: mild, as persuasion must never overrule safety.
const PENALTY: Penalty = Penalty { linear: 100.0, quadratic: 0.0 };

/// The persuasion constraint `‖trj − con‖² ≥ α ‖trj − coop‖²`, `α = 1 + γ p_a` (eq. 6.23, corrected: as printed the right
/// norm is not squared). It starts with the second round, and is left out where the two references nearly coincide.
///
/// With the references of the last round the constraint only limits the rate at which the ego falls back: up to `1/(1 + √α)` of the way in
/// each step. With those of the first round it limits how far it falls back, until the negotiation ends.
pub(super) fn next_constraint(
    settings: &Settings,
    negotiation: &NegotiationState,
    accepted: f64,
    scale: f64,
) -> Option<Persuasion> {
    let round = negotiation.round(settings.references).filter(|_| settings.persuasion)?;
    persuasion(&round.cooperative, round.conservative.as_ref()?, 1.0 + settings.gamma * accepted, scale)
}

/// The persuasion constraint of strength `α` with a cooperative and a conservative reference; none where the two nearly
/// coincide. `scale` is the length of the vehicle as a multiple of a 1/10 scale car's.
pub fn persuasion(
    cooperative: &Trajectory,
    conservative: &Trajectory,
    strength: f64,
    scale: f64,
) -> Option<Persuasion> {
    let area = scale * scale;
    if conservative.squared_distance(cooperative) < MIN_REFERENCE_DISTANCE_M2 * area {
        return None;
    }
    Some(Persuasion {
        vehicle: 0,
        toward: positions(cooperative),
        away: positions(conservative),
        strength,
        penalty: Penalty { linear: PENALTY.linear / area, ..PENALTY },
    })
}

/// Whether the constraint holds with equality (or falls short).
pub(super) fn is_active(constraint: &Persuasion, trajectory: &Trajectory, scale: f64) -> bool {
    let apart: f64 = constraint
        .toward
        .iter()
        .zip(&constraint.away)
        .map(|(a, b)| (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2))
        .sum();
    constraint.value(&trajectory.states) > -1e-4 * apart.max(scale * scale)
}

/// Positions at `t = 0…N−1`.
fn positions(trajectory: &Trajectory) -> Vec<[f64; 2]> {
    trajectory.states.iter().take(trajectory.horizon()).map(|state| state.position()).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::references::References;
    use super::*;
    use crate::State;
    use crate::drivers::negotiation::state::NegotiationRound;
    use crate::prediction::constant_velocity;

    /// For α > 1 the constraint is the ball with the centre and radius that its documentation names.
    #[test]
    fn the_boundary_is_the_apollonius_ball() {
        let (toward, away, strength) = ([0.3, -0.1], [1.0, 0.4], 1.7);
        let constraint = Persuasion { vehicle: 0, toward: vec![toward], away: vec![away], strength, penalty: PENALTY };
        let centre: [f64; 2] = std::array::from_fn(|i| (strength * toward[i] - away[i]) / (strength - 1.0));
        let apart = ((toward[0] - away[0]).powi(2) + (toward[1] - away[1]).powi(2)).sqrt();
        let radius = strength.sqrt() * apart / (strength - 1.0);
        for angle in 0..12 {
            let (sin, cos) = libm::sincos(0.5 * f64::from(angle));
            let state = State { x_m: centre[0] + radius * cos, y_m: centre[1] + radius * sin, ..State::default() };
            assert!(constraint.value(&[state]).abs() < 1e-12);
        }
    }

    /// Steps of a negotiation in which no vehicle yields.
    const STEPS: usize = 10;

    /// Straight motion from a step on, at a speed that has gone back a share of the way from the cooperative one to the
    /// conservative one.
    fn motion(share: f64, step: usize) -> Trajectory {
        let from_start = constant_velocity(&State { speed_mps: 1.2 - 0.8 * share, ..State::default() }, 30, 0.1);
        (0..step).fold(from_start, |motion, _| motion.shifted())
    }

    /// How far an ego goes back that in each step plans the farthest step towards the fallback that the constraint allows.
    fn farthest_fallback(references: References, accepted: f64) -> f64 {
        let settings = Settings { references, ..Settings::default() };
        let mut negotiation = NegotiationState::default();
        let mut share = 0.0;
        for step in 0..STEPS {
            let [cooperative, conservative, proposal, prediction] =
                [share, 1.0, 0.0, 0.0].map(|share| motion(share, step));
            let conservative = Some(conservative);
            negotiation.remember(NegotiationRound { cooperative, conservative, proposal, prediction });
            let Some(constraint) = next_constraint(&settings, &negotiation, accepted, 1.0) else { return 1.0 };
            let holds = |share: f64| constraint.value(&motion(share, step + 1).states) <= 0.0;
            let mut bounds = [share, 1.0];
            for _ in 0..50 {
                let middle = 0.5 * (bounds[0] + bounds[1]);
                bounds[usize::from(!holds(middle))] = middle;
            }
            share = bounds[0];
        }
        share
    }

    proptest! {
        /// References of the last round let the ego fall back nearly completely, those of the first only up to their boundary.
        #[test]
        fn only_the_first_round_s_references_limit_the_fallback(accepted in 0.0..1.0) {
            let boundary = 1.0 / (1.0 + libm::sqrt(1.0 + accepted));
            prop_assert!((farthest_fallback(References::FirstRound, accepted) - boundary).abs() < 1e-9);
            prop_assert!(farthest_fallback(References::LastRound, accepted) > 0.98);
        }
    }
}
