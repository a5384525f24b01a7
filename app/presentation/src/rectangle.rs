//! Rectangles around points. In pictures: left, top, right and bottom, y downwards.

/// Left, top, right and bottom \[px\].
pub type Rectangle = [f64; 4];

pub fn rectangle_around(points: impl IntoIterator<Item = [f64; 2]>) -> Rectangle {
    let [[left, top], [right, bottom]] = extent(points);
    [left, top, right, bottom]
}

/// Whether two rectangles have more than an edge in common.
pub fn overlap([left, top, right, bottom]: Rectangle, [l, t, r, b]: Rectangle) -> bool {
    left < r && l < right && top < b && t < bottom
}

/// The curves of the corners of a polygon that are rounded with a radius: where each begins, the corner, and where it ends. A curve
/// takes at most half of an edge.
pub fn rounded_corners(ring: &[[f64; 2]], radius: f64) -> impl Iterator<Item = [[f64; 2]; 3]> {
    let count = ring.len();
    (0..count).map(move |index| {
        let [before, here, after] = [index + count - 1, index, index + 1].map(|corner| ring[corner % count]);
        let toward = |to: [f64; 2]| {
            let length = libm::hypot(to[0] - here[0], to[1] - here[1]).max(1e-9);
            let share = (radius / length).min(0.5);
            [0, 1].map(|axis| here[axis] + share * (to[axis] - here[axis]))
        };
        [toward(before), here, toward(after)]
    })
}

/// Least and greatest coordinates of some points; without points, from +∞ to −∞.
pub fn extent(points: impl IntoIterator<Item = [f64; 2]>) -> [[f64; 2]; 2] {
    points.into_iter().fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], point| {
        [[0, 1].map(|axis| low[axis].min(point[axis])), [0, 1].map(|axis| high[axis].max(point[axis]))]
    })
}

#[cfg(test)]
mod tests {
    use super::extent;

    #[test]
    fn an_extent_contains_every_point() {
        assert_eq!(extent([[1.0, -2.0], [0.5, 3.0], [0.7, 0.0]]), [[0.5, -2.0], [1.0, 3.0]]);
        assert_eq!(extent([]), [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]]);
    }
}
