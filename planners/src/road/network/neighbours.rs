//! Checks that a lane lies beside another one that names it as a neighbour.

use super::error::LaneFault;
use super::lane::{Lane, LaneNeighbour, NeighbourRelation};

/// A neighbour may reach beyond the middle of a lane by this share of its width where both merge.
const MAX_CROSSED_RATIO: f64 = 0.1;

/// Where two lanes come nearest to lying side by side, they overlap by at most this share of the narrower one's width.
const MAX_OVERLAP_RATIO: f64 = 0.4;

/// There, the strip between them is at most as wide as this share of it.
const MAX_SPACE_RATIO: f64 = 0.5;

/// How many places of a lane are compared at least and at most; between, one each width.
const PLACES: [f64; 2] = [4.0, 200.0];

/// A place of a lane and what lies beside it.
struct Beside {
    own_m: f64,
    /// Where on the other lane \[m\].
    other_m: f64,
    /// Cosine of the angle between both lanes.
    cos: f64,
    /// Where the middle of the other lane is, positive on the side that is said of it \[m\].
    apart_m: f64,
    /// Width of the strip between both lanes, negative where they overlap \[m\].
    space_m: f64,
}

/// What keeps a lane from being the neighbour that it should be, on a side: 1 for the left, −1 for the right.
///
/// RoadLanes may be of different length and are compared where both are. In the middle they run in the direction that is said of
/// them. The neighbour is nowhere on the other side. Somewhere both lie side by side; elsewhere they may merge or part.
pub(super) fn is_beside(lane: &Lane, neighbour: &LaneNeighbour, other: &Lane, side: f64) -> Option<LaneFault> {
    let other_middle = other.centre.at(0.5 * other.centre.length_m()).position;
    let middles_m = [0.5 * lane.centre.length_m(), lane.centre.project(other_middle, None).along_m];
    let is_same = neighbour.relation == NeighbourRelation::SameDirection;
    for middle in middles_m.into_iter().filter_map(|own_m| beside(lane, other, side, own_m)) {
        if is_same != (middle.cos > 0.0) {
            return Some(LaneFault::WrongDirection { other: other.name.clone() });
        }
        if middle.apart_m < -MAX_CROSSED_RATIO * lane.width.value(middle.own_m) {
            return Some(LaneFault::WrongSide { other: other.name.clone() });
        }
    }
    let width_m = lane.width.extremes(0.0, lane.centre.length_m())[0];
    let count = (lane.centre.length_m() / width_m).ceil().clamp(PLACES[0], PLACES[1]) as usize;
    let places = (0..=count).map(|place| lane.centre.length_m() * place as f64 / count as f64);
    let compared: Vec<Beside> = places.chain(middles_m).filter_map(|own_m| beside(lane, other, side, own_m)).collect();
    // Where one of the lanes turns away, the two are no longer side by side.
    let is_along = |place: &&Beside| is_same == (place.cos > 0.0);
    let crossed = compared
        .iter()
        .filter(is_along)
        .find(|place| place.apart_m < -MAX_CROSSED_RATIO * lane.width.value(place.own_m));
    if let Some(place) = crossed {
        return Some(LaneFault::ChangesSides { other: other.name.clone(), along_m: place.own_m });
    }
    let nearest = compared.iter().min_by(|a, b| a.space_m.abs().total_cmp(&b.space_m.abs()))?;
    let narrower_m = lane.width.value(nearest.own_m).min(other.width.value(nearest.other_m));
    let fault_at =
        |space_m: f64| LaneFault::NotSideBySide { other: other.name.clone(), along_m: nearest.own_m, space_m };
    let is_beside = (-MAX_OVERLAP_RATIO * narrower_m..=MAX_SPACE_RATIO * narrower_m).contains(&nearest.space_m);
    (!is_beside).then(|| fault_at(nearest.space_m))
}

/// What lies beside a lane at an arc length, if both lanes reach there.
fn beside(lane: &Lane, other: &Lane, side: f64, own_m: f64) -> Option<Beside> {
    let own = lane.centre.at(own_m);
    let there = other.centre.project(own.position, None);
    let reaches = |lane: &Lane, along_m: f64| (0.0..=lane.centre.length_m()).contains(&along_m);
    if !(reaches(lane, own_m) && reaches(other, there.along_m)) {
        return None;
    }
    let across_m = lane.centre.project(other.centre.at(there.along_m).position, Some(own_m)).across_m;
    let apart_m = side * across_m;
    Some(Beside {
        own_m,
        other_m: there.along_m,
        cos: libm::cos(there.heading_rad - own.heading_rad),
        apart_m,
        space_m: apart_m - lane.half_width_m(own_m) - other.half_width_m(there.along_m),
    })
}
