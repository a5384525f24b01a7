//! What the designs do in 20 random light, heavy and mixed buildings, as a table.
//!
//! ```sh
//! cargo run --release -p interplay-building --example ordinary_buildings
//! ```
//!
//! Every building has the same day six times over, with a forecast that is wrong in the same way: a controller that learns
//! becomes cheaper from day to day.

#![allow(clippy::print_stdout, reason = "an example talks to its user")]

#[path = "../tests/common/ordinary.rs"]
mod ordinary;

use interplay_building::control::Controller;
use ordinary::OrdinaryBuilding;

const BUILDINGS: u64 = 20;
const DAYS: usize = 6;

fn main() {
    println!("| building | rooms | temperatures | design | cost of day 1 | 2 | 3 | 4 | 5 | 6 | days without a plan |");
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    for seed in 0..BUILDINGS {
        let building = OrdinaryBuilding::new(seed);
        let network = building.model.network();
        for controller in [
            Controller::Iterative(Default::default()),
            Controller::Concurrent(Default::default()),
            Controller::Distributed(Default::default()),
        ] {
            let outcome = match building.run(controller.clone(), DAYS) {
                Ok((costs, fallbacks)) => {
                    let costs: Vec<String> = costs.iter().map(|cost| format!("{cost:.2}")).collect();
                    format!("{} | {fallbacks}", costs.join(" | "))
                }
                Err(error) => format!("refused: {error} | | | | | |"),
            };
            let (rooms, nodes) = (network.zone_count(), network.node_count());
            println!(
                "| {} {} | {rooms} | {nodes} | {} | {outcome} |",
                seed + 1,
                format!("{:?}", building.construction).to_lowercase(),
                controller.kind()
            );
        }
    }
}
