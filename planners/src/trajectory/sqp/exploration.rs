//! Explorations: descents in search of something cheaper than what is at hand.

use super::optimum::{Optimum, Statistics};

/// What an exploration has to beat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    /// An optimum is kept if it costs less than this.
    pub cost: f64,
    /// Whether the exploration is given up as soon as nothing suggests that it will.
    pub gives_up: bool,
}

/// What an exploration found.
#[derive(Clone, Debug, PartialEq)]
pub enum Exploration {
    /// An optimum below the bar; the next descent resumes from it.
    Cheaper(Optimum),
    /// An optimum that is not: only its work counts.
    Dearer(Statistics),
}

impl Bar {
    pub(super) fn give_up_above(&self) -> f64 {
        if self.gives_up { self.cost } else { f64::INFINITY }
    }
}

impl Exploration {
    /// The work that it took.
    pub fn statistics(&self) -> &Statistics {
        match self {
            Exploration::Cheaper(optimum) => &optimum.statistics,
            Exploration::Dearer(statistics) => statistics,
        }
    }

    /// Replaces `best` if the exploration found something cheaper; its work is counted either way.
    pub(super) fn improve(self, best: &mut Optimum) {
        let mut work = best.statistics;
        work.add(self.statistics());
        let residual = match self {
            Exploration::Cheaper(found) => {
                *best = found;
                best.statistics.residual
            }
            Exploration::Dearer(_) => best.statistics.residual,
        };
        best.statistics = Statistics { residual, ..work };
    }
}
