//! Ramp merges in which a human comes past a merging ego at close quarters.

mod common;

use common::world::{Vehicle, ramp_merge, run};
use interplay_planners::human::{self, Style::Nice};
use interplay_planners::{Driver, bayesian, negotiation};

/// Starts and weights that `--example adversary -- 1250` has found: per vehicle where it starts, how fast, and how much it minds others,
/// as shares from 0 to 1 of ±0.5 m, ±0.3 m/s, and safety weights from 0.01 to 100.
fn from_shares(mut vehicles: Vec<Vehicle>, shares: [[f64; 3]; 3]) -> Vec<Vehicle> {
    for (vehicle, [along, speed, weight]) in vehicles.iter_mut().zip(shares) {
        vehicle.agent.state.x_m += 0.5 * (2.0 * along - 1.0);
        vehicle.agent.state.speed_mps += 0.3 * (2.0 * speed - 1.0);
        if let Driver::Human(settings) = &vehicle.driver {
            let safety_weight = Some(10.0_f64.powf(2.0 * (2.0 * weight - 1.0)));
            vehicle.drive(Driver::Human(human::Settings { style: None, safety_weight, ..*settings }));
        }
    }
    vehicles
}

/// The human behind comes past, changes its mind about the side within a few ticks, and turns in behind an ego that stands across
/// the road.
#[test]
#[ignore = "not solved: the human behind is touched by 0 to 26 mm"]
fn who_merges_among_humans_that_swerve_touches_nobody() {
    let bayesian = Driver::Bayesian(bayesian::Settings::default());
    let negotiator = || Driver::Negotiation(negotiation::Settings::default());
    let starts = [
        (
            bayesian,
            [
                [0.5524854921174907, 0.30943574358586995, 0.9721484785130085],
                [0.40856923517036503, 0.286956986902871, 0.8456949036536161],
                [0.4919718400344666, 0.22585308569827794, 0.5387033390981497],
            ],
        ),
        (
            negotiator(),
            [
                [0.4241843356268128, 0.9717002998241542, 0.15411451747879126],
                [0.15190831396452376, 0.7788795338073341, 0.0],
                [0.17905951815077517, 0.05095150025202176, 0.6419993747234413],
            ],
        ),
        (
            negotiator(),
            [
                [0.2869698823039895, 0.9736995284840112, 0.1834557440639208],
                [0.028491617673728487, 0.8096871240709941, 0.0076595184095910734],
                [0.01600954679642333, 0.006642845388799237, 0.650245616380395],
            ],
        ),
    ];
    for (driver, shares) in starts {
        let kind = driver.kind();
        let run = run(from_shares(ramp_merge(driver, [Nice, Nice]), shares), 60);
        assert!(run.collision.is_none(), "{kind}: {:?}", run.collision);
    }
}
