//! The middle of a lanelet and its width.
//!
//! The middle lies halfway between both bounds. Errors of measured points cause curvature, so the curve may miss the points by a
//! tolerance: the smallest one with which the inner edge does not cross itself and a car can follow. If no tolerance is large
//! enough, the lane becomes narrower in that bend.

use interplay_planners::road::centre_line::smooth_points;
use interplay_planners::{CentreLine, Profile};

/// The tolerances between curve and points, in the order in which they are tried \[m\].
const TOLERANCES_M: [f64; 6] = [0.02, 0.05, 0.1, 0.2, 0.4, 0.8];
/// Points nearer than this to each other are merged \[m\].
const MIN_SPACING_M: f64 = 0.02;
/// The most points of a lane; further ones are left out.
const MAX_POINTS: usize = 2000;
/// The smallest width of a lane: some lanelets begin or end in a point \[m\].
const MIN_WIDTH_M: f64 = 0.3;
/// The largest width of a lane \[m\].
const MAX_WIDTH_M: f64 = 40.0;
/// An edge is at least this share of the radius away from the centre of the bend.
const EDGE_SHARE: f64 = 0.95;
/// The smallest radius that a car can drive \[m\].
const TURNING_RADIUS_M: f64 = 5.6;
/// The number of points between two knots at which a curve is checked, as in the network.
const PLACES_PER_KNOT: usize = 4;
/// The most times that a lane is narrowed.
const MAX_ROUNDS: usize = 30;

/// The line of a lane, as a network states it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Line {
    /// Points of the middle \[m\].
    pub points: Vec<[f64; 2]>,
    /// The tolerance between the curve and the points \[m\].
    pub tolerance_m: f64,
    /// Pairs of a distance along the lane and the width there \[m\].
    pub widths: Vec<[f64; 2]>,
    /// Whether it is narrower in a bend than the lanelet.
    pub is_narrowed: bool,
    /// Whether the bounds were exchanged, or one of them ran backwards.
    pub is_turned: bool,
}

/// The line between a left and a right bound; `None` for a lanelet without length, and if no curve passes through it.
pub(super) fn between(left: &[[f64; 2]], right: &[[f64; 2]]) -> Option<Line> {
    let (left, right, is_turned) = in_order(left, right);
    let (points, widths) = middle(&paired(&left, &right))?;
    let mut best: Option<Line> = None;
    for tolerance_m in TOLERANCES_M {
        let line = Line { points: points.clone(), tolerance_m, widths: widths.clone(), is_narrowed: false, is_turned };
        let Some(fitted) = fitted(line) else { continue };
        if !fitted.0.is_narrowed && fitted.1 {
            return Some(fitted.0);
        }
        let is_better = best.as_ref().is_none_or(|best| best.is_narrowed && !fitted.0.is_narrowed);
        if is_better {
            best = Some(fitted.0);
        }
    }
    best
}

/// A line that is narrowed until its inner edge does not cross itself, and whether a car can follow it.
fn fitted(mut line: Line) -> Option<(Line, bool)> {
    let smooth = smooth_points(&line.points, line.tolerance_m).ok()?;
    let curve = CentreLine::through(&smooth).ok()?;
    let knots_m = curve.knots_m();
    let between = |pair: &[f64]| {
        let [from, to] = [pair[0], pair[1]];
        (0..=PLACES_PER_KNOT).map(move |part| from + (to - from) * part as f64 / PLACES_PER_KNOT as f64)
    };
    let bends: Vec<[f64; 2]> =
        knots_m.windows(2).flat_map(between).map(|along_m| [along_m, curve.at(along_m).curvature_1pm.abs()]).collect();
    let is_drivable = bends.iter().all(|[_, curvature_1pm]| curvature_1pm * TURNING_RADIUS_M <= 1.0);
    for _ in 0..MAX_ROUNDS {
        let profile = Profile::through(&line.widths).ok()?;
        let too_wide =
            |[along_m, curvature_1pm]: &&[f64; 2]| 0.5 * profile.value(*along_m) * curvature_1pm >= EDGE_SHARE + 0.01;
        let narrow: Vec<[f64; 2]> = bends.iter().filter(too_wide).copied().collect();
        if narrow.is_empty() {
            return Some((line, is_drivable));
        }
        for [along_m, curvature_1pm] in narrow {
            narrow_at(&mut line.widths, along_m, to_millimetres(2.0 * EDGE_SHARE / curvature_1pm - 0.001));
        }
        line.is_narrowed = true;
    }
    None
}

/// Limits a width to `most_m` around a position.
fn narrow_at(widths: &mut [[f64; 2]], along_m: f64, most_m: f64) {
    let after = widths.partition_point(|[at_m, _]| *at_m <= along_m);
    for knot in [after.checked_sub(1), Some(after)].into_iter().flatten() {
        if let Some([_, width_m]) = widths.get_mut(knot) {
            *width_m = width_m.min(most_m).max(0.001);
        }
    }
}

/// The bounds with the left one on the left, and both in the same direction; and whether that changed them.
fn in_order(left: &[[f64; 2]], right: &[[f64; 2]]) -> (Vec<[f64; 2]>, Vec<[f64; 2]>, bool) {
    let (mut left, mut right) = (left.to_vec(), right.to_vec());
    let ends = |bound: &[[f64; 2]]| [bound[0], bound[bound.len() - 1]];
    let ([left_from, left_to], [right_from, right_to]) = (ends(&left), ends(&right));
    let is_reversed = distance(left_from, right_from) + distance(left_to, right_to)
        > distance(left_from, right_to) + distance(left_to, right_from);
    if is_reversed {
        right.reverse();
    }
    let pairs = paired(&left, &right);
    let sides = pairs.windows(2).map(|pair| {
        let [(left, right), (next_left, next_right)] = [pair[0], pair[1]];
        let ahead = [0, 1].map(|i| next_left[i] + next_right[i] - left[i] - right[i]);
        ahead[0] * (left[1] - right[1]) - ahead[1] * (left[0] - right[0])
    });
    let is_mirrored = sides.sum::<f64>() < 0.0;
    if is_mirrored {
        std::mem::swap(&mut left, &mut right);
    }
    (left, right, is_reversed || is_mirrored)
}

/// Points of both bounds that face each other: by number where there are equally many, otherwise by their share of the length.
fn paired(left: &[[f64; 2]], right: &[[f64; 2]]) -> Vec<([f64; 2], [f64; 2])> {
    if left.len() == right.len() {
        return left.iter().copied().zip(right.iter().copied()).collect();
    }
    let shares = if left.len() > right.len() { shares(left) } else { shares(right) };
    let sides = [left, right].map(|bound| Bound { points: bound, shares: self::shares(bound) });
    shares.into_iter().map(|share| (sides[0].at(share), sides[1].at(share))).collect()
}

struct Bound<'a> {
    points: &'a [[f64; 2]],
    shares: Vec<f64>,
}

impl Bound<'_> {
    /// The point at a share of the length.
    fn at(&self, share: f64) -> [f64; 2] {
        let after = self.shares.partition_point(|at| *at < share).clamp(1, self.points.len() - 1);
        let [from, to] = [self.shares[after - 1], self.shares[after]];
        let within = if to > from { ((share - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        let [a, b] = [self.points[after - 1], self.points[after]];
        [0, 1].map(|i| a[i] + within * (b[i] - a[i]))
    }
}

/// The share of the length of a line at each of its points.
fn shares(points: &[[f64; 2]]) -> Vec<f64> {
    let mut along = vec![0.0];
    for pair in points.windows(2) {
        along.push(along[along.len() - 1] + distance(pair[0], pair[1]));
    }
    let length = along[along.len() - 1];
    if length > 0.0 { along.into_iter().map(|at| at / length).collect() } else { vec![0.0; points.len()] }
}

/// Places \[m\].
type Points = Vec<[f64; 2]>;

/// Widths over the distance along a line \[m\].
type Widths = Vec<[f64; 2]>;

/// Points in the middle of pairs that are not too near to each other, and the widths over the distance along them; `None` if fewer
/// than two remain.
fn middle(pairs: &[([f64; 2], [f64; 2])]) -> Option<(Points, Widths)> {
    let spacing_m = if pairs.len() > MAX_POINTS { 0.25 } else { MIN_SPACING_M };
    let mut kept: Vec<([f64; 2], f64)> = Vec::new();
    let all = pairs.iter().map(|(left, right)| {
        let middle = [0, 1].map(|i| to_tenth_millimetres(0.5 * (left[i] + right[i])));
        (middle, distance(*left, *right).clamp(MIN_WIDTH_M, MAX_WIDTH_M))
    });
    for (place, width_m) in all {
        if kept.last().is_none_or(|(before, _)| distance(*before, place) >= spacing_m) {
            kept.push((place, width_m));
        }
    }
    // The lane ends where the lanelet does.
    let (left, right) = *pairs.last()?;
    let end = [0, 1].map(|i| to_tenth_millimetres(0.5 * (left[i] + right[i])));
    if kept.len() > 1 && kept.last().is_some_and(|(last, _)| *last != end) {
        let width_m = kept.pop().map_or(0.0, |(_, width_m)| width_m);
        kept.push((end, width_m));
    }
    let mut widths = Vec::with_capacity(kept.len());
    let mut along_m = 0.0;
    for (index, (place, width_m)) in kept.iter().enumerate() {
        along_m += index.checked_sub(1).map_or(0.0, |before| distance(kept[before].0, *place));
        widths.push([to_millimetres(along_m), to_millimetres(*width_m)]);
    }
    (kept.len() >= 2).then(|| (kept.into_iter().map(|(place, _)| place).collect(), widths))
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}

fn to_millimetres(length_m: f64) -> f64 {
    (1e3 * length_m).round() / 1e3
}

fn to_tenth_millimetres(length_m: f64) -> f64 {
    (1e4 * length_m).round() / 1e4
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEFT: [[f64; 2]; 3] = [[0.0, 3.0], [10.0, 3.0], [20.0, 3.0]];
    const RIGHT: [[f64; 2]; 2] = [[0.0, 0.0], [20.0, 0.0]];

    #[test]
    fn the_centre_of_a_lanelet_is_halfway_for_any_order_of_its_bounds() {
        let line = between(&LEFT, &RIGHT).expect("a line");
        assert_eq!(line.points, [[0.0, 1.5], [10.0, 1.5], [20.0, 1.5]]);
        assert_eq!(line.widths, [[0.0, 3.0], [10.0, 3.0], [20.0, 3.0]]);
        let mirrored = between(&RIGHT, &LEFT).expect("a line");
        assert!(mirrored.is_turned && !line.is_turned && mirrored.points == line.points);
        let backwards = between(&LEFT, &[RIGHT[1], RIGHT[0]]).expect("a line");
        assert!(backwards.is_turned && backwards.points == line.points);
    }

    #[test]
    fn lanelets_without_length_have_no_centre_line() {
        assert_eq!(between(&[[0.0, 1.0]; 3], &[[0.0, 0.0]; 3]), None);
    }

    /// A corner of 90 degrees within a metre: the lane is smoothed or narrowed until its edges do not cross.
    #[test]
    fn corners_of_lanelets_become_smooth_bends() {
        let before = (0..=10).map(|x| ([f64::from(x), 2.0], [f64::from(x) + 0.2 * f64::from(x), 0.0]));
        let after = (1..=10).map(|y| ([10.0, 2.0 + f64::from(y)], [12.0, 1.2 * f64::from(y)]));
        let (left, right): (Vec<[f64; 2]>, Vec<[f64; 2]>) = before.chain(after).unzip();
        let line = between(&left, &right).expect("a line");
        assert!(line.tolerance_m > 0.02 || line.is_narrowed, "{line:?}");
        let curve = smooth_points(&line.points, line.tolerance_m).and_then(|points| CentreLine::through(&points));
        let (curve, width) = (curve.expect("a curve"), Profile::through(&line.widths).expect("a width"));
        for place in 0..=200 {
            let along_m = curve.length_m() * f64::from(place) / 200.0;
            assert!(0.5 * width.value(along_m) * curve.at(along_m).curvature_1pm.abs() < 1.0, "{along_m} m along it");
        }
    }
}
