//! Time points: vehicles and building have a clock each, and the loop runs at every time point of either clock.

use bevy_ecs::prelude::*;
use interplay_scenarios::Scenario;

use crate::components::to_nanosecond;

/// A time at which a tick of the vehicles or a step of the building begins.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct TimePoint {
    /// Simulated time \[s\].
    pub time_s: f64,
    /// Whether it begins a tick of the vehicles.
    pub vehicles: bool,
    /// Whether it begins a step of the building.
    pub building: bool,
}

/// Every time point of a scenario, in order.
pub fn time_points(scenario: &Scenario) -> impl Iterator<Item = TimePoint> + use<> {
    let building_step_s = scenario.building.as_ref().map_or(1.0, |building| building.step_s);
    let steps = scenario.building.as_ref().map_or(0, |building| scenario.days() * building.steps_per_day());
    let (step_s, ticks) = (scenario.step_s, scenario.tick_count());
    let (mut tick, mut step) = (0, 0);
    let strike =
        |index: usize, count: usize, step_s: f64| (index < count).then(|| to_nanosecond(index as f64 * step_s));
    std::iter::from_fn(move || {
        let (vehicles_s, building_s) = (strike(tick, ticks, step_s), strike(step, steps, building_step_s));
        let time_s = vehicles_s.into_iter().chain(building_s).min_by(f64::total_cmp)?;
        let (vehicles, building) = (vehicles_s == Some(time_s), building_s == Some(time_s));
        tick += usize::from(vehicles);
        step += usize::from(building);
        Some(TimePoint { time_s, vehicles, building })
    })
}

/// Whether vehicles drive now.
pub fn vehicles(time_point: Res<TimePoint>) -> bool {
    time_point.vehicles
}

/// Whether the building takes a step now.
pub fn building(time_point: Res<TimePoint>) -> bool {
    time_point.building
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::from_text;

    use super::*;

    fn of(text: &str) -> Vec<TimePoint> {
        let scenario = from_text("clocks.toml", &format!("title = 'a'\nshows = 'b'\n{text}"), &[]);
        time_points(&scenario.expect("a scenario without fault")).collect()
    }

    #[test]
    fn each_clock_strikes_at_its_own_times_and_both_at_once_where_they_meet() {
        let car = "vehicle = [{ name = 'a', start = { x_m = 0, y_m = 0.2, speed_mps = 0 } }]";
        let (vehicles, building) =
            (of(&format!("duration_s = 2000\nstep_s = 450\n{car}")), of("building = {}\niterations = 2"));
        assert_eq!((vehicles.len(), building.len()), (4, 96));
        assert!(vehicles.iter().all(|time_point| time_point.vehicles && !time_point.building));
        let both =
            of(&format!("duration_s = 2000\nstep_s = 450\nbuilding = {{ step_s = 900 }}\niterations = 1\n{car}"));
        let times: Vec<f64> = both[..5].iter().map(|time_point| time_point.time_s).collect();
        assert_eq!(times, [0.0, 450.0, 900.0, 1350.0, 1800.0]);
        let marks: Vec<(bool, bool)> =
            both[..5].iter().map(|time_point| (time_point.vehicles, time_point.building)).collect();
        assert_eq!(marks, [(true, true), (true, false), (true, true), (true, false), (false, true)]);
        assert_eq!(both.len(), 2 + 96);
        assert!(both.windows(2).all(|pair| pair[0].time_s < pair[1].time_s));
    }
}
