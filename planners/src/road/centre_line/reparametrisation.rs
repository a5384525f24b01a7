//! Converts a curve with any parameter to knots by arc length.

use super::error::CentreLineError;
use super::segment::{Knot, MAX_HALF_TURN_RAD, Segment};

/// A twice differentiable plane curve by some parameter.
pub(super) trait ParametricCurve {
    /// Position, first and second derivative over the parameter.
    fn knot(&self, parameter: f64) -> Knot;
}

impl<F: Fn(f64) -> Knot> ParametricCurve for F {
    fn knot(&self, parameter: f64) -> Knot {
        self(parameter)
    }
}

/// Most by which the speed of a segment differs from 1.
pub(super) const MAX_SPEED_ERROR: f64 = 1e-8;

/// A curve is off by at most this, relative to the length of a segment.
const MAX_PLACE_ERROR: f64 = 1e-9;

/// An interval is halved at most this often. Sound curves need about ten.
const MAX_HALVINGS: usize = 24;

/// Segments by arc length of the part of a curve between two parameters, between which it is smooth.
///
/// Halves the interval until each segment keeps its speed, its place and its turn within the limits above.
///
/// # Errors
/// [`CentreLineError::Cusp`] where the curve stands still or turns too sharply, so that no number of knots suffices.
pub(super) fn segments(
    curve: &dyn ParametricCurve,
    from: f64,
    to: f64,
    found: &mut Vec<Segment>,
) -> Result<(), CentreLineError> {
    halve(curve, [from, to], MAX_HALVINGS, found)
}

fn halve(
    curve: &dyn ParametricCurve,
    [from, to]: [f64; 2],
    halvings: usize,
    found: &mut Vec<Segment>,
) -> Result<(), CentreLineError> {
    let [length_m] = integrate(from, to, |parameter| [norm(curve.knot(parameter)[1])]);
    let [start, end] = [from, to].map(|parameter| by_arc_length(curve.knot(parameter)));
    let segment = Segment::new(length_m, start, end);
    let middle = 0.5 * (from + to);
    if is_faithful(&segment, curve.knot(middle)[0]) {
        found.push(segment);
        return Ok(());
    }
    if halvings == 0 {
        let [x_m, y_m] = curve.knot(middle)[0];
        return Err(CentreLineError::Cusp { x_m, y_m });
    }
    halve(curve, [from, middle], halvings - 1, found)?;
    halve(curve, [middle, to], halvings - 1, found)
}

/// Whether a segment has unit speed, turns little, and passes through a point of its curve. False for numbers that are not
/// finite.
fn is_faithful(segment: &Segment, [x, y]: [f64; 2]) -> bool {
    let shares = [0.0, 0.15, 0.3, 0.5, 0.7, 0.85, 1.0];
    let jets = shares.map(|share| segment.jet(share * segment.length_m));
    let [place, tangent, ..] = jets[3];
    let error_m = ((x - place[0]) * tangent[1] - (y - place[1]) * tangent[0]).abs();
    let turns_little = jets.iter().all(|[_, first, ..]| {
        let (dot, cross) =
            (tangent[0] * first[0] + tangent[1] * first[1], tangent[0] * first[1] - tangent[1] * first[0]);
        cross.abs() < 0.95 * MAX_HALF_TURN_RAD * dot
    });
    let is_even = jets.iter().all(|jet| (norm(jet[1]) - 1.0).abs() < MAX_SPEED_ERROR);
    turns_little && is_even && error_m < MAX_PLACE_ERROR * segment.length_m
}

/// The derivatives over arc length: `t` and `κ m`, with the tangent `t` and the normal `m`.
pub(super) fn by_arc_length([place, first, second]: Knot) -> Knot {
    let speed = norm(first);
    let tangent = [first[0] / speed, first[1] / speed];
    let curvature = (tangent[0] * second[1] - tangent[1] * second[0]) / (speed * speed);
    [place, tangent, [-curvature * tangent[1], curvature * tangent[0]]]
}

fn norm([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}

/// Positive nodes on `[−1, 1]` with their weights (Abramowitz and Stegun, table 25.4).
const RULE: [(f64, f64); 5] = [
    (0.148_874_338_981_631_21, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_36),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

/// Integral of a function with `N` values over `[from, to]`; exact for polynomials up to degree 19.
pub(super) fn integrate<const N: usize>(from: f64, to: f64, function: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let mut sum = [0.0; N];
    for (node, weight) in RULE {
        let (before, after) = (function(middle - half * node), function(middle + half * node));
        for i in 0..N {
            sum[i] += weight * (before[i] + after[i]);
        }
    }
    sum.map(|sum| half * sum)
}

#[cfg(test)]
mod tests {
    use super::integrate;

    #[test]
    fn quadrature_is_exact_for_polynomials_of_degree_19() {
        let [nineteenth, second] = integrate(0.0, 2.0, |x| [20.0 * x.powi(19), 3.0 * x * x]);
        assert!((nineteenth / 2.0_f64.powi(20) - 1.0).abs() < 1e-14 && (second - 8.0).abs() < 1e-14);
    }
}
