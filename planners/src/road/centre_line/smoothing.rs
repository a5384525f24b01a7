//! Moves points within a tolerance, so that the curve through them bends less.

use super::error::CentreLineError;

/// Halvings of the search for the largest smoothing that keeps the tolerance.
const SEARCH_STEPS: usize = 60;

/// Smallest and largest smoothing that is tried, by the cube of the mean distance of the points.
const SMOOTHING_RANGE: [f64; 2] = [1e-9, 1e9];

/// Moves each point by at most `tolerance_m`, so that the curve of [`CentreLine::through`](super::CentreLine::through)
/// bends less. The first and the last point stay.
///
/// Errors of measured points cause curvature: 1 cm at a spacing of 0.5 m causes about 0.2 1/m. For x and y over the
/// length of the chords, the smoothing spline minimises `Σ (fᵢ − yᵢ)² + λ ∫ f″²` (Reinsch 1967; Green and Silverman
/// 1994, section 2.3). `λ` is the largest value that keeps the tolerance, found by bisection.
///
/// # Errors
/// [`CentreLineError::NotFinite`] for a point or a tolerance that is not finite, and [`CentreLineError::TooFewPoints`] where
/// two neighbouring points are the same.
pub fn smooth_points(points: &[[f64; 2]], tolerance_m: f64) -> Result<Vec<[f64; 2]>, CentreLineError> {
    if let Some(index) = points.iter().position(|[x, y]| !(x.is_finite() && y.is_finite())) {
        return Err(CentreLineError::NotFinite { place: format!("point {index}") });
    }
    if !(tolerance_m.is_finite() && tolerance_m >= 0.0) {
        return Err(CentreLineError::NotFinite { place: "the tolerance".to_owned() });
    }
    if points.len() < 3 || tolerance_m == 0.0 {
        return Ok(points.to_vec());
    }
    let distance = |a: [f64; 2], b: [f64; 2]| ((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])).sqrt();
    let chords_m: Vec<f64> = points.windows(2).map(|pair| distance(pair[0], pair[1])).collect();
    if chords_m.contains(&0.0) {
        return Err(CentreLineError::TooFewPoints);
    }
    let mean_m = chords_m.iter().sum::<f64>() / chords_m.len() as f64;
    let moved = |exponent: f64| smoothed(points, &chords_m, libm::exp(exponent) * mean_m * mean_m * mean_m);
    let keeps = |moved: &[[f64; 2]]| moved.iter().zip(points).all(|(a, b)| distance(*a, *b) <= tolerance_m);
    let [mut low, mut high] = SMOOTHING_RANGE.map(libm::log);
    let most = moved(high);
    if keeps(&most) {
        return Ok(most);
    }
    for _ in 0..SEARCH_STEPS {
        let middle = 0.5 * (low + high);
        if keeps(&moved(middle)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    let found = moved(low);
    Ok(if keeps(&found) { found } else { points.to_vec() })
}

/// The values of the smoothing spline at the knots, for `λ = smoothing`.
///
/// With the second derivatives `γ` at the inner knots, `(R + λ Qᵀ W Q) γ = Qᵀ y` and `f = y − λ W Q γ`, where `W` is the
/// identity but zero at both ends.
fn smoothed(points: &[[f64; 2]], chords_m: &[f64], smoothing: f64) -> Vec<[f64; 2]> {
    let inner = points.len() - 2;
    // Column j of Q belongs to point j + 1 and has three entries, beginning with point j.
    let column = |j: usize| {
        let (before, after) = (1.0 / chords_m[j], 1.0 / chords_m[j + 1]);
        [before, -before - after, after]
    };
    let weight = |point: usize| if point == 0 || point == points.len() - 1 { 0.0 } else { smoothing };
    let product = |j: usize, k: usize| {
        let (a, b) = (column(j), column(k));
        (k..=j + 2).map(|point| a[point - j] * weight(point) * b[point - k]).sum::<f64>()
    };
    let mut bands: Vec<[f64; 3]> = (0..inner)
        .map(|j| {
            let diagonal = (chords_m[j] + chords_m[j + 1]) / 3.0 + product(j, j);
            let next = if j + 1 < inner { chords_m[j + 1] / 6.0 + product(j, j + 1) } else { 0.0 };
            [diagonal, next, if j + 2 < inner { product(j, j + 2) } else { 0.0 }]
        })
        .collect();
    let mut bends: Vec<[f64; 2]> = (0..inner)
        .map(|j| [0, 1].map(|axis| (0..3).map(|i| column(j)[i] * points[j + i][axis]).sum::<f64>()))
        .collect();
    solve_pentadiagonal(&mut bands, &mut bends);
    let mut values = points.to_vec();
    for (j, bend) in bends.iter().enumerate() {
        for (i, entry) in column(j).into_iter().enumerate() {
            for axis in 0..2 {
                values[j + i][axis] -= weight(j + i) * entry * bend[axis];
            }
        }
    }
    values
}

/// Solves a positive definite system whose rows are given from the diagonal on, by `L D Lᵀ`. Its two right sides become the
/// two solutions.
fn solve_pentadiagonal(rows: &mut [[f64; 3]], sides: &mut [[f64; 2]]) {
    let count = rows.len();
    for i in 0..count {
        let [diagonal, first, second] = rows[i];
        for (ahead, entry) in [(1, first), (2, second)] {
            if i + ahead < count {
                let factor = entry / diagonal;
                rows[i + ahead][0] -= factor * entry;
                if ahead == 1 {
                    rows[i + 1][1] -= factor * second;
                }
                for axis in 0..2 {
                    sides[i + ahead][axis] -= factor * sides[i][axis];
                }
            }
        }
    }
    for i in (0..count).rev() {
        for axis in 0..2 {
            let known: f64 =
                (1..3).filter(|ahead| i + ahead < count).map(|ahead| rows[i][ahead] * sides[i + ahead][axis]).sum();
            sides[i][axis] = (sides[i][axis] - known) / rows[i][0];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::CentreLine;
    use super::*;

    /// Points of a circle of 20 m radius, every 0.5 m, each moved by at most 2 cm.
    fn noisy_circle() -> Vec<[f64; 2]> {
        let point = |i: u32| {
            let (sin, cos) = libm::sincos(0.025 * f64::from(i));
            let radius_m = 20.0 + 0.02 * libm::sin(37.0 * f64::from(i * i));
            [radius_m * cos, radius_m * sin]
        };
        (0..=60).map(point).collect()
    }

    fn largest_curvature_error(points: &[[f64; 2]]) -> f64 {
        let line = CentreLine::through(points).expect("distinct points");
        let errors = (20..=280).map(|step| (line.at(0.1 * f64::from(step)).curvature_1pm - 0.05).abs());
        errors.fold(0.0, f64::max)
    }

    #[test]
    fn smoothing_removes_noise_and_keeps_the_tolerance() {
        let points = noisy_circle();
        let moved = smooth_points(&points, 0.03).expect("sound points");
        assert!(largest_curvature_error(&points) > 0.1, "the noise is curvature");
        assert!(largest_curvature_error(&moved) < 0.02, "{}", largest_curvature_error(&moved));
        assert!(moved.iter().zip(&points).all(|(a, b)| libm::hypot(a[0] - b[0], a[1] - b[1]) <= 0.03));
        assert_eq!((moved[0], moved[60]), (points[0], points[60]));
    }

    /// The straight line through the ends bends least, and with a large tolerance it comes out.
    #[test]
    fn smoothing_with_a_large_tolerance_gives_a_straight_line() {
        let moved = smooth_points(&[[0.0, 0.0], [1.0, 0.2], [2.5, -0.1], [4.0, 0.0]], 1.0).expect("sound points");
        assert!(moved.iter().all(|[_, y]| y.abs() < 1e-6), "{moved:?}");
        let points = [[0.0, 0.0], [1.0, 0.2], [2.0, 0.0]];
        assert_eq!(smooth_points(&points, 0.0), Ok(points.to_vec()));
        assert_eq!(smooth_points(&[[1.0, 1.0]; 4], 0.1), Err(CentreLineError::TooFewPoints));
    }
}
