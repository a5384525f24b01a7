//! How many operations the design of a day takes, about.
//!
//! Leading terms, with factors that fit the times of `docs/building-benchmarks.md` at about 5e8 operations a second, and 2.8 s of the
//! distributed design for 4 zones and 288 steps. They tell a second from an hour, and not one second from two.

use interplay_building::control::Controller;

/// Operations that the controller of a building takes to design one day of `zones` zones and `steps` steps.
pub(super) fn operations_per_day(controller: &Controller, zones: usize, steps: usize) -> f64 {
    let (zones, steps) = (zones as f64, steps as f64);
    match controller {
        Controller::Thermostat(_) | Controller::Pid(_) | Controller::IterativeLearning(_) => zones * steps,
        // A plan of 1024 inputs takes some tenths of a second, and there is one at each step.
        Controller::ModelPredictive(settings) => {
            let horizon = settings.horizon(86_400.0 / steps) as f64;
            steps * 0.15 * (zones * horizon).powi(3)
        }
        Controller::Clairvoyant | Controller::Centralised(_) => central(zones, steps),
        Controller::Iterative(_) => 10.0 * (zones * steps).powi(3),
        Controller::Concurrent(settings) => {
            let unknowns = settings.taps as f64 * zones * zones;
            20.0 * unknowns.powi(3) + zones * steps * unknowns
        }
        Controller::Distributed(settings) => {
            let compared = if settings.compare { central(zones, steps) } else { 0.0 };
            let exchange = 4.0 * settings.rounds as f64 * zones * steps.powi(2);
            20.0 * zones * steps.powi(3) + exchange + compared
        }
    }
}

/// The sparse problem of a whole day: each step fills in a dense block of its zones.
fn central(zones: f64, steps: f64) -> f64 {
    15.0 * zones.powi(3) * steps
}
