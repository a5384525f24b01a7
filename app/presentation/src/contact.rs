//! The place of a contact of two vehicles, and the star that marks it.

use interplay_planners::State;
use interplay_scenarios::Scenario;

/// The point midway between the corner of each vehicle that is nearest to the other vehicle \[m\].
pub fn contact_place(scenario: &Scenario, between: [usize; 2], states: [&State; 2]) -> Option<[f64; 2]> {
    let nearest = |own: usize| {
        let corners = scenario.vehicles[between[own]].body.corners(states[own]);
        let [x, y] = states[1 - own].position();
        let away = |corner: &[f64; 2]| libm::hypot(corner[0] - x, corner[1] - y);
        corners.into_iter().min_by(|a, b| away(a).total_cmp(&away(b)))
    };
    let [one, two] = [nearest(0)?, nearest(1)?];
    Some([0, 1].map(|axis| 0.5 * (one[axis] + two[axis])))
}

/// The corners of a star with eight points around a place.
pub fn star([x, y]: [f64; 2], size: f64) -> Vec<[f64; 2]> {
    let radius = |point: i32| if point % 2 == 0 { size } else { 0.5 * size };
    let at = |point: i32| libm::sincos(std::f64::consts::PI * f64::from(point) / 8.0);
    (0..16).map(|point| (at(point), radius(point))).map(|((sin, cos), r)| [x + r * cos, y + r * sin]).collect()
}

/// The indices of two vehicles with these names.
pub fn vehicle_indices(scenario: &Scenario, between: &[String; 2]) -> Option<[usize; 2]> {
    Some([scenario.index_of(&between[0])?, scenario.index_of(&between[1])?])
}
