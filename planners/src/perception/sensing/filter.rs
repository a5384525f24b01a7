//! The filter behind the measurements of one vehicle.
//!
//! The estimate is driven on from tick to tick at a constant acceleration and angle to the road. A new measurement corrects it
//! with the gains of a Kalman filter: speed `v` and acceleration `a` together,
//!
//! ```text
//! v⁺ = v + T a,  a⁺ = a + w,  w ~ N(0, q_a² T)            measured: v
//! ```
//!
//! and coordinates and heading each for itself, with the gain `P/(P + R)` of its variance `P` against that of the measurement
//! `R`. Without errors of measurement the gains are 1 and the estimate is the measurement, bit for bit.

use super::settings::Settings;
use crate::prediction::steadily_along;
use crate::{Agent, Limits, State};

/// How fast an acceleration is expected to change, `q_a`, for 1/10 scale cars: by 1 m/s² in 0.1 s \[m/s² per √s\].
const ACCELERATION_CHANGE: f64 = 3.0;
/// How fast a heading is expected to change beyond that of the road, for 1/10 scale cars: by 0.05 rad in 0.1 s \[rad per √s\].
const HEADING_CHANGE: f64 = 0.16;
/// Standard deviation of the first estimate of an acceleration \[m/s²\].
const FIRST_ACCELERATION_SD: f64 = 0.5;

/// The estimate of one vehicle's motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Filter {
    /// The estimated state.
    pub state: State,
    /// The estimated acceleration \[m/s²\].
    pub acceleration_mps2: f64,
    /// Variance of a coordinate \[m²\].
    position: f64,
    /// Variance of the heading \[rad²\].
    heading: f64,
    /// Variance of the speed, covariance of speed and acceleration, variance of the acceleration.
    motion: [f64; 3],
}

impl Filter {
    /// The estimate after the first measurement.
    pub(super) fn new(measured: &State, settings: &Settings) -> Filter {
        Filter {
            state: *measured,
            acceleration_mps2: 0.0,
            position: settings.position_sd_m * settings.position_sd_m,
            heading: settings.heading_sd_rad * settings.heading_sd_rad,
            motion: [settings.speed_sd_mps * settings.speed_sd_mps, 0.0, FIRST_ACCELERATION_SD * FIRST_ACCELERATION_SD],
        }
    }

    /// Drives the estimate on by a tick.
    pub(super) fn advance(&mut self, observed: &Agent, step_s: f64) {
        self.state = driven_on(&self.state, self.acceleration_mps2, observed, 1, step_s);
        let time = observed.body.time_ratio();
        let [speed, mixed, acceleration] = self.motion;
        self.position += step_s * step_s * speed;
        self.heading += HEADING_CHANGE * HEADING_CHANGE * step_s / time;
        self.motion = [
            speed + 2.0 * step_s * mixed + step_s * step_s * acceleration,
            mixed + step_s * acceleration,
            acceleration + ACCELERATION_CHANGE * ACCELERATION_CHANGE * step_s / time,
        ];
    }

    /// Corrects the estimate by a measurement of the same tick.
    pub(super) fn correct(&mut self, measured: &State, settings: &Settings) {
        let gain = |variance: f64, sd: f64| if sd == 0.0 { 1.0 } else { variance / (variance + sd * sd) };
        let place = gain(self.position, settings.position_sd_m);
        let turn = gain(self.heading, settings.heading_sd_rad);
        let [speed, mixed, acceleration] = self.motion;
        let spread = speed + settings.speed_sd_mps * settings.speed_sd_mps;
        let [quick, slow] = if spread > 0.0 { [speed / spread, mixed / spread] } else { [1.0, 0.0] };
        let surprise_mps = measured.speed_mps - self.state.speed_mps;
        self.acceleration_mps2 += slow * surprise_mps;
        self.motion = [(1.0 - quick) * speed, (1.0 - quick) * mixed, acceleration - slow * mixed];
        self.position *= 1.0 - place;
        self.heading *= 1.0 - turn;
        let between = |estimate: f64, measured: f64, gain: f64| {
            if gain == 1.0 { measured } else { estimate + gain * (measured - estimate) }
        };
        self.state = State {
            x_m: between(self.state.x_m, measured.x_m, place),
            y_m: between(self.state.y_m, measured.y_m, place),
            heading_rad: between(self.state.heading_rad, measured.heading_rad, turn),
            speed_mps: between(self.state.speed_mps, measured.speed_mps, quick).max(0.0),
        };
    }

    /// Standard deviation of the estimated speed \[m/s\].
    pub(super) fn speed_sd_mps(&self) -> f64 {
        self.motion[0].max(0.0).sqrt()
    }

    /// Standard deviation of the estimated heading \[rad\].
    pub(super) fn heading_sd_rad(&self) -> f64 {
        self.heading.max(0.0).sqrt()
    }
}

/// Where a state leads in some ticks at a constant acceleration within the limits of speed, along the road.
pub(super) fn driven_on(state: &State, acceleration_mps2: f64, observed: &Agent, ticks: usize, step_s: f64) -> State {
    let Limits { speed_min_mps, speed_max_mps, .. } = observed.limits;
    let mut state = *state;
    for _ in 0..ticks {
        let moved = steadily_along(&observed.route, &observed.body, &state, 1, step_s);
        let speed_mps = state.speed_mps + step_s * acceleration_mps2;
        let moved = moved.states.last().copied().unwrap_or(state);
        state = State { speed_mps: speed_mps.max(speed_min_mps).min(speed_max_mps.max(state.speed_mps)), ..moved };
    }
    state
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::agent;
    use crate::perception::sensing::noise::{Draw, Noise};

    const STEP_S: f64 = 0.1;

    /// A vehicle that drives at 1 m/s, brakes by 0.5 m/s² for a second and drives on; its state at a tick.
    fn braking(tick: usize) -> State {
        let mut state = agent(0.0, 0.2, 0.0, 1.0).state;
        for k in 0..tick {
            state.x_m += STEP_S * state.speed_mps;
            state.speed_mps -= if (20..30).contains(&k) { 0.5 * STEP_S } else { 0.0 };
        }
        state
    }

    #[test]
    fn without_errors_the_estimate_is_the_measurement() {
        let (settings, observed) = (Settings::default(), agent(0.0, 0.2, 0.0, 1.0));
        let mut filter = Filter::new(&braking(0), &settings);
        for tick in 1..60 {
            filter.advance(&observed, STEP_S);
            filter.correct(&braking(tick), &settings);
            assert_eq!(filter.state, braking(tick));
        }
    }

    #[test]
    fn estimates_are_closer_to_the_truth_than_measurements() {
        let settings =
            Settings { position_sd_m: 0.02, speed_sd_mps: 0.05, heading_sd_rad: 0.02, ..Settings::default() };
        let observed = agent(0.0, 0.2, 0.0, 1.0);
        let (mut raw, mut filtered) = ([0.0; 3], [0.0; 3]);
        for seed in 0..40 {
            let noise = Noise::new(seed, "ego", "other");
            let measured = |tick: usize| {
                let State { x_m, y_m, heading_rad, speed_mps } = braking(tick);
                State {
                    x_m: x_m + 0.02 * noise.normal(tick, Draw::X),
                    y_m: y_m + 0.02 * noise.normal(tick, Draw::Y),
                    heading_rad: heading_rad + 0.02 * noise.normal(tick, Draw::Heading),
                    speed_mps: speed_mps + 0.05 * noise.normal(tick, Draw::Speed),
                }
            };
            let mut filter = Filter::new(&measured(0), &settings);
            for tick in 1..60 {
                filter.advance(&observed, STEP_S);
                filter.correct(&measured(tick), &settings);
                let truth = braking(tick);
                let errors = |state: &State| {
                    [state.x_m - truth.x_m, state.speed_mps - truth.speed_mps, state.heading_rad - truth.heading_rad]
                };
                for (sums, errors) in [(&mut raw, errors(&measured(tick))), (&mut filtered, errors(&filter.state))] {
                    sums.iter_mut().zip(errors).for_each(|(sum, error)| *sum += error * error);
                }
            }
        }
        for (quantity, (filtered, raw)) in filtered.iter().zip(raw).enumerate() {
            assert!(filtered / raw < 0.95, "quantity {quantity}: {filtered} against {raw}");
        }
        assert!(filtered[0] / raw[0] < 0.5 && filtered[1] / raw[1] < 0.85, "{filtered:?} against {raw:?}");
    }
}
