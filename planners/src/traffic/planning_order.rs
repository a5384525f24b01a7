//! The order in which road users plan.

use std::cmp::Ordering;

use super::road_user::RoadUser;

/// The indices of the road users in the order in which they plan.
///
/// Drivers that go first come first, from the front of the road to its rear: each knows what the vehicle ahead is about to
/// do. Positions are longitudinal coordinates on each vehicle's own road. The others follow as they are listed, and so do
/// vehicles at the same position.
pub fn planning_order(road_users: &[RoadUser]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..road_users.len()).collect();
    order.sort_by(|a, b| compare(&road_users[*a], &road_users[*b]));
    order
}

/// Orders two road users; those that may plan in any order are equal, and a stable sort leaves them as they are listed.
fn compare(a: &RoadUser, b: &RoadUser) -> Ordering {
    let along_m = |user: &RoadUser| user.agent.along_m();
    match (a.goes_first, b.goes_first) {
        (true, true) => along_m(b).total_cmp(&along_m(a)),
        (true, false) => Ordering::Less,
        (false, true) => Ordering::Greater,
        (false, false) => Ordering::Equal,
    }
}
