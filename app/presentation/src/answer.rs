//! What a vehicle answers to a proposal, in words.

use interplay_planners::{Plan, PlanEvent, PlanEventKind};

/// From this share of acceptance on a vehicle accepts, below the other it declines.
const ACCEPTS: f64 = 0.7;
const DECLINES: f64 = 0.3;

/// What a vehicle does that follows a proposal by a share from 0 to 1.
pub fn answer(share: f64) -> &'static str {
    match share {
        share if share >= ACCEPTS => "accepts",
        share if share < DECLINES => "declines",
        _ => "hesitates",
    }
}

/// Whether a plan is the first that asks a vehicle: nobody has answered it.
pub fn is_new(plan: &Plan, to: &str) -> bool {
    let names = |event: &PlanEvent| matches!(&event.kind, PlanEventKind::Partner(Some(partner)) if partner == to);
    plan.events.iter().any(names)
}
