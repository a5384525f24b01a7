//! Cubic splines.

/// Second derivatives at the knots of the twice differentiable curve of cubic polynomials through `values`. At an end it has
/// the slope that is given there, or else no second derivative (a natural spline). `knots` increase; both lists are equally
/// long.
///
/// Solves the tridiagonal system of the spline by elimination (Thomas), at a cost that grows with the number of knots.
pub(super) fn bends(knots: &[f64], values: &[f64], end_slopes: [Option<f64>; 2]) -> Vec<f64> {
    let count = knots.len();
    let mut bends = vec![0.0; count];
    let mut factors = vec![0.0; count];
    let secant = |i: usize| (values[i + 1] - values[i]) / (knots[i + 1] - knots[i]);
    for i in 0..count {
        let before = i.checked_sub(1).map(|before| knots[i] - knots[before]);
        let after = knots.get(i + 1).map(|after| after - knots[i]);
        // A given slope at an end has the effect of an additional interval of zero length there.
        let (slope_before, slope_after) = match (before, after) {
            (Some(_), Some(_)) => (secant(i - 1), secant(i)),
            (None, Some(_)) => match end_slopes[0] {
                Some(slope) => (slope, secant(i)),
                None => continue,
            },
            (Some(_), None) => match end_slopes[1] {
                Some(slope) => (secant(i - 1), slope),
                None => continue,
            },
            (None, None) => continue,
        };
        let (before, after) = (before.unwrap_or(0.0), after.unwrap_or(0.0));
        let earlier = i.saturating_sub(1);
        let pivot = 2.0 * (before + after) - before * factors[earlier];
        factors[i] = after / pivot;
        bends[i] = (6.0 * (slope_after - slope_before) - before * bends[earlier]) / pivot;
    }
    for i in (0..count.saturating_sub(1)).rev() {
        bends[i] -= factors[i] * bends[i + 1];
    }
    bends
}

/// Value, first and second derivative of a spline at a place between two knots, given as (knot, value, bend).
pub(super) fn between(from: [f64; 3], to: [f64; 3], at: f64) -> [f64; 3] {
    let width = to[0] - from[0];
    let (a, b) = ((to[0] - at) / width, (at - from[0]) / width);
    let square = width * width / 6.0;
    [
        a * from[1] + b * to[1] + square * ((a * a * a - a) * from[2] + (b * b * b - b) * to[2]),
        (to[1] - from[1]) / width + width / 6.0 * ((1.0 - 3.0 * a * a) * from[2] + (3.0 * b * b - 1.0) * to[2]),
        a * from[2] + b * to[2],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cubic polynomial is the spline through its own values with its own slopes at the ends.
    #[test]
    fn a_spline_through_a_cubic_polynomial_is_that_polynomial() {
        let (knots, cube) = ([-1.0, 0.5, 0.7, 2.0], |x: f64| x * x * x - x);
        let bends = bends(&knots, &knots.map(cube), [Some(2.0), Some(11.0)]);
        assert!(bends.iter().zip(knots).all(|(bend, x)| (bend - 6.0 * x).abs() < 1e-12), "{bends:?}");
    }

    #[test]
    fn a_spline_passes_through_its_points_and_is_twice_differentiable() {
        let (knots, values) = ([0.0, 1.0, 1.5, 4.0], [1.0, -1.0, 0.0, 2.0]);
        let bends = bends(&knots, &values, [None; 2]);
        let knot = |i: usize| [knots[i], values[i], bends[i]];
        assert_eq!((bends[0], bends[3]), (0.0, 0.0));
        for i in 1..3 {
            let (left, right) = (between(knot(i - 1), knot(i), knots[i]), between(knot(i), knot(i + 1), knots[i]));
            assert!((0..3).all(|order| (left[order] - right[order]).abs() < 1e-13), "{left:?} {right:?}");
            assert!((left[0] - values[i]).abs() < 1e-13);
        }
    }

    /// The spline with knots 0, 1, 2 through 0, 1, 0 is `(3 u − u³)/2` on the first interval.
    #[test]
    fn a_spline_through_one_peak_matches_its_closed_form() {
        let bends = bends(&[0.0, 1.0, 2.0], &[0.0, 1.0, 0.0], [None; 2]);
        let [value, slope, bend] = between([0.0, 0.0, bends[0]], [1.0, 1.0, bends[1]], 0.4);
        assert!((value - 0.568).abs() < 1e-15 && (slope - 1.26).abs() < 1e-15 && (bend + 1.2).abs() < 1e-15);
    }
}
