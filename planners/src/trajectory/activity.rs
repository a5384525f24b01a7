//! Which constraints hold a plan back: at how many of its steps each kind is active.

use crate::trajectory::cost::Violation;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::participant::Participant;
use crate::trajectory::problem::Problem;
use crate::trajectory::terms::{MAX_ROWS_PER_STAGE, RowTerm, Shape};
use crate::vehicle::PoseExpansion;

/// A bound that is closer than this is active (in the unit of what it bounds; `d²` for ellipses).
const ACTIVE_DISTANCE: f64 = 1e-4;

/// Numbers of steps at which constraints of one vehicle are active.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Activity {
    /// On the edge of an ellipse that must not be entered.
    pub safety: usize,
    /// A corner on the edge of the road.
    pub edge: usize,
    /// Acceleration or steering at a bound.
    pub input: usize,
    /// Speed at a bound.
    pub speed: usize,
}

impl Activity {
    /// The activity of one participant of a problem.
    pub(crate) fn count(problem: &Problem, iterate: &Iterate, participant: usize) -> Activity {
        let own = &problem.participants[participant];
        let mut activity = Activity::default();
        for stage in 0..problem.horizon {
            let touches = |violation| touches(problem, iterate, participant, stage, violation);
            activity.safety += usize::from(touches(Violation::Safety));
            activity.edge += usize::from(touches(Violation::RoadEdge));
            let [slowest, fastest] = own.speed_bounds(stage + 1);
            let speed = iterate.states[participant][stage + 1].speed_mps;
            activity.speed += usize::from(is_at_bound(speed, slowest, fastest));
            activity.input += usize::from(is_at_input_bound(own, iterate, participant, stage));
        }
        activity
    }
}

/// Whether a row of a kind that concerns a vehicle is active at a stage.
fn touches(problem: &Problem, iterate: &Iterate, vehicle: usize, stage: usize, kind: Violation) -> bool {
    let concerns_vehicle = |rows: &dyn RowTerm| {
        let subject = rows.subject();
        rows.violation() == Some(kind) && (subject.vehicle == vehicle || subject.other == Some(vehicle))
    };
    problem.terms.iter().any(|term| match term.shape() {
        Shape::Rows(rows) if concerns_vehicle(rows) => {
            let mut expansions = [PoseExpansion::default(); MAX_ROWS_PER_STAGE];
            let expansions = &mut expansions[..rows.rows_per_stage()];
            rows.expand(stage, iterate, expansions);
            expansions.iter().any(|row| row.value < ACTIVE_DISTANCE)
        }
        _ => false,
    })
}

fn is_at_input_bound(own: &Participant, iterate: &Iterate, participant: usize, stage: usize) -> bool {
    let input = &iterate.inputs[participant][stage];
    let ([least_mps2, most_mps2], [least_rad, most_rad]) =
        (own.acceleration_bounds_mps2(stage), own.steering_bounds_rad(stage));
    is_at_bound(input.acceleration_mps2, least_mps2, most_mps2) || is_at_bound(input.steering_rad, least_rad, most_rad)
}

fn is_at_bound(value: f64, low: f64, high: f64) -> bool {
    value < low + ACTIVE_DISTANCE || value > high - ACTIVE_DISTANCE
}
