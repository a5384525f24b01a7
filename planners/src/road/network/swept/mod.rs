//! The route of a long vehicle: the line on which its body stays on the road in tight turns.
//!
//! The rear wheels of a vehicle run on a smaller circle than its front wheels. With its mass centre in the middle of a lane, a lorry
//! therefore leaves that lane in a tight turn, at the inner side with its flank and at the outer one with its front. Its driver swings
//! out before the turn, over the lanes beside where it must. Such a driver's route here differs from the lanes' in three ways, near those
//! turns only:
//!
//! - its line is that of the mass centre of a body whose rear axle follows the path of [`path`],
//! - its edges are those of the paved area ([`area`]): oncoming lanes and the other lanes of a junction belong to it,
//! - its own lane is what the body covers, so that routes of others which it covers, too, meet it there (`conflicts`).
//!
//! What others drive on and it covers only because it swings out, it takes while no vehicle comes
//! ([`Route::set_of`]).

mod area;
mod path;
mod turner;

use std::sync::Arc;

use super::super::centre_line::{CentreLine, LineSection};
use super::super::profile::Profile;
use super::edges::smooth_edge;
use super::road_network::RoadNetwork;
use super::route::{Route, RouteLeg};
use crate::vehicle::{Bicycle, Input, State, slip_on_curve_rad};
use area::Area;
use path::Path;
pub use turner::Turner;
use turner::{MAX_EDGE_SLOPE, SPACING};

/// A body may leave its lane by this share of the lane's width before its route differs: a few centimetres.
const BEYOND_LANE_RATIO: f64 = 0.02;
/// Bodies of fewer lane widths in length follow the middle of their lanes everywhere.
const LEAST_LENGTH_RATIO: f64 = 1.5;
/// A turn is too tight where a body leaves the road by more than this many of its widths.
const TOO_TIGHT_WIDTHS: f64 = 0.2;
/// A turn is prepared from this many wheelbases before it on, and left as many after it.
const REACH_WHEELBASES: f64 = 5.0;
/// There the line is straight: mass centre and rear axle are beside it by less than this share of a lane's width.
const STRAIGHT_RATIO: f64 = 1e-3;
/// Length of a step of a kinematic run, in wheelbases.
const STEP: f64 = 0.02;
/// Distance of the places of new edges, in lane widths.
const EDGE_SPACING: f64 = 0.25;
/// The own lane is this much wider than what the body covers, in lane widths.
const BESIDE_BODY: f64 = 0.06;
/// Corrections of the steering of a kinematic run: the lateral error and the heading error vanish within about this many wheelbases.
const CORRECTION_WHEELBASES: f64 = 0.5;

impl RoadNetwork {
    /// The route of a vehicle along the lanes of a route: the same, unless its body would leave its lane in a turn.
    pub fn route_of_body(&self, route: Route, turner: &Turner) -> Route {
        let width_m = 2.0 * route.half_width.extremes(0.0, route.end_m())[0];
        let is_short = turner.body.front_m + turner.body.rear_m < LEAST_LENGTH_RATIO * width_m;
        if is_short || turner.body.width_m >= width_m {
            // A body as wide as its lane leaves it everywhere.
            return route;
        }
        let windows = windows(&route, turner, width_m);
        if windows.is_empty() {
            return route;
        }
        let areas: Vec<Area> =
            windows.iter().map(|window_m| Area::of(self, &route, *window_m, turner, width_m)).collect();
        let along = |hardness: &[f64]| {
            let paths = windows.iter().zip(&areas);
            let paths: Vec<Path> =
                paths.map(|(window_m, area)| Path::new(&route.centre, *window_m, turner, area, hardness)).collect();
            Some(NewLine::of(&route.centre, &paths)?.route(route.clone(), &areas, turner, width_m))
        };
        let most_m = |route: &Route| route.leaves_road_m(turner, 0.0).1;
        // In a turn that is too tight, hard bounds would lead far from the road.
        let hard = along(&path::HARDNESS).filter(|swept| most_m(swept) <= TOO_TIGHT_WIDTHS * turner.body.width_m);
        hard.or_else(|| along(&path::HARDNESS[..1])).filter(|swept| most_m(swept) < most_m(&route)).unwrap_or(route)
    }
}

/// The stretches of a route in which a body leaves its lane, each with room before and behind it \[m\].
fn windows(route: &Route, turner: &Turner, width_m: f64) -> Vec<[f64; 2]> {
    let reach_m = REACH_WHEELBASES * turner.body.wheelbase_m();
    let lane = [route.half_width.mirrored(), route.half_width.clone()];
    let mut found: Vec<[f64; 2]> = Vec::new();
    kinematic_run(route, turner, |along_m, corners, _| {
        let is_reached = found.last().is_some_and(|[from_m, to_m]| (*from_m..=to_m - reach_m).contains(&along_m));
        if !is_reached && beyond_m(route, [&lane[0], &lane[1]], along_m, corners) > BEYOND_LANE_RATIO * width_m {
            // In a curve, the line of the mass centre is not that of the rear axle.
            let is_straight = |along_m: f64| {
                let off_m = route.centre.at(along_m).curvature_1pm * turner.body.rear_axle_m * turner.body.rear_axle_m;
                off_m.abs() < STRAIGHT_RATIO * width_m
            };
            let step_m = SPACING * turner.body.wheelbase_m();
            let (mut from_m, mut to_m) = (along_m - reach_m, along_m + reach_m);
            while from_m > 0.0 && !is_straight(from_m) {
                from_m -= step_m;
            }
            while to_m < route.end_m() && !is_straight(to_m) {
                to_m += step_m;
            }
            match found.last_mut().filter(|last| from_m < last[1] + reach_m) {
                Some(last) => last[1] = last[1].max(to_m),
                None => found.push([from_m, to_m]),
            }
        }
    });
    found.into_iter().map(|[from_m, to_m]| [from_m.max(0.0), to_m.min(route.end_m())]).collect()
}

/// By how much corners are beyond edges at most \[m\].
fn beyond_m(route: &Route, [right, left]: [&Profile; 2], along_m: f64, corners: &[[f64; 2]; 4]) -> f64 {
    let beyond = corners.iter().map(|corner| {
        let at = route.centre.project(*corner, Some(along_m));
        (right.value(at.along_m) - at.across_m).max(at.across_m - left.value(at.along_m))
    });
    beyond.fold(f64::NEG_INFINITY, f64::max)
}

/// Drives a body along a route by the bicycle model, slowly and with what its steering can do, and calls `see` at each step with the
/// arc length of its mass centre \[m\], its corners and its state.
fn kinematic_run(route: &Route, turner: &Turner, mut see: impl FnMut(f64, &[[f64; 2]; 4], &State)) {
    let Turner { body, steering_max_rad } = *turner;
    let (centre, wheelbase_m) = (&route.centre, body.wheelbase_m());
    let (step_m, rest_m) = (STEP * wheelbase_m, CORRECTION_WHEELBASES * wheelbase_m);
    let model = Bicycle::new(&body, step_m);
    let wanted_rad = |along_m: f64| {
        centre.at(along_m).heading_rad
            - slip_on_curve_rad(body.rear_axle_m, centre.at(along_m - body.rear_axle_m).curvature_1pm)
    };
    let [x_m, y_m] = centre.position(0.0, 0.0);
    let mut state = State { x_m, y_m, heading_rad: wanted_rad(0.0), speed_mps: 1.0 };
    let mut along_m = 0.0;
    for _ in 0..(route.end_m() / step_m) as usize {
        see(along_m, &body.corners(&state), &state);
        let at = centre.project(state.position(), Some(along_m));
        along_m = at.along_m;
        let [now_rad, next_rad] = [0.5, 1.5].map(|steps| wanted_rad(along_m + steps * step_m));
        let turn_1pm = (next_rad - now_rad) / step_m
            - 2.0 / rest_m * (state.heading_rad - now_rad)
            - at.across_m / (rest_m * rest_m);
        let sin_slip = (body.rear_axle_m * turn_1pm).clamp(-0.9, 0.9);
        let steering_rad = libm::atan(wheelbase_m / body.rear_axle_m * sin_slip / (1.0 - sin_slip * sin_slip).sqrt());
        let steering_rad = steering_rad.clamp(-steering_max_rad, steering_max_rad);
        state = model.step(&state, &Input { acceleration_mps2: 0.0, steering_rad });
    }
}

impl Route {
    /// The place from an arc length on where a body that follows the route leaves the road most, and by how much \[m\]: zero where it stays
    /// on it. It is found by driving the body along the route by the bicycle model.
    pub fn leaves_road_m(&self, turner: &Turner, from_m: f64) -> (f64, f64) {
        let mut worst = (0.0, 0.0);
        if self.centre.length_m().is_finite() {
            kinematic_run(self, turner, |along_m, corners, _| {
                let beyond_m = beyond_m(self, [&self.right, &self.left], along_m, corners);
                if along_m >= from_m && beyond_m > worst.1 {
                    worst = (along_m, beyond_m);
                }
            });
        }
        worst
    }

    /// Whether it differs from the route along the middle of its lanes, for a long body.
    pub fn is_swept(&self) -> bool {
        self.plain.is_some()
    }
}

/// A line that replaces another one in some windows.
struct NewLine {
    line: CentreLine,
    /// What is left of the old one: from and to on it, and how much further it begins on the new one \[m\].
    kept: Vec<[f64; 3]>,
}

impl NewLine {
    /// The line along paths; `None` without such a line.
    fn of(old: &CentreLine, paths: &[Path]) -> Option<NewLine> {
        let lines: Vec<CentreLine> = paths.iter().map(|path| path.line_of_mass_centre().ok()).collect::<Option<_>>()?;
        let mut sections: Vec<LineSection> = Vec::new();
        let mut from_m = 0.0;
        for (path, line) in paths.iter().zip(&lines) {
            let [begin_m, end_m] = path.window_m;
            let (has_before, has_after) = (begin_m > path.spacing_m, end_m < old.length_m() - path.spacing_m);
            if has_before {
                sections.push(LineSection { line: old, from_m, to_m: begin_m });
            }
            let [cut_m, rest_m] = [has_before, has_after].map(|is_joined| if is_joined { path.spacing_m } else { 0.0 });
            sections.push(LineSection { line, from_m: cut_m, to_m: line.length_m() - rest_m });
            from_m = end_m;
        }
        if old.length_m() - from_m > paths.last()?.spacing_m {
            sections.push(LineSection { line: old, from_m, to_m: old.length_m() });
        }
        let joined = CentreLine::joined(&sections).ok()?;
        let places = sections.iter().zip(&joined.sections_m).filter(|(section, _)| std::ptr::eq(section.line, old));
        let kept = places.map(|(section, new_m)| [section.from_m, section.to_m, new_m[0] - section.from_m]).collect();
        Some(NewLine { line: joined.line, kept })
    }

    /// The arc length on this line of one on the old line \[m\].
    fn new_m(&self, old: &CentreLine, along_m: f64) -> f64 {
        let kept = self.kept.iter().find(|[from_m, to_m, _]| (*from_m..=*to_m).contains(&along_m));
        kept.map_or_else(
            || self.line.project(old.position(along_m, 0.0), Some(along_m)).along_m,
            |[_, _, shift_m]| along_m + shift_m,
        )
    }

    /// The route along this line: its edges are those of the areas, and its lane is what the body covers.
    fn route(self, plain: Route, areas: &[Area], turner: &Turner, width_m: f64) -> Route {
        let old = &plain.centre;
        let count = (self.line.length_m() / (EDGE_SPACING * width_m)).ceil().max(2.0) as usize;
        let along_m = |place: usize| self.line.length_m() * place as f64 / count as f64;
        let mut near_m = 0.0;
        // Where each place is beside the old line \[m\].
        let places = (0..=count).map(|place| {
            let old_m = along_m(place);
            let kept =
                self.kept.iter().find(|[from_m, to_m, shift_m]| (from_m + shift_m..=to_m + shift_m).contains(&old_m));
            let beside = kept.map(|[_, _, shift_m]| [old_m - shift_m, 0.0]).unwrap_or_else(|| {
                let at = old.project(self.line.position(old_m, 0.0), Some(near_m));
                [at.along_m, at.across_m]
            });
            near_m = beside[0];
            beside
        });
        let places: Vec<[f64; 2]> = places.collect();
        let edge = |profile: &Profile, paved: Option<usize>, sign: f64| {
            let knot = |(place, [old_m, off_m]): (usize, &[f64; 2])| {
                let strip_m = profile.value_before_end(*old_m);
                let paved_m = areas.iter().zip(paved).find_map(|(area, side)| area.edge_m(side, *old_m));
                [along_m(place), sign * (paved_m.map_or(strip_m, |[edge_m, _]| edge_m) - off_m)]
            };
            smooth_edge(places.iter().enumerate().map(knot).collect(), 1e-7 * width_m, sign, MAX_EDGE_SLOPE)
        };
        let half = &plain.half_width;
        let lines = [edge(&half.mirrored(), None, -1.0), edge(half, None, 1.0)];
        let [right, left] = [edge(&plain.right, Some(0), -1.0), edge(&plain.left, Some(1), 1.0)];
        let same = plain.same_direction.as_ref();
        let same_direction = same.map(|[right, left]| [edge(right, None, -1.0), edge(left, None, 1.0)]);
        let legs = plain.legs.iter().map(|leg| moved(leg, |along_m| self.new_m(old, along_m))).collect();
        let mut route = Route::curved(self.line.clone(), right, left, half.clone());
        (route.legs, route.same_direction) = (legs, same_direction);
        let is_kept: Vec<bool> = places.iter().map(|[_, off_m]| *off_m == 0.0).collect();
        route.cover(&lines, &is_kept, turner, width_m);
        route.plain = Some(Arc::new(plain));
        route
    }
}

impl Route {
    /// Widens its lane from its lines to what the body covers. Where it is not kept, the route meets others only on what that is.
    fn cover(&mut self, [right, left]: &[Profile; 2], is_kept: &[bool], turner: &Turner, width_m: f64) {
        let count = (is_kept.len() - 1) as f64;
        let half = self.half_width.clone();
        let mut covered_m = vec![0.0_f64; is_kept.len()];
        let along_m = |place: usize| self.end_m() * place as f64 / count;
        let mut lines: Vec<[f64; 2]> =
            (0..=count as usize).map(|place| [right.value(along_m(place)), left.value(along_m(place))]).collect();
        kinematic_run(self, turner, |near_m, corners, _| {
            for corner in corners {
                let at = self.centre.project(*corner, Some(near_m));
                let place = (at.along_m / self.end_m() * count).clamp(0.0, count);
                for place in place as usize..=place.ceil() as usize {
                    lines[place][0] = lines[place][0].min(at.across_m - BESIDE_BODY * width_m);
                    lines[place][1] = lines[place][1].max(at.across_m + BESIDE_BODY * width_m);
                    covered_m[place] = covered_m[place].max(at.across_m.abs() + BESIDE_BODY * width_m);
                }
            }
        });
        let edge = |side: usize, sign: f64| {
            let places = lines.iter().enumerate().map(|(place, line)| [along_m(place), sign * line[side]]).collect();
            widened(places, sign)
        };
        let [right, left] = [edge(0, -1.0), edge(1, 1.0)];
        let halves = is_kept.iter().zip(&covered_m).enumerate().map(|(place, (is_kept, covered_m))| {
            let at_m = along_m(place);
            [at_m, if *is_kept || *covered_m == 0.0 { half.value(at_m) } else { *covered_m }]
        });
        self.half_width = widened(halves.collect(), 1.0);
        let centre = self.centre.clone();
        self.own_lane = Some(Arc::new(Route::curved(centre, right, left, self.half_width.clone())));
    }
}

/// A leg of a route of which the arc lengths have changed.
fn moved(leg: &RouteLeg, new_m: impl Fn(f64) -> f64) -> RouteLeg {
    let middle_m = 0.5 * (leg.from_m + leg.to_m);
    let offset_m = leg.offset_m + new_m(middle_m) - middle_m;
    RouteLeg { from_m: new_m(leg.from_m), to_m: new_m(leg.to_m), offset_m, ..leg.clone() }
}

/// A profile that is nowhere inside of an edge, times `sign`, and nowhere much steeper than the edges of a road.
fn widened(mut places: Vec<[f64; 2]>, sign: f64) -> Profile {
    let limit = |places: &mut Vec<[f64; 2]>, from: usize, to: usize| {
        let least = places[from][1] - MAX_EDGE_SLOPE * (places[to][0] - places[from][0]).abs();
        places[to][1] = places[to][1].max(least);
    };
    for index in 1..places.len() {
        limit(&mut places, index - 1, index);
    }
    for index in (1..places.len()).rev() {
        limit(&mut places, index, index - 1);
    }
    let knots: Vec<[f64; 2]> = places.into_iter().map(|[along_m, value]| [along_m, sign * value]).collect();
    Profile::through(&knots).unwrap_or(Profile::constant(0.0))
}
