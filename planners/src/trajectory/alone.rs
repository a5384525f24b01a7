//! The problem of one deciding vehicle while the motions of the others are fixed.

use super::iterate::Iterate;
use super::problem::Problem;
use super::terms::{KeepOut, Separation, Term};

impl Problem {
    /// What one vehicle would solve alone, as number 0, if it knew that the others keep to `iterate`.
    ///
    /// Its own terms stay. A separation from another vehicle becomes an ellipse around that vehicle's motion: the squared
    /// elliptical distance is symmetric, so it does not matter which of the two was in the centre.
    pub fn alone(&self, vehicle: usize, iterate: &Iterate) -> Problem {
        let terms = self.terms.iter().filter_map(|term| match term {
            Term::Separation(separation) => apart_from_fixed(separation, vehicle, iterate),
            own => own.of_vehicle(vehicle),
        });
        Problem {
            horizon: self.horizon,
            shared_steps: 0,
            terms: terms.collect(),
            participants: vec![self.participants[vehicle].clone()],
        }
    }
}

/// A separation of a vehicle from another whose motion is fixed; none if it does not concern the vehicle.
fn apart_from_fixed(separation: &Separation, vehicle: usize, iterate: &Iterate) -> Option<Term> {
    let other = match (separation.vehicle, separation.from) {
        (own, other) if own == vehicle => other,
        (other, own) if own == vehicle => other,
        _ => return None,
    };
    let centres = iterate.states[other].iter().skip(1).map(|state| state.position()).collect();
    let Separation { ellipses, penalty, .. } = separation.clone();
    Some(Term::KeepOut(KeepOut { vehicle: 0, centres, ellipses, penalty }))
}
