//! Makes routes from lists of lanes.

use super::super::centre_line::{CentreLine, CentreLineError, JoinedLine, LineSection};
use super::edges;
use super::error::RouteError;
use super::lane::Lane;
use super::road_network::RoadNetwork;
use super::route::{Route, RouteLeg};

/// The part of a lane that a route follows.
struct Part<'a> {
    lane: &'a Lane,
    /// Where it begins on the lane \[m\].
    from_m: f64,
    /// Where it ends on the lane \[m\].
    to_m: f64,
}

/// Where two lanes do not continue each other exactly, this length of each is replaced, by their width.
const JOINT_RATIO: f64 = 1.0;

/// Length of a change to the lane beside, by the width of the lane: on 3.5 m wide lanes 42 m, 3 s at 50 km/h.
const CHANGE_RATIO: f64 = 12.0;

/// A change to the lane beside is at least this long, by the width of the lane: on 3.5 m wide lanes it turns with a radius of
/// about 10 m.
const MIN_CHANGE_RATIO: f64 = 4.0;

/// Most of a lane that one joint or change replaces.
const MAX_REPLACED_SHARE: f64 = 0.4;

impl RoadNetwork {
    /// The route along lanes. Each lane is a successor of the one before, or a neighbour in the same direction into
    /// which a vehicle may change.
    ///
    /// Its centre line follows the lanes' centres from the begin of the first to the end of the last. Where lanes touch
    /// without being continuous in position, heading and curvature, a smooth curve replaces one lane width on either side. A
    /// change to the lane beside takes twelve lane widths in the middle of what is left of the lane.
    ///
    /// The strip between `left` and `right` is the lane with the neighbours on either side, and their neighbours, that are
    /// driven in the same direction and into which one may change. Where a neighbour begins or ends, the edge moves by at
    /// most a fifth of a metre per metre, inside of the strip.
    ///
    /// # Errors
    /// [`RouteError::NoLanes`], [`RouteError::UnknownLane`], [`RouteError::NotConnected`], [`RouteError::NoRoomToChange`], and
    /// [`RouteError::Centre`] where the lines of two lanes face each other so badly that no smooth curve joins them.
    pub fn route<Name: AsRef<str>>(&self, names: &[Name]) -> Result<Route, RouteError> {
        let unknown = |name: &str| RouteError::UnknownLane { lane: name.to_owned() };
        let lanes = names
            .iter()
            .map(|name| self.lane(name.as_ref()).ok_or_else(|| unknown(name.as_ref())))
            .collect::<Result<Vec<&Lane>, RouteError>>()?;
        let names = || lanes.iter().map(|lane| lane.name.clone()).collect();
        let (joined, parts) = join(&lanes)?.map_err(|source| RouteError::Centre { lanes: names(), source })?;
        let JoinedLine { line: centre, sections_m } = joined;
        let middle_m = |index: usize| 0.5 * (sections_m[index][1] + sections_m[index + 1][0]);
        let leg = |(index, part): (usize, &Part)| RouteLeg {
            lane: part.lane.name.clone(),
            from_m: if index == 0 { 0.0 } else { middle_m(index - 1) },
            to_m: if index + 1 == parts.len() { centre.length_m() } else { middle_m(index) },
            offset_m: sections_m[index][0] - part.from_m,
            speed_limit_mps: part.lane.speed_limit_mps,
            right_of_way: part.lane.right_of_way,
            light: part.lane.light.clone(),
            is_zebra: part.lane.is_zebra,
        };
        let legs: Vec<RouteLeg> = parts.iter().enumerate().map(leg).collect();
        let strip = edges::strip(self, &centre, &legs, &sections_m);
        let mut route = Route::curved(centre, strip.right, strip.left, strip.half_width);
        route.legs = legs;
        route.same_direction = Some(strip.same_direction);
        Ok(route)
    }
}

/// The joined centre lines, with the part of each lane. The outer error says that lanes are not connected, the inner one that
/// their lines cannot be joined.
type Joined<'a> = Result<Result<(JoinedLine, Vec<Part<'a>>), CentreLineError>, RouteError>;

fn join<'a>(lanes: &[&'a Lane]) -> Joined<'a> {
    let mut parts: Vec<Part> = Vec::new();
    for (place, &lane) in lanes.iter().enumerate() {
        let mut next = Part { lane, from_m: 0.0, to_m: lane.centre.length_m() };
        if let Some(last) = parts.last_mut() {
            if last.lane.successors.contains(&lane.name) {
                last.make_room_for_joint(&mut next);
            } else if last.lane.may_change_to(&lane.name) {
                last.make_room_for_change(&mut next, changes(&lanes[place - 1..]))?;
            } else {
                return Err(RouteError::NotConnected { from: last.lane.name.clone(), to: lane.name.clone() });
            }
        }
        parts.push(next);
    }
    if parts.is_empty() {
        return Err(RouteError::NoLanes);
    }
    let section = |part: &Part<'a>| LineSection { line: &part.lane.centre, from_m: part.from_m, to_m: part.to_m };
    let sections: Vec<LineSection> = parts.iter().map(section).collect();
    Ok(CentreLine::joined(&sections).map(|joined| (joined, parts)))
}

impl Part<'_> {
    /// Makes room for a joint between this part and its successor, unless they continue each other.
    fn make_room_for_joint(&mut self, next: &mut Part) {
        if self.lane.centre.is_continued_by(&next.lane.centre) {
            return;
        }
        let width_m = self.lane.width.value(self.to_m).min(next.lane.width.value(next.from_m));
        let shorter_m = (self.to_m - self.from_m).min(next.to_m - next.from_m);
        let replaced_m = (JOINT_RATIO * width_m).min(MAX_REPLACED_SHARE * shorter_m);
        self.to_m -= replaced_m;
        next.from_m += replaced_m;
    }

    /// Makes room for a change from this part to the lane beside it, in the first of as many equal stretches as there are
    /// changes in a row.
    ///
    /// # Errors
    /// [`RouteError::NoRoomToChange`] where the stretch is too short.
    fn make_room_for_change(&mut self, next: &mut Part, changes: usize) -> Result<(), RouteError> {
        let [begin_m, end_m] = side_by_side(self.lane, next.lane);
        let begin_m = begin_m.max(self.from_m);
        let room_m = (end_m.min(self.to_m) - begin_m) / changes.max(1) as f64;
        let middle_m = begin_m + 0.5 * room_m;
        let width_m = self.lane.width.value(middle_m);
        if room_m < least_room_m(width_m) {
            let (from, to) = (self.lane.name.clone(), next.lane.name.clone());
            return Err(RouteError::NoRoomToChange { from, to, needed_m: least_room_m(width_m), room_m });
        }
        let half_m = (0.5 * CHANGE_RATIO * width_m).min(MAX_REPLACED_SHARE * room_m);
        let end = self.lane.centre.at(middle_m + half_m).position;
        self.to_m = middle_m - half_m;
        next.from_m = next.lane.centre.project(end, None).along_m;
        Ok(())
    }
}

/// How many changes to the lane beside a list of lanes begins with.
fn changes(lanes: &[&Lane]) -> usize {
    let is_change =
        |pair: &&[&Lane]| !pair[0].successors.contains(&pair[1].name) && pair[0].may_change_to(&pair[1].name);
    lanes.windows(2).take_while(is_change).count()
}

/// Where a lane runs beside another one: from and to, along the first; the second is smaller where it does not \[m\].
pub(super) fn side_by_side(lane: &Lane, other: &Lane) -> [f64; 2] {
    let beside_m = |along_m: f64| lane.centre.project(other.centre.at(along_m).position, None).along_m;
    [beside_m(0.0).max(0.0), beside_m(other.centre.length_m()).min(lane.centre.length_m())]
}

/// Length that lanes must run side by side for a change, by the width of the lane \[m\].
pub(super) fn least_room_m(width_m: f64) -> f64 {
    MIN_CHANGE_RATIO * width_m / (2.0 * MAX_REPLACED_SHARE)
}
