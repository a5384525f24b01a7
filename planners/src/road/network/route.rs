//! The route of a vehicle through a network.

use std::sync::Arc;

use super::super::centre_line::CentreLine;
use super::super::corridor::Corridor;
use super::super::profile::Profile;
use super::bend::{Bend, CHECKS_PER_KNOT, bends, highest_speed_mps};
use super::error::RouteError;
use super::lane::RightOfWay;
use super::light::LightCycle;
use super::route_conflict::RouteConflict;

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
    /// A straight road without ends.
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
            Some(TightestTurn { lane, along_m, curvature_1pm }) if curvature_1pm.abs() * smallest_m > 1.0 => {
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
