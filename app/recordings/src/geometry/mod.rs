//! Lines of lanes and boxes of vehicles.

use interplay_planners::plan::certificate::overlap_m;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Box2 {
    /// Its centre \[m\].
    pub middle: [f64; 2],
    /// The direction of its length \[rad\].
    pub heading_rad: f64,
    /// Half its length and half its width \[m\].
    pub half_m: [f64; 2],
}

impl Box2 {
    pub(crate) fn overlaps(&self, other: &Box2) -> bool {
        overlap_m(&self.corners(), &other.corners()) > 0.0
    }

    /// Front right, front left, rear right, rear left \[m\].
    fn corners(&self) -> [[f64; 2]; 4] {
        let (sin, cos) = libm::sincos(self.heading_rad);
        let [x, y] = self.middle;
        let [length_m, width_m] = self.half_m;
        [[1.0, -1.0], [1.0, 1.0], [-1.0, -1.0], [-1.0, 1.0]].map(|[ahead, left]| {
            let [ahead_m, left_m] = [ahead * length_m, left * width_m];
            [x + ahead_m * cos - left_m * sin, y + ahead_m * sin + left_m * cos]
        })
    }
}

/// A position relative to a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Projection {
    /// Arc length of the nearest point of the line \[m\].
    pub along_m: f64,
    /// Distance from it, positive to the left \[m\].
    pub across_m: f64,
    /// Direction of the line there \[rad\].
    pub heading_rad: f64,
    /// Width of the lane there \[m\].
    pub width_m: f64,
}

/// A line of at least two points, extended straight at both ends.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct LaneLine {
    points: Vec<[f64; 2]>,
    /// Arc length at each point \[m\].
    along_m: Vec<f64>,
    /// Width of the lane at each point \[m\].
    widths_m: Vec<f64>,
}

/// Minimum spacing of points; nearer ones are merged \[m\].
const MIN_SPACING_M: f64 = 0.05;

impl LaneLine {
    /// The line through points with the lane's width at each; none unless two points differ.
    pub(crate) fn through(places: impl IntoIterator<Item = ([f64; 2], f64)>) -> Option<LaneLine> {
        let mut line = LaneLine::default();
        for (point, width_m) in places {
            let step_m = line.points.last().map(|last| distance_m(*last, point));
            if step_m.is_some_and(|step_m| step_m < MIN_SPACING_M) {
                continue;
            }
            let before_m = line.along_m.last().copied().unwrap_or(0.0);
            line.points.push(point);
            line.along_m.push(before_m + step_m.unwrap_or(0.0));
            line.widths_m.push(width_m);
        }
        (line.points.len() >= 2).then_some(line)
    }

    /// The line halfway between two bounds.
    pub(crate) fn between(left: &[[f64; 2]], right: &[[f64; 2]]) -> Option<LaneLine> {
        let [left, right] = [left, right].map(|bound| LaneLine::through(bound.iter().map(|point| (*point, 0.0))));
        let (left, right) = (left?, right?);
        let pieces = left.points.len().max(right.points.len()).max(4);
        let places = (0..=pieces).map(|piece| {
            let share = piece as f64 / pieces as f64;
            let [a, b] = [&left, &right].map(|line| line.position(share * line.length_m(), 0.0).0);
            ([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])], distance_m(a, b))
        });
        LaneLine::through(places)
    }

    /// A straight line through a point.
    pub(crate) fn straight(point: [f64; 2], heading_rad: f64, width_m: f64) -> LaneLine {
        let (sin, cos) = libm::sincos(heading_rad);
        let at = |along_m: f64| [point[0] + along_m * cos, point[1] + along_m * sin];
        LaneLine { points: vec![at(-50.0), at(50.0)], along_m: vec![0.0, 100.0], widths_m: vec![width_m; 2] }
    }

    /// The points of the line, each with the lane's width there.
    pub(crate) fn places(&self) -> impl DoubleEndedIterator<Item = ([f64; 2], f64)> {
        self.points.iter().copied().zip(self.widths_m.iter().copied())
    }

    pub(crate) fn length_m(&self) -> f64 {
        self.along_m.last().copied().unwrap_or(0.0)
    }

    /// Change of its direction from begin to end \[rad\].
    pub(crate) fn turn_rad(&self) -> f64 {
        let [first, last] = [0, self.points.len() - 2].map(|piece| self.heading_rad(piece));
        libm::remainder(last - first, std::f64::consts::TAU)
    }

    /// The direction of a piece \[rad\].
    fn heading_rad(&self, piece: usize) -> f64 {
        let [from, to] = [self.points[piece], self.points[piece + 1]];
        libm::atan2(to[1] - from[1], to[0] - from[0])
    }

    /// Projects a point onto the line, which is extended straight at both ends.
    pub(crate) fn project(&self, point: [f64; 2]) -> Projection {
        let last = self.points.len() - 2;
        let mut best: Option<(f64, usize, f64, f64)> = None;
        for piece in 0..=last {
            let [from, to] = [self.points[piece], self.points[piece + 1]];
            let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
            let [px, py] = [point[0] - from[0], point[1] - from[1]];
            let length_m = self.along_m[piece + 1] - self.along_m[piece];
            let [low, high] = [
                if piece == 0 { f64::NEG_INFINITY } else { 0.0 },
                if piece == last { f64::INFINITY } else { length_m },
            ];
            let along_m = ((px * dx + py * dy) / length_m).clamp(low, high);
            let [ex, ey] = [px - along_m * dx / length_m, py - along_m * dy / length_m];
            let away_m = libm::hypot(ex, ey);
            if best.is_none_or(|(best_m, ..)| away_m < best_m) {
                let side = (dx * py - dy * px) / length_m;
                let across_m = if side < 0.0 { -away_m } else { away_m };
                best = Some((away_m, piece, along_m, across_m));
            }
        }
        let (_, piece, along_m, across_m) = best.unwrap_or_default();
        let length_m = self.along_m[piece + 1] - self.along_m[piece];
        let share = (along_m / length_m).clamp(0.0, 1.0);
        Projection {
            along_m: self.along_m[piece] + along_m,
            across_m,
            heading_rad: self.heading_rad(piece),
            width_m: self.widths_m[piece] + share * (self.widths_m[piece + 1] - self.widths_m[piece]),
        }
    }

    /// The point at an arc length and a lateral offset, and the direction of the line there.
    pub(crate) fn position(&self, along_m: f64, across_m: f64) -> ([f64; 2], f64) {
        let after = self.along_m.partition_point(|at_m| *at_m <= along_m);
        let piece = after.saturating_sub(1).min(self.points.len() - 2);
        let heading_rad = self.heading_rad(piece);
        let (sin, cos) = libm::sincos(heading_rad);
        let ahead_m = along_m - self.along_m[piece];
        let from = self.points[piece];
        ([from[0] + ahead_m * cos - across_m * sin, from[1] + ahead_m * sin + across_m * cos], heading_rad)
    }
}

fn distance_m(a: [f64; 2], b: [f64; 2]) -> f64 {
    libm::hypot(b[0] - a[0], b[1] - a[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_overlap_unless_a_side_separates_them() {
        let at = |x_m: f64, y_m: f64, heading_rad: f64| Box2 { middle: [x_m, y_m], heading_rad, half_m: [2.0, 1.0] };
        let one = at(0.0, 0.0, 0.0);
        assert!(one.overlaps(&at(3.9, 0.0, 0.0)) && !one.overlaps(&at(4.1, 0.0, 0.0)));
        assert!(one.overlaps(&at(2.9, 0.0, std::f64::consts::FRAC_PI_2)));
        // The corner of a rotated box comes near without touching.
        assert!(!one.overlaps(&at(3.6, 2.6, std::f64::consts::FRAC_PI_4)));
    }

    fn corner() -> LaneLine {
        LaneLine::through([([0.0, 0.0], 3.0), ([10.0, 0.0], 3.0), ([10.0, 10.0], 4.0)]).expect("a line")
    }

    #[test]
    fn project_and_position_are_inverse() {
        let line = corner();
        for (along_m, across_m) in [(3.0, 1.0), (15.0, -2.0), (-5.0, 0.5), (26.0, 0.0)] {
            let (point, _) = line.position(along_m, across_m);
            let found = line.project(point);
            assert!((found.along_m - along_m).abs() < 1e-9 && (found.across_m - across_m).abs() < 1e-9, "{found:?}");
        }
        assert!((line.turn_rad() - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
        assert!((line.project([10.0, 5.0]).width_m - 3.5).abs() < 1e-12);
    }

    #[test]
    fn the_centre_line_is_halfway_between_the_bounds() {
        let (left, right) = ([[0.0, 4.0], [20.0, 4.0]], [[0.0, 0.0], [7.0, 0.0], [20.0, 0.0]]);
        let line = LaneLine::between(&left, &right).expect("a line");
        let at = line.project([12.0, 2.5]);
        assert!((at.across_m - 0.5).abs() < 1e-12 && (at.width_m - 4.0).abs() < 1e-12, "{at:?}");
    }

    #[test]
    fn coincident_points_do_not_define_a_lane_line() {
        assert_eq!(LaneLine::through([([1.0, 1.0], 3.0), ([1.0, 1.0], 3.0)]), None);
        let straight = LaneLine::straight([5.0, 5.0], 0.0, 3.5);
        assert_eq!(straight.project([5.0, 6.0]).along_m, 50.0);
    }
}
