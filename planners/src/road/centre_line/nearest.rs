//! The point of a curve that is nearest to a position, by descents of Halley's method.

use super::chord::{Chord, ChordGroup};
use super::line::{Curve, CurvePoint};
use super::segment::{Segment, distance, dot};

/// Most steps of a search. Halley's method needs 1 to 4; the rest is for bisection.
const MAX_STEPS: usize = 64;

/// A search ends with a step that is shorter \[m\]: Halley's method leaves about `κ²/6` times its cube, which is rounding. The last
/// step is taken in the series of the curve, whose position and direction are exact to rounding then, and whose curvature is to
/// the square of the step.
const LAST_STEP_M: f64 = 1e-4;

/// A step of Halley's method needs a second derivative of at least this share of `v²`; otherwise the curvature is ignored.
const MIN_CONVEXITY: f64 = 0.1;

/// A step is at most this many times the distance to the position, so that a search stays on its branch of the line.
const MAX_STEP_RATIO: f64 = 2.0;

/// Beyond the centre of curvature a step is at least this share of the distance to the position.
const LEAST_STEP_RATIO: f64 = 0.25;

/// Most by which a curve leaves the chord between two knots, by its length: above `½ tan 0.2`, the largest turn of a segment.
const MAX_SAG_RATIO: f64 = 0.11;

/// One step of a search, from a point of the curve towards the point nearest to a position.
#[derive(Clone, Copy)]
pub(super) struct SearchStep {
    /// `g = (p − position)·p′`.
    pub slope: f64,
    /// `g′`.
    pub bend: f64,
    /// How far to go along the curve \[m\].
    pub length_m: f64,
}

impl SearchStep {
    /// The step of Halley's method `−g g′/(g′² − ½ g g″)`, or of steepest descent where the distance is not convex.
    #[inline(always)]
    pub fn from(point: &CurvePoint, position: [f64; 2]) -> SearchStep {
        let [place, first, second, third] = point.jet;
        let apart = [place[0] - position[0], place[1] - position[1]];
        let slope = dot(apart, first);
        let square = dot(first, first);
        let bend = square + dot(apart, second);
        let twist = 3.0 * dot(first, second) + dot(apart, third);
        let halley = bend * bend - 0.5 * slope * twist;
        let mut length_m = if bend > MIN_CONVEXITY * square && halley > 0.5 * bend * bend {
            -slope * bend / halley
        } else {
            -slope / square
        };
        let reach_squared = MAX_STEP_RATIO * MAX_STEP_RATIO * dot(apart, apart);
        if length_m * length_m > reach_squared {
            length_m = reach_squared.sqrt().copysign(length_m);
        }
        if bend <= 0.0 {
            // Beyond the centre of curvature the distance may have a maximum here, which the search must leave.
            let least_m = LEAST_STEP_RATIO * dot(apart, apart).sqrt();
            length_m = length_m.abs().max(least_m).copysign(-slope);
        }
        SearchStep { slope, bend, length_m }
    }

    pub fn is_last(&self) -> bool {
        self.length_m.abs() < LAST_STEP_M
    }
}

impl Curve {
    /// The point nearest to a position among those that a descent from an arc length reaches.
    fn descend(&self, position: [f64; 2], from_m: f64) -> (f64, CurvePoint<'_>) {
        let point = self.point(from_m);
        self.descend_on(position, from_m, point, SearchStep::from(&point, position))
    }

    /// The same from a point whose step is known.
    ///
    /// Finds a zero of `g(s) = (p(s) − position)·p′(s)` at which `g` increases, by Halley's method between the places where `g`
    /// was found negative and positive.
    pub(super) fn descend_on<'a>(
        &'a self,
        position: [f64; 2],
        from_m: f64,
        from: CurvePoint<'a>,
        first: SearchStep,
    ) -> (f64, CurvePoint<'a>) {
        let (mut along_m, mut low_m, mut high_m) = (from_m, f64::NEG_INFINITY, f64::INFINITY);
        let (mut point, mut step) = (from, first);
        for _ in 0..MAX_STEPS {
            if step.slope < 0.0 {
                low_m = along_m;
            } else if step.slope > 0.0 {
                high_m = along_m;
            } else if step.bend > 0.0 {
                break;
            }
            if step.is_last() {
                return (along_m + step.length_m, point.moved(step.length_m));
            }
            let mut next_m = along_m + step.length_m;
            if next_m <= low_m || next_m >= high_m {
                next_m = 0.5 * (low_m + high_m);
            }
            along_m = next_m;
            point = self.point_near(along_m, &point);
            step = SearchStep::from(&point, position);
        }
        (along_m, point)
    }

    /// The point nearest to a position, by descents from every segment that may hold it.
    pub(super) fn nearest(&self, position: [f64; 2]) -> (f64, CurvePoint<'_>) {
        let mut best = self.descend(position, self.nearest_chord_m(position));
        let mut best_m = distance(best.1.jet[0], position);
        for group in &self.groups {
            // A segment is a little longer than its chord.
            if group.is_beyond(best_m + 2.0 * MAX_SAG_RATIO * group.longest_m, position) {
                continue;
            }
            for (segment, chord) in self.members(group) {
                let sag_m = MAX_SAG_RATIO * segment.length_m;
                if chord.is_beyond(best_m + sag_m, position) {
                    continue;
                }
                let [distance_m, share] = chord.nearest(position);
                // A descent from the best point so far would only be repeated.
                let is_known = (segment.from_m..=segment.end_m()).contains(&best.0);
                if !is_known && distance_m - sag_m < best_m {
                    let other = self.descend(position, segment.from_m + share * segment.length_m);
                    let other_m = distance(other.1.jet[0], position);
                    if other_m < best_m && (0.0..=self.length_m).contains(&other.0) {
                        (best, best_m) = (other, other_m);
                    }
                }
            }
        }
        best
    }

    fn members(&self, group: &ChordGroup) -> impl Iterator<Item = (&Segment, &Chord)> {
        self.segments[group.chords.clone()].iter().zip(&self.chords[group.chords.clone()])
    }

    /// The arc length of the point of the chords that is nearest to a position; the first of equally near ones \[m\].
    fn nearest_chord_m(&self, position: [f64; 2]) -> f64 {
        let (mut nearby, mut least) = (0, f64::INFINITY);
        for group in self.groups.iter() {
            if group.is_beyond(least.sqrt(), position) {
                continue;
            }
            for index in group.chords.clone() {
                let square = self.chords[index].squared_to_middle(position);
                if square < least {
                    (nearby, least) = (index, square);
                }
            }
        }
        let bound_m = self.chords[nearby].nearest(position)[0];
        let mut best = [f64::INFINITY, 0.0];
        for group in self.groups.iter().filter(|group| !group.is_beyond(bound_m, position)) {
            for (segment, chord) in self.members(group) {
                if !chord.is_beyond(bound_m, position) {
                    let [distance_m, share] = chord.nearest(position);
                    if distance_m < best[0] {
                        best = [distance_m, segment.from_m + share * segment.length_m];
                    }
                }
            }
        }
        best[1]
    }
}
