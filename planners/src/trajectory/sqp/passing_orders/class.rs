//! The class of a motion: on which side of whom it passes and where it ends.

use crate::Axes;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::problem::Problem;
use crate::trajectory::terms::RowTerm;

/// Most ellipses that are told apart; the classes of motions around further ones are not.
const MAX_ELLIPSES: usize = 16;

/// The class of a motion in a problem.
///
/// For every ellipse, in the order of the terms, the sector around its centre in which the motion ends (0 ahead, 1 to the
/// left, 2 behind, 3 to the right, between the diagonals of the ellipse's box), counted on through full turns: a vehicle that
/// begins behind and passes on the left ends at 0, one that passes on the right at 4. Motions of one class can be deformed
/// into each other without touching a centre.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct PassingClass {
    sectors: [i8; MAX_ELLIPSES],
}

impl PassingClass {
    /// The class of a motion that was rolled out.
    pub fn of(problem: &Problem, iterate: &Iterate) -> PassingClass {
        let mut class = PassingClass::default();
        for (sector, rows) in class.sectors.iter_mut().zip(ellipses(problem)) {
            *sector = sector_reached(problem.horizon, rows, iterate);
        }
        class
    }
}

/// The row terms around an ellipse.
fn ellipses(problem: &Problem) -> impl Iterator<Item = &dyn RowTerm> {
    problem.row_terms().filter(|rows| rows.ellipse().is_some())
}

/// The sector in which the motion ends, counted on through full turns.
fn sector_reached(horizon: usize, rows: &dyn RowTerm, iterate: &Iterate) -> i8 {
    let Some(ellipse) = rows.ellipse() else { return 0 };
    let (axes, shape) = (Axes::along(ellipse.heading_rad()), ellipse.shape());
    let mut reached = 0;
    let mut before: Option<[f64; 2]> = None;
    for stage in 0..horizon {
        let Some(relative) = rows.relative_position(stage, iterate) else { return 0 };
        let [along, across] = axes.components(relative);
        let scaled = [along / shape.along_m, across / shape.across_m];
        reached = match before {
            None => sector(scaled),
            Some(before) => reached + turn(before, scaled),
        };
        before = Some(scaled);
    }
    reached
}

/// The sector of a position: 0 ahead, 1 to the left, 2 behind, 3 to the right.
fn sector([along, across]: [f64; 2]) -> i8 {
    match (along >= across.abs(), -along >= across.abs()) {
        (true, _) => 0,
        (_, true) => 2,
        _ if across > 0.0 => 1,
        _ => 3,
    }
}

/// How many sectors a motion goes on to the left about the centre, the short way.
fn turn(from: [f64; 2], to: [f64; 2]) -> i8 {
    match (sector(to) - sector(from)).rem_euclid(4) {
        3 => -1,
        2 if from[0] * to[1] < from[1] * to[0] => -2,
        steps => steps,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reached(path: &[[f64; 2]]) -> i8 {
        path.windows(2).fold(sector(path[0]), |at, pair| at + turn(pair[0], pair[1]))
    }

    #[test]
    fn passing_on_the_left_and_on_the_right_end_a_full_turn_apart() {
        let (left, right) =
            ([[-2.0, 0.1], [-1.0, 1.5], [1.0, 1.5], [2.0, 0.1]], [[-2.0, 0.1], [0.0, -1.5], [2.0, 0.1]]);
        assert_eq!((reached(&left), reached(&right)), (0, 4));
        assert_eq!(reached(&left[..2]), 1, "beside it");
        assert_eq!(reached(&left[..1]), 2, "behind it");
    }

    /// A motion that jumps across in one step turns the way that its chord passes the centre.
    #[test]
    fn a_jump_across_turns_the_way_its_chord_passes() {
        assert_eq!(turn([-2.0, 0.1], [2.0, 0.1]), -2, "over the left");
        assert_eq!(turn([-2.0, -0.1], [2.0, -0.1]), 2, "over the right");
    }
}
