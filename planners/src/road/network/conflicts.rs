//! Finds the places where two routes cross or merge.

use super::route::{ConflictKind, Route};

/// Parts of two routes whose lanes overlap without being the same lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conflict {
    /// Where the first route is on the lanes of the second one, from and to \[m\].
    pub on_a: [f64; 2],
    /// Where the second route is on the lanes of the first one \[m\].
    pub on_b: [f64; 2],
    /// Whether the routes cross, merge, part or run against each other there.
    pub kind: ConflictKind,
}

/// The ends of conflicts are accurate to this share of the width of the narrowest lane.
pub const CONFLICT_TOLERANCE_RATIO: f64 = 0.01;

/// RoadLanes that overlap by less than this share of their width lie side by side, and do not conflict.
const SIDE_BY_SIDE_RATIO: f64 = 0.05;

/// Edges that touch do not overlap: each lane is taken as narrower by this share.
const TOUCHING_RATIO: f64 = 0.01;

/// Distance of the places that are compared, by the width of the narrowest lane.
const SPACING_RATIO: f64 = 0.2;

/// Most places of a route that are compared: roads of ordinary lanes have fewer on 10 km.
const MAX_PLACES: f64 = 20_000.0;

/// How many points of a cross-section are compared before the one nearest to the other route is refined.
const POINTS_ACROSS: usize = 9;

/// Steps of a golden-section search across a lane: each leaves 0.62 of the interval.
const REFINEMENTS: usize = 12;

/// The golden section, `(√5 − 1)/2`.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// The parts of two routes whose lanes overlap, in the order of the first route.
///
/// The lanes that the centre lines follow are compared, not the neighbouring lanes of the strips: vehicles on lanes side by
/// side do not conflict. Where both routes are on the same lane, they follow each other without conflict. Places a
/// fifth of a lane width apart are compared, at most `MAX_PLACES` of a route, so an overlap that is shorter may be missed; the
/// ends of the others are exact to [`CONFLICT_TOLERANCE_RATIO`] lane widths. Both routes need ends; others have no conflicts.
pub fn conflicts(a: &Route, b: &Route) -> Vec<Conflict> {
    if !(a.end_m().is_finite() && b.end_m().is_finite()) {
        return Vec::new();
    }
    let (on_a, on_b) = (overlaps(a, b), overlaps(b, a));
    let conflict = |overlap: &Overlap| {
        let meets = |other: &&Overlap| {
            let touches = |one: [f64; 2], two: [f64; 2]| one[0] <= two[1] && two[0] <= one[1];
            touches(other.own_m, overlap.other_m) && touches(overlap.own_m, other.other_m)
        };
        // The search on the other route gives its precise ends; an overlap so short that only one search finds it keeps
        // the approximate ends.
        let refined = on_b.iter().filter(meets).map(|other| other.own_m).reduce(hull);
        let (on_a, on_b) = (overlap.own_m, refined.unwrap_or(overlap.other_m));
        let beyond_m = 2.0 * SPACING_RATIO * narrowest_m(a, b);
        let same_lane = |on_a_m: f64, on_b_m: f64| match (a.leg(on_a_m), b.leg(on_b_m)) {
            (Some(a), Some(b)) => a.lane == b.lane,
            _ => false,
        };
        let kind = if same_lane(on_a[1] + beyond_m, on_b[1] + beyond_m) {
            ConflictKind::Merging
        } else if same_lane(on_a[0] - beyond_m, on_b[0] - beyond_m) {
            ConflictKind::Diverging
        } else {
            ConflictKind::Crossing
        };
        Conflict { on_a, on_b, kind }
    };
    on_a.iter().map(conflict).collect()
}

/// Width of the narrowest lane of two routes \[m\].
fn narrowest_m(a: &Route, b: &Route) -> f64 {
    let narrowest = |route: &Route| 2.0 * route.half_width.extremes(0.0, route.end_m())[0];
    narrowest(a).min(narrowest(b))
}

/// The largest distance of the places of a route that are compared \[m\].
fn spacing_m(own: &Route, narrowest_m: f64) -> f64 {
    (SPACING_RATIO * narrowest_m).max(own.end_m() / MAX_PLACES)
}

/// A part of a route on the lanes of another one, and about where that is on the other one \[m\].
struct Overlap {
    own_m: [f64; 2],
    other_m: [f64; 2],
    /// Most by which the lanes overlap \[m\].
    depth_m: f64,
}

/// A place of a route on the lanes of another one: where that is on the other one, and by how much the lanes overlap \[m\].
struct Meeting {
    other_m: f64,
    depth_m: f64,
}

fn hull(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// The parts of `own` that lie on the lanes of `other`, without those on a lane that both follow.
fn overlaps(own: &Route, other: &Route) -> Vec<Overlap> {
    let narrowest_m = narrowest_m(own, other);
    let (spacing_m, tolerance_m) = (spacing_m(own, narrowest_m), CONFLICT_TOLERANCE_RATIO * narrowest_m);
    let widest_half_m = other.half_width.extremes(0.0, other.end_m())[1];
    let pair = RoutePair { own, other, widest_half_m };
    let count = (own.end_m() / spacing_m).ceil().max(1.0) as usize;
    let mut found: Vec<Overlap> = Vec::new();
    let mut before: Option<(f64, bool)> = None;
    for place in 0..=count {
        let along_m = own.end_m() * place as f64 / count as f64;
        let meets = pair.meeting(along_m);
        let earlier = before;
        let was_inside = earlier.is_some_and(|(_, was_inside)| was_inside);
        let edge_m = || match earlier {
            Some((before_m, _)) => {
                bisect(before_m, along_m, tolerance_m, |at_m| pair.meeting(at_m).is_some() == was_inside)
            }
            None => along_m,
        };
        before = Some((along_m, meets.is_some()));
        match (meets, found.last_mut()) {
            (Some(Meeting { other_m, depth_m }), Some(overlap)) if was_inside => {
                overlap.own_m[1] = along_m;
                overlap.other_m = hull(overlap.other_m, [other_m; 2]);
                overlap.depth_m = overlap.depth_m.max(depth_m);
            }
            (Some(Meeting { other_m, depth_m }), _) => {
                found.push(Overlap { own_m: [edge_m(), along_m], other_m: [other_m; 2], depth_m });
            }
            (None, Some(overlap)) if was_inside => overlap.own_m[1] = edge_m(),
            (None, _) => {}
        }
    }
    found.retain(|overlap| overlap.depth_m > SIDE_BY_SIDE_RATIO * narrowest_m);
    // An overlap may extend beyond its sampled positions by up to one spacing.
    for overlap in &mut found {
        overlap.other_m = [overlap.other_m[0] - spacing_m, overlap.other_m[1] + spacing_m];
    }
    found
}

/// The place where a claim that holds at `from_m` and not at `to_m` ceases to hold, to a tolerance.
fn bisect(mut from_m: f64, mut to_m: f64, tolerance_m: f64, holds: impl Fn(f64) -> bool) -> f64 {
    while to_m - from_m > tolerance_m {
        let middle_m = 0.5 * (from_m + to_m);
        if holds(middle_m) {
            from_m = middle_m;
        } else {
            to_m = middle_m;
        }
    }
    0.5 * (from_m + to_m)
}

/// Two routes of which one is compared with the lanes of the other.
struct RoutePair<'a> {
    own: &'a Route,
    other: &'a Route,
    /// Half of the width of the widest lane of `other` \[m\].
    widest_half_m: f64,
}

impl RoutePair<'_> {
    /// Where the cross-section of a route at an arc length touches the lanes of the other one, if it does.
    fn meeting(&self, along_m: f64) -> Option<Meeting> {
        let half_m = (1.0 - TOUCHING_RATIO) * self.own.half_width.value(along_m);
        if self.is_clear(along_m, half_m) {
            return None;
        }
        let share = |index: usize| -1.0 + 2.0 * index as f64 / (POINTS_ACROSS - 1) as f64;
        let points = (0..POINTS_ACROSS).map(|index| (share(index), self.overlap(along_m, share(index) * half_m)));
        let (deepest, mut meeting) = points.max_by(|a, b| a.1.depth_m.total_cmp(&b.1.depth_m))?;
        if meeting.depth_m < 0.0 {
            // Between two points, too, the cross-section may touch: the depth is concave near its maximum.
            let step = 2.0 / (POINTS_ACROSS - 1) as f64;
            let (mut low, mut high) = ((deepest - step).max(-1.0), (deepest + step).min(1.0));
            if -meeting.depth_m > (high - low) * half_m {
                return None;
            }
            for _ in 0..REFINEMENTS {
                let (a, b) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
                if self.overlap(along_m, a * half_m).depth_m > self.overlap(along_m, b * half_m).depth_m {
                    high = b;
                } else {
                    low = a;
                }
            }
            meeting = self.overlap(along_m, 0.5 * (low + high) * half_m);
        }
        (meeting.depth_m >= 0.0 && !self.is_same_lane(along_m, meeting.other_m)).then_some(meeting)
    }

    /// Whether a cross-section is too far from the other route to touch it, or in the middle of a lane that both follow.
    fn is_clear(&self, along_m: f64, half_m: f64) -> bool {
        let centre = self.own.centre.position(along_m, 0.0);
        let nearest = self.other.centre.project(centre, None);
        let foot = self.other.centre.position(nearest.along_m.clamp(0.0, self.other.end_m()), 0.0);
        let apart_m = libm::hypot(centre[0] - foot[0], centre[1] - foot[1]);
        let is_in_the_middle = apart_m < SIDE_BY_SIDE_RATIO * half_m;
        apart_m > half_m + self.widest_half_m || (is_in_the_middle && self.is_same_lane(along_m, nearest.along_m))
    }

    fn is_same_lane(&self, own_m: f64, other_m: f64) -> bool {
        self.own.leg(own_m).map(|leg| &leg.lane) == self.other.leg(other_m).map(|leg| &leg.lane)
    }

    /// By how much a point of a cross-section is inside of the other lanes, negative outside, and where that is.
    fn overlap(&self, along_m: f64, across_m: f64) -> Meeting {
        let point = self.other.centre.project(self.own.centre.position(along_m, across_m), None);
        let inside_m = point.along_m.min(self.other.end_m() - point.along_m);
        let other_half_m = (1.0 - TOUCHING_RATIO) * self.other.half_width.value(point.along_m);
        Meeting { other_m: point.along_m, depth_m: (other_half_m - point.across_m.abs()).min(inside_m) }
    }
}
