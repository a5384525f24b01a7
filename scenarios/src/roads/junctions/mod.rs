//! Junctions and roads with few numbers, one file for each form, and their conversion to lanes of a network.
//!
//! Traffic keeps to the right. The middle of a junction is the origin, x points to the east and y to the north.

mod arms;
mod connector;
mod ring;

use interplay_planners::road::centre_line::{CentreLineError, Piece};
use interplay_planners::road::network::{Lane, LaneNeighbour, NeighbourRelation};
use interplay_planners::{CentreLine, Profile};

use super::form::RoadFault;

/// The forms: file, type, and the description of the kind in the schema. A type has a `lane_width_m`, and `lanes`, which returns the lanes
/// of a network. To add a form, write its file and a line here.
macro_rules! forms {
    ($declare:ident) => {
        $declare! {
            roundabout::Roundabout: "A ring with three to six arms.";
            t_junction::TJunction: "A minor road that ends at a main one.";
            crossing::Crossing: "Two roads with both directions that cross, the main one with priority.";
            all_way_stop::AllWayStop: "Two roads with both directions that cross at an all-way stop.";
            on_ramp::OnRamp: "A motorway that a ramp joins with an acceleration lane.";
            narrow_passage::NarrowPassage: "A road with both directions that narrows to the width of one lane.";
            two_way::TwoWay: "A straight road with a lane in each direction.";
        }
    };
}

macro_rules! modules {
    ($($file:ident::$Form:ident: $about:literal;)*) => {
        $(mod $file; pub use $file::*;)*
    };
}

forms!(modules);
pub(super) use forms;

/// Sideways acceleration of a vehicle that drives through a turn at its speed limit \[m/s²\].
const ACCELERATION_IN_TURNS_MPS2: f64 = 2.0;

/// The speed limit in a turn of a radius \[m\]: at most that of the road \[m/s\].
fn limit_in_turn_mps(radius_m: f64, limit_mps: f64) -> f64 {
    (ACCELERATION_IN_TURNS_MPS2 * radius_m).sqrt().min(limit_mps)
}

/// A lane of constant width \[m\] with a speed limit \[m/s\].
fn lane(name: &str, centre: CentreLine, width_m: f64, limit_mps: f64) -> Lane {
    Lane { speed_limit_mps: Some(limit_mps), ..Lane::new(name, centre, width_m) }
}

/// A straight line of a length from a place in a direction \[m, rad\].
fn straight(start: [f64; 2], heading_rad: f64, length_m: f64) -> Result<CentreLine, CentreLineError> {
    CentreLine::from_pieces(start, heading_rad, &[Piece::Straight { length_m }])
}

fn beside(lane: &str, relation: NeighbourRelation, may_change: bool) -> Option<LaneNeighbour> {
    Some(LaneNeighbour { lane: lane.to_owned(), relation, may_change })
}

/// The name of a lane, with its number from the right if there are several.
fn numbered(name: &str, number: usize, count: usize) -> String {
    if count == 1 { name.to_owned() } else { format!("{name}-{number}") }
}

/// A width that changes between two places \[m\].
fn changing_width(places_m: [f64; 2], widths_m: [f64; 2]) -> Profile {
    let knots = [[places_m[0], widths_m[0]], [places_m[1], widths_m[1]]];
    // An earlier check refuses positions that do not increase.
    Profile::steps(&knots).unwrap_or(Profile::constant(widths_m[0]))
}

/// The refusal of a form whose sizes do not give a smooth line.
impl From<CentreLineError> for RoadFault {
    fn from(error: CentreLineError) -> RoadFault {
        RoadFault::new("", "sizes that do not fit", format!("no smooth lanes have these sizes: {error}"))
            .help("larger radii, longer lanes or narrower lanes work")
    }
}
