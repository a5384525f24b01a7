//! What Frenet coordinates cost: plans on a straight road beside plans on curved ones.
//!
//! ```sh
//! cargo bench -p interplay-planners --bench roads
//! ```
//!
//! `road/PLANNER/ROAD`: the first four seconds of a lane change among nice drivers, all plans of the ego. `straight` is a straight
//! road, `pieces` the same road as a line of straight pieces (the same plans in Frenet coordinates, so the ratio is the price of these
//! alone), and `bend` a turn with a radius of 20 m.

#[path = "../../tests/common/mod.rs"]
mod common;
mod scenes;

use std::hint::black_box;

use common::world::egos;
use criterion::{Criterion, criterion_group, criterion_main};

fn roads(criterion: &mut Criterion) {
    for driver in egos() {
        let mut group = criterion.benchmark_group(format!("road/{}", driver.kind()));
        for road in scenes::ROADS {
            let scenes = scenes::scenes(&driver, road).expect("one of the roads");
            group.bench_function(road, |bencher| {
                bencher.iter(|| {
                    let mut planner = driver.planner();
                    scenes.iter().filter(|scene| black_box(planner.plan(scene)).is_ok()).count()
                });
            });
        }
        group.finish();
    }
}

criterion_group!(benches, roads);
criterion_main!(benches);
