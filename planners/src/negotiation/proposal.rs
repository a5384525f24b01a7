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
use crate::trajectory::{Leaning, Optimiser, Participant, Penalty, Problem, Robust, Separation, Tracking};
use crate::vehicle::Bicycle;
use crate::{Agent, Axes, Scene};

/// Diagonal of `D` on (x, y, θ, v).
const DEVIATION: [f64; 4] = [1.0, 1.0, 0.1, 0.5];
/// Weight of the other's changes of input.
const OTHER_COMFORT: f64 = 1e-2;

/// What solves the negotiation problem.
pub fn optimiser(settings: &Settings) -> Optimiser<Robust> {
    let mut optimiser = Optimiser::resuming(Robust::default());
    optimiser.looks_across = settings.look_across;
    optimiser
}

/// The negotiation problem: participant 0 is the ego, participant 1 the `partner`; `weight` is the concession weight `w`.
pub fn problem(scene: &Scene, partner: &Agent, weight: f64, leaning: Option<Leaning>, settings: &Settings) -> Problem {
    let others = scene.others.iter().filter(|other| other.name != partner.name);
    let keep_outs =
        others.map(|other| scene.keep_out(&other.prediction, other.corridor.heading_rad, Penalty::EXACT)).collect();
    let mut ego = scene.participant(keep_outs);
    let share = weight / settings.ego_normaliser;
    ego.tracking.weights = ego.tracking.weights.map(|q| share * q);
    ego.comfort = ego.comfort.map(|r| share * r);
    let separation = Separation {
        of: 0,
        from: 1,
        heading_rad: partner.corridor.heading_rad,
        ellipse: scene.goal.safety,
        penalty: Penalty::EXACT,
    };
    let other = asked(scene, partner, (1.0 - weight) / settings.other_normaliser, settings);
    Problem { horizon: scene.horizon, participants: vec![ego, other], separations: vec![separation], leaning }
}

/// The partner as a participant that prefers its own prediction.
fn asked(scene: &Scene, partner: &Agent, share: f64, settings: &Settings) -> Participant {
    let prediction = &partner.prediction;
    let settled = settings.settled_steps.min(scene.horizon - 1);
    let last = prediction.states.last().copied().unwrap_or(partner.state);
    let target = |t: usize| prediction.states.get(t).copied().unwrap_or(last);
    Participant {
        model: Bicycle::new(&partner.body, scene.step_s),
        body: partner.body,
        limits: partner.limits,
        corridor: partner.corridor,
        start: partner.state,
        previous_input: partner.previous_input,
        known_inputs: (0..settled).map(|t| prediction.inputs.get(t).copied().unwrap_or_default()).collect(),
        tracking: Tracking {
            weights: DEVIATION.map(|d| share * d),
            axes: Axes::WORLD,
            targets: (1..=scene.horizon).map(target).collect(),
        },
        comfort: [OTHER_COMFORT; 2],
        keep_outs: Vec::new(),
        distance_costs: Vec::new(),
        mean_speed: None,
    }
}
