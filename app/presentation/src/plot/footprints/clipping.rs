//! The parts of polygons and lines within a rectangle.

/// The part of a polygon within a rectangle (Sutherland and Hodgman).
pub(super) fn clipped(ring: &[[f64; 2]], low: [f64; 2], high: [f64; 2]) -> Vec<[f64; 2]> {
    let mut ring = ring.to_vec();
    for (axis, bound, sign) in [(0, low[0], 1.0), (0, high[0], -1.0), (1, low[1], 1.0), (1, high[1], -1.0)] {
        let depth = |point: [f64; 2]| sign * (point[axis] - bound);
        let mut kept = Vec::new();
        for (index, &point) in ring.iter().enumerate() {
            let before = ring[(index + ring.len() - 1) % ring.len()];
            if (depth(before) < 0.0) != (depth(point) < 0.0) {
                let share = depth(before) / (depth(before) - depth(point));
                kept.push([0, 1].map(|i| before[i] + share * (point[i] - before[i])));
            }
            if depth(point) >= 0.0 {
                kept.push(point);
            }
        }
        ring = kept;
    }
    ring
}

/// The parts of a line within a rectangle (Liang and Barsky).
pub(super) fn clipped_line(line: &[[f64; 2]], low: [f64; 2], high: [f64; 2]) -> Vec<Vec<[f64; 2]>> {
    let mut parts: Vec<Vec<[f64; 2]>> = Vec::new();
    for pair in line.windows(2) {
        let Some([from, to]) = clipped_segment([pair[0], pair[1]], low, high) else { continue };
        match parts.last_mut().filter(|part| part.last() == Some(&from)) {
            Some(part) => part.push(to),
            None => parts.push(vec![from, to]),
        }
    }
    parts
}

fn clipped_segment([from, to]: [[f64; 2]; 2], low: [f64; 2], high: [f64; 2]) -> Option<[[f64; 2]; 2]> {
    let (mut begin, mut end) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let delta = to[axis] - from[axis];
        let bounds = [low[axis] - from[axis], high[axis] - from[axis]];
        if delta == 0.0 {
            if bounds[0] > 0.0 || bounds[1] < 0.0 {
                return None;
            }
            continue;
        }
        let shares = bounds.map(|bound| bound / delta);
        begin = begin.max(shares[0].min(shares[1]));
        end = end.min(shares[0].max(shares[1]));
    }
    // Ends inside the rectangle stay exact, so that parts join.
    let at = |share: f64| match share {
        0.0 => from,
        1.0 => to,
        _ => [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis])),
    };
    (begin < end).then(|| [at(begin), at(end)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_is_clipped_to_the_rectangle() {
        let diamond = [[0.0, -2.0], [2.0, 0.0], [0.0, 2.0], [-2.0, 0.0]];
        let inside = clipped(&diamond, [-1.0, -1.0], [1.0, 1.0]);
        let area: f64 = (0..inside.len())
            .map(|i| {
                let ([x, y], [next_x, next_y]) = (inside[i], inside[(i + 1) % inside.len()]);
                0.5 * (x * next_y - next_x * y)
            })
            .sum();
        assert!((area - 4.0).abs() < 1e-12, "the diamond covers the whole square: {area}");
        assert!(clipped(&diamond, [3.0, 3.0], [4.0, 4.0]).is_empty());
    }

    #[test]
    fn a_line_is_clipped_to_the_rectangle() {
        let line = [[-3.0, 0.0], [0.0, 0.0], [0.0, 3.0], [0.5, 3.0], [0.5, -3.0]];
        let parts = clipped_line(&line, [-1.0, -1.0], [1.0, 1.0]);
        assert_eq!(parts, [vec![[-1.0, 0.0], [0.0, 0.0], [0.0, 1.0]], vec![[0.5, 1.0], [0.5, -1.0]]]);
    }
}
