//! Centre lines as polynomials, for storing a line or exporting it to another program.

use super::error::CentreLineError;
use super::joining::continues;
use super::line::{CentreLine, Curve, Shape};
use super::reparametrisation::by_arc_length;
use super::segment::{LinePolynomial, MAX_HALF_TURN_RAD, Segment};

impl CentreLine {
    /// The polynomials of the line in the order of arc length; none for [`CentreLine::straight`].
    pub fn polynomials(&self) -> Vec<LinePolynomial> {
        match &self.0 {
            Shape::Straight { .. } => Vec::new(),
            Shape::Curve(curve) => curve.segments.iter().map(Segment::polynomial).collect(),
        }
    }

    /// The line of [`CentreLine::polynomials`], bit for bit. `heading_rad` is the heading at its start, which
    /// determines the full turn from which headings are counted \[rad\].
    ///
    /// # Errors
    /// - [`CentreLineError::NoPieces`] without polynomials,
    /// - [`CentreLineError::NotFinite`] and [`CentreLineError::NoLength`] for a polynomial without sound numbers,
    /// - [`CentreLineError::Cusp`] for one that turns by more than is allowed between two knots,
    /// - [`CentreLineError::Gap`] for one that does not continue the one before.
    pub fn from_polynomials(parts: &[LinePolynomial], heading_rad: f64) -> Result<CentreLine, CentreLineError> {
        let mut segments: Vec<Segment> = Vec::with_capacity(parts.len());
        for (piece, part) in parts.iter().enumerate() {
            if !part.x.iter().chain(&part.y).chain([&part.length_m, &heading_rad]).all(|number| number.is_finite()) {
                return Err(CentreLineError::NotFinite { place: format!("polynomial {piece}") });
            }
            if part.length_m <= 0.0 {
                return Err(CentreLineError::NoLength { piece, length_m: part.length_m });
            }
            let segment = Segment::from_polynomial(part).placed(0.0, heading_rad);
            let [begin, end] = [0.0, segment.length_m].map(|u| segment.knot(u));
            let turns_rad = [begin, end].map(|[_, tangent, _]| segment.turn_from_middle_rad(tangent));
            if !turns_rad.iter().all(|turn_rad| turn_rad.abs() <= MAX_HALF_TURN_RAD) {
                let [x_m, y_m] = begin[0];
                return Err(CentreLineError::Cusp { x_m, y_m });
            }
            if segments.last().is_some_and(|last| !continues([last.knot(last.length_m), begin].map(by_arc_length))) {
                return Err(CentreLineError::Gap { piece });
            }
            segments.push(segment);
        }
        let curve = Curve::new(segments).ok_or(CentreLineError::NoPieces)?;
        Ok(CentreLine(Shape::Curve(std::sync::Arc::new(curve))))
    }
}
