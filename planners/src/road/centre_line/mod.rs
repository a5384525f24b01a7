//! Centre lines of roads: plane curves of which position, heading and curvature are continuous.
//!
//! A [`CentreLine`] is built from straight, arc and clothoid [`Piece`]s ([`CentreLine::from_pieces`]), as a smooth curve through
//! points ([`CentreLine::through`], for measured points after [`smooth_points`]), or from other lines ([`CentreLine::between`],
//! [`CentreLine::parallel`], [`CentreLine::joined`]). It converts a position to Frenet coordinates: the arc length `s` along the
//! line and the signed lateral distance `n`, positive to the left ([`CentreLine::project`], [`CentreLine::expand`]).
//!
//! # Representation
//!
//! Between neighbouring knots, x and y are polynomials of degree 5 of the arc length from the first knot. At both knots they
//! have the position, the tangent and the second derivative of the curve (Hermite interpolation), so the curve is twice
//! continuously differentiable. The knots are so dense that the speed `v = |p′|` differs from 1 by less than `1e-8`.
//! Projections and derivatives include `v`: they are exact for the polynomials, whatever their speed is.

mod chord;
mod error;
mod fit;
mod frenet;
mod joining;
mod line;
mod nearest;
mod pieces;
mod polynomials;
mod projection;
mod reparametrisation;
mod segment;
mod smoothing;
mod spline;

#[cfg(test)]
mod tests;

pub use error::CentreLineError;
pub use frenet::{FrenetExpansion, FrenetPoint};
pub use joining::{JoinedLine, LineSection};
pub use line::{CentreLine, LinePoint};
pub use pieces::{Piece, smooth};
pub use segment::LinePolynomial;
pub use smoothing::smooth_points;
