//! Explorations: descents in another homotopy class, in search of something cheaper than what is at hand.

use super::homotopy_class::HomotopyClass;
use super::optimum::{DescentError, Optimum, Statistics};
use crate::trajectory::problem::Problem;

/// An exploration goes on while this multiple of what a step promises would lead below the cost to beat. On the recorded
/// problems 1 misses one cheaper class in ten, and 3 costs five times the time of 2 without finding more.
const MAX_GAIN_PER_PROMISE: f64 = 2.0;
/// The same for later steps, whose promises are nearer to the truth.
const LATER_GAIN_PER_PROMISE: f64 = 1.2;
/// Largest tolerance of a QP subproblem.
const MAX_PROGRAMME_TOLERANCE: f64 = 1e-2;

/// When an exploration is given up.
#[derive(Clone, Copy, Debug)]
pub(super) struct GivesUp<'a> {
    /// As soon as nothing suggests that it will end below this cost, the cost to beat.
    pub above: f64,
    /// As soon as it is in one of these classes, whose optima are known, and its step promises nothing below that cost.
    pub settled: &'a [HomotopyClass],
}

impl GivesUp<'_> {
    /// The tolerance that will do for the QP subproblem at an iterate of this cost: `share` of what is missing to the cost to beat.
    pub fn programme_tolerance(&self, cost: f64, share: f64) -> f64 {
        (share * (cost - self.above)).min(MAX_PROGRAMME_TOLERANCE)
    }

    /// Whether to go on from here with a step that promises a decrease.
    ///
    /// # Errors
    /// [`DescentError::NotBelow`] or [`DescentError::Settled`] if not.
    pub fn check(&self, problem: &Problem, now: &Optimum, step: usize, promised: f64) -> Result<(), DescentError> {
        let (statistics, promised) = (now.statistics, promised.max(0.0));
        let expected = now.cost.total - promised;
        if expected <= self.above {
            return Ok(());
        }
        let is_settled = step > 0 && self.settled.contains(&HomotopyClass::classify(problem, &now.iterate));
        if is_settled {
            return Err(DescentError::Settled(statistics));
        }
        let gain = if step == 0 { MAX_GAIN_PER_PROMISE } else { LATER_GAIN_PER_PROMISE };
        if now.cost.total - gain * promised <= self.above {
            return Ok(());
        }
        Err(DescentError::NotBelow { bar: self.above, expected, statistics })
    }
}

/// What an exploration found.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Exploration {
    /// An optimum below the cost to beat; the next descent resumes from it.
    Cheaper(Optimum),
    /// An optimum that is not.
    Dearer(Optimum),
    /// It reached the limit of its work here.
    Unfinished(Optimum),
}

/// Replaces the plan at hand by a cheaper one. Returns the work that this one took.
pub(super) fn replace(held: &mut Result<Optimum, DescentError>, found: Optimum) -> usize {
    let work = found.statistics.work();
    match held {
        Ok(held) => held.give_way(found),
        Err(_) => *held = Ok(found),
    }
    work
}

impl Optimum {
    /// Gives way to a cheaper optimum of another class and becomes its runner-up.
    pub(super) fn give_way(&mut self, found: Optimum) {
        let held = std::mem::replace(self, found);
        self.add_work(&held.statistics);
        self.runner_up_cost = Some(held.cost.total);
    }

    /// Counts the work of another descent; what is said of this optimum itself stays.
    pub(super) fn add_work(&mut self, work: &Statistics) {
        let Statistics { residual, unfinished, .. } = self.statistics;
        self.statistics.add(work);
        self.statistics.residual = residual;
        self.statistics.unfinished = unfinished;
    }

    /// Notes a dearer optimum of another class, which is the runner-up if none is cheaper.
    pub(super) fn note_rival(&mut self, rival: &Optimum) {
        self.add_work(&rival.statistics);
        let cost = rival.cost.total;
        self.runner_up_cost = Some(self.runner_up_cost.map_or(cost, |known| known.min(cost)));
    }
}
