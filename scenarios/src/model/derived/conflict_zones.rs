//! The conflict zones of two vehicles, where their routes cross or merge.

use interplay_planners::road::network::ConflictKind;

use crate::model::scenario::Vehicle;
use crate::roads::Road;

/// A region where the routes of two vehicles overlap without being the same lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConflictZone {
    /// Its interval along the route of the first vehicle \[m\].
    pub first_m: [f64; 2],
    /// Its interval along the route of the second \[m\].
    pub second_m: [f64; 2],
    /// The interval from where the front of the first enters the route of the second to where its rear has left it \[m\]; where routes
    /// merge, the position of the merge.
    pub first_way_m: [f64; 2],
    /// The same for the second \[m\].
    pub second_way_m: [f64; 2],
}

impl Road {
    /// The regions where the routes of two vehicles cross, merge or meet head-on, in the order of the first one's route; empty
    /// if both drive along one road.
    ///
    /// Routes of one network store where they meet: a zone begins where their centre lines meet, since a vehicle that waits before
    /// that point, with its front in the outer part of the other's lane, lets the other pass. On an intersection of two roads, the zone is
    /// their overlap.
    pub fn conflict_zones(&self, first: &Vehicle, second: &Vehicle) -> Vec<ConflictZone> {
        if first.route.is_in_network() && second.route.is_in_network() {
            let conflicts = first.route.conflicts_with(&second.route);
            return conflicts
                .map(|conflict| ConflictZone {
                    first_m: [conflict.own_meeting_m, conflict.own_m[1]],
                    second_m: [conflict.their_meeting_m, conflict.their_m[1]],
                    first_way_m: way_m(conflict.kind, conflict.own_m, conflict.own_meeting_m),
                    second_way_m: way_m(conflict.kind, conflict.their_m, conflict.their_meeting_m),
                })
                .collect();
        }
        let zones = self.conflict_zone_m(first.road).zip(self.conflict_zone_m(second.road));
        let zones = zones.filter(|_| first.road != second.road);
        let zone =
            |(first_m, second_m)| ConflictZone { first_m, second_m, first_way_m: first_m, second_way_m: second_m };
        zones.map(zone).into_iter().collect()
    }
}

/// The part of a route on which a vehicle blocks another one that drives through a conflict \[m\].
fn way_m(kind: ConflictKind, overlap_m: [f64; 2], meeting_m: f64) -> [f64; 2] {
    match kind {
        ConflictKind::Merging => [meeting_m; 2],
        ConflictKind::Crossing | ConflictKind::Diverging | ConflictKind::HeadOn => overlap_m,
    }
}
