//! Footprints as Parry sees them: boxes around the bodies, and the distance between two of them.

use interplay_planners::{Body, State};
use rapier2d::prelude::{Pose, SharedShape, Vector};

/// Distance between two footprints; 0 where they touch or overlap \[m\].
pub fn gap_m(a: (&Body, &State), b: (&Body, &State)) -> f64 {
    let origin = a.1.position();
    let place = |(body, state): (&Body, &State)| pose(state, origin) * centre(body);
    let (shape_a, shape_b) = (shape(a.0), shape(b.0));
    let outcome = parry2d::query::distance(&place(a), &*shape_a, &place(b), &*shape_b);
    outcome.map_or(f64::INFINITY, |found| f64::from(found.distance))
}

/// Length of a footprint \[m\].
pub(super) fn length_m(body: &Body) -> f64 {
    body.front_m + body.rear_m
}

/// Distance from the mass centre to the farthest corner \[m\].
pub(super) fn radius_m(body: &Body) -> f64 {
    let (ahead, aside) = (body.front_m.max(body.rear_m), 0.5 * body.width_m);
    (ahead * ahead + aside * aside).sqrt()
}

/// The box, around its own middle.
pub(super) fn shape(body: &Body) -> SharedShape {
    SharedShape::cuboid((0.5 * length_m(body)) as f32, (0.5 * body.width_m) as f32)
}

/// Where the middle of the box is, seen from the mass centre.
pub(super) fn centre(body: &Body) -> Pose {
    Pose::new(Vector::new((0.5 * (body.front_m - body.rear_m)) as f32, 0.0), 0.0)
}

/// A state in single precision, relative to an origin.
pub(super) fn pose(state: &State, origin: [f64; 2]) -> Pose {
    let position = Vector::new((state.x_m - origin[0]) as f32, (state.y_m - origin[1]) as f32);
    Pose::new(position, state.heading_rad as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x_m: f64, y_m: f64, heading_rad: f64) -> State {
        State { x_m, y_m, heading_rad, speed_mps: 1.0 }
    }

    #[test]
    fn gaps_of_boxes_in_closed_form() {
        let body = Body::default();
        let ahead = gap_m((&body, &at(10.0, 0.2, 0.0)), (&body, &at(11.0, 0.2, 0.0)));
        assert!((ahead - 0.6).abs() < 1e-5, "{ahead}");
        let beside = gap_m((&body, &at(10.0, 0.2, 0.0)), (&body, &at(10.1, 0.5, 0.0)));
        assert!((beside - 0.11).abs() < 1e-5, "{beside}");
        let quarter = std::f64::consts::FRAC_PI_2;
        let crossing = gap_m((&body, &at(0.0, 0.0, 0.0)), (&body, &at(1.0, -0.01, quarter)));
        assert!((crossing - (1.0 - 0.21 - 0.095)).abs() < 1e-5, "{crossing}");
        assert_eq!(gap_m((&body, &at(0.0, 0.0, 0.3)), (&body, &at(0.1, 0.05, 0.0))), 0.0);
    }
}
