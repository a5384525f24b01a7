//! What a vehicle can still do when it has no plan, and how harmful that is.

use std::sync::Arc;

use super::violation::{expected, first_contact, first_off_road, is_farther, reach_m};
use crate::prediction::steady_inputs;
use crate::prediction::steering::{admissible, roll_out, steer};
use crate::{Agent, Input, Scene, State, Trajectory};

/// Accelerations of the last resorts, as shares of the strongest braking and acceleration.
const ACCELERATION_SHARES: [f64; 4] = [-1.0, -0.5, 0.0, 1.0];
/// Lateral positions of the last resorts besides straight on, in widths of the body to the left of the present one.
const ASIDE_WIDTHS: [f64; 5] = [0.0, 1.0, -1.0, 2.0, -2.0];
/// Corners may be beyond the edge by this share of the vehicle's length before that is called harmful; of people's vehicles by the
/// second one.
const SHOULDERS: [f64; 2] = [0.1, 0.01];
/// Impacts that differ by less are equally harmful \[m/s\].
const IMPACT_TOLERANCE_MPS: f64 = 1e-6;

/// The harm of a motion if all others move as predicted: the first impact, and leaving the road.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Harm {
    /// The largest relative speed at which it first touches a vehicle \[m/s\]; none without a contact.
    pub impact_mps: Option<f64>,
    /// Whether it leaves the road by more than a tenth of its length; of people's vehicles, by more than a hundredth.
    pub leaves_road: bool,
    /// Whether the road is not left in order to avoid a contact, or to weaken one.
    prefers_road: bool,
}

impl Harm {
    /// Measures the harm of a motion of the planning vehicle.
    pub fn measure(scene: &Scene, motion: &Trajectory) -> Harm {
        let impacts = scene.others.iter().filter_map(|other| {
            let stage = first_contact(scene, motion, other)?;
            Some(relative_speed_mps(&motion.states[stage], expected(other, stage)?))
        });
        // A value that is not a number counts as the worst.
        let impacts = impacts.map(|mps| if mps.is_nan() { f64::INFINITY } else { mps });
        // Beside a road there may be a wall or a footway.
        let prefers_road = scene.knowledge.is_of_motion();
        Harm {
            impact_mps: impacts.max_by(f64::total_cmp),
            leaves_road: first_off_road(scene, motion, SHOULDERS[usize::from(prefers_road)]).is_some(),
            prefers_road,
        }
    }

    /// Whether the motion touches no vehicle and stays on the road.
    pub fn is_none(&self) -> bool {
        self.impact_mps.is_none() && !self.leaves_road
    }

    /// Whether a motion does less harm than another: a weaker impact, and of equal impacts one that stays on the road. Among people the
    /// road comes first.
    fn is_less_than(&self, other: &Harm) -> bool {
        if self.prefers_road && self.leaves_road != other.leaves_road {
            return other.leaves_road;
        }
        match (self.impact_mps, other.impact_mps) {
            (None, Some(_)) => true,
            (Some(_), None) => false,
            (Some(own), Some(others)) if (own - others).abs() > IMPACT_TOLERANCE_MPS => own < others,
            _ => !self.leaves_road && other.leaves_road,
        }
    }
}

fn relative_speed_mps(one: &State, other: &State) -> f64 {
    let velocity = |state: &State| {
        let (sin, cos) = libm::sincos(state.heading_rad);
        [state.speed_mps * cos, state.speed_mps * sin]
    };
    let ([a, b], [c, d]) = (velocity(one), velocity(other));
    libm::hypot(a - c, b - d)
}

/// Simple motions that need no planner: from full braking to full acceleration, straight on or to a lateral position.
pub fn last_resorts(scene: &Scene) -> impl Iterator<Item = Trajectory> {
    let (ego, limits) = (&scene.ego, scene.ego.limits);
    let here_m = ego.across_m();
    let accelerations = ACCELERATION_SHARES
        .map(|share| share * if share < 0.0 { -limits.acceleration_min_mps2 } else { limits.acceleration_max_mps2 });
    let straight_on = accelerations.into_iter().map(|mps2| taken(scene, steady_inputs(scene, mps2)));
    let aside = ASIDE_WIDTHS.into_iter().flat_map(move |widths| {
        let across_m = here_m + widths * ego.body.width_m;
        accelerations.into_iter().map(move |mps2| {
            let mut last_rad = ego.previous_input.steering_rad;
            let motion = roll_out(scene, |_, state| {
                last_rad = limits.steering_towards_rad(last_rad, steer(ego, state, across_m), scene.step_s);
                Input { acceleration_mps2: admissible(ego, state, mps2, scene.step_s), steering_rad: last_rad }
            });
            if scene.knowledge.is_of_motion() { taken(scene, motion.inputs) } else { motion }
        })
    });
    straight_on.chain(aside)
}

/// Where inputs lead the planning vehicle. People change to the first of them evenly over the first step, so that half of the change counts
/// for the motion; the input itself is the one to which they change.
fn taken(scene: &Scene, inputs: Vec<Input>) -> Trajectory {
    let Some(first) = inputs.first().copied().filter(|_| scene.knowledge.is_of_motion()) else {
        return rolled_out(scene, inputs);
    };
    let (ego, mut on_average) = (&scene.ego, inputs);
    let half = |last: f64, next: f64| 0.5 * (last + next);
    on_average[0] = Input {
        acceleration_mps2: half(first.acceleration_mps2, ego.previous_input.acceleration_mps2),
        steering_rad: half(first.steering_rad, ego.previous_input.steering_rad),
    };
    on_average[0].acceleration_mps2 = admissible(ego, &ego.state, on_average[0].acceleration_mps2, scene.step_s);
    let mut motion = rolled_out(scene, on_average);
    motion.inputs[0] = first;
    motion
}

/// The least harmful of some motions with its index, the first of equals; `None` without motions.
pub fn least_harmful(scene: &Scene, motions: impl IntoIterator<Item = Trajectory>) -> Option<(usize, Trajectory)> {
    let mut best: Option<(usize, Trajectory, Harm)> = None;
    for (number, motion) in motions.into_iter().enumerate() {
        let harm = Harm::measure(scene, &motion);
        if harm.is_none() && best.is_none() {
            return Some((number, motion));
        }
        if best.as_ref().is_none_or(|(.., least)| harm.is_less_than(least)) {
            best = Some((number, motion, harm));
        }
    }
    best.map(|(number, motion, _)| (number, motion))
}

/// Whether a plan gives away the last way out: it touches a vehicle before the own one could stand, some last resort from here is
/// harmless, and from the place after its first step none is any more.
///
/// Where no harmless motion is left now, the plan is driven: of two motions with a contact, the one that was planned counts on
/// what the others will do next, and the other one on nothing.
pub fn gives_away_the_last_way_out(scene: &Scene, plan: &Trajectory) -> bool {
    let contact = early_contact(scene, plan).map(|(stage, _)| stage);
    if contact.is_none() {
        return false;
    }
    let is_left = |scene: &Scene| last_resorts(scene).any(|motion| Harm::measure(scene, &motion).is_none());
    // After a contact in the first step no way out remains.
    let is_over = contact <= Some(1);
    is_left(scene) && (is_over || !is_left(&after_first_step(scene, plan)))
}

/// Whether no last resort is harmless, and one does less harm than the plan.
pub(super) fn is_worse_than_a_last_resort(scene: &Scene, plan: &Trajectory) -> bool {
    let planned = Harm::measure(scene, plan);
    let harms: Vec<Harm> = last_resorts(scene).map(|motion| Harm::measure(scene, &motion)).collect();
    !harms.iter().any(Harm::is_none) && harms.iter().any(|harm| harm.is_less_than(&planned))
}

/// Whether a plan comes so near to a vehicle, which may be longer by some length \[m\], that they could touch.
pub(super) fn comes_near(scene: &Scene, plan: &Trajectory, longer_m: impl Fn(&Agent) -> f64) -> bool {
    scene.others.iter().any(|other| {
        let reach_m = reach_m(&scene.ego, other) + longer_m(other);
        plan.states.iter().enumerate().any(|(stage, here)| {
            expected(other, stage).is_some_and(|there| !is_farther(here.x_m - there.x_m, here.y_m - there.y_m, reach_m))
        })
    })
}

/// The vehicle that a plan touches first with the stage, if the own one could not stand before.
pub(super) fn early_contact<'a>(scene: &'a Scene, plan: &Trajectory) -> Option<(usize, &'a Agent)> {
    let braking_mps = -scene.ego.limits.acceleration_min_mps2 * scene.step_s;
    let could_stand = 1 + (scene.ego.state.speed_mps.abs() / braking_mps).ceil() as usize;
    let contacts = scene.others.iter().filter_map(|other| Some((first_contact(scene, plan, other)?, other)));
    contacts.min_by_key(|(stage, _)| *stage).filter(|(stage, _)| *stage <= could_stand)
}

/// The scene after the first step of a plan, if all vehicles move as expected.
fn after_first_step(scene: &Scene, plan: &Trajectory) -> Scene {
    let mut later = scene.clone();
    if let (Some(state), Some(input)) = (plan.states.get(1), plan.inputs.first()) {
        (later.ego.state, later.ego.previous_input) = (*state, *input);
    }
    for other in &mut later.others {
        other.prediction = Arc::new(other.prediction.shifted());
        other.state = other.prediction.states.first().copied().unwrap_or(other.state);
    }
    later
}

/// Where inputs lead the planning vehicle of a scene.
pub(crate) fn rolled_out(scene: &Scene, inputs: Vec<Input>) -> Trajectory {
    let mut states = Vec::new();
    scene.model().roll_out(&scene.ego.state, &inputs, &mut states);
    Trajectory { states, inputs }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{real_car, scene};
    use crate::prediction::{constant_velocity, steady};
    use crate::scene::Knowledge;

    /// To touch the car ahead at 1 m/s, or to leave the road beside it.
    #[test]
    fn people_stay_on_the_road_rather_than_avoid_a_contact() {
        let (ego, mut ahead) = (real_car(0.0, 3.0), real_car(6.0, 2.0));
        ahead.prediction = Arc::new(constant_velocity(&ahead.state, 30, 0.1));
        let mut scene = scene(ego.clone(), vec![ahead]);
        let straight = rolled_out(&scene, steady(&ego.state, 0.0, &ego.limits, 30, 0.1));
        let mut aside = straight.clone();
        (1..31).for_each(|stage| aside.states[stage].y_m = -(stage as f64));
        for (knowledge, prefers_road) in [(Knowledge::Plans, false), (Knowledge::Motion { late_steps: 0 }, true)] {
            scene.knowledge = knowledge;
            let [straight, aside] = [&straight, &aside].map(|motion| Harm::measure(&scene, motion));
            assert!(straight.impact_mps.is_some() && aside.leaves_road && aside.impact_mps.is_none());
            assert_eq!(straight.is_less_than(&aside), prefers_road);
            assert_eq!(aside.is_less_than(&straight), !prefers_road);
        }
    }
}
