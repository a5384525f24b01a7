//! Overlap of footprints, for metrics: plain geometry that shares no code with planners or the physics engine.

use interplay_planners::{Body, State};

/// Whether the footprints of two vehicles overlap or touch.
///
/// By the separating axis theorem: two rectangles are disjoint exactly if they are disjoint along the direction of an edge of one of them.
pub(super) fn overlap(body: &Body, state: &State, other_body: &Body, other: &State) -> bool {
    let corners = [body.corners(state), other_body.corners(other)];
    let axes = [state.heading_rad, other.heading_rad].into_iter().flat_map(|heading_rad| {
        let (sin, cos) = libm::sincos(heading_rad);
        [[cos, sin], [-sin, cos]]
    });
    { axes }.all(|axis| {
        let [[low, high], [other_low, other_high]] = corners.map(|corners| extent(&corners, axis));
        low <= other_high && other_low <= high
    })
}

/// The interval that points cover along an axis.
fn extent(corners: &[[f64; 2]; 4], [x, y]: [f64; 2]) -> [f64; 2] {
    let places = corners.map(|corner| corner[0] * x + corner[1] * y);
    places.into_iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], place| [low.min(place), high.max(place)])
}

/// Largest distance of a body's points from its mass centre \[m\].
pub(super) fn half_diagonal_m(body: &Body) -> f64 {
    libm::hypot(body.front_m.max(body.rear_m), 0.5 * body.width_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rectangles_overlap_at_corners_and_edges() {
        let body = Body { front_m: 2.0, rear_m: 2.0, width_m: 2.0, ..Body::default() };
        let at = |x_m: f64, y_m: f64, heading_rad: f64| State { x_m, y_m, heading_rad, speed_mps: 0.0 };
        let origin = at(0.0, 0.0, 0.0);
        let meets = |state: State| overlap(&body, &origin, &body, &state);
        assert!(meets(at(3.9, 1.9, 0.0)));
        assert!(!meets(at(4.1, 0.0, 0.0)));
        assert!(!meets(at(0.0, 2.1, 0.0)));
        let quarter = std::f64::consts::FRAC_PI_4;
        // The corner of a rotated one extends (2 + 1)/√2 towards the other.
        assert!(meets(at(4.0, 0.0, quarter)) && !meets(at(4.2, 0.0, quarter)));
        // Their circles and axis-aligned boxes overlap, but the rectangles do not.
        assert!(!meets(at(3.3, 2.7, quarter)));
    }
}
