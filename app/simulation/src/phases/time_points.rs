//! Time points: vehicles and building each have a clock, and the loop runs at every time point of either clock.

use bevy_ecs::prelude::*;
use interplay_scenarios::Scenario;

use crate::state::components::to_nanosecond;

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

/// The remaining time points of a scenario, in order.
#[derive(Clone, Debug)]
pub struct TimePoints {
    vehicles: ClockStrikes,
    building: ClockStrikes,
    passed: usize,
}

/// The times of one clock.
#[derive(Clone, Copy, Debug)]
struct ClockStrikes {
    step_s: f64,
    count: usize,
    next: usize,
}

impl ClockStrikes {
    /// The next time \[s\]; none after the last.
    fn next_s(&self) -> Option<f64> {
        (self.next < self.count).then(|| to_nanosecond(self.next as f64 * self.step_s))
    }

    /// The end of the last step that has begun \[s\].
    fn reached_s(&self) -> f64 {
        to_nanosecond(self.next as f64 * self.step_s)
    }
}

impl TimePoints {
    /// All time points of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        let building = scenario.building.as_ref();
        let clock = |step_s, count| ClockStrikes { step_s, count, next: 0 };
        TimePoints {
            vehicles: clock(scenario.step_s, scenario.tick_count()),
            building: clock(
                building.map_or(1.0, |building| building.step_s),
                building.map_or(0, |building| scenario.days() * building.steps_per_day()),
            ),
            passed: 0,
        }
    }

    /// Number of time points that have passed.
    pub fn passed(&self) -> usize {
        self.passed
    }

    /// The time up to which the slower clock has advanced \[s\].
    pub fn reached_s(&self) -> f64 {
        self.vehicles.reached_s().max(self.building.reached_s())
    }
}

impl Iterator for TimePoints {
    type Item = TimePoint;

    fn next(&mut self) -> Option<TimePoint> {
        let (vehicles_s, building_s) = (self.vehicles.next_s(), self.building.next_s());
        let time_s = vehicles_s.into_iter().chain(building_s).min_by(f64::total_cmp)?;
        let (vehicles, building) = (vehicles_s == Some(time_s), building_s == Some(time_s));
        self.vehicles.next += usize::from(vehicles);
        self.building.next += usize::from(building);
        self.passed += 1;
        Some(TimePoint { time_s, vehicles, building })
    }
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

    fn time_points_of(text: &str) -> Vec<TimePoint> {
        let scenario = from_text("clocks.toml", &format!("title = 'a'\nshows = 'b'\n{text}"), &[]);
        TimePoints::new(&scenario.expect("a scenario without fault")).collect()
    }

    #[test]
    fn each_clock_has_its_own_times_and_common_times_are_one_time_point() {
        let car = "vehicle = [{ name = 'a', start = { x_m = 0, y_m = 0.2, speed_mps = 0 } }]";
        let (vehicles, building) = (
            time_points_of(&format!("duration_s = 2000\nstep_s = 450\n{car}")),
            time_points_of("building = {}\niterations = 2"),
        );
        assert_eq!((vehicles.len(), building.len()), (4, 96));
        assert!(vehicles.iter().all(|time_point| time_point.vehicles && !time_point.building));
        let both = time_points_of(&format!(
            "duration_s = 2000\nstep_s = 450\nbuilding = {{ step_s = 900 }}\niterations = 1\n{car}"
        ));
        let times: Vec<f64> = both[..5].iter().map(|time_point| time_point.time_s).collect();
        assert_eq!(times, [0.0, 450.0, 900.0, 1350.0, 1800.0]);
        let marks: Vec<(bool, bool)> =
            both[..5].iter().map(|time_point| (time_point.vehicles, time_point.building)).collect();
        assert_eq!(marks, [(true, true), (true, false), (true, true), (true, false), (false, true)]);
        assert_eq!(both.len(), 2 + 96);
        assert!(both.windows(2).all(|pair| pair[0].time_s < pair[1].time_s));
    }
}
