//! The beliefs of a driver about the others, with the time since when it holds them.

use interplay_planners::scene::driver_estimate::DriverEstimate;

/// The latest beliefs of one vehicle's driver about the others.
#[derive(Clone, Debug, Default)]
pub struct Beliefs(Vec<HeldBelief>);

/// A belief of a driver.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldBelief {
    /// The latest estimate.
    pub estimate: DriverEstimate,
    /// Time since when the other has been classified as this kind of driver \[s\].
    pub since_s: f64,
}

impl Beliefs {
    /// Updates the beliefs with the estimates of one tick; beliefs about vehicles that are out of sight are kept.
    pub fn observe(&mut self, estimates: &[DriverEstimate], time_s: f64) {
        for estimate in estimates {
            match self.0.iter_mut().find(|held| held.estimate.vehicle == estimate.vehicle) {
                Some(held) => {
                    if held.estimate.model != estimate.model {
                        held.since_s = time_s;
                    }
                    held.estimate = estimate.clone();
                }
                None => self.0.push(HeldBelief { estimate: estimate.clone(), since_s: time_s }),
            }
        }
    }

    /// The latest beliefs, in the order in which the others were first seen.
    pub fn held(&self) -> impl Iterator<Item = &HeldBelief> {
        self.0.iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use interplay_planners::scene::driver_estimate::DriverModel;

    fn estimate(model: DriverModel, entropy: f64) -> DriverEstimate {
        DriverEstimate {
            vehicle: "other".to_owned(),
            model,
            probabilities: [0.2; 5],
            safety_weight: 20.0,
            safety_weight_interval: [0.0, 100.0],
            entropy,
        }
    }

    #[test]
    fn a_belief_is_dated_from_the_last_change_of_the_driver_kind() {
        let mut beliefs = Beliefs::default();
        let kinds = [DriverModel::Nice, DriverModel::Nice, DriverModel::Tough, DriverModel::Tough];
        for (tick, kind) in kinds.into_iter().enumerate() {
            beliefs.observe(&[estimate(kind, tick as f64)], 0.1 * tick as f64);
        }
        beliefs.observe(&[], 0.4);
        let held: Vec<&HeldBelief> = beliefs.held().collect();
        assert_eq!(held, [&HeldBelief { estimate: estimate(DriverModel::Tough, 3.0), since_s: 0.2 }]);
    }
}
