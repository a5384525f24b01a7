//! The route of a vehicle through a network.

use std::sync::Arc;

use super::super::corridor::Corridor;
use super::super::profile::Profile;
use super::error::RouteError;
use super::lane::RightOfWay;
use super::light::LightCycle;
use crate::road::centre_line::CentreLine;

/// The way of a vehicle: a centre line, and the strip beside it that the vehicle may use.
///
/// A route that is not made by a [`RoadNetwork`](super::RoadNetwork) may have any centre line, also one without ends, and any
/// edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Route {
    /// The line that the vehicle follows: the centres of its lanes, joined.
    pub centre: CentreLine,
    /// Lateral coordinate of the right edge of the strip over the arc length of `centre` \[m\].
    pub right: Profile,
    /// Lateral coordinate of the left edge \[m\].
    pub left: Profile,
    /// Half of the width of the lane that the centre line is on \[m\].
    pub half_width: Profile,
    /// The lanes in the order in which the centre line follows them, without gaps.
    pub legs: Vec<RouteLeg>,
    /// The right and the left edge of the part of the strip that is driven in the direction of the route \[m\]; none where that
    /// is all of it.
    pub(super) same_direction: Option<[Profile; 2]>,
    /// The same line with the edges of the lane that it is on; none for a route that stands alone.
    pub(super) own_lane: Option<Arc<Route>>,
    /// Its number in a set of routes that know where they meet; none for one that stands alone.
    pub(super) number: Option<usize>,
    /// Where it meets the others of that set.
    pub(super) conflicts: Vec<RouteConflict>,
    /// The route along the middle of its lanes; none where this is that route. A long body swings out of it.
    pub(super) plain: Option<Arc<Route>>,
    /// The route as a straight road, if it is one.
    pub(super) straight: Option<Corridor>,
    /// Largest curvature of the centre line \[1/m\].
    pub(super) max_curvature_1pm: f64,
    /// Its parts with their curvatures, in order.
    pub(super) bends: Vec<Bend>,
}

/// The part of a route on one lane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RouteLeg {
    /// The name of the lane.
    pub lane: String,
    /// Where the leg begins on the route \[m\].
    pub from_m: f64,
    /// Where the leg ends on the route \[m\].
    pub to_m: f64,
    /// Arc length of the route less that of the lane, where both run together \[m\].
    pub offset_m: f64,
    /// Highest permitted speed on the lane \[m/s\].
    pub speed_limit_mps: Option<f64>,
    /// Who goes first at the end of the lane.
    pub right_of_way: RightOfWay,
    /// The traffic light at the end of the lane.
    pub light: Option<Arc<LightCycle>>,
    /// Whether the lane is a zebra crossing.
    pub is_zebra: bool,
    /// Whether the lane ends, and the route leaves it near its end for the lane beside.
    pub is_left_late: bool,
}

/// The place of a route at which its centre line has the largest curvature.
#[derive(Clone, Debug, PartialEq)]
pub struct TightestTurn {
    /// Name of the lane at this place.
    pub lane: String,
    /// Arc length of the route \[m\].
    pub along_m: f64,
    /// Curvature of the centre line at this place \[1/m\].
    pub curvature_1pm: f64,
}

impl From<Corridor> for Route {
    fn from(corridor: Corridor) -> Route {
        let Corridor { heading_rad, right_m, left_m, end } = corridor;
        let right = end.map_or_else(|| Profile::constant(right_m), |end| Profile::lane_end(right_m, end));
        Route {
            centre: CentreLine::straight(heading_rad),
            right,
            left: Profile::constant(left_m),
            half_width: Profile::constant(0.5 * (left_m - right_m)),
            legs: Vec::new(),
            same_direction: None,
            own_lane: None,
            number: None,
            conflicts: Vec::new(),
            plain: None,
            straight: Some(corridor),
            max_curvature_1pm: 0.0,
            bends: Vec::new(),
        }
    }
}

impl From<Corridor> for Arc<Route> {
    fn from(corridor: Corridor) -> Arc<Route> {
        Arc::new(Route::from(corridor))
    }
}

impl Route {
    /// A curved road: the strip between two edges beside a line, given as lateral coordinates over its arc length \[m\].
    pub fn curved(centre: CentreLine, right: Profile, left: Profile, half_width: Profile) -> Route {
        let bends = bends(&centre);
        let max_curvature_1pm = bends.iter().map(|bend| bend.curvature_1pm).fold(0.0, f64::max);
        let (legs, conflicts) = (Vec::new(), Vec::new());
        Route {
            centre,
            right,
            left,
            half_width,
            legs,
            same_direction: None,
            own_lane: None,
            number: None,
            conflicts,
            plain: None,
            straight: None,
            max_curvature_1pm,
            bends,
        }
    }

    /// The same line, bounded to the lane that it is on; `None` for a route outside a network.
    pub fn own_lane(&self) -> Option<&Arc<Route>> {
        self.own_lane.as_ref()
    }

    /// The route as a straight road, if it is one.
    pub fn straight(&self) -> Option<&Corridor> {
        self.straight.as_ref()
    }

    /// Arc length at which the route ends \[m\].
    pub fn end_m(&self) -> f64 {
        self.centre.length_m()
    }

    /// The leg at an arc length; beyond the ends, the first or the last leg. `None` without legs.
    pub fn leg(&self, along_m: f64) -> Option<&RouteLeg> {
        self.legs.iter().find(|leg| along_m < leg.to_m).or_else(|| self.legs.last())
    }

    /// The arc length of the route at an arc length of one of its lanes \[m\]; `None` for a lane on which it has no leg.
    ///
    /// Exact where the route follows the lane's centre line. Where it changes to a lane beside it, it is the place of the
    /// lane's continuation, which may lie before or after the leg.
    pub fn along_m(&self, lane: &str, along_lane_m: f64) -> Option<f64> {
        self.legs.iter().find(|leg| leg.lane == lane).map(|leg| along_lane_m + leg.offset_m)
    }

    /// The highest speed at an arc length from which, braking at `braking_mps2`, the vehicle keeps the speed limits of
    /// all lanes ahead; `None` without speed limits \[m/s\].
    pub fn permitted_speed_mps(&self, along_m: f64, braking_mps2: f64) -> Option<f64> {
        let ahead = self.legs.iter().filter(|leg| leg.to_m > along_m || self.legs.last() == Some(leg));
        let limits = ahead.filter_map(|leg| {
            let room_m = (leg.from_m - along_m).max(0.0);
            leg.speed_limit_mps.map(|limit_mps| (limit_mps * limit_mps + 2.0 * braking_mps2 * room_m).sqrt())
        });
        limits.min_by(f64::total_cmp)
    }

    /// The highest speed at an arc length from which, braking at `braking_mps2`, the vehicle takes every curve ahead
    /// with at most this lateral acceleration; `None` without curves ahead \[m/s\].
    pub fn curve_speed_mps(&self, along_m: f64, lateral_mps2: f64, braking_mps2: f64) -> Option<f64> {
        highest_speed_mps(&self.bends, along_m, lateral_mps2, braking_mps2)
    }

    /// The place with the largest curvature; `None` for a route without legs.
    pub fn tightest_turn(&self) -> Option<TightestTurn> {
        let (along_m, curvature_1pm) = max_curvature(&self.centre);
        let lane = self.leg(along_m)?.lane.clone();
        Some(TightestTurn { lane, along_m, curvature_1pm })
    }

    /// Checks that a vehicle can follow the centre line.
    ///
    /// # Errors
    /// [`RouteError::TooTight`] where the curve is tighter than the smallest turning radius of the vehicle \[m\].
    pub fn check_turns(&self, smallest_m: f64) -> Result<(), RouteError> {
        match self.tightest_turn() {
            // Whether a long body comes round is found out by driving it along its line.
            Some(TightestTurn { lane, along_m, curvature_1pm })
                if self.plain.is_none() && curvature_1pm.abs() * smallest_m > 1.0 =>
            {
                Err(RouteError::TooTight { lane, along_m, radius_m: 1.0 / curvature_1pm.abs(), smallest_m })
            }
            _ => Ok(()),
        }
    }
}

/// Where a line has its largest curvature, and that curvature; zero for a line without knots.
pub(super) fn max_curvature(line: &CentreLine) -> (f64, f64) {
    let knots_m = line.knots_m();
    let places = knots_m.windows(2).flat_map(|pair| {
        (0..=CHECKS_PER_KNOT).map(|part| pair[0] + (pair[1] - pair[0]) * part as f64 / CHECKS_PER_KNOT as f64)
    });
    let turns = places.map(|along_m| (along_m, line.at(along_m).curvature_1pm));
    turns.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).unwrap_or_default()
}

/// A place where a route meets another one of the same network, described from the first route.
#[derive(Clone, Debug, PartialEq)]
pub struct RouteConflict {
    /// The number of the other route.
    pub(super) with: usize,
    /// Where the route is on the lanes of the other one, from and to \[m\].
    pub own_m: [f64; 2],
    /// Where the other one is on the lanes of this one \[m\].
    pub their_m: [f64; 2],
    /// Where a vehicle on this route waits before the conflict \[m\].
    pub own_line_m: f64,
    /// Where a vehicle on the other route waits \[m\].
    pub their_line_m: f64,
    /// Where the centre lines meet, on this route \[m\].
    pub own_meeting_m: f64,
    /// Where the centre lines meet, on the other one \[m\].
    pub their_meeting_m: f64,
    /// Whether the routes cross, merge, part or run against each other there.
    pub kind: ConflictKind,
    /// Which of the two vehicles goes first at the conflict.
    pub precedence: Precedence,
}

/// The rule for which vehicle goes first where two routes meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precedence {
    /// The vehicles on this route go first.
    Own,
    /// The vehicles on the other route go first.
    Other,
    /// The first to arrive goes first.
    ByArrival,
}

/// How two routes overlap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConflictKind {
    /// The routes come from different lanes and go on to different lanes.
    Crossing,
    /// The routes go on to the same lane.
    Merging,
    /// The routes come from the same lane and go on to different lanes.
    Diverging,
    /// The routes use the same strip in opposite directions.
    HeadOn,
}

/// A part of a route, between two knots of its centre line, with its largest curvature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bend {
    /// Where it begins \[m\].
    from_m: f64,
    /// Where it ends \[m\].
    to_m: f64,
    /// Largest curvature in it, without sign \[1/m\].
    pub curvature_1pm: f64,
}

/// How many places are checked between two knots of a centre line.
pub(super) const CHECKS_PER_KNOT: usize = 8;

/// A curvature below this is that of a straight road \[1/m\].
const STRAIGHT_CURVATURE_1PM: f64 = 1e-6;

/// The parts of a centre line between its knots, in order.
pub(super) fn bends(centre: &CentreLine) -> Vec<Bend> {
    let knots_m = centre.knots_m();
    let parts = knots_m.windows(2).map(|pair| {
        let places = (0..=CHECKS_PER_KNOT).map(|part| part as f64 / CHECKS_PER_KNOT as f64);
        let curvatures = places.map(|share| centre.at(pair[0] + share * (pair[1] - pair[0])).curvature_1pm.abs());
        Bend { from_m: pair[0], to_m: pair[1], curvature_1pm: curvatures.fold(0.0, f64::max) }
    });
    parts.collect()
}

/// The speed at an arc length from which every curve ahead is taken with at most a lateral acceleration, braking at `braking_mps2`:
/// the least of `√(a/κ + 2 b d)` over the curves, `d` ahead; none without curves ahead \[m/s\].
pub(super) fn highest_speed_mps(bends: &[Bend], along_m: f64, lateral_mps2: f64, braking_mps2: f64) -> Option<f64> {
    let speeds =
        bends.iter().filter(|bend| bend.to_m > along_m && bend.curvature_1pm > STRAIGHT_CURVATURE_1PM).map(|bend| {
            let room_m = (bend.from_m - along_m).max(0.0);
            (lateral_mps2 / bend.curvature_1pm + 2.0 * braking_mps2 * room_m).sqrt()
        });
    speeds.min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use crate::road::centre_line::{CentreLine, Piece, smooth};

    /// Straight for 50 m, a quarter of a circle of 20 m, straight again: 2 m/s² allow `√(2·20)` m/s on the circle, and before it
    /// what braking at 3 m/s² takes off.
    #[test]
    fn a_curve_ahead_limits_the_speed_by_the_braking_distance() {
        let pieces = [
            Piece::Straight { length_m: 50.0 },
            Piece::Arc { length_m: 10.0 * std::f64::consts::PI, curvature_1pm: 0.05 },
            Piece::Straight { length_m: 50.0 },
        ];
        let centre = CentreLine::from_pieces([0.0; 2], 0.0, &smooth(&pieces, 4.0).expect("room")).expect("a line");
        let bends = super::bends(&centre);
        let speed_mps = |along_m| super::highest_speed_mps(&bends, along_m, 2.0, 3.0);
        let on_circle_mps = speed_mps(65.0).expect("on the circle");
        assert!((on_circle_mps - 40.0_f64.sqrt()).abs() < 0.02 * on_circle_mps, "{on_circle_mps}");
        // The curvature of the circle is reached within the transition from 48 to 52 m.
        let before_mps = speed_mps(20.0).expect("before the circle");
        let by_braking_mps = |room_m: f64| (40.0 + 2.0 * 3.0 * room_m).sqrt();
        assert!((by_braking_mps(28.0)..=by_braking_mps(32.0)).contains(&before_mps), "{before_mps}");
        assert_eq!(speed_mps(105.0), None);
    }
}
