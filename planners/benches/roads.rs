//! What road coordinates cost: plans on a straight road beside plans on curved ones.
//!
//! ```sh
//! cargo bench -p interplay-planners --bench roads
//! ```
//!
//! `road/PLANNER/ROAD`: the first four seconds of a lane change among nice drivers, all plans of the ego. `straight` is a straight
//! road, `pieces` the same road as a line of straight pieces (the same plans in road coordinates, so the ratio is the price of these
//! alone), and `bend` a turn with a radius of 20 m.

#[path = "../tests/common/mod.rs"]
mod common;

use std::hint::black_box;
use std::sync::Arc;

use common::world::{Vehicle, begin, egos, lane_change, moved_to};
use criterion::{Criterion, criterion_group, criterion_main};
use interplay_planners::human::Style::Nice;
use interplay_planners::road::centre_line::Piece;
use interplay_planners::{CentreLine, Profile, Route, Scene};

const TICKS: usize = 40;

fn road(piece: Piece) -> Arc<Route> {
    let line = CentreLine::from_pieces([-3.0, 0.0], 0.0, &[piece]).expect("a line");
    Arc::new(Route::curved(line, Profile::constant(0.0), Profile::constant(0.74), Profile::constant(0.37)))
}

/// What the ego sees in closed loop.
fn scenes(vehicles: &[Vehicle]) -> Vec<Scene> {
    let (mut traffic, mut planners) = begin(vehicles);
    let mut scenes = Vec::new();
    for _ in 0..TICKS {
        traffic.drive(|index, scene| {
            if index == 0 {
                scenes.push(scene.clone());
            }
            planners[index].plan(scene)
        });
    }
    scenes
}

fn roads(criterion: &mut Criterion) {
    let pieces = road(Piece::Straight { length_m: 60.0 });
    let bend = road(Piece::Arc { length_m: 60.0, curvature_1pm: 0.05 });
    for driver in egos() {
        let mut group = criterion.benchmark_group(format!("road/{}", driver.kind()));
        for (name, route) in [("straight", None), ("pieces", Some(&pieces)), ("bend", Some(&bend))] {
            let vehicles = lane_change(driver.clone(), [Nice, Nice]);
            let vehicles = route.map_or(vehicles, |route| moved_to(route, lane_change(driver.clone(), [Nice, Nice])));
            let scenes = scenes(&vehicles);
            group.bench_function(name, |bencher| {
                bencher.iter(|| {
                    let mut planner = driver.planner();
                    scenes.iter().map(|scene| black_box(planner.plan(scene)).is_ok()).filter(|found| *found).count()
                });
            });
        }
        group.finish();
    }
}

criterion_group!(benches, roads);
criterion_main!(benches);
