//! Whether one vehicle sees another: range, field of view, and others in between.

use super::settings::Settings;
use crate::Scene;
use crate::vehicle::{Body, State};

/// Whether the planning vehicle of a scene can measure number `observed` of its others.
pub(super) fn is_visible(scene: &Scene, observed: usize, settings: &Settings) -> bool {
    let (ego, other) = (&scene.ego.state, &scene.others[observed]);
    let [along_m, left_m] = difference(other.state.position(), ego.position());
    if settings.range_m.is_some_and(|range_m| libm::hypot(along_m, left_m) > range_m) {
        return false;
    }
    let bearing_rad = libm::atan2(left_m, along_m) - ego.heading_rad;
    let off_rad = libm::acos(libm::cos(bearing_rad).clamp(-1.0, 1.0));
    if off_rad > 0.5 * settings.field_of_view_rad {
        return false;
    }
    !settings.occlusion || !is_hidden(scene, observed)
}

/// Whether centre and corners of an observed vehicle all lie behind the bodies of others.
fn is_hidden(scene: &Scene, observed: usize) -> bool {
    let other = &scene.others[observed];
    let eye = scene.ego.state.position();
    let between: Vec<[[f64; 2]; 4]> = scene
        .others
        .iter()
        .enumerate()
        .filter(|(index, _)| *index != observed)
        .map(|(_, third)| outline(&third.body, &third.state))
        .collect();
    let points = std::iter::once(other.state.position()).chain(other.body.corners(&other.state));
    let is_covered = |point: [f64; 2]| between.iter().any(|outline| crosses(eye, point, outline));
    points.into_iter().all(is_covered)
}

/// The corners of a body in the order of its outline \[m\].
fn outline(body: &Body, state: &State) -> [[f64; 2]; 4] {
    let [front_right, front_left, rear_right, rear_left] = body.corners(state);
    [front_right, front_left, rear_left, rear_right]
}

/// Whether the segment between two points crosses a side of an outline.
fn crosses(from: [f64; 2], to: [f64; 2], outline: &[[f64; 2]; 4]) -> bool {
    (0..4).any(|side| {
        let (a, b) = (outline[side], outline[(side + 1) % 4]);
        turn(from, to, a) * turn(from, to, b) < 0.0 && turn(a, b, from) * turn(a, b, to) < 0.0
    })
}

/// Twice the signed area of a triangle: positive where the third point is to the left.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    let ([bx, by], [cx, cy]) = (difference(b, a), difference(c, a));
    bx * cy - by * cx
}

fn difference(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;
    use crate::fixture::{agent, scene};

    fn sees(settings: Settings, places: &[[f64; 2]]) -> Vec<bool> {
        let others = places.iter().map(|[x_m, y_m]| agent(*x_m, *y_m, 0.0, 1.0)).collect();
        let scene = scene(agent(0.0, 0.0, 0.0, 1.0), others);
        (0..places.len()).map(|index| is_visible(&scene, index, &settings)).collect()
    }

    #[test]
    fn far_vehicles_are_not_seen() {
        let near = Settings { range_m: Some(2.0), ..Settings::default() };
        assert_eq!(sees(near, &[[1.9, 0.0], [-1.9, 0.0], [1.5, 1.5]]), [true, true, false]);
        assert_eq!(sees(Settings::default(), &[[1e6, 0.0]]), [true]);
    }

    #[test]
    fn the_field_of_view_is_a_sector_about_the_heading() {
        let ahead = Settings { field_of_view_rad: FRAC_PI_2, ..Settings::default() };
        assert_eq!(sees(ahead, &[[1.0, 0.9], [1.0, 1.1], [1.0, -0.9], [-1.0, 0.0]]), [true, false, true, false]);
        let half = Settings { field_of_view_rad: PI, ..Settings::default() };
        assert_eq!(sees(half, &[[0.1, 1.0], [-0.1, 1.0]]), [true, false]);
    }

    #[test]
    fn a_vehicle_behind_another_is_hidden_and_one_beside_it_is_not() {
        let occlusion = Settings { occlusion: true, ..Settings::default() };
        assert_eq!(sees(occlusion, &[[1.0, 0.0], [3.0, 0.0], [3.0, 0.4]]), [true, false, true]);
        assert_eq!(sees(Settings::default(), &[[1.0, 0.0], [3.0, 0.0]]), [true, true]);
    }
}
