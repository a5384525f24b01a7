//! Two deciding vehicles keep apart: the first stays outside an ellipse around the second, `d² − 1 + s ≥ 0` at `t = 1…N`.

use super::keep_out::{FAR_VALUE, expand, violation};
use super::shape::{RowTerm, Subject};
use crate::trajectory::cost::Violation;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::penalty::Penalty;
use crate::vehicle::{OrientedEllipse, PoseExpansion};

/// An ellipse around a deciding vehicle that another deciding vehicle keeps out of.
#[derive(Clone, Debug, PartialEq)]
pub struct Separation {
    /// Index of the vehicle that keeps out.
    pub vehicle: usize,
    /// Index of the vehicle in the ellipse's centre.
    pub from: usize,
    /// The ellipse at `t = 1…N`, along the road of the vehicle in its centre; `N` long.
    pub ellipses: Vec<OrientedEllipse>,
    /// Cost of entering the ellipse.
    pub penalty: Penalty,
}

impl RowTerm for Separation {
    fn subject(&self) -> Subject {
        Subject { vehicle: self.vehicle, other: Some(self.from) }
    }

    fn penalty(&self) -> Penalty {
        self.penalty
    }

    fn violation(&self) -> Option<Violation> {
        violation(&self.penalty)
    }

    fn far_value(&self) -> f64 {
        FAR_VALUE
    }

    fn ellipse(&self, stage: usize) -> Option<&OrientedEllipse> {
        self.ellipses.get(stage)
    }

    fn relative_position(&self, stage: usize, iterate: &Iterate) -> Option<[f64; 2]> {
        let ([x, y], [centre_x, centre_y]) =
            (iterate.states[self.vehicle][stage + 1].position(), iterate.states[self.from][stage + 1].position());
        Some([x - centre_x, y - centre_y])
    }

    fn expand(&self, stage: usize, iterate: &Iterate, rows: &mut [PoseExpansion]) {
        let position = |vehicle: usize| iterate.states[vehicle][stage + 1].position();
        rows[0] = expand(&self.ellipses[stage], position(self.vehicle), position(self.from));
    }
}
