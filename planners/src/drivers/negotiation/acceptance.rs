//! How far the other accepts what the ego proposes.
//!
//! **Willingness** (the default): the share of the room in the way of the ego's own proposed motion that the other has given
//! up since it was first asked,
//!
//! ```text
//! p_a = 1 − I(new plan) / I(first plan),      I(q) = Σ_t max(0, 1 − d²(p_t, q_t))
//! ```
//!
//! where `p` is the ego's motion in the last proposal, `q` a motion of the other and `d` the elliptical distance. Its first
//! plan is the one before the first proposal, continued. A driver who yields, in whatever way, reads 1; one who goes on as if
//! the ego had not asked reads 0. Where the first plan leaves the room free already nothing is asked, and `p_a` is 1.
//!
//! **As printed** (eq. 6.19, corrected): the share of the way from the other's last plan to the proposal that its new plan has
//! gone. It looks back one step only, so that a driver who has yielded completely a step before reads as one who refuses, and
//! it counts yielding in another way than the one proposed as refusal.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::vehicle::OrientedEllipse;
use crate::{State, Trajectory};

/// How the planner measures whether another vehicle accepts a proposal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Acceptance {
    /// How much of the room that the ego's proposed motion needs the other has given up since it was first asked.
    #[default]
    Willingness,
    /// How far the other's plan has moved to the proposal since the step before (eq. 6.19).
    AsPrinted,
}

/// Intrusion below which a motion leaves the room free: less than a tenth of an ellipse at one step.
pub(super) const MIN_INTRUSION: f64 = 0.1;

/// Squared distance of proposal and old prediction below which nothing was asked, for 1/10 scale cars \[m²\].
const MIN_ASKED_DEVIATION_M2: f64 = 1e-3;
/// Keeps the share defined when the other neither moved nor was far from the proposal, for 1/10 scale cars \[m²\].
const SHARE_REGULARISATION_M2: f64 = 1e-4;

/// The acceptance probability `p_a` (eq. 6.19, corrected): with `a` the squared distance of the other's new prediction
/// from its old one and `b` that from the proposal, `(a + ε)/(a + b + ε)`.
///
/// As printed it is 0/0 when nothing changes and tends to one half when the proposal is the old plan, so that the ego
/// concedes to a driver who does all it asks. Here a proposal that asks for nothing is always accepted.
///
/// All three trajectories begin at the present step; `scale` is the length of the other as a multiple of a 1/10 scale car's.
pub fn printed_acceptance(
    prediction: &Trajectory,
    old_prediction: &Trajectory,
    proposal: &Trajectory,
    scale: f64,
) -> f64 {
    let area = scale * scale;
    if proposal.squared_distance(old_prediction) < MIN_ASKED_DEVIATION_M2 * area {
        return 1.0;
    }
    let moved = prediction.squared_distance(old_prediction);
    let missed = prediction.squared_distance(proposal);
    let regularisation_m2 = SHARE_REGULARISATION_M2 * area;
    (moved + regularisation_m2) / (moved + missed + regularisation_m2)
}

/// Willingness: the share of its first plan's intrusion into the room of the ego's proposed motion that the other has given up.
///
/// All trajectories begin at the present step; `ellipse` is that of the ego around the other at a position of the other.
pub fn willingness(
    prediction: &Trajectory,
    first_plan: &Trajectory,
    proposed: &Trajectory,
    ellipse: impl Fn([f64; 2]) -> OrientedEllipse,
) -> f64 {
    let before = intrusion(first_plan, proposed, &ellipse);
    if before < MIN_INTRUSION {
        return 1.0;
    }
    (1.0 - intrusion(prediction, proposed, &ellipse) / before).clamp(0.0, 1.0)
}

/// `Σ_t max(0, 1 − d²)` over the common horizon, the present step left out.
pub(super) fn intrusion(
    other: &Trajectory,
    proposed: &Trajectory,
    ellipse: &impl Fn([f64; 2]) -> OrientedEllipse,
) -> f64 {
    let pairs = proposed.states.iter().zip(&other.states).skip(1);
    let depth = |(own, other): (&State, &State)| {
        let [own, centre] = [own, other].map(|state| state.position());
        (1.0 - ellipse(centre).distance(own, centre).squared).max(0.0)
    };
    pairs.map(depth).sum()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::prediction::{constant_velocity, steady};
    use crate::vehicle::Bicycle;
    use crate::{Body, Limits, SafetyEllipse, State};

    /// The ego's motion, and the other's when it brakes by a share of all it can, in one of three families.
    fn braking(family: usize, share: f64) -> (Trajectory, Trajectory, OrientedEllipse) {
        let own = |x_m, y_m, speed_mps| State { x_m, y_m, heading_rad: 0.0, speed_mps };
        let crossing = State { x_m: 0.0, y_m: -1.9, heading_rad: std::f64::consts::FRAC_PI_2, speed_mps: 0.8 };
        let (ego, other) = [
            (own(-2.4, 0.185, 1.0), crossing),
            (own(0.0, 0.5, 1.2), own(-0.4, 0.555, 1.4)),
            (own(0.0, 0.555, 1.3), own(-0.1, 0.5, 1.3)),
        ][family];
        let inputs = steady(&other, -share, &Limits::default(), 30, 0.1);
        let mut states = Vec::new();
        Bicycle::new(&Body::default(), 0.1).roll_out(&other, &inputs, &mut states);
        let ellipse = SafetyEllipse::default().oriented(other.heading_rad);
        (constant_velocity(&ego, 30, 0.1), Trajectory { states, inputs }, ellipse)
    }

    proptest! {
        /// Braking to let a vehicle in never lowers the willingness, in no family.
        #[test]
        fn braking_harder_never_reads_as_less_willing(family in 0_usize..3, share in 0.0..1.0, more in 0.0..1.0) {
            let (ego, first, ellipse) = braking(family, 0.0);
            let read = |share: f64| willingness(&braking(family, share).1, &first, &ego, |_| ellipse);
            let (gentle, hard) = (read(share), read(share + (1.0 - share) * more));
            prop_assert!(hard >= gentle - 1e-12, "{gentle} at {share}, then {hard}");
        }
    }

    #[test]
    fn continuing_reads_as_unwilling_and_stopping_as_willing() {
        for family in 0..3 {
            let (ego, first, ellipse) = braking(family, 0.0);
            assert_eq!(willingness(&first, &first, &ego, |_| ellipse), 0.0, "family {family}");
            let stopped = willingness(&braking(family, 1.0).1, &first, &ego, |_| ellipse);
            assert!(stopped > 0.3, "family {family}: {stopped}");
        }
    }

    fn at(speed_mps: f64) -> Trajectory {
        constant_velocity(&State { speed_mps, ..State::default() }, 30, 0.1)
    }

    #[test]
    fn it_is_one_when_the_proposal_is_followed_and_near_zero_when_it_is_ignored() {
        assert!(printed_acceptance(&at(0.5), &at(1.0), &at(0.5), 1.0) > 0.9999);
        assert!(printed_acceptance(&at(1.0), &at(1.0), &at(0.5), 1.0) < 1e-4);
    }

    #[test]
    fn it_grows_as_the_prediction_moves_to_the_proposal() {
        let shares =
            [1.0, 0.9, 0.8, 0.7, 0.6, 0.5].map(|speed| printed_acceptance(&at(speed), &at(1.0), &at(0.5), 1.0));
        assert!(shares.windows(2).all(|pair| pair[0] < pair[1]), "{shares:?}");
    }

    #[test]
    fn a_proposal_that_asks_for_nothing_is_accepted() {
        assert_eq!(printed_acceptance(&at(1.0), &at(1.0), &at(1.0), 1.0), 1.0);
    }
}
