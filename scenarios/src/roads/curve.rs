//! A road of straight and curved pieces.

use std::collections::BTreeMap;
use std::sync::Arc;

use interplay_planners::road::centre_line::{CentreLineError, Piece, smooth};
use interplay_planners::road::network::RouteLeg;
use interplay_planners::{CentreLine, LaneEnd, Profile, Route};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

/// A road of straight and curved pieces with parallel lanes. Its middle begins at x = 0 and half of the road's width in y,
/// with heading 0, so that the right edge there is y = 0. Before and after its pieces the road goes on straight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RoadCurve {
    /// How many lanes there are.
    #[serde(default = "defaults::lane_count")]
    #[schemars(range(min = 1, max = 16))]
    pub lane_count: usize,
    /// Width of each lane \[m\].
    #[serde(default = "defaults::lane_width_m")]
    #[schemars(range(min = 0.001, max = 40.0))]
    pub lane_width_m: f64,
    /// The pieces of the road's middle, one after the other, each straight or a turn.
    #[schemars(
        length(min = 1, max = 200),
        example = json!([{ "straight_m": 3.0 }, { "turn_deg": 90.0, "radius_m": 2.5 }, { "straight_m": 3.0 }])
    )]
    pub pieces: Vec<CurvePiece>,
    /// Length over which the curvature changes from that of one piece to that of the next; half of it lies on each piece. By
    /// default half of the smallest radius, or less where the pieces are too short for that \[m\].
    #[serde(default)]
    #[schemars(range(min = 0.001), example = 1.25)]
    pub transition_m: Option<f64>,
    /// The end of lane 0, if it ends: its vehicles merge into lane 1 before, or stop.
    #[serde(default)]
    #[schemars(example = json!({ "end_m": 6.0, "taper_m": 0.3 }))]
    pub lane_end: Option<CurveLaneEnd>,
}

mod defaults {
    use crate::roads::Lanes;

    pub fn lane_count() -> usize {
        Lanes::default().lane_count
    }
    pub fn lane_width_m() -> f64 {
        Lanes::default().lane_width_m
    }
}

/// Where lane 0 of a curved road ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CurveLaneEnd {
    /// The end of the lane, along the road \[m\].
    #[schemars(range(min = 0.001), example = 6.0)]
    pub end_m: f64,
    /// Length scale `w` of the taper: the edge moves by the lane's width between about `4w` before the end and the end,
    /// as `½ (1 + tanh((s − (end_m − 2w))/w))` with the arc length `s` \[m\].
    #[schemars(range(min = 0.001), example = 0.3)]
    pub taper_m: f64,
}

/// A turn of the road's middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Turn {
    pub piece: usize,
    /// Radius of the road's middle \[m\].
    pub radius_m: f64,
    /// 1 to the left, −1 to the right.
    side: f64,
}

impl Turn {
    /// Radius at a lateral coordinate, positive to the left of the road's middle \[m\].
    pub fn radius_at_m(&self, lateral_m: f64) -> f64 {
        self.radius_m - self.side * lateral_m
    }
}

/// The faults of a curved road. Pieces are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum CurveFault {
    /// A piece is not a valid piece of a road.
    Piece { piece: usize, fault: PieceFault },
    /// The road is longer than the checked geometry.
    TooLong { length_m: f64, most_m: f64 },
    /// A piece is shorter than the transitions at its ends.
    NoRoom { piece: usize, length_m: f64, transition_m: f64, most_m: f64 },
    /// The road crosses itself; both arc lengths.
    MeetsItself { first_m: f64, again_m: f64 },
    /// Lane 0 ends without a lane beside it.
    NoLaneBeside,
    /// Lane 0 ends beyond the road.
    EndsBeyond { end_m: f64, length_m: f64 },
}

/// Longest road, as a multiple of its width: bounds the cost of loading it.
const MAX_LENGTH_WIDTHS: f64 = 20_000.0;

/// The default length of a transition, as a share of the longest possible one.
const DEFAULT_TRANSITION_SHARE: f64 = 0.5;

impl RoadCurve {
    /// Width of all lanes together \[m\].
    pub(crate) fn width_m(&self) -> f64 {
        self.lane_count as f64 * self.lane_width_m
    }

    /// The end of lane 0, if it ends.
    pub(crate) fn lane_end(&self) -> Option<LaneEnd> {
        let end = self.lane_end?;
        Some(LaneEnd { end_m: end.end_m, height_m: self.lane_width_m, taper_m: end.taper_m })
    }

    pub(crate) fn turns(&self) -> impl Iterator<Item = Turn> {
        self.pieces
            .iter()
            .enumerate()
            .filter_map(|(piece, turn)| Some(Turn { piece, radius_m: turn.radius_m?, side: turn.turn_deg?.signum() }))
    }

    /// The road as a route whose lateral coordinates count from the road's middle.
    pub(crate) fn route(&self) -> Result<Arc<Route>, CurveFault> {
        let centre = self.centre()?;
        let half_m = 0.5 * self.width_m();
        let right = self.lane_end().map_or_else(|| Profile::constant(-half_m), |end| Profile::lane_end(-half_m, end));
        let to_m = centre.length_m();
        let mut route = Route::curved(centre, right, Profile::constant(half_m), Profile::constant(half_m));
        // The route needs a leg to return its tightest turn.
        route.legs.push(RouteLeg { lane: "road".to_owned(), to_m, ..RouteLeg::default() });
        Ok(Arc::new(route))
    }

    /// Checks the pieces, that the road does not meet itself, and the end of lane 0.
    pub(crate) fn check(&self) -> Result<(), CurveFault> {
        let centre = self.centre()?;
        if let Some([first_m, again_m]) = meeting_m(&centre, self.width_m()) {
            return Err(CurveFault::MeetsItself { first_m, again_m });
        }
        let Some(end) = self.lane_end else { return Ok(()) };
        if self.lane_count < 2 {
            return Err(CurveFault::NoLaneBeside);
        }
        let (end_m, length_m) = (end.end_m, centre.length_m());
        if end_m > length_m { Err(CurveFault::EndsBeyond { end_m, length_m }) } else { Ok(()) }
    }

    /// The line of the road's middle, from the start of its first piece to the end of its last one.
    fn centre(&self) -> Result<CentreLine, CurveFault> {
        let pieces = self.piece_list()?;
        let length_m = pieces.iter().map(Piece::length_m).sum::<f64>();
        let most_m = MAX_LENGTH_WIDTHS * self.width_m();
        if length_m > most_m {
            return Err(CurveFault::TooLong { length_m, most_m });
        }
        let transition_m = self.transition_m.unwrap_or_else(|| self.default_transition_m(&pieces));
        // Beyond its ends the road is straight. A turn at an end also needs a transition, for which this piece makes room.
        let straight = Piece::Straight { length_m: 0.5 * transition_m };
        let is_turn = |piece: Option<&Piece>| matches!(piece, Some(Piece::Arc { .. }));
        let before = is_turn(pieces.first()).then_some(straight);
        let after = is_turn(pieces.last()).then_some(straight);
        let number = |index: usize| index - usize::from(before.is_some() && index > 0);
        let all: Vec<Piece> = before.into_iter().chain(pieces.iter().copied()).chain(after).collect();
        let begin = [0.0, 0.5 * self.width_m()];
        smooth(&all, transition_m).and_then(|smoothed| CentreLine::from_pieces(begin, 0.0, &smoothed)).map_err(
            |error| match error {
                CentreLineError::NoRoomForTransition { piece, length_m, .. } => {
                    let most_m = longest_transition_m(&pieces);
                    CurveFault::NoRoom { piece: number(piece), length_m, transition_m, most_m }
                }
                CentreLineError::NotFinite { .. }
                | CentreLineError::NoPieces
                | CentreLineError::NoLength { .. }
                | CentreLineError::CurvatureJump { .. }
                | CentreLineError::TooFewPoints
                | CentreLineError::Cusp { .. }
                | CentreLineError::Gap { .. }
                | CentreLineError::NoSection { .. } => CurveFault::Piece { piece: 0, fault: PieceFault::NoPiece },
            },
        )
    }

    /// The pieces as those of a centre line.
    fn piece_list(&self) -> Result<Vec<Piece>, CurveFault> {
        let least_m = 0.5 * self.width_m();
        let located = |(piece, stated): (usize, &CurvePiece)| {
            stated.piece(least_m).map_err(|fault| CurveFault::Piece { piece, fault })
        };
        self.pieces.iter().enumerate().map(located).collect()
    }

    fn default_transition_m(&self, pieces: &[Piece]) -> f64 {
        let radius_m = self.turns().map(|turn| turn.radius_m).fold(f64::INFINITY, f64::min);
        let most_m = DEFAULT_TRANSITION_SHARE * longest_transition_m(pieces).min(radius_m);
        if most_m.is_finite() { most_m } else { self.width_m() }
    }
}

/// The longest transition for which every piece has room; infinite without a turn \[m\].
fn longest_transition_m(pieces: &[Piece]) -> f64 {
    let curvature = |piece: Option<&Piece>| piece.map_or(0.0, |piece| piece.curvatures_1pm()[0]);
    let room_m = |index: usize| {
        let own = curvature(pieces.get(index));
        let neighbours = [index.checked_sub(1).and_then(|before| pieces.get(before)), pieces.get(index + 1)];
        let cuts = neighbours.iter().filter(|neighbour| curvature(**neighbour) != own).count();
        if cuts == 0 { f64::INFINITY } else { 2.0 * pieces[index].length_m() / cuts as f64 }
    };
    (0..pieces.len()).map(room_m).fold(f64::INFINITY, f64::min)
}

/// Two arc lengths at which a road of a width covers the same point, if any. Beyond both ends, where it continues
/// straight, the road is examined over its own length.
///
/// Along a turn whose inner edge does not cross itself, points at least `π/2` widths apart are at least a width apart.
fn meeting_m(centre: &CentreLine, width_m: f64) -> Option<[f64; 2]> {
    let (step_m, length_m) = (0.5 * width_m, centre.length_m());
    let apart_m = 0.5 * std::f64::consts::PI * width_m + step_m;
    let mut cells: BTreeMap<[i64; 2], Vec<(f64, [f64; 2])>> = BTreeMap::new();
    let count = (length_m / step_m) as i64;
    for index in -count..=2 * count {
        let along_m = index as f64 * step_m;
        let position = centre.at(along_m).position;
        let cell = position.map(|coordinate| (coordinate / width_m).floor() as i64);
        for (x, y) in (-1..=1).flat_map(|x| (-1..=1).map(move |y| (x, y))) {
            let mut near = cells.get(&[cell[0] + x, cell[1] + y]).into_iter().flatten();
            let is_met = |(earlier_m, other): &&(f64, [f64; 2])| {
                along_m - earlier_m > apart_m
                    && libm::hypot(other[0] - position[0], other[1] - position[1]) < 0.95 * width_m
            };
            if let Some((earlier_m, _)) = near.find(is_met) {
                return Some([*earlier_m, along_m]);
            }
        }
        cells.entry(cell).or_default().push((along_m, position));
    }
    None
}

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
    HalfTurn {
        key: &'static str,
    },
    NoTurn,
    /// The inner edge of the turn crosses itself.
    TooTight {
        radius_m: f64,
        least_m: f64,
    },
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
