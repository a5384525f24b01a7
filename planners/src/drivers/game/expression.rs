//! Intention expression: the mean speeds at which the other reads the ego's intention (eq. 8.11-8.15).

use super::Settings;
use super::best_response::{MAX_INTENTION, MIN_INTENTION};
use super::conflict_geometry::{ConflictGeometry, ObservedBehaviour};
use crate::Scene;
use crate::trajectory::Penalty;
use crate::trajectory::terms::{MeanSpeed, SpeedMeasure};

/// An intention this close to a bound means "or more": with both at 0.95, eq. 8.14 would force the neutral speed.
const EXTREME_MARGIN: f64 = 0.005;
/// The lower bound of eq. 8.11 stays above this.
const MIN_LOWER_BOUND: f64 = 0.01;

/// The lowest and the highest probability at which the other is to believe that the ego passes: `[p* − ε_p, p*]` (eq. 8.11).
///
/// Expressed on one side, an ego that intends to pass may seem surer of it, and so may one that yields. With both bounds an ego that is
/// ahead and thought to pass for sure slows down until it seems less determined, and the other no longer yields.
pub fn wanted_posterior(intention: f64, settings: &Settings) -> [Option<f64>; 2] {
    let lower = (intention - settings.epsilon_p).max(MIN_LOWER_BOUND);
    let [has_lower, has_upper] = match settings.expresses_intervals() {
        true => [lower > MIN_INTENTION + EXTREME_MARGIN, intention < MAX_INTENTION - EXTREME_MARGIN],
        false => [intention >= 0.5, intention < 0.5],
    };
    [has_lower.then_some(lower), has_upper.then_some(intention)]
}

/// The interval of mean speeds at which the posterior about the ego is [as wanted](wanted_posterior), within what the ego can drive.
///
/// Bounds of arrivals turn into bounds of speeds, `v = d/T`. An earliest arrival before now (an upper denominator of eq.
/// 8.15 that is not positive) bounds nothing; to arrive by a time that is past no speed is enough, so the highest is asked
/// for.
pub fn mean_speed(
    intention: f64,
    prior: f64,
    geometry: &ConflictGeometry,
    ego_behaviour: &ObservedBehaviour,
    scene: &Scene,
    settings: &Settings,
    measure: SpeedMeasure,
) -> MeanSpeed {
    let [least, most] = wanted_posterior(intention, settings)
        .map(|bound| bound.map(|bound| speed_mps(ego_behaviour.behaviour.expressing(bound, prior), geometry)));
    let drivable = |speed: f64| speed.clamp(scene.ego.limits.speed_min_mps, scene.ego.limits.speed_max_mps);
    let penalty = Penalty { linear: settings.slack_weight * scene.horizon as f64, quadratic: 0.0 };
    MeanSpeed { measure, lower_mps: least.map(drivable), upper_mps: most.map(drivable), penalty }
}

/// The speed that a behaviour of the ego stands for: itself, or that of an arrival.
fn speed_mps(shown: f64, geometry: &ConflictGeometry) -> f64 {
    match *geometry {
        ConflictGeometry::Alongside { .. } => shown,
        ConflictGeometry::Crossing { .. } if shown <= 0.0 => f64::INFINITY,
        ConflictGeometry::Crossing { ego_m, .. } => ego_m / shown,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drivers::game::{ExpressedBounds, GameForm};
    use crate::fixture::{agent, scene};
    use proptest::prelude::*;

    fn alone() -> Scene {
        scene(agent(0.0, 0.0, 0.0, 1.0), Vec::new())
    }

    const GEOMETRIES: [ConflictGeometry; 2] =
        [ConflictGeometry::Alongside { lead_m: 0.3 }, ConflictGeometry::Crossing { ego_m: 1.4, other_m: 1.9 }];

    proptest! {
        /// The law that the constraint stands for: inside the interval the other believes what the ego wants it to.
        #[test]
        fn speeds_in_the_interval_are_read_as_intended(
            intention in 0.12..0.94, prior in 0.1..0.9, other_mps in 0.4..1.4, share in 0.0..1.0, which in 0_usize..2,
        ) {
            let settings = Settings { expressed_bounds: ExpressedBounds::Interval, ..Settings::default() };
            let geometry = GEOMETRIES[which];
            let [ego_behaviour, _] = geometry.observations([1.0, other_mps], &settings);
            let bound = mean_speed(intention, prior, &geometry, &ego_behaviour, &alone(), &settings, SpeedMeasure::default());
            if let (Some(lower), Some(upper)) = (bound.lower_mps, bound.upper_mps) {
                prop_assert!(lower <= upper);
                let speed = lower + share * (upper - lower);
                // A bound that cannot be driven was moved.
                let limits = alone().ego.limits;
                prop_assume!(lower > settings.standstill_mps && upper < limits.speed_max_mps);
                // What the other expects depends on its own speed only.
                let [shown, _] = geometry.observations([speed, other_mps], &settings);
                let read = shown.behaviour.posterior(prior, shown.observed);
                prop_assert!(read <= intention + 1e-9 && read >= intention - settings.epsilon_p - 1e-9);
            }
        }
    }

    #[test]
    fn a_late_vehicle_expresses_itself_by_its_highest_speed() {
        let settings = Settings { sigma_2_s: 0.5, ..Settings::default() };
        let geometry = ConflictGeometry::Crossing { ego_m: 1.4, other_m: 0.2 };
        let [ego_behaviour, _] = geometry.observations([1.0, 1.0], &settings);
        let bound = mean_speed(0.9, 0.1, &geometry, &ego_behaviour, &alone(), &settings, SpeedMeasure::default());
        assert_eq!(bound.lower_mps, Some(alone().ego.limits.speed_max_mps));
    }

    #[test]
    fn a_player_may_seem_surer_to_pass_and_surer_to_yield() {
        let wanted = |intention| wanted_posterior(intention, &Settings::default());
        assert_eq!(wanted(0.7), [Some(0.7 - Settings::default().epsilon_p), None]);
        assert_eq!(wanted(0.3), [None, Some(0.3)]);
        let printed = Settings { form: GameForm::AsPrinted, ..Settings::default() };
        assert_eq!(wanted_posterior(0.7, &printed), [Some(0.7 - printed.epsilon_p), Some(0.7)]);
    }

    #[test]
    fn extreme_intentions_are_bounded_on_one_side() {
        let settings = Settings { expressed_bounds: ExpressedBounds::Interval, ..Settings::default() };
        let geometry = GEOMETRIES[0];
        let [ego_behaviour, _] = geometry.observations([1.0, 1.0], &settings);
        let bound = |intention| {
            mean_speed(intention, 0.5, &geometry, &ego_behaviour, &alone(), &settings, SpeedMeasure::default())
        };
        assert!(bound(MAX_INTENTION).upper_mps.is_none() && bound(MAX_INTENTION).lower_mps.is_some());
        assert!(bound(MIN_INTENTION).lower_mps.is_none() && bound(MIN_INTENTION).upper_mps.is_some());
    }
}
