//! The designs in random light, heavy and mixed buildings: each has a plan every day, and costs fall.

mod common;

use common::ordinary::OrdinaryBuilding;
use interplay_building::control::Controller;

/// The largest rise of the cost from one day to the next: as the bias settles, costs of later days differ by less than a tenth
/// of a percent.
const SETTLED: f64 = 1.002;

fn check(controller: Controller, seeds: std::ops::Range<u64>) {
    for seed in seeds {
        let building = OrdinaryBuilding::new(seed);
        let (costs, fallbacks) = building.run(controller.clone(), 5).expect("it starts");
        let what = format!("{} {seed} {:?}: {costs:?}", controller.kind(), building.construction);
        assert_eq!(fallbacks, 0, "{what}");
        assert!(costs[1] < 0.2 * costs[0] && costs[4] < costs[1], "{what}");
        assert!(costs.windows(2).all(|pair| pair[1] <= SETTLED * pair[0]), "{what}");
    }
}

#[test]
fn the_iterative_design_works_in_ordinary_buildings() {
    check(Controller::Iterative(Default::default()), 0..9);
}

#[test]
fn the_concurrent_design_works_in_ordinary_buildings() {
    check(Controller::Concurrent(Default::default()), 0..9);
}

#[test]
fn the_distributed_design_works_in_ordinary_buildings() {
    check(Controller::Distributed(Default::default()), 0..9);
}
