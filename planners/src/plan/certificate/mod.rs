//! Certificates: whether a plan is what it should be, by geometry that shares nothing with how it was found.
//!
//! A plan must follow from its inputs by the bicycle (eq. 6.10), keep the limits of inputs and speed (eq. 6.9), keep the corners of
//! the body on the road (eq. 6.7), and keep the body itself, a rectangle and not an ellipse, clear of where the others are expected to
//! be. The first stage at which a condition is violated is reported. What is violated where the vehicle already is, no plan can mend: it
//! is not counted.
//!
//! Not every violation is a fault. A negotiator's plan counts on what it asks for, and a driver who looks 3 s ahead may touch
//! a vehicle at the end of them that it will avoid with the next plans. So a plan is refused if its states, inputs or speeds are wrong,
//! or if it gives away the last way out ([`gives_away_the_last_way_out`]). A driver without a plan takes the least harmful of going
//! on with the last plan and the [`last_resorts`].

mod last_resort;
mod rectangles;
mod violation;

pub(crate) use last_resort::rolled_out;
pub use last_resort::{Harm, gives_away_the_last_way_out, last_resorts, least_harmful};
use last_resort::{comes_near, early_contact, is_worse_than_a_last_resort};
pub use rectangles::overlap_m;
pub use violation::violations;
pub(crate) use violation::{touches_ahead, within_touch};

use crate::prediction::spread_m;
use crate::{Agent, PlanCondition, PlanViolation, Scene, Trajectory};

/// The violation for which a plan must not be driven, if there is one: a fault of the plan itself, or a contact with
/// which it gives
/// away the last way out.
pub fn refused<'a>(scene: &Scene, plan: &Trajectory, violations: &'a [PlanViolation]) -> Option<&'a PlanViolation> {
    let contact = violations.iter().find(|violation| matches!(violation.condition, PlanCondition::Clear(_)));
    let fault = violations.iter().find(|violation| violation.is_fault());
    fault.or_else(|| contact.filter(|_| gives_away_the_last_way_out(scene, plan)))
}

/// The same for a driver who sees the motion of the others only, with bodies as long as their spread. Where no motion without a contact
/// is left, a plan is refused if one with a weaker impact is.
pub fn refused_by_motion(scene: &Scene, plan: &Trajectory, violations: &[PlanViolation]) -> Option<PlanViolation> {
    let fault = violations.iter().find(|violation| violation.is_fault());
    fault.cloned().or_else(|| {
        if !comes_near(scene, plan, longer_m) {
            return None;
        }
        let scene = as_spread(scene);
        let (stage, other) = early_contact(&scene, plan)?;
        let is_refused = gives_away_the_last_way_out(&scene, plan) || is_worse_than_a_last_resort(&scene, plan);
        is_refused.then(|| PlanViolation { condition: PlanCondition::Clear(other.name.clone()), stage })
    })
}

/// The scene by which motions are judged where the motion of the others is all that is known: their bodies are longer by their spread
/// after a second, and those that follow the planning vehicle in its lane are left out, since they keep their distance.
pub(crate) fn as_spread(scene: &Scene) -> Scene {
    let ego = &scene.ego;
    let follows = |other: &Agent| ego.shares_lane_with(other) && ego.lead_of(other) < 0.0;
    let others = scene.others.iter().filter(|other| !follows(other)).map(spread).collect();
    Scene { others, ego: ego.clone(), ..*scene }
}

/// A vehicle as long as the places at which its body may be that is expected in a second.
fn spread(other: &Agent) -> Agent {
    let (mut other, longer_m) = (other.clone(), longer_m(other));
    other.body.front_m += longer_m;
    other.body.rear_m += longer_m;
    other
}

/// The spread of the place of a vehicle after a second \[m\].
fn longer_m(other: &Agent) -> f64 {
    if other.is_obstacle { 0.0 } else { spread_m(&other.body, other.body.real_ratio().sqrt()) }
}
