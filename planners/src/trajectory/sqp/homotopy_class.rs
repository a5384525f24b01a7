//! The homotopy class of a motion: which way it goes round whom.

use crate::Axes;
use crate::trajectory::iterate::Iterate;
use crate::trajectory::problem::Problem;
use crate::trajectory::terms::RowTerm;

/// Most ellipses that are told apart; the classes of motions around further ones are not.
const MAX_ELLIPSES: usize = 16;

/// Which way a motion winds round a centre, seen from there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Winding {
    /// Within an eighth of a turn of where it began: neither has passed.
    #[default]
    Neither,
    /// To the left (anticlockwise).
    Left,
    /// To the right (clockwise).
    Right,
}

/// The homotopy class of a motion in a problem: for every ellipse, in the order of the terms, the way round its centre.
///
/// A vehicle that begins beside another one, to its left, and merges ahead of it goes round to the right; behind it, to the left.
/// A vehicle that comes from behind and overtakes on the left goes round to the right. Crossing ahead of another and crossing
/// behind are the two ways, too. How far a motion gets on its way makes no class of its own: no centre lies between.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct HomotopyClass {
    windings: [Winding; MAX_ELLIPSES],
}

impl HomotopyClass {
    /// The class of a motion that was rolled out.
    pub fn classify(problem: &Problem, iterate: &Iterate) -> HomotopyClass {
        let mut class = HomotopyClass::default();
        for (winding, rows) in class.windings.iter_mut().zip(ellipses(problem)) {
            *winding = winding_round(problem.horizon, rows, iterate);
        }
        class
    }
}

/// The row terms around an ellipse.
fn ellipses(problem: &Problem) -> impl Iterator<Item = &dyn RowTerm> {
    problem.row_terms().filter(|rows| rows.ellipse(0).is_some())
}

/// The way round the centre of an ellipse, in the plane where it is a circle.
fn winding_round(horizon: usize, rows: &dyn RowTerm, iterate: &Iterate) -> Winding {
    let mut course = Course::default();
    let (mut heading_rad, mut axes) = (0.0, Axes::WORLD);
    for stage in 0..horizon {
        let (Some(ellipse), Some(relative)) = (rows.ellipse(stage), rows.relative_position(stage, iterate)) else {
            return Winding::Neither;
        };
        if ellipse.heading_rad() != heading_rad {
            heading_rad = ellipse.heading_rad();
            axes = Axes::along(heading_rad);
        }
        let shape = ellipse.shape();
        let [along, across] = axes.components(relative);
        course.go_to([along / shape.along_m, across / shape.across_m]);
    }
    course.winding()
}

/// A course about a centre: quarters of a turn, counted from the direction in which it began.
#[derive(Default)]
struct Course {
    began: Option<[f64; 2]>,
    last: [f64; 2],
    quarters: i32,
}

impl Course {
    /// Goes on to a position, the short way round.
    fn go_to(&mut self, position: [f64; 2]) {
        let [ahead, left] = *self.began.get_or_insert(position);
        // Turned so that the course begins straight ahead.
        let now = [ahead * position[0] + left * position[1], ahead * position[1] - left * position[0]];
        self.quarters += match (quarter(now) - quarter(self.last)).rem_euclid(4) {
            3 => -1,
            2 if self.last[0] * now[1] < self.last[1] * now[0] => -2,
            quarters => quarters,
        };
        self.last = now;
    }

    fn winding(&self) -> Winding {
        match self.quarters {
            0 => Winding::Neither,
            1.. => Winding::Left,
            _ => Winding::Right,
        }
    }
}

/// The quarter around straight ahead (0), left (1), behind (2) or right (3) in which a position lies.
fn quarter([ahead, left]: [f64; 2]) -> i32 {
    match (ahead >= left.abs(), -ahead > left.abs()) {
        (true, _) => 0,
        (_, true) => 2,
        _ if left > 0.0 => 1,
        _ => 3,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn winding(path: &[[f64; 2]]) -> Winding {
        let mut course = Course::default();
        path.iter().for_each(|position| course.go_to(*position));
        course.winding()
    }

    #[test]
    fn overtaking_on_the_left_goes_round_to_the_right_and_staying_behind_nowhere() {
        let (left, right) =
            ([[-2.0, 0.1], [-1.0, 1.5], [1.0, 1.5], [2.0, 0.1]], [[-2.0, 0.1], [0.0, -1.5], [2.0, 0.1]]);
        assert_eq!((winding(&left), winding(&right)), (Winding::Right, Winding::Left));
        assert_eq!(winding(&left[..1]), Winding::Neither);
        assert_eq!(winding(&[[-2.0, 0.1], [-1.2, 0.0], [-1.1, -0.1]]), Winding::Neither);
    }

    /// A motion that jumps across in one step goes round the way that its chord passes the centre.
    #[test]
    fn a_jump_across_goes_the_way_its_chord_passes() {
        assert_eq!(winding(&[[-2.0, 0.1], [2.0, 0.1]]), Winding::Right, "over the left");
        assert_eq!(winding(&[[-2.0, -0.1], [2.0, -0.1]]), Winding::Left, "over the right");
    }

    #[test]
    fn merging_ahead_and_merging_behind_are_the_two_ways() {
        let beside = [0.1, 1.2];
        assert_eq!(winding(&[beside, [0.8, 0.9], [1.3, 0.0]]), Winding::Right);
        assert_eq!(winding(&[beside, [-0.8, 0.9], [-1.3, 0.0]]), Winding::Left);
    }
}
