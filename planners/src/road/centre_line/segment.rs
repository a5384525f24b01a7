//! The part of a centre line between two neighbouring knots.

/// Position, first and second derivative at a knot, over some parameter.
pub(super) type Knot = [[f64; 2]; 3];

/// Position and its first three derivatives.
pub(super) type Jet = [[f64; 2]; 4];

/// x and y as polynomials of degree 5 of the distance `u` from the first knot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Segment {
    /// Arc length of the line at the first knot \[m\].
    pub from_m: f64,
    /// Arc length between the knots \[m\].
    pub length_m: f64,
    /// Coefficients of (x, y), from the constant to `u⁵`: side by side, so that a processor evaluates both at once.
    coefficients: [[f64; 2]; 6],
    /// Cosine and sine of the heading in the middle.
    middle: [f64; 2],
    /// Heading in the middle, continued from segment to segment without jumps of a full turn \[rad\].
    middle_heading_rad: f64,
}

/// Most by which the heading at a knot may differ from that in the middle, so that [`small_arctangent`] is exact \[rad\].
pub(super) const MAX_HALF_TURN_RAD: f64 = 0.1;

impl Segment {
    /// The polynomials that have these values and derivatives at both ends of an interval of `length_m`.
    ///
    /// Its heading is the one in the middle, in `(−π, π]`, until [`Segment::placed`] continues it.
    pub fn new(length_m: f64, from: Knot, to: Knot) -> Segment {
        let polynomials = [0, 1].map(|axis| {
            let (h, start, end) = (length_m, from.map(|value| value[axis]), to.map(|value| value[axis]));
            let place = end[0] - start[0] - h * (start[1] + 0.5 * h * start[2]);
            let slope = h * (end[1] - start[1] - h * start[2]);
            let bend = h * h * (end[2] - start[2]);
            [
                start[0],
                start[1],
                0.5 * start[2],
                (10.0 * place - 4.0 * slope + 0.5 * bend) / (h * h * h),
                (-15.0 * place + 7.0 * slope - bend) / (h * h * h * h),
                (6.0 * place - 3.0 * slope + 0.5 * bend) / (h * h * h * h * h),
            ]
        });
        let [x, y] = polynomials;
        Segment::from_polynomial(&LinePolynomial { length_m, x, y })
    }

    /// The segment of a polynomial, at arc length 0.
    pub fn from_polynomial(&LinePolynomial { length_m, x, y }: &LinePolynomial) -> Segment {
        let coefficients = std::array::from_fn(|power| [x[power], y[power]]);
        Segment { from_m: 0.0, length_m, coefficients, middle: [1.0, 0.0], middle_heading_rad: 0.0 }.with_middle()
    }

    pub fn polynomial(&self) -> LinePolynomial {
        let [x, y] = [0, 1].map(|axis| self.coefficients.map(|pair| pair[axis]));
        LinePolynomial { length_m: self.length_m, x, y }
    }

    fn with_middle(self) -> Segment {
        let [_, [x, y], ..] = self.jet(0.5 * self.length_m);
        let speed = (x * x + y * y).sqrt();
        Segment { middle: [x / speed, y / speed], middle_heading_rad: libm::atan2(y, x), ..self }
    }

    /// The segment moved to another arc length. Of its headings, which differ by full turns, it takes the one nearest to
    /// `heading_rad`. The heading is bit-identical wherever the segment was before.
    pub fn placed(self, from_m: f64, heading_rad: f64) -> Segment {
        let principal_rad = self.with_middle().middle_heading_rad;
        let turns = ((heading_rad - principal_rad) / std::f64::consts::TAU).round();
        Segment { from_m, middle_heading_rad: principal_rad + turns * std::f64::consts::TAU, ..self }
    }

    /// Arc length of the line at the second knot \[m\].
    pub fn end_m(&self) -> f64 {
        self.from_m + self.length_m
    }

    /// Position and derivatives at the distance `u` from the first knot, evaluated in pairs of terms (Estrin's scheme),
    /// which a processor computes in parallel.
    #[inline(always)]
    pub fn jet(&self, u: f64) -> Jet {
        let c = &self.coefficients;
        let (square, fourth) = (u * u, u * u * (u * u));
        let both = |polynomial: &dyn Fn(usize) -> f64| [polynomial(0), polynomial(1)];
        [
            both(&|i| (c[0][i] + c[1][i] * u) + (c[2][i] + c[3][i] * u) * square + (c[4][i] + c[5][i] * u) * fourth),
            both(&|i| {
                (c[1][i] + 2.0 * c[2][i] * u) + (3.0 * c[3][i] + 4.0 * c[4][i] * u) * square + 5.0 * c[5][i] * fourth
            }),
            both(&|i| (2.0 * c[2][i] + 6.0 * c[3][i] * u) + (12.0 * c[4][i] + 20.0 * c[5][i] * u) * square),
            both(&|i| (6.0 * c[3][i] + 24.0 * c[4][i] * u) + 60.0 * c[5][i] * square),
        ]
    }

    /// Position, first and second derivative at the distance `u` from the first knot.
    pub fn knot(&self, u: f64) -> Knot {
        let [position, first, second, _] = self.jet(u);
        [position, first, second]
    }

    /// The position of the first knot.
    pub fn start(&self) -> [f64; 2] {
        self.coefficients[0]
    }

    /// Heading of a tangent of this segment \[rad\].
    #[inline(always)]
    pub fn heading_rad(&self, [x, y]: [f64; 2]) -> f64 {
        let [cos, sin] = self.middle;
        self.middle_heading_rad + small_arctangent((cos * y - sin * x) / (cos * x + sin * y))
    }

    /// The angle from the heading in the middle to a tangent of any polynomial, between −π and π \[rad\].
    pub fn turn_from_middle_rad(&self, [x, y]: [f64; 2]) -> f64 {
        let [cos, sin] = self.middle;
        libm::atan2(cos * y - sin * x, cos * x + sin * y)
    }

    /// The part between two distances from the first knot, at arc length 0.
    pub fn part(&self, from: f64, to: f64) -> Segment {
        Segment::new(to - from, self.knot(from), self.knot(to)).placed(0.0, self.middle_heading_rad)
    }
}

/// The arctangent of a number below 0.1 in magnitude: its series up to the power 15, of which the rest is below `1e-17`.
#[inline(always)]
fn small_arctangent(z: f64) -> f64 {
    let second = z * z;
    let (fourth, eighth) = (second * second, second * second * (second * second));
    let low = (1.0 - second * (1.0 / 3.0)) + (1.0 / 5.0 - second * (1.0 / 7.0)) * fourth;
    let high = (1.0 / 9.0 - second * (1.0 / 11.0)) + (1.0 / 13.0 - second * (1.0 / 15.0)) * fourth;
    z * (low + high * eighth)
}

/// The part of a centre line between two neighbouring knots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinePolynomial {
    /// Arc length between the knots \[m\].
    pub length_m: f64,
    /// Coefficients of x over the distance `u` from the first knot, from the constant to `u⁵`.
    pub x: [f64; 6],
    /// Coefficients of y over the distance `u`, from the constant to `u⁵`.
    pub y: [f64; 6],
}

pub(super) fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(super) fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

pub(super) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let apart = [a[0] - b[0], a[1] - b[1]];
    (apart[0] * apart[0] + apart[1] * apart[1]).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_has_the_given_values_and_derivatives_at_both_ends() {
        let (from, to) = ([[1.0, 2.0], [1.0, 0.1], [0.01, 0.2]], [[3.9, 2.9], [0.9, 0.4], [-0.1, 0.3]]);
        let segment = Segment::new(3.0, from, to);
        for (knot, expected) in [(segment.knot(0.0), from), (segment.knot(3.0), to)] {
            let pairs = knot.iter().flatten().zip(expected.iter().flatten());
            assert!(pairs.clone().all(|(a, b)| (a - b).abs() < 1e-14), "{knot:?} {expected:?}");
        }
    }

    #[test]
    fn the_series_of_the_arctangent_agrees_with_libm() {
        for step in -50..=50 {
            let z = 0.002 * f64::from(step) * 1.01;
            assert!((small_arctangent(z) - libm::atan(z)).abs() < 3e-17, "{z}");
        }
    }
}
