//! The routes of several vehicles through one network, with their conflicts and the right of way in each.

use std::f64::consts::PI;
use std::sync::Arc;

use super::conflicts::{Conflict, conflicts};
use super::error::RouteError;
use super::lane::RightOfWay;
use super::road_network::{RoadNetwork, turn_rad};
use super::route::{ConflictKind, Precedence, Route, RouteConflict, RouteLeg};

/// Approaches whose directions differ by less than this come from the same side, and by more than 180° less this from opposite
/// sides \[rad\].
const SAME_SIDE_RAD: f64 = 45.0 * PI / 180.0;

/// A lane that turns by more than this to the left is a left turn \[rad\].
const LEFT_TURN_RAD: f64 = 30.0 * PI / 180.0;

/// A vehicle that swings out waits at the line of its lane, unless that is farther away than this many half widths of what it covers.
const SWINGING_RATIO: f64 = 8.0;

impl RoadNetwork {
    /// The routes along lists of lanes, each as by [`RoadNetwork::route`], with the places where they meet each other
    /// and the right of way there. Equal lists share a route.
    ///
    /// Who goes first follows from the signs at the ends of the lanes before the conflict ([`RightOfWay`]). Where both signs
    /// say the same, a vehicle that turns left yields to those from the opposite side; otherwise the one from the
    /// right goes first. Where all stop, and where one lane serves both directions, the first to arrive goes first.
    ///
    /// # Errors
    /// The number of the first list that is not a route, and why.
    pub fn routes<Name: AsRef<str>>(&self, lists: &[Vec<Name>]) -> Result<Vec<Arc<Route>>, (usize, RouteError)> {
        let routes = lists.iter().enumerate();
        let routes = routes.map(|(index, names)| self.route(names).map_err(|error| (index, error)));
        Ok(Route::set_of(routes.collect::<Result<_, _>>()?))
    }
}

impl Route {
    /// Joins routes of one network to a set with the places where they meet and the right of way there, as by
    /// [`RoadNetwork::routes`]. Routes along the same lanes become one.
    pub fn set_of(routes: Vec<Route>) -> Vec<Arc<Route>> {
        let mut distinct: Vec<Route> = Vec::new();
        let mut numbers = Vec::with_capacity(routes.len());
        for mut route in routes {
            let lanes = |route: &Route| route.legs.iter().map(|leg| leg.lane.clone()).collect::<Vec<String>>();
            let is_same = |known: &Route| {
                let has_same_edges = known.right == route.right && known.left == route.left;
                lanes(known) == lanes(&route) && has_same_edges && known.centre == route.centre
            };
            let number = distinct.iter().position(is_same);
            numbers.push(number.unwrap_or(distinct.len()));
            if number.is_none() {
                route.number = Some(distinct.len());
                distinct.push(route);
            }
        }
        let known: Vec<Vec<RouteConflict>> = distinct.iter().map(|own| with_all(own, &distinct)).collect();
        for (route, conflicts) in distinct.iter_mut().zip(known) {
            route.conflicts = conflicts;
            let (centre, half_width) = (route.centre.clone(), route.half_width.clone());
            route.own_lane.get_or_insert_with(|| {
                Arc::new(Route::curved(centre, half_width.mirrored(), half_width.clone(), half_width))
            });
        }
        let routes: Vec<Arc<Route>> = distinct.into_iter().map(Arc::new).collect();
        numbers.into_iter().map(|number| Arc::clone(&routes[number])).collect()
    }
}

impl Route {
    /// Whether the route belongs to a set of routes, whose conflicts are known.
    pub fn is_in_network(&self) -> bool {
        self.number.is_some()
    }

    /// The places where other routes of the same set cross this one.
    pub(crate) fn crossings(&self) -> impl Iterator<Item = &RouteConflict> {
        self.conflicts.iter().filter(|conflict| conflict.kind == ConflictKind::Crossing)
    }

    /// The places where the route meets another one of the same set, in the order along this route.
    pub fn conflicts_with<'a>(&'a self, other: &Route) -> impl Iterator<Item = &'a RouteConflict> {
        let number = other.number;
        self.conflicts.iter().filter(move |conflict| Some(conflict.with) == number)
    }
}

/// What a route knows of its conflicts with all others.
fn with_all(own: &Route, all: &[Route]) -> Vec<RouteConflict> {
    let others = all.iter().enumerate().filter(|(_, other)| other.number != own.number);
    let pairs = others.flat_map(|(number, other)| conflicts(own, other).into_iter().map(move |it| (number, other, it)));
    let known = pairs.filter(|(_, _, conflict)| conflict.kind != ConflictKind::Diverging);
    known
        .map(|(with, other, conflict)| {
            let swinging = swinging(own, other, &conflict);
            let kind = if is_head_on(own, other, &conflict.on_a) { ConflictKind::HeadOn } else { conflict.kind };
            let (mut approach, mut their_approach) =
                (Approach::find(own, conflict.on_a), Approach::find(other, conflict.on_b));
            approach.wait_at_zebra(&their_approach, conflict.on_a);
            their_approach.wait_at_zebra(&approach, conflict.on_b);
            if swinging.is_some() {
                approach.wait_nearer(own, conflict.on_a);
                their_approach.wait_nearer(other, conflict.on_b);
            }
            let meeting = |route: &Route, partner: &Route, [from_m, to_m]: [f64; 2]| match kind {
                ConflictKind::Crossing | ConflictKind::Diverging => 0.5 * (from_m + to_m),
                // The lanes overlap before the centre lines meet.
                ConflictKind::Merging => (0.5 * (from_m + to_m)).min(from_m + partner.half_width.value(0.0)),
                ConflictKind::HeadOn => (from_m + route.half_width.value(from_m)).min(to_m),
            };
            RouteConflict {
                with,
                own_m: conflict.on_a,
                their_m: conflict.on_b,
                own_line_m: approach.line_m,
                their_line_m: their_approach.line_m,
                own_meeting_m: meeting(own, other, conflict.on_a),
                their_meeting_m: meeting(other, own, conflict.on_b),
                kind,
                precedence: swinging.unwrap_or_else(|| precedence(&approach, &their_approach, kind)),
            }
        })
        .collect()
}

/// The precedence where routes meet only because a long vehicle swings out of its lanes: the other vehicle goes first. `None` where their
/// lanes themselves meet.
fn swinging(own: &Route, other: &Route, conflict: &Conflict) -> Option<Precedence> {
    if own.plain.is_none() && other.plain.is_none() {
        return None;
    }
    let [plain, their_plain] = [own, other].map(|route| route.plain.as_deref().unwrap_or(route));
    let between = |route: &Route, plain: &Route, [from_m, to_m]: [f64; 2]| {
        [from_m, to_m].map(|along_m| plain.along(route.centre.position(along_m, 0.0)))
    };
    let (on_a, on_b) = (between(own, plain, conflict.on_a), between(other, their_plain, conflict.on_b));
    let touch = |one: [f64; 2], two: [f64; 2]| one[0] <= two[1] && two[0] <= one[1];
    let is_of_lanes = conflicts(plain, their_plain).iter().any(|met| touch(met.on_a, on_a) && touch(met.on_b, on_b));
    let swings = [own.plain.is_some(), other.plain.is_some()];
    (!is_of_lanes).then_some(match swings {
        [true, false] => Precedence::Other,
        [false, true] => Precedence::Own,
        _ => Precedence::ByArrival,
    })
}

/// Whether the routes run against each other from one end of a conflict to the other.
fn is_head_on(own: &Route, other: &Route, ends_m: &[f64; 2]) -> bool {
    ends_m.iter().all(|along_m| {
        let at = own.centre.at(*along_m);
        libm::cos(at.heading_rad - other.heading_at(at.position)) < -libm::cos(SAME_SIDE_RAD)
    })
}

/// How a route comes to a conflict.
struct Approach {
    /// Where its vehicles wait \[m\].
    line_m: f64,
    /// The sign that they see there.
    sign: RightOfWay,
    /// Direction of the route there \[rad\].
    heading_rad: f64,
    /// By how much the lane of the conflict turns to the left \[rad\].
    turn_rad: f64,
    /// Whether the lane of the conflict is a zebra crossing.
    is_zebra: bool,
}

impl Approach {
    fn find(route: &Route, [from_m, to_m]: [f64; 2]) -> Approach {
        let middle_m = 0.5 * (from_m + to_m);
        let place = |along_m: f64| route.legs.iter().position(|leg| along_m < leg.to_m);
        let number = place(from_m).unwrap_or_default();
        let leg = route.legs.get(number);
        let before = number.checked_sub(1).and_then(|before| route.legs.get(before));
        let sign_of = |leg: Option<&RouteLeg>| leg.map(|leg| leg.right_of_way).unwrap_or_default();
        // If the conflict begins on a lane with its own sign, the route leaves this lane there or the lane reaches into the conflict.
        let (line_m, sign) = if sign_of(leg) != RightOfWay::Priority {
            (from_m, sign_of(leg))
        } else {
            (before.map_or(from_m, |before| before.to_m), sign_of(before))
        };
        let turning = place(middle_m).and_then(|number| route.legs.get(number));
        let turn_rad =
            turning.map_or(0.0, |leg| route.centre.at(leg.to_m).heading_rad - route.centre.at(leg.from_m).heading_rad);
        let is_zebra = turning.is_some_and(|leg| leg.is_zebra);
        Approach { line_m, sign, heading_rad: route.centre.at(line_m).heading_rad, turn_rad, is_zebra }
    }

    /// Before a zebra crossing vehicles wait right there, unless the lane ends at a line of its own before it.
    fn wait_at_zebra(&mut self, other: &Approach, [from_m, _]: [f64; 2]) {
        if other.is_zebra && !self.is_zebra && self.sign == RightOfWay::Priority {
            self.line_m = from_m;
        }
    }

    /// Before what is met only in swinging out, vehicles wait no further back than is needed.
    fn wait_nearer(&mut self, route: &Route, [from_m, _]: [f64; 2]) {
        let is_on_first_lane = route.legs.first().is_none_or(|leg| from_m < leg.to_m);
        if is_on_first_lane || from_m - self.line_m > SWINGING_RATIO * route.half_width.value(from_m) {
            self.line_m = from_m;
        }
    }

    fn turns(&self) -> bool {
        self.turn_rad.abs() > LEFT_TURN_RAD
    }

    fn turns_left(&self) -> bool {
        self.turn_rad > LEFT_TURN_RAD
    }
}

fn precedence(own: &Approach, other: &Approach, kind: ConflictKind) -> Precedence {
    let own_first = |is_own: bool| if is_own { Precedence::Own } else { Precedence::Other };
    if own.is_zebra != other.is_zebra {
        return own_first(own.is_zebra);
    }
    match (own.sign, other.sign) {
        (RightOfWay::AllWayStop, RightOfWay::AllWayStop) => return Precedence::ByArrival,
        (RightOfWay::Priority, RightOfWay::Priority) => {}
        (RightOfWay::Priority, _) => return Precedence::Own,
        (_, RightOfWay::Priority) => return Precedence::Other,
        _ => {}
    }
    let from_right_rad = turn_rad(own.heading_rad, other.heading_rad);
    if kind == ConflictKind::HeadOn {
        return Precedence::ByArrival;
    }
    if from_right_rad.abs() < SAME_SIDE_RAD {
        // A vehicle that turns gives way to those that go straight on beside it.
        return match (own.turns(), other.turns()) {
            (true, false) if kind == ConflictKind::Crossing => Precedence::Other,
            (false, true) if kind == ConflictKind::Crossing => Precedence::Own,
            _ => Precedence::ByArrival,
        };
    }
    if from_right_rad.abs() > PI - SAME_SIDE_RAD {
        return match (own.turns_left(), other.turns_left()) {
            (true, false) => Precedence::Other,
            (false, true) => Precedence::Own,
            _ => Precedence::ByArrival,
        };
    }
    // A vehicle that crosses to the left comes from the right.
    own_first(from_right_rad < 0.0)
}
