//! How far two rectangles overlap, by the separating axis theorem.

/// The depth to which two convex quadrilaterals with right angles overlap: the shortest way by which one would have to be moved
/// for them not to \[m\]; not positive where they are apart. Corners in any order around a middle.
pub fn overlap_m(one: &[[f64; 2]; 4], other: &[[f64; 2]; 4]) -> f64 {
    let depths = [one, other].into_iter().flat_map(axes).map(|axis| {
        let ([low, high], [other_low, other_high]) = (reach(one, axis), reach(other, axis));
        (high - other_low).min(other_high - low)
    });
    depths.fold(f64::INFINITY, f64::min)
}

/// The directions of the sides of a rectangle whose corners are those of [`Body::corners`](crate::Body::corners).
fn axes([front_right, front_left, rear_right, _]: &[[f64; 2]; 4]) -> [[f64; 2]; 2] {
    [rear_right, front_left].map(|corner| {
        let [x, y] = [0, 1].map(|axis| corner[axis] - front_right[axis]);
        let length = libm::hypot(x, y);
        [x / length, y / length]
    })
}

/// Least and greatest coordinate of some corners along a direction.
fn reach(corners: &[[f64; 2]; 4], [x, y]: [f64; 2]) -> [f64; 2] {
    let along = corners.map(|corner| x * corner[0] + y * corner[1]);
    [along.into_iter().fold(f64::INFINITY, f64::min), along.into_iter().fold(f64::NEG_INFINITY, f64::max)]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{Body, State};

    fn at(x_m: f64, y_m: f64, heading_rad: f64) -> [[f64; 2]; 4] {
        Body { front_m: 2.0, rear_m: 2.0, width_m: 2.0, ..Body::default() }.corners(&State {
            x_m,
            y_m,
            heading_rad,
            speed_mps: 0.0,
        })
    }

    #[test]
    fn depths_are_those_of_plain_cases() {
        let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        close(overlap_m(&at(0.0, 0.0, 0.0), &at(3.5, 0.0, 0.0)), 0.5);
        close(overlap_m(&at(0.0, 0.0, 0.0), &at(4.5, 0.0, 0.0)), -0.5);
        close(overlap_m(&at(0.0, 0.0, 0.0), &at(0.0, 1.75, 0.0)), 0.25);
        // A corner that points at a side: half of the diagonal reaches 0.1 m beyond it.
        let half = libm::hypot(2.0, 1.0);
        let turn = std::f64::consts::PI - libm::atan2(1.0, 2.0);
        close(overlap_m(&at(0.0, 0.0, 0.0), &at(2.0 + half - 0.1, 0.0, turn)), 0.1);
    }

    proptest! {
        /// Rectangles overlap exactly if some point of a fine grid over one lies in the other, but for grazing ones.
        #[test]
        fn overlap_agrees_with_points(x in -6.0..6.0, y in -6.0..6.0, turn in -3.2..3.2, own in -3.2..3.2) {
            let (one, other) = (at(0.0, 0.0, own), at(x, y, turn));
            let inside = |along: f64, left: f64| {
                let point = [x + turn.cos() * along - turn.sin() * left, y + turn.sin() * along + turn.cos() * left];
                let ahead = own.cos() * point[0] + own.sin() * point[1];
                let across = own.cos() * point[1] - own.sin() * point[0];
                ahead.abs() <= 2.0 && across.abs() <= 1.0
            };
            let grid = |count: i32, half: f64| (-count..=count).map(move |i| half * f64::from(i) / f64::from(count));
            let touches = grid(80, 2.0).any(|along| grid(40, 1.0).any(|left| inside(along, left)));
            let depth = overlap_m(&one, &other);
            prop_assert!(depth.abs() < 0.08 || touches == (depth > 0.0), "{depth} {touches}");
        }
    }
}
