//! How smoothly a vehicle drives.

use interplay_planners::{Input, State};

use super::peak::Peak;

/// Means and peaks of accelerations and of jerk.
///
/// Longitudinal acceleration is that of the inputs; jerk is its change from one tick to the next over a tick, and a vehicle
/// begins without acceleration. Lateral acceleration is the mean speed of a tick times the yaw rate in it.
#[derive(Clone, Copy, Debug)]
pub struct RideComfort {
    step_s: f64,
    previous: f64,
    acceleration_sum: f64,
    jerk_sum: f64,
    count: usize,
    /// Magnitude of the longitudinal acceleration \[m/s²\].
    pub acceleration: Peak,
    /// Deceleration \[m/s²\].
    pub braking: Peak,
    /// Magnitude of the jerk \[m/s³\].
    pub jerk: Peak,
    /// Magnitude of the lateral acceleration \[m/s²\].
    pub lateral_acceleration: Peak,
}

impl RideComfort {
    /// A vehicle that has not accelerated yet.
    pub fn new(step_s: f64) -> Self {
        RideComfort {
            step_s,
            previous: 0.0,
            acceleration_sum: 0.0,
            jerk_sum: 0.0,
            count: 0,
            acceleration: Peak::default(),
            braking: Peak::default(),
            jerk: Peak::default(),
            lateral_acceleration: Peak::default(),
        }
    }

    /// Takes the input of a tick that begins at `time_s`, and the states before and after it.
    pub fn observe(&mut self, input: &Input, [before, after]: [&State; 2], time_s: f64) {
        let acceleration = input.acceleration_mps2;
        let jerk = (acceleration - self.previous).abs() / self.step_s;
        let yaw_rate_radps = (after.heading_rad - before.heading_rad) / self.step_s;
        let lateral = 0.5 * (before.speed_mps + after.speed_mps) * yaw_rate_radps;
        self.acceleration_sum += acceleration.abs();
        self.jerk_sum += jerk;
        self.acceleration.observe(acceleration.abs(), time_s);
        self.braking.observe(-acceleration, time_s);
        self.jerk.observe(jerk, time_s);
        self.lateral_acceleration.observe(lateral.abs(), time_s);
        self.previous = acceleration;
        self.count += 1;
    }

    /// Mean absolute acceleration \[m/s²\].
    pub fn mean_abs_acceleration(&self) -> f64 {
        self.acceleration_sum / self.count.max(1) as f64
    }

    /// Mean absolute jerk \[m/s³\].
    pub fn mean_abs_jerk(&self) -> f64 {
        self.jerk_sum / self.count.max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn input(acceleration_mps2: f64) -> Input {
        Input { acceleration_mps2, steering_rad: 0.0 }
    }

    #[test]
    fn means_and_peaks_of_a_pulse() {
        let (mut comfort, still) = (RideComfort::new(0.1), State::default());
        for (tick, acceleration_mps2) in [0.0, 1.0, -2.0, 0.0].into_iter().enumerate() {
            comfort.observe(&input(acceleration_mps2), [&still, &still], tick as f64);
        }
        assert!((comfort.mean_abs_acceleration() - 0.75).abs() < 1e-12);
        assert!((comfort.mean_abs_jerk() - 15.0).abs() < 1e-12);
        let peak = |value, time_s| Peak { value, time_s: Some(time_s) };
        assert_eq!((comfort.acceleration, comfort.braking), (peak(2.0, 2.0), peak(2.0, 2.0)));
        assert!((comfort.jerk.value - 30.0).abs() < 1e-12 && comfort.jerk.time_s == Some(2.0));
        assert_eq!(comfort.lateral_acceleration, Peak::default());
        let mut faster = RideComfort::new(0.1);
        faster.observe(&input(1.5), [&still, &still], 0.0);
        assert_eq!((faster.acceleration, faster.braking), (peak(1.5, 0.0), Peak::default()), "it never brakes");
    }

    /// On a circle, lateral acceleration is the speed squared over the radius, in both directions.
    #[test]
    fn lateral_acceleration_on_a_circle() {
        let (speed_mps, radius_m, step_s) = (12.0, 40.0, 0.1);
        for sign in [1.0, -1.0] {
            let mut comfort = RideComfort::new(step_s);
            let turn_rad = sign * speed_mps * step_s / radius_m;
            let [before, after] =
                [0.3, 0.3 + turn_rad].map(|heading_rad| State { heading_rad, speed_mps, ..State::default() });
            comfort.observe(&input(0.0), [&before, &after], 0.4);
            let found = comfort.lateral_acceleration;
            assert!((found.value - speed_mps * speed_mps / radius_m).abs() < 1e-9, "{found:?}");
            assert_eq!(found.time_s, Some(0.4));
        }
    }
}
