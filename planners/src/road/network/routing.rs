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

/// Length of a late change out of a lane that ends, by the width of the lane, and most of the lane that it takes: a change of 84 m is
/// comfortable at 27 m/s, and one of 42 m only at 14 m/s.
const LATE_CHANGE_RATIO: f64 = 24.0;
const LATE_SHARE: f64 = 0.45;
/// It leaves this much of the lane unused, by its length.
const UNUSED_RATIO: f64 = 0.1;

/// Where a route leaves a lane that ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EndingLane {
    /// In the middle of what is left of it, as other lanes.
    Middle,
    /// Near its end: an acceleration lane is for accelerating.
    End,
}

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
        self.route_leaving(names, EndingLane::Middle)
    }

    /// The same, which leaves lanes that end at a stated place.
    ///
    /// # Errors
    /// As [`RoadNetwork::route`].
    pub fn route_leaving<Name: AsRef<str>>(&self, names: &[Name], ending: EndingLane) -> Result<Route, RouteError> {
        let unknown = |name: &str| RouteError::UnknownLane { lane: name.to_owned() };
        let lanes = names
            .iter()
            .map(|name| self.lane(name.as_ref()).ok_or_else(|| unknown(name.as_ref())))
            .collect::<Result<Vec<&Lane>, RouteError>>()?;
        let names = || lanes.iter().map(|lane| lane.name.clone()).collect();
        let (joined, parts) = join(&lanes, ending)?.map_err(|source| RouteError::Centre { lanes: names(), source })?;
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
            is_left_late: false,
        };
        let mut legs: Vec<RouteLeg> = parts.iter().enumerate().map(leg).collect();
        for (leg, part) in legs.iter_mut().zip(&parts).rev().skip(1) {
            leg.is_left_late = ending == EndingLane::End && part.lane.successors.is_empty();
        }
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

fn join<'a>(lanes: &[&'a Lane], ending: EndingLane) -> Joined<'a> {
    let mut parts: Vec<Part> = Vec::new();
    for (place, &lane) in lanes.iter().enumerate() {
        let mut next = Part { lane, from_m: 0.0, to_m: lane.centre.length_m() };
        if let Some(last) = parts.last_mut() {
            if last.lane.successors.contains(&lane.name) {
                last.make_room_for_joint(&mut next);
            } else if last.lane.may_change_to(&lane.name) {
                last.make_room_for_change(&mut next, changes(&lanes[place - 1..]), ending)?;
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
    fn make_room_for_change(&mut self, next: &mut Part, changes: usize, ending: EndingLane) -> Result<(), RouteError> {
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
        let is_late = ending == EndingLane::End && changes == 1 && self.lane.successors.is_empty();
        let (middle_m, half_m) = if is_late {
            let half_m = half_m.max(0.5 * (LATE_CHANGE_RATIO * width_m).min(LATE_SHARE * room_m));
            (begin_m + room_m - (1.0 + 2.0 * UNUSED_RATIO) * half_m, half_m)
        } else {
            (middle_m, half_m)
        };
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

/// What a change to the lane beside costs, by its width: routes that need no change are preferred to those that save less.
const CHANGE_COST_RATIO: f64 = 10.0;

/// One more than the most changes in a row that a search considers.
const CHANGES_IN_A_ROW: usize = 6;

impl RoadNetwork {
    /// The shortest route from the start of a lane to the end of another one.
    ///
    /// Searches by Dijkstra's method over successors and open neighbours; a change costs as much as ten lane widths of
    /// driving, and needs room. Of routes of equal length, the one whose lanes come first in the network is taken.
    ///
    /// # Errors
    /// [`RouteError::UnknownLane`], [`RouteError::NoWay`] where no route leads there, and those of
    /// [`RoadNetwork::route`].
    pub fn shortest_route(&self, from: &str, to: &str) -> Result<Route, RouteError> {
        let number = |name: &str| {
            let found = self.lanes().iter().position(|lane| lane.name == name);
            found.ok_or_else(|| RouteError::UnknownLane { lane: name.to_owned() })
        };
        let (start, goal) = (number(from)?, number(to)?);
        let lanes = self.shortest(start, goal);
        let lanes = lanes.ok_or_else(|| RouteError::NoWay { from: from.to_owned(), to: to.to_owned() })?;
        let names: Vec<&str> = lanes.iter().map(|number| self.lanes()[*number].name.as_str()).collect();
        self.route(&names)
    }

    /// The lanes from which no end of the network can be reached, in the order of the network: loops without an exit,
    /// and the lanes that lead only into them. An end is a lane without successors; changes into open neighbours count.
    pub fn lanes_without_end(&self) -> Vec<&Lane> {
        let mut ends: Vec<bool> = self.lanes().iter().map(|lane| lane.successors.is_empty()).collect();
        let leads_to =
            |lane: &Lane, other: &Lane| lane.successors.contains(&other.name) || lane.may_change_to(&other.name);
        // Each round except the last adds a lane.
        loop {
            let reaches = |(number, lane): (usize, &Lane), ends: &[bool]| {
                !ends[number] && self.lanes().iter().zip(ends).any(|(other, is_end)| *is_end && leads_to(lane, other))
            };
            let next = self.lanes().iter().enumerate().find(|numbered| reaches(*numbered, &ends));
            let Some((number, _)) = next else { break };
            ends[number] = true;
        }
        self.lanes().iter().zip(&ends).filter(|(_, is_end)| !**is_end).map(|(lane, _)| lane).collect()
    }

    /// The numbers of the lanes on the shortest way, if there is one.
    fn shortest(&self, start: usize, goal: usize) -> Option<Vec<usize>> {
        // A node is a lane with the number of changes in a row that led to it.
        let count = self.lanes().len() * CHANGES_IN_A_ROW;
        let mut costs = vec![f64::INFINITY; count];
        let mut before = vec![None; count];
        let mut is_done = vec![false; count];
        costs[start * CHANGES_IN_A_ROW] = 0.0;
        let mut found = None;
        // Each round finishes a node, so the search also ends where lanes form a loop.
        while found.is_none() {
            let open = (0..count).filter(|node| !is_done[*node] && costs[*node].is_finite());
            let next = open.min_by(|a, b| costs[*a].total_cmp(&costs[*b]))?;
            is_done[next] = true;
            found = (next / CHANGES_IN_A_ROW == goal).then_some(next);
            for (node, cost) in self.steps(next / CHANGES_IN_A_ROW, next % CHANGES_IN_A_ROW) {
                if costs[next] + cost < costs[node] {
                    costs[node] = costs[next] + cost;
                    before[node] = Some(next);
                }
            }
        }
        let way = std::iter::successors(found, |node| before[*node]);
        let mut lanes: Vec<usize> = way.map(|node| node / CHANGES_IN_A_ROW).collect();
        lanes.reverse();
        Some(lanes)
    }

    /// The nodes that can be reached from a lane after some changes in a row, with their cost \[m\].
    fn steps(&self, lane: usize, changes: usize) -> Vec<(usize, f64)> {
        let lane = &self.lanes()[lane];
        let number = |name: &str| self.lanes().iter().position(|lane| lane.name == name);
        let length_m = lane.centre.length_m();
        let ahead = lane.successors.iter().filter_map(|name| Some((number(name)? * CHANGES_IN_A_ROW, length_m)));
        let change_m = CHANGE_COST_RATIO * lane.width.value(0.5 * length_m);
        let beside = [&lane.left, &lane.right].into_iter().flatten().filter(|neighbour| neighbour.is_open());
        let with_room = beside.filter_map(|neighbour| number(&neighbour.lane)).filter(|number| {
            let [from_m, to_m] = side_by_side(lane, &self.lanes()[*number]);
            let room_m = (to_m - from_m) / (changes + 1) as f64;
            changes + 1 < CHANGES_IN_A_ROW && room_m > least_room_m(lane.width.value(0.5 * (from_m + to_m)))
        });
        ahead.chain(with_room.map(|number| (number * CHANGES_IN_A_ROW + changes + 1, change_m))).collect()
    }
}
