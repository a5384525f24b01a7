//! The centre line of a lane from its keys.

use interplay_planners::CentreLine;
use interplay_planners::road::centre_line::{CentreLineError, LineSection, Piece, smooth_points};

use super::super::curve::PieceFault;
use super::super::form::{RoadFault, to_centimetres};
use super::lane_config::{LaneConfig, LanePlaceConfig};
use crate::text::error::quoted;

/// The largest length of a piece that a curve to the next piece replaces, by the radius of the tighter one.
const TRANSITION_RADIUS_RATIO: f64 = 0.25;

/// The largest share of a piece that a curve to the next piece replaces.
const TRANSITION_LENGTH_SHARE: f64 = 0.4;

/// Longest lane, as a multiple of its width: bounds the cost of loading it.
const MAX_LENGTH_WIDTHS: f64 = 20_000.0;

/// The middle of a lane; `path` is that of its table below `road`.
pub(super) fn centre(lane: &LaneConfig, path: &str) -> Result<CentreLine, RoadFault> {
    let line = match (&lane.start, lane.pieces.as_slice(), lane.points.as_slice()) {
        (Some(start), [_, ..], _) => of_pieces(lane, start, path)?,
        (None, [], [_, _, ..]) => of_points(lane, path)?,
        (Some(_), [], _) => return Err(unstated(lane, "pieces", path)),
        (None, [_, ..], _) => return Err(unstated(lane, "start", path)),
        (None, [], [_]) => {
            let message = format!("lane {} has one point; a line needs two", quoted(&lane.name));
            return Err(RoadFault::new(format!("{path}.points"), "only one point", message)
                .help("add the point where the lane ends"));
        }
        (None, [], []) => return Err(unstated(lane, "points", path)),
    };
    let most_m = MAX_LENGTH_WIDTHS * lane.width_m.first_m();
    if line.length_m() > most_m {
        let message = format!("lane {} is {} m long", quoted(&lane.name), to_centimetres(line.length_m()));
        return Err(RoadFault::new(format!("{path}.width_m"), "too narrow for this length", message)
            .help(format!("a lane of this width may be at most {} m long", to_centimetres(most_m))));
    }
    Ok(line)
}

fn unstated(lane: &LaneConfig, key: &str, path: &str) -> RoadFault {
    let message = format!("lane {} has no {key}: nothing says where it is", quoted(&lane.name));
    RoadFault::new(path, &format!("has no `{key}`"), message)
        .help("state `start` and `pieces`, or `points`: `points = [[0.0, 0.0], [100.0, 0.0]]`")
}

fn of_points(lane: &LaneConfig, path: &str) -> Result<CentreLine, RoadFault> {
    let line = smooth_points(&lane.points, lane.tolerance_m).and_then(|points| CentreLine::through(&points));
    line.map_err(|error| points_fault(&error, lane, path))
}

/// Why points do not form a line: two are equal, or the line turns back at one of them. Points are counted from 0.
fn points_fault(error: &CentreLineError, lane: &LaneConfig, path: &str) -> RoadFault {
    let of_lane = format!("lane {}", quoted(&lane.name));
    if let Some(point) = lane.points.windows(2).position(|pair| pair[0] == pair[1]) {
        let (path, message) = (
            format!("{path}.points.{}", point + 1),
            format!("the points {point} and {} of {of_lane} are the same", point + 1),
        );
        return RoadFault::new(path, "again", message).help("leave one of them out");
    }
    if let Some(point) = turning_point(&lane.points).filter(|_| matches!(error, CentreLineError::Cusp { .. })) {
        let message = format!("the points of {of_lane} are no line: the line turns back at point {point}");
        return RoadFault::new(format!("{path}.points.{point}"), "turns back", message)
            .help("points follow each other in the direction of driving; a bend takes several points");
    }
    let message = format!("the points of {of_lane} are no line: {error}");
    RoadFault::new(format!("{path}.points"), "no line", message).help("a smooth line must lead through the points")
}

/// The point at which the line through the points turns most, if by more than a right angle.
fn turning_point(points: &[[f64; 2]]) -> Option<usize> {
    let turn_rad = |triple: &[[f64; 2]]| {
        let [before, after] = [0, 1].map(|at| [0, 1].map(|axis| triple[at + 1][axis] - triple[at][axis]));
        let (cross, dot) = (before[0] * after[1] - before[1] * after[0], before[0] * after[0] + before[1] * after[1]);
        libm::atan2(cross, dot).abs()
    };
    let turns = points.windows(3).map(turn_rad).enumerate();
    let (index, most_rad) = turns.max_by(|one, other| one.1.total_cmp(&other.1))?;
    (most_rad > std::f64::consts::FRAC_PI_2).then_some(index + 1)
}

fn of_pieces(lane: &LaneConfig, start: &LanePlaceConfig, path: &str) -> Result<CentreLine, RoadFault> {
    let least_m = 0.5 * lane.width_m.first_m();
    let mut pieces = Vec::new();
    for (index, stated) in lane.pieces.iter().enumerate() {
        let refused = |fault| piece_fault(fault, &format!("{path}.pieces.{index}"), &lane.name);
        pieces.push(stated.piece(least_m).map_err(refused)?);
    }
    joined(start, &pieces).map_err(|error| {
        let message = format!("the pieces of lane {} are no line: {error}", quoted(&lane.name));
        RoadFault::new(format!("{path}.pieces"), "no line", message).help("longer pieces or larger radii work")
    })
}

/// The pieces one after the other. Where the curvature jumps between two of them, a smooth curve replaces a part of
/// both; the ends of all pieces but this part stay where they are.
fn joined(start: &LanePlaceConfig, pieces: &[Piece]) -> Result<CentreLine, CentreLineError> {
    let mut lines = Vec::new();
    let (mut position, mut heading_rad) = ([start.x_m, start.y_m], start.heading_deg.to_radians());
    for piece in pieces {
        let line = CentreLine::from_pieces(position, heading_rad, &[*piece])?;
        let end = line.at(line.length_m());
        (position, heading_rad) = (end.position, end.heading_rad);
        lines.push(line);
    }
    let mut sections: Vec<LineSection> =
        lines.iter().map(|line| LineSection { line, from_m: 0.0, to_m: line.length_m() }).collect();
    for index in 1..pieces.len() {
        let [before, after] = [pieces[index - 1], pieces[index]];
        let [from_1pm, to_1pm] = [before, after].map(|piece| piece.curvatures_1pm()[0]);
        if from_1pm != to_1pm {
            let shorter_m = before.length_m().min(after.length_m());
            let tightest_m = 1.0 / from_1pm.abs().max(to_1pm.abs());
            let replaced_m = (TRANSITION_RADIUS_RATIO * tightest_m).min(TRANSITION_LENGTH_SHARE * shorter_m);
            sections[index - 1].to_m -= replaced_m;
            sections[index].from_m += replaced_m;
        }
    }
    CentreLine::joined(&sections).map(|joined| joined.line)
}

fn piece_fault(fault: PieceFault, path: &str, lane: &str) -> RoadFault {
    let of_lane = |what: &str| format!("a piece of lane {} {what}", quoted(lane));
    match fault {
        PieceFault::NoPiece => RoadFault::new(path, "no piece", of_lane("is neither straight nor a turn"))
            .help("state `straight_m`, or `turn_deg` and `radius_m`"),
        PieceFault::HalfTurn { key } => {
            RoadFault::new(path, &format!("has no `{key}`"), of_lane(&format!("has no `{key}`")))
                .help("a turn has `turn_deg` and `radius_m`, for example `{ turn_deg = 90.0, radius_m = 8.0 }`")
        }
        PieceFault::NoTurn => RoadFault::new(format!("{path}.turn_deg"), "no turn", of_lane("turns by 0"))
            .help("positive values turn to the left; a straight piece is `{ straight_m = 30.0 }`"),
        PieceFault::TooTight { radius_m, least_m } => {
            let message = of_lane(&format!("has a radius of {radius_m} m: its inner edge would cross itself"));
            RoadFault::new(format!("{path}.radius_m"), "too tight", message)
                .help(format!("more than {} m works; so does a narrower lane", to_centimetres(least_m)))
        }
    }
}
