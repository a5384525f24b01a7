//! Where the ways of two vehicles cross or merge.

use crate::road::Road;
use crate::scenario::Vehicle;

/// A place where the ways of two vehicles overlap without being the same lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConflictZone {
    /// From where to where it reaches along the route of the first vehicle \[m\].
    pub first_m: [f64; 2],
    /// From where to where it reaches along the route of the second \[m\].
    pub second_m: [f64; 2],
}

impl Road {
    /// The places where the ways of two vehicles cross, merge or meet head-on, in the order of the first one's route; none
    /// where both drive along one road.
    ///
    /// Routes of one network know where they meet: a zone begins where their centre lines do, for whoever waits before that, with
    /// its front in the outer part of the other's lane, lets the other pass. Of the roads of an intersection, it is where one lies on the other.
    pub fn conflict_zones(&self, first: &Vehicle, second: &Vehicle) -> Vec<ConflictZone> {
        if first.route.is_in_network() && second.route.is_in_network() {
            let conflicts = first.route.conflicts_with(&second.route);
            return conflicts
                .map(|conflict| ConflictZone {
                    first_m: [conflict.own_meeting_m, conflict.own_m[1]],
                    second_m: [conflict.their_meeting_m, conflict.their_m[1]],
                })
                .collect();
        }
        let zones = self.conflict_zone_m(first.road).zip(self.conflict_zone_m(second.road));
        let zones = zones.filter(|_| first.road != second.road);
        zones.map(|(first_m, second_m)| ConflictZone { first_m, second_m }).into_iter().collect()
    }
}
