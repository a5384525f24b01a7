//! The plans of the benchmark `roads` and nothing else, for counting their instructions, which no other load disturbs:
//!
//! ```sh
//! cargo build --release -p interplay-planners --example road_plans
//! valgrind --tool=callgrind --toggle-collect='*plan_all*' target/release/examples/road_plans PLANNER ROAD
//! ```

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../benches/roads/scenes.rs"]
mod scenes;

use std::error::Error;
use std::hint::black_box;
use std::io::Write;

use interplay_planners::{Driver, Scene};

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [planner, road] = words.as_slice() else { return Err("usage: road_plans PLANNER ROAD".into()) };
    let driver = common::world::egos().into_iter().find(|ego| ego.kind() == planner).ok_or("no such planner")?;
    let found = plan_all(&driver, &scenes::scenes(&driver, road).ok_or("no such road")?);
    writeln!(std::io::stdout(), "{found} plans")?;
    Ok(())
}

/// How many plans are found. A function of its own, so that a profiler can count what happens inside it.
#[inline(never)]
fn plan_all(driver: &Driver, scenes: &[Scene]) -> usize {
    let mut planner = driver.planner();
    scenes.iter().filter(|scene| black_box(planner.plan(scene)).is_ok()).count()
}
