//! Centre lines through points.

use super::error::CentreLineError;
use super::line::CentreLine;
use super::reparametrisation::segments;
use super::segment::distance;
use super::spline;

/// A point that is nearer to the one before than this share of the mean distance is left out: so short an interval would
/// turn the rounding of its points into curvature.
const MIN_SPACING_RATIO: f64 = 0.05;

impl CentreLine {
    /// A smooth line through at least two points \[m\]: the natural cubic spline over the length of the chords.
    ///
    /// It passes through every point, except those that are nearer to their predecessor than a twentieth of the mean
    /// distance, which are left out. The first and the last point are kept. The curvature is zero at both ends.
    ///
    /// # Errors
    /// - [`CentreLineError::NotFinite`] names a point that is infinite or not a number,
    /// - [`CentreLineError::TooFewPoints`] where fewer than two points are distinct,
    /// - [`CentreLineError::Cusp`] where the points turn back so sharply that the curve has no direction.
    pub fn through(points: &[[f64; 2]]) -> Result<CentreLine, CentreLineError> {
        CentreLine::through_towards(points, [None; 2])
    }

    /// Like [`CentreLine::through`], with given headings at the start, at the end, or at both \[rad\].
    ///
    /// Lanes that follow each other can thus have the same heading where they meet. The curvature at an end with a
    /// given heading need not be zero.
    ///
    /// # Errors
    /// As [`CentreLine::through`]; [`CentreLineError::NotFinite`] also for a heading.
    pub fn through_towards(
        points: &[[f64; 2]],
        end_headings_rad: [Option<f64>; 2],
    ) -> Result<CentreLine, CentreLineError> {
        if let Some(index) = points.iter().position(|[x, y]| !(x.is_finite() && y.is_finite())) {
            return Err(CentreLineError::NotFinite { place: format!("point {index}") });
        }
        if end_headings_rad.iter().flatten().any(|heading_rad| !heading_rad.is_finite()) {
            return Err(CentreLineError::NotFinite { place: "a heading".to_owned() });
        }
        let points = distinct(points)?;
        let mut chords_m = vec![0.0];
        let mut total_m = 0.0;
        for pair in points.windows(2) {
            total_m += distance(pair[0], pair[1]);
            chords_m.push(total_m);
        }
        let tangents = end_headings_rad.map(|heading_rad| heading_rad.map(libm::sincos));
        let values = [0, 1].map(|axis| points.iter().map(|point| point[axis]).collect::<Vec<f64>>());
        let bends = [0, 1].map(|axis| {
            let slopes = tangents.map(|tangent| tangent.map(|(sin, cos)| [cos, sin][axis]));
            spline::bends(&chords_m, &values[axis], slopes)
        });
        let mut found = Vec::new();
        for index in 1..points.len() {
            let curve = |chord_m: f64| {
                let [x, y] = [0, 1].map(|axis| {
                    let knot = |i: usize| [chords_m[i], values[axis][i], bends[axis][i]];
                    spline::between(knot(index - 1), knot(index), chord_m)
                });
                std::array::from_fn(|order| [x[order], y[order]])
            };
            segments(&curve, chords_m[index - 1], chords_m[index], &mut found)?;
        }
        CentreLine::from_segments(found).ok_or(CentreLineError::TooFewPoints)
    }
}

/// The points without those that nearly equal their predecessor.
fn distinct(points: &[[f64; 2]]) -> Result<Vec<[f64; 2]>, CentreLineError> {
    let total_m: f64 = points.windows(2).map(|pair| distance(pair[0], pair[1])).sum();
    let least_m = MIN_SPACING_RATIO * total_m / points.len() as f64;
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return Err(CentreLineError::TooFewPoints) };
    let mut kept = vec![*first];
    for point in &points[1..] {
        if kept.last().is_some_and(|before| distance(*before, *point) > least_m) {
            kept.push(*point);
        }
    }
    // The end of the line is kept, and the point before it is removed.
    if kept.last() != Some(last) {
        if kept.len() > 1 {
            kept.pop();
        }
        kept.push(*last);
    }
    if kept.len() < 2 || !(total_m > 0.0 && total_m.is_finite()) || (kept.len() == 2 && kept[0] == kept[1]) {
        return Err(CentreLineError::TooFewPoints);
    }
    Ok(kept)
}
