//! Explorations: descents in another class of motion, in search of something cheaper than what is at hand.

use super::optimum::{Optimum, Statistics};

/// What an exploration has to beat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bar {
    /// An optimum is kept if it costs less than this.
    pub cost: f64,
    /// Whether the exploration is given up as soon as nothing suggests that it will.
    pub gives_up: bool,
}

/// What an exploration found.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Exploration {
    /// An optimum below the bar; the next descent resumes from it.
    Cheaper(Optimum),
    /// An optimum that is not.
    Dearer(Optimum),
}

impl Bar {
    pub fn give_up_above(&self) -> f64 {
        if self.gives_up { self.cost } else { f64::INFINITY }
    }
}

impl Optimum {
    /// Gives way to a cheaper optimum of another class and becomes its runner-up.
    pub(super) fn give_way(&mut self, found: Optimum) {
        let held = std::mem::replace(self, found);
        self.add_work(&held.statistics);
        self.runner_up_cost = Some(held.cost.total);
    }

    /// Counts the work of another descent; the residual stays that of this optimum.
    pub(super) fn add_work(&mut self, work: &Statistics) {
        let residual = self.statistics.residual;
        self.statistics.add(work);
        self.statistics.residual = residual;
    }

    /// Notes a dearer optimum of another class, which is the runner-up if there is no cheaper one.
    pub(super) fn note_rival(&mut self, rival: &Optimum) {
        self.add_work(&rival.statistics);
        let cost = rival.cost.total;
        self.runner_up_cost = Some(self.runner_up_cost.map_or(cost, |known| known.min(cost)));
    }
}
