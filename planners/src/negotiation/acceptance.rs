//! How far the other accepted the last proposal (eq. 6.19).

use crate::Trajectory;

/// Squared distance of proposal and old prediction below which nothing was asked \[m²\].
const MIN_ASKED_DEVIATION_M2: f64 = 1e-3;
/// Keeps the share defined when the other neither moved nor was far from the proposal \[m²\].
const SHARE_REGULARISATION_M2: f64 = 1e-4;

/// The acceptance probability `p_a` (eq. 6.19, corrected): with `a` the squared distance of the other's new prediction
/// from its old one and `b` that from the proposal, `(a + ε)/(a + b + ε)`.
///
/// As printed it is 0/0 when nothing changes and tends to one half when the proposal is the old plan, so that the ego
/// concedes to a driver who does all it asks. Here a proposal that asks for nothing is always accepted.
///
/// All three trajectories begin at the present step.
pub fn acceptance(prediction: &Trajectory, old_prediction: &Trajectory, proposal: &Trajectory) -> f64 {
    if proposal.squared_distance(old_prediction) < MIN_ASKED_DEVIATION_M2 {
        return 1.0;
    }
    let moved = prediction.squared_distance(old_prediction);
    let missed = prediction.squared_distance(proposal);
    (moved + SHARE_REGULARISATION_M2) / (moved + missed + SHARE_REGULARISATION_M2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::State;
    use crate::predict::constant_velocity;

    fn at(speed_mps: f64) -> Trajectory {
        constant_velocity(&State { speed_mps, ..State::default() }, 30, 0.1)
    }

    #[test]
    fn it_is_one_when_the_proposal_is_followed_and_near_zero_when_it_is_ignored() {
        assert!(acceptance(&at(0.5), &at(1.0), &at(0.5)) > 0.9999);
        assert!(acceptance(&at(1.0), &at(1.0), &at(0.5)) < 1e-4);
    }

    #[test]
    fn it_grows_as_the_prediction_moves_to_the_proposal() {
        let shares = [1.0, 0.9, 0.8, 0.7, 0.6, 0.5].map(|speed| acceptance(&at(speed), &at(1.0), &at(0.5)));
        assert!(shares.windows(2).all(|pair| pair[0] < pair[1]), "{shares:?}");
    }

    #[test]
    fn a_proposal_that_asks_for_nothing_is_accepted() {
        assert_eq!(acceptance(&at(1.0), &at(1.0), &at(1.0)), 1.0);
    }
}
