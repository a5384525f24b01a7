//! Errors of centre lines that cannot be built.

use thiserror::Error;

/// Why a centre line cannot be built. Pieces and points are counted from 0.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum CentreLineError {
    /// A number of the start, of a piece or of a point is infinite or not a number (NaN).
    #[error("{place} has a number that is not finite")]
    NotFinite {
        /// Where the number is: `the start`, `piece 2`, `point 7`.
        place: String,
    },
    /// There are no pieces.
    #[error("a centre line needs at least one piece")]
    NoPieces,
    /// A piece has no positive length.
    #[error("piece {piece} is {length_m} m long; lengths are positive")]
    NoLength {
        /// Index of the piece.
        piece: usize,
        /// Length of the piece \[m\].
        length_m: f64,
    },
    /// The curvature jumps between two pieces.
    #[error(
        "the curvature jumps from {from_1pm} 1/m to {to_1pm} 1/m where piece {piece} begins; insert a clothoid, or give a \
         transition length"
    )]
    CurvatureJump {
        /// Index of the second piece.
        piece: usize,
        /// Curvature at the end of the first piece \[1/m\].
        from_1pm: f64,
        /// Curvature at the begin of the second piece \[1/m\].
        to_1pm: f64,
    },
    /// A piece is shorter than the transitions that replace its ends.
    #[error("piece {piece} is {length_m} m long, but its transitions need more than {needed_m} m of it")]
    NoRoomForTransition {
        /// Index of the piece.
        piece: usize,
        /// Length of the piece \[m\].
        length_m: f64,
        /// The part of it that the transitions replace \[m\].
        needed_m: f64,
    },
    /// A curve through points needs two points that are not the same.
    #[error("a centre line needs at least two distinct points")]
    TooFewPoints,
    /// A line is turned by so much, or so sharply, that its arc length cannot be computed.
    #[error("the curve has a cusp or a corner near ({:.3} m, {:.3} m)", to_millimetres(*.x_m), to_millimetres(*.y_m))]
    Cusp {
        /// Coordinate of the cusp \[m\].
        x_m: f64,
        /// Coordinate of the cusp \[m\].
        y_m: f64,
    },
    /// A polynomial does not begin with the position, tangent and second derivative of the end before it.
    #[error("polynomial {piece} does not continue the one before it")]
    Gap {
        /// Index of the polynomial.
        piece: usize,
    },
    /// The section of a line that was asked for is empty or not on the line.
    #[error("there is no line between {from_m} m and {to_m} m")]
    NoSection {
        /// Begin of the section \[m\].
        from_m: f64,
        /// End of the section \[m\].
        to_m: f64,
    },
}

/// A coordinate in whole millimetres, and zero without a sign \[m\].
fn to_millimetres(coordinate_m: f64) -> f64 {
    (1000.0 * coordinate_m).round() / 1000.0 + 0.0
}

#[cfg(test)]
mod tests {
    use super::CentreLineError;

    #[test]
    fn the_error_of_a_cusp_at_the_origin_has_no_minus_signs() {
        let error = CentreLineError::Cusp { x_m: -1e-9, y_m: -0.0 };
        assert_eq!(error.to_string(), "the curve has a cusp or a corner near (0.000 m, 0.000 m)");
    }
}
