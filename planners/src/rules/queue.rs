//! Whether a vehicle waits for a reason that others see: then it is a queue, which is followed and never passed by leaving the lane.
//!
//! A reason is a line before which the rules hold the vehicle (a sign, a light, a crossing, a vehicle with priority), or its indicator.
//! A vehicle close behind one that waits belongs to its queue, and one that still stands behind one that moves off. How long it has stood, and whether it stood when it was first seen,
//! says nothing.

use super::giving_way::{front_m, length_m};
use crate::Agent;
use crate::scene::relation::is_standing;

/// A vehicle waits at a line that is at most this many lengths of its body ahead, besides the way in which it stops in comfort.
const LINE_LENGTHS: f64 = 3.0;
/// A vehicle belongs to the queue of one ahead that is at most this many lengths of its body before it, besides the way in which it
/// stops in comfort.
const QUEUE_LENGTHS: f64 = 2.5;
/// A vehicle that comes to a queue brakes with this deceleration \[m/s²\].
const COMFORTABLE_MPS2: f64 = 1.5;

/// Whether a vehicle waits, or slows down, for a visible reason, alone or behind others that do.
pub(super) fn waits<'a>(agent: &'a Agent, others: impl Iterator<Item = &'a Agent> + Clone) -> bool {
    let mut last = agent;
    let mut most = others.clone().count();
    loop {
        if last.is_obstacle {
            return false;
        }
        if is_held(last) {
            return true;
        }
        let next = next_ahead(last, others.clone());
        let Some(next) = next.filter(|_| most > 0) else { return false };
        if is_standing(last) && !is_standing(next) && !next.is_obstacle {
            return true;
        }
        (last, most) = (next, most - 1);
    }
}

/// Whether a line close ahead holds a vehicle, or whether it indicates.
fn is_held(agent: &Agent) -> bool {
    let is_near = |line_m: f64| line_m - front_m(agent) < reach_m(agent, LINE_LENGTHS);
    agent.rules.stop_line_m.is_some_and(is_near) || agent.indicator.is_some()
}

/// The vehicle ahead of another one to whose queue it belongs if that waits.
fn next_ahead<'a>(agent: &'a Agent, others: impl Iterator<Item = &'a Agent>) -> Option<&'a Agent> {
    let next = agent.leader_among(others.filter(|other| other.name != agent.name))?;
    let gap_m = agent.lead_of(next) - agent.body.front_m - next.body.rear_m;
    (gap_m < reach_m(agent, QUEUE_LENGTHS)).then_some(next)
}

/// A number of lengths of a vehicle, and the way in which it stops in comfort \[m\].
fn reach_m(agent: &Agent, lengths: f64) -> f64 {
    let speed_mps = agent.state.speed_mps;
    lengths * length_m(agent) + speed_mps * speed_mps / (2.0 * COMFORTABLE_MPS2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::real_car;

    #[test]
    fn a_vehicle_waits_that_stands_close_behind_one_that_is_held() {
        let mut first = real_car(40.0, 0.0);
        let [second, far] = [33.0, 5.0].map(|x_m| real_car(x_m, 0.0));
        let waiting = |first: &Agent| [first, &second, &far].map(|car| waits(car, [first, &second, &far].into_iter()));
        assert_eq!(waiting(&first), [false; 3], "no line holds the first");
        first.state.speed_mps = 1.0;
        assert_eq!(waiting(&first), [false, true, false], "the first moves off");
        first.state.speed_mps = 0.0;
        first.rules.stop_line_m = Some(43.0);
        assert_eq!(waiting(&first), [true, true, false]);
        first.is_obstacle = true;
        assert_eq!(waiting(&first), [false; 3]);
    }

    /// A line far ahead is not a reason to drive slowly; a fast vehicle stops in comfort before a nearer one.
    #[test]
    fn a_line_counts_within_the_way_in_which_a_vehicle_stops() {
        let mut car = real_car(0.0, 2.0);
        car.rules.stop_line_m = Some(60.0);
        assert!(!waits(&car, std::iter::empty()));
        car.state.speed_mps = 14.0;
        assert!(waits(&car, std::iter::empty()));
    }
}
