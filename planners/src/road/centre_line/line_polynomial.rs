//! A polynomial of a centre line.

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
