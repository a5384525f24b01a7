//! The ego's plan and a proposal to the other, decided together (eq. 6.14-6.17, 6.24).
//!
//! ```text
//! minimise  w/Z₁ Σ (‖x₁ − x_des‖²_Q + ‖Δu₁‖²_R)  +  (1 − w)/Z₂ Σ ‖x₂ − x₂ᴾ‖²_D  +  10⁻² Σ ‖Δu₂‖²
//! such that both obey the bicycle, their bounds and their roads, the ego keeps out of the other's ellipse and of
//! everybody else's predicted one, the other follows its prediction until T_n, and the ego leans (eq. 6.23)
//! ```
//!
//! Corrections of the source: safety holds against the *decision* `x₂`, not against the prediction (6.15 as printed makes
//! the prediction itself optimal); the deviation is squared (6.17 prints a norm, not smooth at its minimiser), with weights
//! `D` = (1, 1, 0.1, 0.5) on (x, y, θ, v); `Δu` in 6.14 is vehicle 1's; the other's comfort costs a little.
//!
//! That the other follows its prediction until `T_n` is imposed exactly: those inputs are no unknowns.

use super::Settings;
use crate::scene::ellipses;
use crate::trajectory::terms::{Comfort, Persuasion, Separation, Tracking};
use crate::trajectory::{Optimiser, Participant, Penalty, Problem, Robust, RouteStart, Term};
use crate::{Agent, Axes, Bicycle, Goal, Scene};

/// Diagonal of `D` on (x, y, θ, v) for 1/10 scale cars.
const DEVIATION_WEIGHTS: [f64; 4] = [1.0, 1.0, 0.1, 0.5];
/// Weight of the other's changes of input.
const OTHER_COMFORT_WEIGHT: f64 = 1e-2;

/// Most work of a descent: a problem that needs more has no proposal that the safety filter would admit.
const WORK_LIMIT: usize = 300;
/// Most work of comparing passing orders in one plan. Proposals are renewed at every step and may be compared over several;
/// a planner that asks nobody decides by its comparison and makes it at once.
const COMPARISON_WORK_LIMIT: usize = 200;

/// What solves the negotiation problem.
pub fn optimiser(settings: &Settings) -> Optimiser<Robust> {
    let mut optimiser = Optimiser::resuming(Robust::default()).searching(settings.passing_orders);
    optimiser.tolerances.work_limit = WORK_LIMIT;
    optimiser.tolerances.comparison_work_limit = COMPARISON_WORK_LIMIT;
    optimiser
}

/// The negotiation problem: participant 0 is the ego, participant 1 the `partner`; `weight` is the concession weight `w`.
pub fn problem(
    scene: &Scene,
    partner: &Agent,
    weight: f64,
    persuasion: Option<Persuasion>,
    settings: &Settings,
) -> Problem {
    let share = weight / settings.ego_normaliser;
    let Goal { tracking, comfort, .. } = scene.goal;
    let goal = Goal { tracking: tracking.map(|q| share * q), comfort: comfort.map(|r| share * r), ..scene.goal };
    let mut terms = scene.own_terms(0, &goal);
    terms.extend(scene.exact_keep_outs(scene.others.iter().filter(|other| other.name != partner.name)));
    terms.extend(partner_terms(scene, partner, (1.0 - weight) / settings.other_normaliser));
    let ellipses = ellipses(scene.goal.safety, &partner.route, &scene.centres(&partner.prediction));
    terms.push(Term::Separation(Separation { vehicle: 0, from: 1, ellipses, penalty: Penalty::EXACT }));
    terms.extend(persuasion.map(Term::Persuasion));
    let participants = vec![scene.participant(), asked(scene, partner, settings)];
    Problem { horizon: scene.horizon, participants, shared_steps: 0, terms }
}

/// The partner as a participant that follows its prediction until `T_n`.
fn asked(scene: &Scene, partner: &Agent, settings: &Settings) -> Participant {
    let settled = settings.settled_steps.min(scene.horizon - 1);
    let inputs = &partner.prediction.inputs;
    Participant {
        model: Bicycle::new(&partner.body, scene.step_s),
        limits: partner.limits,
        steering_bounds_rad: partner.steering_bounds_rad(scene.horizon),
        start: partner.state,
        previous_input: partner.previous_input,
        known_inputs: (0..settled).map(|t| inputs.get(t).copied().unwrap_or_default()).collect(),
        route_start: RouteStart::new(&partner.route, &partner.state),
    }
}

/// What the partner prefers: its own prediction.
fn partner_terms(scene: &Scene, partner: &Agent, share: f64) -> [Term; 3] {
    let states = &partner.prediction.states;
    let last = states.last().copied().unwrap_or(partner.state);
    let targets = (1..=scene.horizon).map(|t| states.get(t).copied().unwrap_or(last)).collect();
    let (scale, [x, y, heading, speed]) = (partner.body.scale, DEVIATION_WEIGHTS);
    let weights = [x / (scale * scale), y / (scale * scale), heading, speed / scale].map(|d| share * d);
    [
        Term::Comfort(Comfort { vehicle: 1, weights: [OTHER_COMFORT_WEIGHT; 2] }),
        Term::Tracking(Tracking { vehicle: 1, weights, axes: Axes::WORLD, targets }),
        Term::RoadEdge(partner.road_edge(1)),
    ]
}
