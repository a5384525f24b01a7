//! How the ways of two vehicles are related: side by side, meeting ahead, or apart.
//!
//! On routes of one network this follows from where the routes meet ([`RouteConflict`]). On straight roads, which know nothing
//! of each other, it follows from their directions where the other vehicle is.

use crate::road::centre_line::FrenetPoint;
use crate::road::network::{ConflictKind, RouteConflict};
use crate::scene::OwnPlace;
use crate::scene::road_rules::Merging;
use crate::{Agent, Route, State};

/// Paths that meet at a smaller angle than this run side by side \[rad\].
pub(crate) const PARALLEL_RAD: f64 = 0.1;

/// Headings that differ by more than this belong to different roads \[rad\].
const SAME_ROAD_RAD: f64 = 0.1;
/// Ways on one strip at a larger angle cross \[rad\].
const ACROSS_RAD: f64 = 1.05;

/// A vehicle whose heading differs by at most this from a lane drives along it \[rad\].
const ALONG_LANE_RAD: f64 = std::f64::consts::FRAC_PI_6;

/// A 1/10 scale car below this speed stands \[m/s\].
const STANDING_MPS: f64 = 0.085;

/// How the ways of two vehicles are related where they are now, seen by the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Relation<'a> {
    /// One is, or may come, in the other's lane, before or behind it.
    Alongside,
    /// Their straight roads cross, or meet head-on.
    CrossingRoads,
    /// Their routes meet in a conflict that is still ahead of both, or under way.
    Conflict(&'a RouteConflict),
    /// Their routes have nothing in common that is still ahead.
    Apart,
}

impl Agent {
    /// Its place on its route.
    pub fn place(&self) -> FrenetPoint {
        self.own_place.or_search(&self.route, self.state.position())
    }

    /// Arc length of its mass centre on its route \[m\].
    pub fn along_m(&self) -> f64 {
        self.place().along_m
    }

    /// Lateral coordinate of its mass centre beside its route \[m\].
    pub fn across_m(&self) -> f64 {
        self.place().across_m
    }

    /// Searches its place, so that it is known until it moves.
    pub fn note_place(&mut self) {
        self.own_place = OwnPlace::of(&self.route, self.state.position());
    }

    /// How the way of another vehicle is related to this one's.
    pub(crate) fn relation(&self, other: &Agent) -> Relation<'_> {
        if other.is_obstacle {
            return if touches_strip(self, other) { Relation::Alongside } else { Relation::Apart };
        }
        if !(self.route.is_in_network() && other.route.is_in_network()) {
            let place = other.state.position();
            let difference = self.route.heading_at(place) - other.route.heading_at(place);
            let is_same = libm::cos(difference) >= libm::cos(SAME_ROAD_RAD);
            return if is_same { Relation::Alongside } else { Relation::CrossingRoads };
        }
        let (own_m, their_m) = (rear_m(self), rear_m(other));
        let is_open = |conflict: &&RouteConflict| own_m <= conflict.own_m[1] && their_m <= conflict.their_m[1];
        let conflict = self.route.conflicts_with(&other.route).find(is_open);
        let follows = || follows_in_lane(self, other) || follows_in_lane(other, self);
        match conflict {
            Some(conflict) if conflict.kind == ConflictKind::Merging && follows() => Relation::Alongside,
            Some(conflict) => Relation::Conflict(conflict),
            None if is_on_strip(self, other) || is_on_strip(other, self) => Relation::Alongside,
            None => Relation::Apart,
        }
    }

    /// Whether two vehicles' ways cross, merge or meet head-on ahead rather than run side by side.
    pub fn crosses(&self, other: &Agent) -> bool {
        matches!(self.relation(other), Relation::CrossingRoads | Relation::Conflict(_))
    }

    /// Whether the vehicle could come in another one's way: not if their routes have nothing in common ahead.
    pub(crate) fn may_meet(&self, other: &Agent) -> bool {
        self.relation(other) != Relation::Apart
    }

    /// How far `other`'s centre is ahead along this vehicle's road \[m\].
    pub fn lead_of(&self, other: &Agent) -> f64 {
        self.route.along(other.state.position()) - self.along_m()
    }

    /// How far ahead another vehicle is in the order in which a planner turns to its partners: along the road, or, where the
    /// routes meet, the more the nearer the other is to the meeting \[m\].
    pub(crate) fn lead_or_nearness_of(&self, other: &Agent) -> f64 {
        match self.relation(other) {
            Relation::Conflict(conflict) => other.along_m() - conflict.their_meeting_m,
            Relation::Alongside | Relation::CrossingRoads | Relation::Apart => self.lead_of(other),
        }
    }

    /// The nearest of some vehicles that is ahead in the same lane.
    pub(crate) fn leader_among<'a>(&self, others: impl IntoIterator<Item = &'a Agent>) -> Option<&'a Agent> {
        let ahead = others.into_iter().filter(|other| self.shares_lane_with(other) && self.lead_of(other) > 0.0);
        ahead.min_by(|a, b| self.lead_of(a).total_cmp(&self.lead_of(b)))
    }

    /// Whether it is too near to what stands ahead to come past it by steering: on the tightest circle of the radius `R` it moves aside by
    /// `L` on the way `√(2 R L)`.
    pub(crate) fn is_too_near_to_swing_out(&self, room_m: f64, aside_m: f64) -> bool {
        let radius_m = self.body.wheelbase_m() / libm::tan(self.limits.steering_max_rad);
        room_m > 0.0 && room_m * room_m < 2.0 * radius_m * aside_m
    }

    /// Whether two vehicles on one road overlap across it, so that one would run into the other.
    pub fn shares_lane_with(&self, other: &Agent) -> bool {
        let apart = self.route.across(other.state.position()) - self.across_m();
        self.relation(other) == Relation::Alongside
            && apart.abs() < 0.5 * (self.body.width_m + other.body.width_m)
            && (!self.route.is_in_network() || other.is_obstacle || is_along(&self.route, &other.state))
    }
}

impl Agent {
    /// Half of the length and of the width of the body \[m\]; of an obstacle, those of the rectangle in a direction that contains it.
    pub(crate) fn half_extents_m(&self, heading_rad: f64) -> [f64; 2] {
        let halves_m = [0.5 * (self.body.front_m + self.body.rear_m), 0.5 * self.body.width_m];
        if !self.is_obstacle {
            return halves_m;
        }
        let (sin, cos) = libm::sincos(self.state.heading_rad - heading_rad);
        let [length_m, width_m] = halves_m;
        [cos.abs() * length_m + sin.abs() * width_m, sin.abs() * length_m + cos.abs() * width_m]
    }

    /// The speed that it does not exceed for now, so that there is room when it joins the way of others \[m/s\]; none if nothing holds it.
    pub(crate) fn merging_speed_mps(&self) -> Option<f64> {
        let Merging { meeting_m, in_s, .. } = self.rules.merging.as_ref()?;
        let front_m = self.along_m() + self.body.front_m;
        Some(self.state.speed_mps.min((meeting_m - front_m).max(0.0) / in_s.max(1e-3)))
    }

    /// Whether the rules hold another vehicle for this one.
    pub(crate) fn is_waited_for_by(&self, other: &Agent) -> bool {
        other.rules.waits_for.contains(&self.name)
    }

    /// Whether the rules say which of two vehicles goes first now: there is nothing to negotiate.
    pub(crate) fn has_order_with(&self, other: &Agent) -> bool {
        self.is_waited_for_by(other) || other.is_waited_for_by(self)
    }
}

/// Whether a vehicle stands, or as good as stands.
pub(crate) fn is_standing(agent: &Agent) -> bool {
    is_standing_at(agent, agent.state.speed_mps)
}

/// The same at a speed, for vehicles of the scale of one.
pub(crate) fn is_standing_at(like: &Agent, speed_mps: f64) -> bool {
    speed_mps.abs() < STANDING_MPS * like.body.time_ratio()
}

/// The arc length of a vehicle's rear on its own route \[m\].
fn rear_m(agent: &Agent) -> f64 {
    agent.along_m() - agent.body.rear_m
}

/// Whether `other` is in the lane of `agent`, ahead of it.
fn follows_in_lane(agent: &Agent, other: &Agent) -> bool {
    let at = agent.route.locate(other.state.position(), None);
    let reach_m = 0.5 * (agent.body.width_m + other.body.width_m);
    at.along_m > agent.along_m() && at.across_m.abs() < reach_m && is_along(&agent.route, &other.state)
}

/// Whether a vehicle drives about in the direction of a route.
fn is_along(route: &Route, state: &State) -> bool {
    libm::cos(state.heading_rad - route.heading_at(state.position())) > libm::cos(ALONG_LANE_RAD)
}

/// Whether any part of `other` is on the strip that `agent` may use, and its way does not lead across it there.
pub(crate) fn is_on_strip(agent: &Agent, other: &Agent) -> bool {
    let at = agent.route.locate(other.state.position(), None);
    if libm::cos(other.place().heading_rad - at.heading_rad).abs() < libm::cos(ACROSS_RAD) {
        return false;
    }
    touches_strip(agent, other)
}

/// Whether any part of `other`, which is along the road, is on the strip that `agent` may use.
fn touches_strip(agent: &Agent, other: &Agent) -> bool {
    let at = agent.route.locate(other.state.position(), None);
    let [right_m, left_m] = agent.route.edges_before_end_m(at.along_m);
    let half_m = 0.5 * other.body.width_m;
    (right_m - half_m..=left_m + half_m).contains(&at.across_m)
}

#[cfg(test)]
mod tests {
    use crate::Corridor;
    use crate::fixture::agent;

    #[test]
    fn a_known_place_is_that_of_the_present_position_and_route() {
        let mut agent = agent(3.0, 0.2, 0.0, 1.0);
        agent.note_place();
        assert_eq!([agent.along_m(), agent.across_m()], [3.0, 0.2]);
        agent.state.x_m = 4.0;
        assert_eq!([agent.along_m(), agent.across_m()], [4.0, 0.2]);
        agent.note_place();
        let heading_rad = std::f64::consts::FRAC_PI_2;
        agent.route = Corridor { heading_rad, right_m: -2.0, left_m: 2.0, end: None }.into();
        assert!((agent.along_m() - 0.2).abs() < 1e-12 && (agent.across_m() + 4.0).abs() < 1e-12);
    }
}
