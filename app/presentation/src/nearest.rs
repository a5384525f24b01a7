//! Who is near the ego: where there are many vehicles, pictures name and colour those alone.

use interplay_scenarios::Scenario;
use interplay_simulation::frame::Frame;

/// The vehicles on the road that somebody drives, without the ego, by index, the nearest to the ego first.
pub fn nearest(scenario: &Scenario, frame: &Frame) -> Vec<usize> {
    let ego = scenario.ego_index();
    let Some(own) = frame.vehicles.get(ego).map(|vehicle| vehicle.state) else { return Vec::new() };
    let away_m = |index: &usize| {
        let state = &frame.vehicles[*index].state;
        libm::hypot(state.x_m - own.x_m, state.y_m - own.y_m)
    };
    let is_driven = |index: &usize| {
        *index != ego && scenario.vehicles[*index].obstacle.is_none() && !frame.vehicles[*index].is_absent
    };
    let mut near: Vec<usize> = (0..frame.vehicles.len()).filter(is_driven).collect();
    near.sort_by(|one, other| away_m(one).total_cmp(&away_m(other)));
    near
}
