//! The paved area beside a route: all lanes that vehicles use, whatever their direction, and the narrow gaps between them.

use std::f64::consts::TAU;

use super::super::super::centre_line::CentreLine;
use super::super::lane::{Lane, LaneUser};
use super::super::road_network::RoadNetwork;
use super::super::route::Route;
use super::turner::{MAX_EDGE_SLOPE, SPACING, Turner};

/// Distance of the places beside a route that are looked at, in lane widths.
const STEP_RATIO: f64 = 0.05;
/// How far beside its strip a vehicle may swing out, in lane widths.
const FARTHEST_RATIO: f64 = 2.0;
/// Gaps between lanes that are narrower than this are paved, in lane widths.
const GAP_RATIO: f64 = 0.35;
/// So are the holes between the lanes of a junction: in this many directions, lanes are nearer than a lane width.
const DIRECTIONS: usize = 8;
/// Places that are looked at in each direction.
const LOOKS: usize = 4;
/// Of the way to the middle of a curve, places up to this share are looked at.
const INSIDE_SHARE: f64 = 0.9;
/// Length of the parts of a lane that are compared with a place at once, in lane widths.
const PART_RATIO: f64 = 4.0;

/// The edges of the area beside a stretch of a route.
pub(super) struct Area {
    from_m: f64,
    spacing_m: f64,
    /// Width of a lane \[m\].
    pub width_m: f64,
    /// The right and the left edge at places in equal distances \[m\].
    edges_m: Vec<[f64; 2]>,
}

impl Area {
    /// The area beside a window of a route, and a length of the vehicle beyond it.
    pub fn of(network: &RoadNetwork, route: &Route, window_m: [f64; 2], turner: &Turner, width_m: f64) -> Area {
        let reach_m = turner.body.front_m + turner.body.rear_m;
        let from_m = (window_m[0] - reach_m).max(0.0);
        let to_m = (window_m[1] + reach_m).min(route.end_m());
        let spacing_m = 2.0 * SPACING * turner.body.wheelbase_m();
        let count = ((to_m - from_m) / spacing_m).ceil().max(1.0);
        let middle = route.centre.position(0.5 * (from_m + to_m), 0.0);
        let reach_m = 0.5 * (to_m - from_m) + (FARTHEST_RATIO + 1.0) * width_m;
        let pavements = network.lanes().iter().filter_map(|lane| Pavement::of(lane, width_m));
        let near: Vec<Pavement> = pavements.filter(|pavement| pavement.is_within(middle, reach_m)).collect();
        let places = (0..=count as usize).map(|place| {
            let along_m = (from_m + spacing_m * place as f64).min(to_m);
            [-1.0, 1.0].map(|side| edge_m(&near, route, along_m, side, width_m))
        });
        let mut edges_m: Vec<[f64; 2]> = places.collect();
        let most_m = MAX_EDGE_SLOPE * spacing_m;
        let limit = |edges_m: &mut Vec<[f64; 2]>, from: usize, to: usize| {
            let [right_m, left_m] = edges_m[from];
            edges_m[to] = [edges_m[to][0].max(right_m - most_m), edges_m[to][1].min(left_m + most_m)];
        };
        for place in 1..edges_m.len() {
            limit(&mut edges_m, place - 1, place);
        }
        for place in (1..edges_m.len()).rev() {
            limit(&mut edges_m, place, place - 1);
        }
        Area { from_m, spacing_m, width_m, edges_m }
    }

    /// The right (0) or left (1) edge at an arc length \[m\], and its slope; none outside of the area.
    pub fn edge_m(&self, side: usize, along_m: f64) -> Option<[f64; 2]> {
        let place = (along_m - self.from_m) / self.spacing_m;
        let last = (self.edges_m.len() - 1) as f64;
        if !(0.0..=last).contains(&place) {
            return None;
        }
        let (before, after) = (self.edges_m[place as usize][side], self.edges_m[place.ceil() as usize][side]);
        Some([before + (after - before) * (place - place.floor()), (after - before) / self.spacing_m])
    }
}

/// The lateral coordinate of the edge on a side: 1 for the left, −1 for the right \[m\].
fn edge_m(near: &[Pavement], route: &Route, along_m: f64, side: f64, width_m: f64) -> f64 {
    let edges_m = route.edges_before_end_m(along_m);
    let strip_m = if side < 0.0 { -edges_m[0] } else { edges_m[1] };
    let curvature_1pm = side * route.centre.at(along_m).curvature_1pm;
    let inside_m = if curvature_1pm > 0.0 { INSIDE_SHARE / curvature_1pm } else { f64::INFINITY };
    let most_m = (strip_m + FARTHEST_RATIO * width_m).min(inside_m);
    let (step_m, mut edge_m, mut here_m) = (STEP_RATIO * width_m, strip_m, strip_m);
    while here_m + step_m <= most_m {
        here_m += step_m;
        let point = route.centre.position(along_m, side * here_m);
        if is_paved(near, point) {
            edge_m = here_m;
        } else if here_m - edge_m >= GAP_RATIO * width_m && !is_hole(near, point, width_m) {
            break;
        }
    }
    side * edge_m
}

fn is_paved(near: &[Pavement], point: [f64; 2]) -> bool {
    near.iter().any(|pavement| pavement.holds(point))
}

/// Whether a point beside all lanes has lanes on all sides.
fn is_hole(near: &[Pavement], [x_m, y_m]: [f64; 2], width_m: f64) -> bool {
    (0..DIRECTIONS).all(|direction| {
        let (sin, cos) = libm::sincos(TAU * direction as f64 / DIRECTIONS as f64);
        (1..=LOOKS).any(|look| {
            let away_m = width_m * look as f64 / LOOKS as f64;
            is_paved(near, [x_m + away_m * cos, y_m + away_m * sin])
        })
    })
}

/// A lane that vehicles use, with circles around its parts.
struct Pavement<'a> {
    lane: &'a Lane,
    /// Centres \[m\].
    parts: Vec<[f64; 2]>,
    radius_m: f64,
}

impl Pavement<'_> {
    fn of(lane: &Lane, width_m: f64) -> Option<Pavement<'_>> {
        let is_driven = |user: &LaneUser| matches!(user, LaneUser::Car | LaneUser::Bus | LaneUser::Truck);
        if lane.is_zebra || !(lane.users.is_empty() || lane.users.iter().any(is_driven)) {
            return None;
        }
        let centre: &CentreLine = &lane.centre;
        let count = (centre.length_m() / (PART_RATIO * width_m)).ceil().max(1.0);
        let part_m = centre.length_m() / count;
        let parts = (0..count as usize).map(|part| centre.position((part as f64 + 0.5) * part_m, 0.0)).collect();
        Some(Pavement { lane, parts, radius_m: 0.5 * part_m + lane.width.extremes(0.0, centre.length_m())[1] })
    }

    /// Whether a part of it may be nearer to a point than some distance \[m\].
    fn is_within(&self, point: [f64; 2], reach_m: f64) -> bool {
        let distance_m = |part: &[f64; 2]| libm::hypot(part[0] - point[0], part[1] - point[1]);
        self.parts.iter().any(|part| distance_m(part) < self.radius_m + reach_m)
    }

    fn holds(&self, point: [f64; 2]) -> bool {
        self.is_within(point, 0.0) && {
            let at = self.lane.centre.project(point, None);
            (0.0..=self.lane.centre.length_m()).contains(&at.along_m)
                && at.across_m.abs() <= self.lane.half_width_m(at.along_m)
        }
    }
}
