//! Centre lines from straight, arc and clothoid pieces.

use super::error::CentreLineError;
use super::line::CentreLine;
use super::reparametrisation::{MAX_SPEED_ERROR, integrate};
use super::segment::{Knot, MAX_HALF_TURN_RAD, Segment};

/// A piece of a centre line, given by its curvature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Piece {
    /// A straight piece.
    Straight {
        /// Length of the piece \[m\].
        length_m: f64,
    },
    /// A circular arc.
    Arc {
        /// Length of the piece \[m\].
        length_m: f64,
        /// Curvature of the arc, positive to the left \[1/m\].
        curvature_1pm: f64,
    },
    /// A clothoid: the curvature changes linearly with the arc length.
    Clothoid {
        /// Length of the piece \[m\].
        length_m: f64,
        /// Curvature at its begin \[1/m\].
        from_1pm: f64,
        /// Curvature at its end \[1/m\].
        to_1pm: f64,
    },
}

/// Curvatures that differ by less, relative to the larger one, are equal: what decimal numbers in a file may differ by.
const CURVATURE_TOLERANCE: f64 = 1e-9;

impl Piece {
    /// Length of the piece \[m\].
    pub fn length_m(&self) -> f64 {
        match *self {
            Piece::Straight { length_m } | Piece::Arc { length_m, .. } | Piece::Clothoid { length_m, .. } => length_m,
        }
    }

    /// Curvature at the start and at the end of the piece \[1/m\].
    pub fn curvatures_1pm(&self) -> [f64; 2] {
        match *self {
            Piece::Straight { .. } => [0.0; 2],
            Piece::Arc { curvature_1pm, .. } => [curvature_1pm; 2],
            Piece::Clothoid { from_1pm, to_1pm, .. } => [from_1pm, to_1pm],
        }
    }

    /// The part between two distances from its begin.
    fn part(&self, from_m: f64, to_m: f64) -> Piece {
        let length_m = to_m - from_m;
        match *self {
            Piece::Straight { .. } => Piece::Straight { length_m },
            Piece::Arc { curvature_1pm, .. } => Piece::Arc { length_m, curvature_1pm },
            Piece::Clothoid { length_m: whole_m, from_1pm, to_1pm } => {
                let curvature = |at_m: f64| from_1pm + (to_1pm - from_1pm) * at_m / whole_m;
                Piece::Clothoid { length_m, from_1pm: curvature(from_m), to_1pm: curvature(to_m) }
            }
        }
    }

    fn check(&self, piece: usize) -> Result<(), CentreLineError> {
        let ([from, to], length_m) = (self.curvatures_1pm(), self.length_m());
        if !(from.is_finite() && to.is_finite() && length_m.is_finite()) {
            return Err(CentreLineError::NotFinite { place: format!("piece {piece}") });
        }
        if length_m <= 0.0 {
            return Err(CentreLineError::NoLength { piece, length_m });
        }
        Ok(())
    }

    /// How many segments it needs: each is below the largest turn and the largest error of its speed.
    ///
    /// The sixth derivative of a clothoid, which a polynomial of degree 5 leaves out, is at most
    /// `κ⁵ + 10 κ³ κ′ + 15 κ κ′²`. Its contribution to the first derivative is at most `h⁵/13400` times that.
    fn segment_count(&self) -> usize {
        let ([from, to], length_m) = (self.curvatures_1pm(), self.length_m());
        let turn = from.abs().max(to.abs()) * length_m;
        let turn_slope = (to - from).abs() * length_m;
        let mut count = (turn / (1.9 * MAX_HALF_TURN_RAD)).ceil().max(1.0);
        loop {
            let (a, b) = (turn / count, turn_slope / (count * count));
            let bend = a * (a * a * (a * a + 10.0 * b) + 15.0 * b * b);
            if bend / 13400.0 < MAX_SPEED_ERROR {
                return count as usize;
            }
            count = (1.1 * count).ceil();
        }
    }
}

/// A curve without curvature jumps: where the curvature jumps between two pieces, a clothoid of `transition_m` replaces half
/// of this length of each of them.
///
/// Between a straight piece and an arc this keeps the length of the line and the heading after it; the line after it moves
/// sideways by about `κ l²/24` with the length `l` of the transition.
///
/// # Errors
/// [`CentreLineError::NotFinite`] and [`CentreLineError::NoLength`] for a piece without a sound length, and
/// [`CentreLineError::NoRoomForTransition`] for one that is too short for its transitions.
pub fn smooth(pieces: &[Piece], transition_m: f64) -> Result<Vec<Piece>, CentreLineError> {
    if !(transition_m.is_finite() && transition_m > 0.0) {
        return Err(CentreLineError::NotFinite { place: "the transition length".to_owned() });
    }
    let jumps_after = |index: usize| index + 1 < pieces.len() && jump(&pieces[index], &pieces[index + 1]).is_some();
    let mut smoothed: Vec<Piece> = Vec::new();
    for (index, piece) in pieces.iter().enumerate() {
        piece.check(index)?;
        let cut = |is_cut: bool| if is_cut { 0.5 * transition_m } else { 0.0 };
        let (before_m, after_m) = (cut(index > 0 && jumps_after(index - 1)), cut(jumps_after(index)));
        let (length_m, needed_m) = (piece.length_m(), before_m + after_m);
        // A piece may vanish between its transitions, up to rounding.
        if length_m < needed_m * (1.0 - CURVATURE_TOLERANCE) {
            return Err(CentreLineError::NoRoomForTransition { piece: index, length_m, needed_m });
        }
        let rest = piece.part(before_m, length_m - after_m);
        if before_m > 0.0 {
            let from_1pm = smoothed.last().map_or(0.0, |last| last.curvatures_1pm()[1]);
            smoothed.push(Piece::Clothoid { length_m: transition_m, from_1pm, to_1pm: rest.curvatures_1pm()[0] });
        }
        smoothed.push(rest);
    }
    // A vanished piece has the same end curvature as the clothoids beside it.
    smoothed.retain(|piece| piece.length_m() > CURVATURE_TOLERANCE * transition_m);
    Ok(smoothed)
}

/// The curvatures on both sides of a joint, if they differ.
fn jump(before: &Piece, after: &Piece) -> Option<[f64; 2]> {
    let ([_, from], [to, _]) = (before.curvatures_1pm(), after.curvatures_1pm());
    let differs = (from - to).abs() > CURVATURE_TOLERANCE * from.abs().max(to.abs());
    differs.then_some([from, to])
}

impl CentreLine {
    /// The line of consecutive pieces, from a start with a heading \[m, rad\]; its headings continue from this one,
    /// beyond a full turn if necessary.
    ///
    /// Clothoids are integrated by Gauss-Legendre quadrature with ten points between neighbouring knots, to rounding.
    ///
    /// # Errors
    /// - [`CentreLineError::NoPieces`] without a piece,
    /// - [`CentreLineError::NotFinite`] and [`CentreLineError::NoLength`] for numbers that are no start or no piece,
    /// - [`CentreLineError::CurvatureJump`] where the curvatures of two pieces differ where they meet; [`smooth`] inserts
    ///   clothoids there.
    pub fn from_pieces(start: [f64; 2], heading_rad: f64, pieces: &[Piece]) -> Result<CentreLine, CentreLineError> {
        if !(start[0].is_finite() && start[1].is_finite() && heading_rad.is_finite()) {
            return Err(CentreLineError::NotFinite { place: "the start".to_owned() });
        }
        for (index, piece) in pieces.iter().enumerate() {
            piece.check(index)?;
            let before = index.checked_sub(1).and_then(|before| jump(&pieces[before], piece));
            if let Some([from_1pm, to_1pm]) = before {
                return Err(CentreLineError::CurvatureJump { piece: index, from_1pm, to_1pm });
            }
        }
        let mut segments = Vec::new();
        let mut pose = Pose { position: start, heading_rad };
        for piece in pieces {
            pose = pose.follow(piece, &mut segments);
        }
        if let Some(first) = segments.first_mut() {
            *first = first.placed(0.0, heading_rad);
        }
        CentreLine::from_segments(segments).ok_or(CentreLineError::NoPieces)
    }
}

/// Where a piece begins.
struct Pose {
    position: [f64; 2],
    heading_rad: f64,
}

impl Pose {
    /// Adds the segments of a piece and returns its end.
    fn follow(self, piece: &Piece, segments: &mut Vec<Segment>) -> Pose {
        let ([from, to], length_m, count) = (piece.curvatures_1pm(), piece.length_m(), piece.segment_count());
        let slope = (to - from) / length_m;
        let heading_rad = |at_m: f64| self.heading_rad + at_m * (from + 0.5 * slope * at_m);
        let knot = |at_m: f64, position: [f64; 2]| -> Knot {
            let ((sin, cos), curvature) = (libm::sincos(heading_rad(at_m)), from + slope * at_m);
            [position, [cos, sin], [-curvature * sin, curvature * cos]]
        };
        let mut start = knot(0.0, self.position);
        for index in 1..=count {
            let [from_m, to_m] = [index - 1, index].map(|knot| length_m * knot as f64 / count as f64);
            let moved = integrate(from_m, to_m, |at_m| {
                let (sin, cos) = libm::sincos(heading_rad(at_m));
                [cos, sin]
            });
            let end = knot(to_m, [start[0][0] + moved[0], start[0][1] + moved[1]]);
            segments.push(Segment::new(to_m - from_m, start, end));
            start = end;
        }
        Pose { position: start[0], heading_rad: heading_rad(length_m) }
    }
}
