//! The shortest route between two lanes.

use super::error::RouteError;
use super::lane::Lane;
use super::road_network::RoadNetwork;
use super::route::Route;
use super::routing::{least_room_m, side_by_side};

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
