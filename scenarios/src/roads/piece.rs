//! The pieces of the middle of a road or a lane.

use interplay_planners::road::centre_line::Piece;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A piece of a curved road: `straight_m`, or `turn_deg` with `radius_m`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CurvePiece {
    /// Length of a straight piece \[m\].
    #[schemars(range(min = 0.001), example = 3.0, extend("x-excludes" = ["turn_deg", "radius_m"]))]
    pub straight_m: Option<f64>,
    /// By how much the road turns, positive to the left \[deg\].
    #[schemars(range(min = -360.0, max = 360.0), example = 90.0)]
    pub turn_deg: Option<f64>,
    /// Radius of the road's middle in the turn \[m\].
    #[schemars(range(min = 0.001), example = 2.5)]
    pub radius_m: Option<f64>,
}

/// The fault of a piece of a curved road.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum PieceFault {
    /// It is neither straight nor a turn.
    NoPiece,
    /// It does not state both the angle and the radius of a turn; this key is missing.
    HalfTurn { key: &'static str },
    /// A turn by 0.
    NoTurn,
    /// The inner edge of the turn crosses itself.
    TooTight { radius_m: f64, least_m: f64 },
}

impl CurvePiece {
    /// The piece of a centre line, on which a radius is above `least_m`.
    pub(crate) fn piece(&self, least_m: f64) -> Result<Piece, PieceFault> {
        match (self.straight_m, self.turn_deg, self.radius_m) {
            (Some(length_m), ..) => Ok(Piece::Straight { length_m }),
            (None, None, None) => Err(PieceFault::NoPiece),
            (None, Some(_), None) => Err(PieceFault::HalfTurn { key: "radius_m" }),
            (None, None, Some(_)) => Err(PieceFault::HalfTurn { key: "turn_deg" }),
            (None, Some(0.0), Some(_)) => Err(PieceFault::NoTurn),
            (None, Some(_), Some(radius_m)) if radius_m <= least_m => Err(PieceFault::TooTight { radius_m, least_m }),
            (None, Some(turn_deg), Some(radius_m)) => Ok(Piece::Arc {
                length_m: turn_deg.abs().to_radians() * radius_m,
                curvature_1pm: turn_deg.signum() / radius_m,
            }),
        }
    }
}
