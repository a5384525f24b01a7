//! The trajectory problem whose solution is the signal (eq. 7.23-7.26).
//!
//! The ego's cost is the expectation, over what the other makes of its state `x ~ 𝒩(x̂, Σ)`, of `exp C(x)`,
//! `C(x) = ‖x − x_g‖²_{W_2} + k_1 ω(x)`. Laplace's method needs the *maximum* of `C(x) − ½‖x − x̂‖²_{Σ⁻¹}` (argmin in print),
//! and `ω` is a norm, so that `C` is not the quadratic that the source takes it for. Without `ω` the maximum is in closed form,
//! component by component,
//!
//! ```text
//! x* = (x̂ − 2ΣW_2 x_g)/(1 − 2ΣW_2),   exponent there:  W_2/(1 − 2ΣW_2) (x̂ − x_g)²,     valid for Σ⁻¹ > 2 W_2
//! ```
//!
//! and `ω` is evaluated at it: doubt exaggerates deviations from the goal. `2ΣW_2` is kept below 0.9. As `x*` is affine in
//! `x̂`, so is the place from which `ω` is measured: the distance from `x_sᴾ` at `x*` is the one from a moved centre at `x̂`, in
//! a stretched metric.
//!
//! As printed `ω` also draws an ego back that is ahead of the other: it brakes for the sake of a bold signal, and loses its place
//! to the one it came close to. So at a stage at which the ego is expected ahead of the other, along the other's road, only a share of
//! the distance along that road counts, and the ego comes closer from the side. What is expected is the ego's last plan: within a
//! problem a distance costs the same ahead and behind, and no side is favoured.

use super::belief::PersuasionBelief;
use super::{Settings, value};
use crate::drivers::conservative;
use crate::problem::clearance::ellipses;
use crate::trajectory::terms::{DistanceCost, FrenetTracking, Tracking};
use crate::trajectory::{Problem, Term};
use crate::vehicle::OrientedEllipse;
use crate::{Agent, Scene, Trajectory};

/// Largest `2ΣW_2`.
const MAX_SIGNAL_DOUBT: f64 = 0.9;

/// The conservative problem (eq. 6.13), also used when no vehicle is left to persuade, with the price of a
/// signal to `partner`. `last` is what the ego planned a step ago.
pub fn problem(
    scene: &Scene,
    partner: Option<&Agent>,
    last: Option<&Trajectory>,
    belief: &PersuasionBelief,
    settings: &Settings,
) -> Problem {
    let others: Vec<&Agent> = scene.others.iter().collect();
    let mut problem = conservative::problem(scene, &others);
    if let Some(partner) = partner {
        let doubts = doubts(scene, belief);
        for term in &mut problem.terms {
            if let Term::Tracking(Tracking { weights, .. }) | Term::FrenetTracking(FrenetTracking { weights, .. }) =
                term
            {
                weights.iter_mut().zip(doubts).for_each(|(weight, doubt)| *weight /= 1.0 - doubt);
            }
        }
        problem.terms.push(Term::DistanceCost(impression(scene, partner, last, belief, doubts, settings)));
    }
    problem
}

/// `2ΣW_2` of every component (along, across, θ, v), `W_2` in the units of a 1/10 scale car, as `Σ`.
fn doubts(scene: &Scene, belief: &PersuasionBelief) -> [f64; 4] {
    let (scale, [along, across, heading, speed]) = (scene.ego.body.scale, scene.goal.tracking);
    let weights = [along * (scale * scale), across * (scale * scale), heading, speed * scale];
    weights.map(|weight| (2.0 * belief.variance * weight).min(MAX_SIGNAL_DOUBT))
}

/// `I′ᵀI′` of `ω` at `t = 1…N`: that of the safety ellipse, with less along the other's road where the ego is expected ahead.
/// `centres` are those of the partner.
fn metrics(
    scene: &Scene,
    partner: &Agent,
    centres: &[[f64; 2]],
    last: Option<&Trajectory>,
    settings: &Settings,
) -> Vec<[f64; 3]> {
    let expected = last.map(|last| scene.centres(&last.shifted()));
    let ellipses = ellipses(scene.goal.safety, &partner.route, centres);
    let metric = |(stage, (ellipse, centre)): (usize, (&OrientedEllipse, &[f64; 2]))| {
        let (sin, cos) = libm::sincos(ellipse.heading_rad());
        let leads = |[x, y]: [f64; 2]| cos * (x - centre[0]) + sin * (y - centre[1]) > 0.0;
        let is_ahead = expected.as_ref().is_some_and(|expected| leads(expected[stage]));
        let discount = if is_ahead { 1.0 - settings.ahead_share } else { 0.0 };
        let along_m = ellipse.shape().along_m;
        let less = discount / (along_m * along_m);
        // The curvature of a squared distance is twice its metric.
        let [xx, xy, yy] = ellipse.hessian().map(|bend| 0.5 * bend);
        [xx - less * cos * cos, xy - less * cos * sin, yy - less * sin * sin]
    };
    ellipses.iter().zip(centres).enumerate().map(metric).collect()
}

/// The price of `ω` at `x*`: with `D = 2ΣW_2`, `x* − x_sᴾ = (x̂ − D x_g − (1 − D) x_sᴾ)/(1 − D)`.
fn impression(
    scene: &Scene,
    partner: &Agent,
    last: Option<&Trajectory>,
    belief: &PersuasionBelief,
    [doubt_along, doubt_across, ..]: [f64; 4],
    settings: &Settings,
) -> DistanceCost {
    let (stretch, widen) = (1.0 / (1.0 - doubt_along), 1.0 / (1.0 - doubt_across));
    let centres = scene.centres(&partner.prediction);
    let metrics = metrics(scene, partner, &centres, last, settings);
    let goals = scene.goals_beside(&centres);
    let place = |stage: usize| {
        let (axes, goal) = goals[stage];
        let [goal_along, goal_across] = axes.components(goal);
        let [along, across] = axes.components(centres[stage]);
        let moved = axes.vector([
            doubt_along * goal_along + (1.0 - doubt_along) * along,
            doubt_across * goal_across + (1.0 - doubt_across) * across,
        ]);
        let [along, mixed, across] = axes.entries(metrics[stage]);
        (moved, axes.matrix([stretch * stretch * along, stretch * widen * mixed, widen * widen * across]))
    };
    let (centres, metrics) = (0..centres.len()).map(place).unzip();
    DistanceCost { vehicle: 0, centres, metrics, price: value::price(settings, belief.w_1, belief.deviation) }
}
