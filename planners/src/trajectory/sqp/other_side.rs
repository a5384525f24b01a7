//! The other side of an ellipse.
//!
//! Behind, before or beside somebody a plan has a choice that no descent makes: on which side. Each side has an optimum of its
//! own, and a plan that is improved from step to step stays on the side where it began, even when the other has become
//! the cheaper one. Here an optimum that touches an ellipse is asked what the other side would cost: by a step problem
//! whose rows of that ellipse are half-planes on the other side. Only where that promises to be cheaper does a descent begin there.
//!
//! With `r = (r_∥, r_⊥)` the position relative to the centre along and across the long axis, a plan is abreast where
//! `|r_∥| < a`: there it is on one side or on the other. The side to leave is that of the last such time. The rows of those times
//! are replaced by the tangent to the ellipse on the other side, at the point `r′` with the same `r_∥`:
//!
//! ```text
//! r′ = (r_∥, ±b √(1 − r_∥²/a²)),      c = ∇d²(r′)·(r − r′),      ∇d²(r′) = (2 r′_∥/a², 2 r′_⊥/b²)
//! ```
//!
//! The tangent keeps out of the whole ellipse, so the promise is rather too dear than too cheap. A plan that begins abreast cannot
//! be on the other side at once: it crosses where it is nearest to the axis.

use super::exploration::Bar;
use super::optimiser::Optimiser;
use super::optimum::Optimum;
use super::step_problem::row_terms;
use crate::Axes;
use crate::trajectory::problem::Problem;
use crate::trajectory::stage::{ACTIVE_MULTIPLIER, Row, RowBlock, StageSolver};
use crate::vehicle::OrientedEllipse;

/// A promised cost is followed if it is below this multiple of the optimum at hand; tangents make the promise too dear.
const MAX_PROMISED_COST_RATIO: f64 = 1.01;
/// Above this multiple of the optimum at hand the other side is treated as out of reach.
const UNREACHABLE_COST_RATIO: f64 = 2.0;
/// Number of plans for which a side that was out of reach is not examined.
const PLANS_WITHOUT_LOOK: usize = 4;

/// The cheapest of an optimum, whose descent is the last that was kept, and those on the other side of each ellipse that it
/// touches.
pub(super) fn look_to_other_sides<S: StageSolver>(
    optimiser: &mut Optimiser<S>,
    problem: &Problem,
    mut best: Optimum,
) -> Optimum {
    let blocks = optimiser.warm_start.multipliers.row_multipliers.len();
    optimiser.warm_start.plans_without_look.resize(blocks, 0);
    let mut block = 0;
    for rows in row_terms(problem) {
        if let Some(ellipse) = rows.ellipse() {
            look(optimiser, problem, &mut best, block, ellipse);
        }
        block += rows.rows_per_stage();
    }
    best
}

/// Looks to the other side of the ellipse of one block, if the optimum touches it and the side is worth a look.
fn look<S: StageSolver>(
    optimiser: &mut Optimiser<S>,
    problem: &Problem,
    best: &mut Optimum,
    block: usize,
    ellipse: &OrientedEllipse,
) {
    let start = &mut optimiser.warm_start;
    let plans_without_look = &mut start.plans_without_look[block];
    if *plans_without_look > 0 {
        *plans_without_look -= 1;
        return;
    }
    if !start.multipliers.row_multipliers[block].iter().any(|multiplier| *multiplier > ACTIVE_MULTIPLIER) {
        return;
    }
    match promised_cost(optimiser, problem, best, block, ellipse) {
        Some(promise) if promise < MAX_PROMISED_COST_RATIO * best.cost.total => follow(optimiser, problem, best),
        Some(promise) if promise > UNREACHABLE_COST_RATIO * best.cost.total => {
            optimiser.warm_start.plans_without_look[block] = PLANS_WITHOUT_LOOK;
        }
        _ => {}
    }
}

/// Solves for the step to the other side of one ellipse; returns the cost that it promises there, or nothing if the optimum
/// is on no side.
fn promised_cost<S: StageSolver>(
    optimiser: &mut Optimiser<S>,
    problem: &Problem,
    best: &mut Optimum,
    block: usize,
    ellipse: &OrientedEllipse,
) -> Option<f64> {
    let steps = &mut optimiser.descent.steps;
    steps.problem.linearize(problem, &best.iterate);
    let rows = &mut steps.problem.qp.blocks[block];
    let before = penalties(rows);
    if !move_to_other_side(&mut rows.rows, ellipse) {
        return None;
    }
    let posed = best.cost.total + penalties(rows) - before;
    let solved = steps.solve(best, false).is_ok();
    Some(if solved { posed + steps.problem.qp.change(&steps.step) } else { f64::INFINITY })
}

/// Descends from where the step leads, and stays there if it is cheaper.
fn follow<S: StageSolver>(optimiser: &mut Optimiser<S>, problem: &Problem, best: &mut Optimum) {
    let descent = &mut optimiser.descent;
    descent.search.try_step(&descent.steps.step, problem, &best.iterate, 1.0);
    let from = descent.search.trial.clone();
    if let Ok(found) = optimiser.explore_on(problem, from, Bar { cost: best.bar(), gives_up: true }) {
        found.improve(best);
    }
}

/// What the violations of a block cost.
fn penalties(block: &RowBlock) -> f64 {
    let rows = block.rows.iter().filter(|row| row.active);
    block.penalty.map_or(0.0, |penalty| rows.map(|row| penalty.cost(row.value)).sum())
}

/// Where a row of an ellipse is evaluated: `r`, and the Hessian of `d²` on (along, across).
struct Abreast {
    relative: [f64; 2],
    bend: [f64; 2],
}

impl Abreast {
    fn of(row: &Row, ellipse: &OrientedEllipse, axes: &Axes) -> Option<Abreast> {
        let [x, y, _] = row.gradient;
        let [along, across] = axes.components([x, y]);
        let [long, _, short] = axes.entries(ellipse.hessian());
        let relative = [along / long, across / short];
        (row.active && 0.5 * long * relative[0].powi(2) < 1.0).then_some(Abreast { relative, bend: [long, short] })
    }

    /// The tangent on one side (1 left, −1 right).
    fn tangent(&self, side: f64, axes: &Axes, row: &mut Row) {
        let ([along, across], [long, short]) = (self.relative, self.bend);
        let edge = side * ((2.0 - long * along * along) / short).sqrt();
        let [x, y] = axes.vector([long * along, short * edge]);
        row.gradient = [x, y, 0.0];
        row.value = short * edge * (across - edge);
    }
}

/// Replaces rows by tangents on the other side of their ellipse; returns whether there were any to replace.
fn move_to_other_side(rows: &mut [Row], ellipse: &OrientedEllipse) -> bool {
    let axes = &Axes::along(ellipse.heading_rad());
    let seen: Vec<Option<Abreast>> = rows.iter().map(|row| Abreast::of(row, ellipse, axes)).collect();
    let Some(side) = seen.iter().rev().flatten().next().map(|last| -last.relative[1].signum()) else { return false };
    let off_axis = |k: &usize| seen[*k].as_ref().map_or(f64::INFINITY, |at| at.relative[1].abs());
    let begins_abreast = seen.first().is_some_and(Option::is_some);
    let nearest = (0..seen.len()).min_by(|a, b| off_axis(a).total_cmp(&off_axis(b)));
    let from = nearest.filter(|_| begins_abreast).unwrap_or(0);
    for (row, seen) in rows.iter_mut().zip(&seen).skip(from) {
        if let Some(seen) = seen.as_ref().filter(|seen| side * seen.relative[1] <= 0.0) {
            seen.tangent(side, axes, row);
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::SafetyEllipse;

    const ELLIPSE: SafetyEllipse = SafetyEllipse { along_m: 0.75, across_m: 0.35 };

    fn row_at(relative: [f64; 2], heading_rad: f64) -> Row {
        let distance = ELLIPSE.oriented(heading_rad).distance(relative, [0.0; 2]);
        let [x, y] = distance.gradient;
        Row { active: true, value: distance.squared - 1.0, gradient: [x, y, 0.0], curvature: [0.0; 4] }
    }

    proptest! {
        /// Where a tangent's row holds, so does the ellipse's; and the point abreast on the other side lies on it.
        #[test]
        fn a_tangent_keeps_out_of_the_whole_ellipse(
            along in -0.74..0.74, across in -0.5..0.5, heading in -3.1..3.1, left: bool,
            to in [-2.0..2.0, -2.0..2.0],
        ) {
            let (axes, side) = (Axes::along(heading), if left { 1.0 } else { -1.0 });
            let here = axes.vector([along, across]);
            let mut row = row_at(here, heading);
            let abreast = Abreast::of(&row, &ELLIPSE.oriented(heading), &axes).expect("abreast");
            abreast.tangent(side, &axes, &mut row);
            let value = |p: [f64; 2]| row.value + row.gradient[0] * (p[0] - here[0]) + row.gradient[1] * (p[1] - here[1]);
            let edge = side * ELLIPSE.across_m * (1.0 - (along / ELLIPSE.along_m).powi(2)).sqrt();
            prop_assert!(value(axes.vector([along, edge])).abs() < 1e-9);
            let distance = ELLIPSE.oriented(heading).distance(to, [0.0; 2]).squared;
            prop_assert!(value(to) <= distance - 1.0 + 1e-9, "{} where the ellipse has {}", value(to), distance - 1.0);
        }
    }

    /// From abreast on the right: the way to the left begins where the plan is nearest to the axis.
    #[test]
    fn a_plan_that_begins_abreast_crosses_where_it_is_nearest_to_the_axis() {
        let plan = [[0.3, -0.4], [0.4, -0.3], [0.5, -0.1], [0.6, -0.2], [0.8, -0.2]];
        let mut rows = plan.map(|relative| row_at(relative, 0.0));
        let before = rows;
        assert!(move_to_other_side(&mut rows, &ELLIPSE.oriented(0.0)));
        let moved: Vec<bool> = rows.iter().zip(&before).map(|(row, was)| row != was).collect();
        assert_eq!(moved, [false, false, true, true, false]);
        assert!(rows[2..4].iter().all(|row| row.gradient[1] > 0.0), "the left side");
    }
}
