//! What drivers on networks see that react.

use std::collections::BTreeMap;

use super::neighbours::Neighbours;
use super::road_user::RoadUser;
use crate::Agent;

/// The vehicles near each other, and all vehicles by lanes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReactiveSight {
    near: Neighbours,
    /// The vehicles by the lane on which their route is: arc length on the lane \[m\], and row.
    lanes: BTreeMap<String, Vec<(f64, usize)>>,
}

impl ReactiveSight {
    /// What all can see now who see those that they can meet within a time \[s\].
    pub(super) fn find(road_users: &[RoadUser], sight_s: f64) -> ReactiveSight {
        let mut lanes: BTreeMap<String, Vec<(f64, usize)>> = BTreeMap::new();
        for (row, RoadUser { agent, .. }) in road_users.iter().enumerate().filter(|(_, user)| !user.is_absent()) {
            let along_m = agent.along_m();
            if let Some(leg) = agent.route.leg(along_m) {
                lanes.entry(leg.lane.clone()).or_default().push((along_m - leg.offset_m, row));
            }
        }
        ReactiveSight { near: Neighbours::find(road_users, sight_s), lanes }
    }

    /// The rows that a vehicle sees, in the order in which they are listed.
    pub(super) fn of(&self, row: usize, road_users: &[RoadUser]) -> Vec<usize> {
        let mut seen = self.near.of(row, road_users);
        if let Some(ahead) = self.ahead_on_route(row, &road_users[row].agent).filter(|ahead| !seen.contains(ahead)) {
            seen.push(ahead);
            seen.sort_unstable();
        }
        seen
    }

    /// The next vehicle whose route is on the lanes of a vehicle's route ahead of it.
    fn ahead_on_route(&self, row: usize, agent: &Agent) -> Option<usize> {
        let own_m = agent.along_m();
        agent.route.legs.iter().filter(|leg| leg.to_m > own_m).find_map(|leg| {
            let there = self.lanes.get(&leg.lane)?.iter();
            let ahead = there.map(|(along_m, other)| (along_m + leg.offset_m, *other));
            let ahead = ahead.filter(|(along_m, other)| *along_m > own_m && *other != row);
            ahead.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, other)| other)
        })
    }
}
