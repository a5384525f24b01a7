//! Whether there is room for a vehicle that enters the road.

use super::Traffic;
use crate::Agent;

/// Least gap between bumpers, for real cars \[m\].
const STANDSTILL_GAP_M: f64 = 2.0;
/// Least time gap of the one behind, for real cars \[s\].
const TIME_GAP_S: f64 = 1.0;
/// The one behind brakes down to the speed of the one ahead with at most this \[m/s²\].
const BRAKING_MPS2: f64 = 2.0;

impl Traffic {
    /// Whether a road user who is not on the road yet could come where it stands, so that neither it nor a vehicle behind it would have
    /// to brake hard.
    pub fn has_room_for(&self, newcomer: usize) -> bool {
        let own = &self.road_users[newcomer].agent;
        let others = self.road_users.iter().enumerate().filter(|(index, user)| *index != newcomer && !user.is_absent());
        others.into_iter().all(|(_, other)| is_apart(own, &other.agent))
    }
}

/// Whether two vehicles are in different lanes or far enough apart along the first one's route.
fn is_apart(own: &Agent, other: &Agent) -> bool {
    let [at, here] = [other, own].map(|agent| own.route.locate(agent.state.position(), None));
    let reach_m = 0.5 * (own.body.width_m + other.body.width_m);
    if (at.across_m - here.across_m).abs() >= reach_m {
        return true;
    }
    let lead_m = at.along_m - here.along_m;
    let along_mps = other.state.speed_mps * libm::cos(other.state.heading_rad - at.heading_rad);
    let (ahead, behind) = if lead_m >= 0.0 { (other, own) } else { (own, other) };
    let [slow_mps, fast_mps] =
        if lead_m >= 0.0 { [along_mps, own.state.speed_mps] } else { [own.state.speed_mps, along_mps] };
    let gap_m = lead_m.abs() - ahead.body.rear_m - behind.body.front_m;
    let closing_m = (fast_mps * fast_mps - slow_mps.max(0.0) * slow_mps.max(0.0)).max(0.0) / (2.0 * BRAKING_MPS2);
    let ratio = own.body.real_ratio();
    gap_m > STANDSTILL_GAP_M * ratio + TIME_GAP_S * ratio.sqrt() * fast_mps.max(0.0) + closing_m
}

#[cfg(test)]
mod tests {
    use super::super::{Presence, RoadUser};
    use super::*;
    use crate::fixture::{agent, scene};

    fn traffic(others: &[Agent]) -> Traffic {
        let user = |agent: &Agent| RoadUser::new(agent.clone(), scene(agent.clone(), Vec::new()).goal, false);
        let newcomer = RoadUser { presence: Presence::Awaited, ..user(&agent(0.0, 0.185, 0.0, 1.0)) };
        Traffic { road_users: std::iter::once(newcomer).chain(others.iter().map(user)).collect(), ..Traffic::default() }
    }

    #[test]
    fn there_is_room_far_from_others_and_in_another_lane() {
        assert!(traffic(&[]).has_room_for(0));
        assert!(traffic(&[agent(3.0, 0.185, 0.0, 1.0)]).has_room_for(0));
        assert!(!traffic(&[agent(0.8, 0.185, 0.0, 1.0)]).has_room_for(0), "too near ahead");
        assert!(!traffic(&[agent(-0.8, 0.185, 0.0, 1.0)]).has_room_for(0), "too near behind");
        assert!(traffic(&[agent(0.8, 0.555, 0.0, 1.0)]).has_room_for(0), "in another lane");
        let mut gone = traffic(&[agent(0.8, 0.185, 0.0, 1.0)]);
        gone.road_users[1].presence = Presence::Left;
        assert!(gone.has_room_for(0), "a vehicle that is not there");
    }
}
