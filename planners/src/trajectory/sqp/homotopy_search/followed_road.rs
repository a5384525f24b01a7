//! The road along which a simple motion leads.

use crate::road::centre_line::{FrenetExpansion, FrenetPoint};
use crate::trajectory::problem::Problem;
use crate::trajectory::route_start::RouteStart;
use crate::trajectory::terms::{Term, Tracking};
use crate::{Axes, State};

/// The road of a deciding vehicle.
pub(super) enum FollowedRoad<'a> {
    /// A straight one, along which it tracks its goal.
    Straight(&'a Tracking),
    /// A curved one.
    Curved {
        start: &'a RouteStart,
        /// How far the vehicle moves in a step at its present speed \[m\].
        step_m: f64,
        /// The lateral position that it wants, if it wants one \[m\].
        wanted_m: Option<f64>,
    },
}

impl<'a> FollowedRoad<'a> {
    /// The road of a vehicle; none for a vehicle without a goal.
    pub fn find(problem: &'a Problem, vehicle: usize) -> Option<FollowedRoad<'a>> {
        let participant = &problem.participants[vehicle];
        let Some(start) = &participant.route_start else {
            return problem.terms.iter().find_map(|term| match term {
                Term::Tracking(tracking) if tracking.vehicle == vehicle => Some(FollowedRoad::Straight(tracking)),
                _ => None,
            });
        };
        let wanted_m = problem.terms.iter().find_map(|term| match term {
            Term::FrenetTracking(tracking) if tracking.vehicle == vehicle && tracking.weights[1] > 0.0 => {
                Some(tracking.target.across_m)
            }
            _ => None,
        });
        let step_m = participant.start.speed_mps * participant.model.step_s();
        Some(FollowedRoad::Curved { start, step_m, wanted_m })
    }

    /// Where a state is beside the road; `place` is its place beside a curved one.
    pub fn at(&self, state: &State, place: Option<&FrenetExpansion>) -> FrenetPoint {
        match self {
            FollowedRoad::Straight(tracking) => {
                let [along_m, across_m] = tracking.axes.components(state.position());
                let heading_rad = tracking.targets.last().map_or(0.0, |target| target.heading_rad);
                FrenetPoint { along_m, across_m, heading_rad, curvature_1pm: 0.0 }
            }
            FollowedRoad::Curved { start, .. } => place.unwrap_or(&start.at).point(),
        }
    }

    /// Lateral coordinate of a position, and the axes of the road beside it; `stage` is that of the vehicle.
    pub fn beside(&self, position: [f64; 2], stage: usize) -> (f64, Axes) {
        match self {
            FollowedRoad::Straight(tracking) => (tracking.axes.components(position)[1], tracking.axes),
            FollowedRoad::Curved { start, step_m, .. } => {
                let at = start.route.locate(position, Some(start.at.along_m + step_m * (stage + 1) as f64));
                (at.across_m, Axes::along(at.heading_rad))
            }
        }
    }

    /// Where a vehicle starts along the road \[m\].
    pub fn start_m(&self, problem: &Problem, vehicle: usize) -> f64 {
        self.at(&problem.participants[vehicle].start, None).along_m
    }

    /// The lateral position that the vehicle wants, if it wants one \[m\].
    pub fn wanted_m(&self) -> Option<f64> {
        match self {
            FollowedRoad::Straight(tracking) => {
                let target = tracking.targets.last().filter(|_| tracking.weights[1] > 0.0)?;
                Some(tracking.axes.components(target.position())[1])
            }
            FollowedRoad::Curved { wanted_m, .. } => *wanted_m,
        }
    }
}
