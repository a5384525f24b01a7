//! The ego's plan and a proposal to the other, decided together (eq. 6.14-6.17, 6.24).
//!
//! ```text
//! minimise  w/Z₁ Σ (‖x₁ − x_des‖²_Q + ‖Δu₁‖²_R)  +  (1 − w)/Z₂ Σ ‖x₂ − x₂ᴾ‖²_D  +  10⁻² Σ ‖Δu₂‖²
//! such that both obey the bicycle, their bounds and their roads, the ego keeps out of the other's ellipse and of
//! the predicted ones of all others, the other follows its prediction until T_n, and the ego leans (eq. 6.23)
//! ```
//!
//! Corrections of the source: safety holds against the *decision* `x₂`, not against the prediction (6.15 as printed makes
//! the prediction itself optimal); the deviation is squared (6.17 prints a norm, not smooth at its minimiser), with weights
//! `D` = (1, 1, 0.1, 0.5) on (x, y, θ, v); `Δu` in 6.14 is vehicle 1's; the other's comfort costs a little.
//!
//! That the other follows its prediction until `T_n` is imposed exactly: those inputs are no unknowns.
//!
//! With several others `j` (the source has one) there is one problem for all of them. Each has its own `w_j`, lowered by its own
//! refusals, and the ratio of the ego's cost to each deviation is the one of a negotiation with this vehicle alone: with the
//! least weight `w = min w_j` the ego's cost has the factor `w/Z₁` and the deviation of `j` the factor `(w/w_j)(1 − w_j)/Z₂`.
//! The others keep apart from one another by the ego's ellipse, or by the part of it that they plan to keep.

use super::Settings;
use crate::trajectory::terms::{Comfort, Persuasion, Tracking};
use crate::trajectory::{Optimiser, Participant, Penalty, Problem, Robust, RouteStart, Term};
use crate::{Agent, Axes, Bicycle, Goal, Limits, SafetyEllipse, Scene};

/// Diagonal of `D` on (x, y, θ, v) for 1/10 scale cars.
const DEVIATION_WEIGHTS: [f64; 4] = [1.0, 1.0, 0.1, 0.5];
/// Those that are asked keep at least this share of the ellipse between them, however near they plan to come.
const LEAST_DISTANCE_SHARE: f64 = 0.3;
/// Weight of the other's changes of input.
const OTHER_COMFORT_WEIGHT: f64 = 1e-2;

/// Most work of a descent: a problem that needs more has no proposal that the safety filter would admit. With 100 here and 60 below
/// three of 108 authored scenarios fail.
const WORK_LIMIT: usize = 300;
/// Most work of comparing homotopy classes in a plan but the first. Proposals are renewed at every step and may be compared over
/// several; a planner that asks no vehicle decides by its comparison and makes it at once.
const COMPARISON_WORK_LIMIT: usize = 200;

/// An optimiser for the negotiation problem.
pub fn optimiser(settings: &Settings) -> Optimiser<Robust> {
    let mut optimiser = Optimiser::receding_horizon(Robust::default()).searching(settings.passing_orders);
    optimiser.tolerances.work_limit = WORK_LIMIT;
    optimiser.tolerances.comparison_work_limit = COMPARISON_WORK_LIMIT;
    optimiser
}

/// A vehicle to which a proposal is made.
#[derive(Clone, Copy, Debug)]
pub struct AskedPartner<'a> {
    /// The asked vehicle.
    pub agent: &'a Agent,
    /// The weight `w` that concession to it has left to the ego's cost.
    pub weight: f64,
}

/// The negotiation problem: participant 0 is the ego, the others are those that are asked, in their order.
pub fn problem(scene: &Scene, asked: &[AskedPartner], persuasion: Option<Persuasion>, settings: &Settings) -> Problem {
    let weight = asked.iter().map(|partner| partner.weight).fold(f64::INFINITY, f64::min);
    let share = weight / settings.ego_normaliser;
    let Goal { tracking, comfort, .. } = scene.goal;
    let goal = Goal { tracking: tracking.map(|q| share * q), comfort: comfort.map(|r| share * r), ..scene.goal };
    let mut terms = scene.own_terms(0, &goal);
    let is_asked = |other: &&Agent| asked.iter().any(|partner| partner.agent.name == other.name);
    terms.extend(scene.exact_keep_outs(scene.others.iter().filter(|other| !is_asked(other))));
    for (index, AskedPartner { agent, weight: own_weight }) in asked.iter().enumerate() {
        let vehicle = index + 1;
        let share = weight / own_weight * (1.0 - own_weight) / settings.other_normaliser;
        terms.extend(partner_terms(scene, agent, vehicle, share));
        terms.push(scene.separation(scene.room_asked_of(agent), 0, vehicle, agent));
    }
    for (index, partner) in asked.iter().enumerate() {
        let before = asked[..index].iter().enumerate().filter(|(_, other)| other.agent.may_meet(partner.agent));
        terms.extend(before.map(|(other, by)| {
            let safety = planned_distance(scene, by.agent, partner.agent);
            scene.separation(safety, other + 1, index + 1, partner.agent)
        }));
    }
    terms.extend(persuasion.map(Term::Persuasion));
    let partners = asked.iter().map(|partner| participant(scene, partner.agent, settings));
    let participants = std::iter::once(scene.participant()).chain(partners).collect();
    Problem { horizon: scene.horizon, participants, shared_steps: 0, terms }
}

/// The ego's ellipse, or as large a part of it as one vehicle plans to keep out of around another.
fn planned_distance(scene: &Scene, vehicle: &Agent, from: &Agent) -> SafetyEllipse {
    let nearest = scene.keep_out(&from.prediction, &from.route, Penalty::EXACT).nearest(&vehicle.prediction.states);
    let share = libm::sqrt(nearest.min(1.0)).max(LEAST_DISTANCE_SHARE);
    let SafetyEllipse { along_m, across_m } = scene.goal.safety;
    SafetyEllipse { along_m: share * along_m, across_m: share * across_m }
}

/// The partner as a participant that follows its prediction until `T_n`.
fn participant(scene: &Scene, partner: &Agent, settings: &Settings) -> Participant {
    let settled = settings.settled_steps.min(scene.horizon - 1);
    let inputs = &partner.prediction.inputs;
    Participant {
        model: Bicycle::new(&partner.body, scene.step_s),
        limits: partner.limits,
        // Its known inputs may lead it beyond what the rules permit and what is comfortable.
        stage_bounds: Agent { limits: Limits { comfort: None, ..partner.limits }, ..partner.clone() }.stage_bounds(
            scene.horizon,
            scene.step_s,
            &[],
        ),
        start: partner.state,
        previous_input: partner.previous_input,
        known_inputs: (0..settled).map(|t| inputs.get(t).copied().unwrap_or_default()).collect(),
        route_start: RouteStart::new(&partner.route, &partner.state),
    }
}

/// What the partner prefers: its own prediction.
fn partner_terms(scene: &Scene, partner: &Agent, vehicle: usize, share: f64) -> [Term; 3] {
    let states = &partner.prediction.states;
    let last = states.last().copied().unwrap_or(partner.state);
    let targets = (1..=scene.horizon).map(|t| states.get(t).copied().unwrap_or(last)).collect();
    let (scale, [x, y, heading, speed]) = (partner.body.scale, DEVIATION_WEIGHTS);
    let weights = [x / (scale * scale), y / (scale * scale), heading, speed / scale].map(|d| share * d);
    [
        Term::Comfort(Comfort { vehicle, weights: [OTHER_COMFORT_WEIGHT; 2] }),
        Term::Tracking(Tracking { vehicle, weights, axes: Axes::WORLD, targets }),
        Term::RoadEdge(partner.road_edge(vehicle)),
    ]
}
