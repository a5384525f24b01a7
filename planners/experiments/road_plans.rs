//! The plans of the benchmark `roads`, for counting their instructions, which no other load disturbs:
//!
//! ```sh
//! cargo build --release -p interplay-planners --example road_plans
//! valgrind --tool=callgrind --toggle-collect='*plan_all*' target/release/examples/road_plans PLANNER ROAD
//! ```
//!
//! Without a road it times the roads in turn, so that other load meets all of them, and prints the shortest time of each as a ratio
//! to that of the straight road, for all plans and for an interior-point iteration: in a bend other plans are made, which may take
//! more or fewer of them.

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../benches/roads/scenes.rs"]
mod scenes;

use std::error::Error;
use std::hint::black_box;
use std::io::Write;
use std::time::Instant;

use interplay_planners::{Driver, Scene};

/// How often each road is timed.
const ROUNDS: usize = 40;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let usage = "usage: road_plans PLANNER [ROAD]";
    let (planner, road) = match words.as_slice() {
        [planner] => (planner, None),
        [planner, road] => (planner, Some(road)),
        _ => return Err(usage.into()),
    };
    let driver = common::world::egos().into_iter().find(|ego| ego.kind() == planner).ok_or("no such planner")?;
    let text = match road {
        Some(road) => {
            let iterations = plan_all(&driver, &scenes::scenes(&driver, road).ok_or("no such road")?);
            format!("{iterations} interior-point iterations")
        }
        None => ratios(&driver).ok_or("no such road")?,
    };
    writeln!(std::io::stdout(), "{text}")?;
    Ok(())
}

/// The shortest time of the plans on each road, as a ratio to that on the first.
fn ratios(driver: &Driver) -> Option<String> {
    let roads: Vec<Vec<Scene>> =
        scenes::ROADS.iter().map(|road| scenes::scenes(driver, road)).collect::<Option<_>>()?;
    let mut shortest_ms = [f64::INFINITY; scenes::ROADS.len()];
    let mut iterations = [0; scenes::ROADS.len()];
    for _ in 0..ROUNDS {
        for ((shortest_ms, iterations), scenes) in shortest_ms.iter_mut().zip(&mut iterations).zip(&roads) {
            let began = Instant::now();
            *iterations = plan_all(driver, scenes);
            *shortest_ms = shortest_ms.min(1e3 * began.elapsed().as_secs_f64());
        }
    }
    let share = |index: usize| {
        let (all, one) = (shortest_ms[index] / shortest_ms[0], iterations[0] as f64 / iterations[index] as f64);
        format!("{:.2} ms, {all:.3}, {:.3} an iteration", shortest_ms[index], all * one)
    };
    let cells = scenes::ROADS.iter().enumerate().map(|(index, road)| format!("{road} {}", share(index)));
    Some(format!("{}: {}", driver.kind(), cells.collect::<Vec<_>>().join("; ")))
}

/// The interior-point iterations of all plans. A function of its own, so that a profiler can count what happens inside it.
#[inline(never)]
fn plan_all(driver: &Driver, scenes: &[Scene]) -> usize {
    let mut planner = driver.planner();
    let plans = scenes.iter().filter_map(|scene| black_box(planner.plan(scene)).ok());
    plans.map(|plan| plan.statistics.inner_iterations).sum()
}
