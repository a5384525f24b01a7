//! What the ego of a lane change among nice drivers sees on a straight road and on curved ones.

use std::sync::Arc;

use interplay_planners::drivers::human::Style::Nice;
use interplay_planners::road::centre_line::Piece;
use interplay_planners::{CentreLine, Driver, Profile, Route, Scene};

use crate::common::world::{begin, lane_change, moved_to};

pub const ROADS: [&str; 3] = ["straight", "pieces", "bend"];

const TICKS: usize = 40;

fn curved(piece: Piece) -> Arc<Route> {
    let line = CentreLine::from_pieces([-3.0, 0.0], 0.0, &[piece]).expect("a line");
    Arc::new(Route::curved(line, Profile::constant(0.0), Profile::constant(0.74), Profile::constant(0.37)))
}

/// What the ego sees in closed loop; none for a road that is not one of [`ROADS`].
pub fn scenes(driver: &Driver, road: &str) -> Option<Vec<Scene>> {
    let vehicles = lane_change(driver.clone(), [Nice, Nice]);
    let vehicles = match road {
        "straight" => vehicles,
        "pieces" => moved_to(&curved(Piece::Straight { length_m: 60.0 }), vehicles),
        "bend" => moved_to(&curved(Piece::Arc { length_m: 60.0, curvature_1pm: 0.05 }), vehicles),
        _ => return None,
    };
    let (mut traffic, mut planners) = begin(&vehicles);
    let mut scenes = Vec::new();
    for _ in 0..TICKS {
        traffic.drive(|index, scene| {
            if index == 0 {
                scenes.push(scene.clone());
            }
            planners[index].plan(scene)
        });
    }
    Some(scenes)
}
