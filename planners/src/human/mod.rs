//! The human driver: model-predictive control with a safety weight.
//!
//! Cost: tracking and comfort (eq. 6.6), plus for every vehicle that might cut in
//!
//! ```text
//! weight · Σ_t max(0, 1 − d²(p_t, q_t))²
//! ```
//!
//! where `q` is the other's position at constant velocity *with its present heading*, so that a nudge of the steering
//! wheel is seen, and `d` the elliptical distance along the other's road. The hinge is sharp: a driver yields only to what
//! threatens to enter. Where roads cross the driver minds both ellipses, along the other's road and along its own; this is
//! our choice, as with one of them drivers and planners disagree about who is in whose way. The car ahead in the same lane
//! is followed with at least `following_weight`, whatever the style; whoever is behind in the same lane is ignored.
//!
//! One who closes gaps (`closing`) wants to be faster while somebody is about to cut in ahead of it.
//!
//! The source only says that nice drivers have a higher safety weight (section 6.5). Going first and yielding are two classes
//! of motion, which the optimiser compares.

mod closing;
pub mod diagnostics;
mod settings;

pub use settings::{Settings, Style};

use crate::predict::steady;
use crate::trajectory::terms::KeepOut;
use crate::trajectory::{Optimiser, Penalty, Problem, Robust, Term};
use crate::{Agent, Input, Plan, PlanError, SafetyEllipse, Scene, Trajectory};

/// The very first guess brakes with this share of the strongest braking.
const FIRST_BRAKING_RATIO: f64 = 0.3;
/// Length of the ellipse around the car ahead that is not entered while brakes can help, as a share of the safety ellipse. A
/// hinge alone does not exclude a collision where the wanted speed weighs more.
const LEADER_LENGTH_RATIO: f64 = 0.7;
/// Width of the same ellipse as a multiple of the safety ellipse: the driver stops behind rather than swerve into a lane where
/// it yields to nobody.
const LEADER_WIDTH_RATIO: f64 = 4.0;

/// A human driver with the plan it made last.
#[derive(Clone, Debug)]
pub struct Human {
    settings: Settings,
    optimiser: Optimiser<Robust>,
    last: Option<Trajectory>,
}

impl Human {
    /// A driver who has not planned yet.
    pub fn new(settings: Settings) -> Self {
        Human {
            settings,
            optimiser: Optimiser::resuming(Robust::default()).comparing(settings.passing_orders),
            last: None,
        }
    }

    /// Plans the next move.
    ///
    /// # Errors
    /// [`PlanError`] if none of the guesses leads to an optimum.
    pub fn plan(&mut self, scene: &Scene) -> Result<Plan, PlanError> {
        let hurried = closing::hurried(scene, self.settings.closing_mps);
        let scene = hurried.as_ref().unwrap_or(scene);
        let problem = problem(scene, &self.settings);
        let optimum = self.optimiser.optimise(&problem, &[guess(scene, self.last.as_ref())])?;
        let trajectory = optimum.trajectory(0);
        self.last = Some(trajectory.clone());
        Ok(Plan {
            trajectory,
            diagnostics: vec![diagnostics::SAFETY_WEIGHT.is(self.settings.weight())],
            problem: Some(Box::new(problem)),
            statistics: optimum.statistics,
            ..Plan::default()
        })
    }
}

/// The problem that a driver poses.
pub fn problem(scene: &Scene, settings: &Settings) -> Problem {
    let mut terms = scene.own_terms(0, &scene.goal);
    terms.extend(followed(scene, settings).into_iter().chain(yielded_to(scene, settings)).map(Term::KeepOut));
    Problem { horizon: scene.horizon, participants: vec![scene.participant()], terms }
}

/// The guess of keeping on: the last plan one step later, or at first a little braking.
pub fn guess(scene: &Scene, last: Option<&Trajectory>) -> Vec<Input> {
    last.map_or_else(|| steadily(scene, -FIRST_BRAKING_RATIO), Trajectory::later_inputs)
}

/// Straight on with a share of the strongest acceleration, or of the strongest braking where it is negative.
fn steadily(scene: &Scene, share: f64) -> Vec<Input> {
    let limits = &scene.ego.limits;
    let bound = if share < 0.0 { -limits.acceleration_min_mps2 } else { limits.acceleration_max_mps2 };
    steady(&scene.ego.state, share * bound, limits, scene.horizon, scene.step_s)
}

/// The vehicle ahead in the same lane: followed at a comfortable distance, and not entered while brakes can help.
fn followed(scene: &Scene, settings: &Settings) -> Vec<KeepOut> {
    let Some(leader) = leader(scene) else { return Vec::new() };
    let penalty = Penalty::hinge(settings.weight().max(settings.following_weight));
    let comfortable = scene.keep_out(&leader.prediction, scene.ego.corridor.heading_rad, penalty);
    let SafetyEllipse { along_m, across_m } = comfortable.ellipse.shape();
    let ellipse = SafetyEllipse { along_m: LEADER_LENGTH_RATIO * along_m, across_m: LEADER_WIDTH_RATIO * across_m };
    let firm = KeepOut {
        ellipse: ellipse.oriented(comfortable.ellipse.heading_rad()),
        penalty: Penalty::EXACT,
        ..comfortable.clone()
    };
    vec![comfortable, firm]
}

/// Everybody who might cut in or cross.
fn yielded_to(scene: &Scene, settings: &Settings) -> Vec<KeepOut> {
    let (ego, weight) = (&scene.ego, settings.weight());
    if weight == 0.0 {
        return Vec::new();
    }
    let leader = leader(scene).map(|leader| &leader.name);
    let behind = |other: &&Agent| ego.shares_lane_with(other) && ego.lead_of(other) <= 0.0;
    let mut keep_outs = Vec::new();
    for other in scene.others.iter().filter(|other| Some(&other.name) != leader && !behind(other)) {
        let predicted = settings.prediction.of(other, scene.horizon, scene.step_s);
        keep_outs.push(scene.keep_out(&predicted, other.corridor.heading_rad, Penalty::hinge(weight)));
        if ego.crosses(other) {
            keep_outs.push(scene.keep_out(&predicted, ego.corridor.heading_rad, Penalty::hinge(weight)));
        }
    }
    keep_outs
}

/// The nearest vehicle ahead in the same lane.
fn leader(scene: &Scene) -> Option<&Agent> {
    let ahead = scene.others.iter().filter(|other| scene.ego.shares_lane_with(other) && scene.ego.lead_of(other) > 0.0);
    ahead.min_by(|a, b| scene.ego.lead_of(a).total_cmp(&scene.ego.lead_of(b)))
}
