//! What a driver senses of the others: measurements with errors, late, not always, and a filter behind them.
//!
//! At tick `k` the driver gets the measurements of tick `k − d`, where `d` is the delay in ticks; what is measured first is known
//! at once. A measurement exists if the vehicle is in range, in the field of view and not hidden (`visibility`), and is not
//! lost; its errors are normal and a function of seed, observer, observed vehicle and tick (`noise`). A Kalman filter turns
//! measurements into an estimate at `k − d` (`filter`), which is driven on to tick `k` at its acceleration. A vehicle that has not
//! been measured for a second (of 1/10 scale) leaves the scene.
//!
//! Plans that others tell are a message and no measurement: where a driver knows plans, they are as old and as exact as without a
//! sensor, but begin at the sensed state. Lengths of bodies, limits and routes are known.

mod filter;
mod noise;
mod settings;
mod visibility;

use std::sync::Arc;

pub use settings::Settings;

use std::collections::VecDeque;

use crate::{Agent, Input, Scene, State};
use filter::{Filter, driven_on};
use noise::{Draw, Noise};

/// How long a vehicle stays in the scene after its last measurement, for 1/10 scale cars \[s\].
const MAX_UNSEEN_S: f64 = 1.0;

/// The sensor of one vehicle, with what it remembers of each of the others.
#[derive(Clone, Debug)]
pub struct Sensor {
    settings: Settings,
    seed: u64,
    tracks: Vec<Track>,
}

/// What is known of one observed vehicle.
#[derive(Clone, Debug)]
struct Track {
    name: String,
    /// Measurements by the tick in which they were made, the oldest first; none where one is missing.
    under_way: VecDeque<(usize, Option<State>)>,
    last: Option<Measured>,
}

/// The last measurement of a vehicle.
#[derive(Clone, Copy, Debug)]
struct Measured {
    /// Tick of the measurement.
    tick: usize,
    state: State,
    /// The estimated state after the measurement.
    filter: Filter,
}

/// The last measurement of one vehicle, and the estimate that follows from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    /// The tick of the last measurement.
    pub tick: usize,
    /// The measured state.
    pub measured: State,
    /// The estimated state after the measurement.
    pub estimate: State,
    /// Standard deviation of a measured speed \[m/s\].
    pub measured_speed_sd_mps: f64,
    /// Standard deviation of a measured heading \[rad\].
    pub measured_heading_sd_rad: f64,
    /// Standard deviation of the estimated speed \[m/s\].
    pub speed_sd_mps: f64,
    /// Standard deviation of the estimated heading \[rad\].
    pub heading_sd_rad: f64,
}

impl Sighting {
    /// A sighting without error or delay.
    pub fn perfect(tick: usize, state: &State) -> Sighting {
        Sighting {
            tick,
            measured: *state,
            estimate: *state,
            measured_speed_sd_mps: 0.0,
            measured_heading_sd_rad: 0.0,
            speed_sd_mps: 0.0,
            heading_sd_rad: 0.0,
        }
    }
}

/// A scene as a driver senses it.
#[derive(Clone, Debug, PartialEq)]
pub struct SensedScene {
    /// The scene with the others at their estimated states, driven on to the present, without those that are not seen.
    pub scene: Scene,
    /// The last sighting of each other vehicle, in the order of the scene.
    pub sightings: Vec<Sighting>,
}

impl SensedScene {
    /// A scene in which all vehicles are sensed without error or delay.
    pub fn perfect(scene: &Scene) -> SensedScene {
        let sightings = scene.others.iter().map(|other| Sighting::perfect(scene.tick, &other.state)).collect();
        SensedScene { scene: scene.clone(), sightings }
    }

    /// The age of the oldest sighting in ticks.
    pub fn oldest_sighting(&self) -> usize {
        let ages = self.sightings.iter().map(|sighting| self.scene.tick.saturating_sub(sighting.tick));
        ages.max().unwrap_or_default()
    }
}

/// What a sensor says of the others at a tick, before any plan is known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sight(Vec<SeenVehicle>);

/// A vehicle as a sensor sees it.
#[derive(Clone, Debug, PartialEq)]
struct SeenVehicle {
    name: String,
    /// Its estimated state, driven on to the present.
    state: State,
    /// The input that it is estimated to apply; none where it is seen as it is.
    estimated_input: Option<Input>,
    sighting: Sighting,
}

impl Sight {
    /// A scene as it is sensed: the others at their estimated states, with the plans that the scene tells, without those that are not seen.
    pub fn apply_to(&self, scene: &Scene) -> SensedScene {
        let (mut others, mut sightings) = (Vec::new(), Vec::new());
        for other in &scene.others {
            let Some(seen) = self.0.iter().find(|seen| seen.name == other.name) else { continue };
            let mut agent = Agent { state: seen.state, ..other.clone() };
            if let Some(first) = Arc::make_mut(&mut agent.prediction).states.first_mut() {
                *first = seen.state;
            }
            agent.previous_input = seen.estimated_input.unwrap_or(agent.previous_input);
            others.push(agent);
            sightings.push(seen.sighting);
        }
        SensedScene { scene: Scene { others, ..scene.clone() }, sightings }
    }
}

impl Sensor {
    /// A sensor that has not measured yet; `seed` is that of the run.
    pub fn new(settings: Settings, seed: u64) -> Sensor {
        Sensor { settings, seed, tracks: Vec::new() }
    }

    /// Measures the others of a scene; their plans play no part. To be called once a tick, with scenes whose ticks follow each other.
    pub fn look(&mut self, scene: &Scene) -> Sight {
        for index in 0..scene.others.len() {
            self.measure(scene, index);
        }
        let mut seen = Vec::new();
        for other in &scene.others {
            let Some(track) = self.tracks.iter_mut().find(|track| track.name == other.name) else { continue };
            track.receive(scene, other, &self.settings);
            seen.extend(track.seen(scene, other, &self.settings));
        }
        Sight(seen)
    }

    /// Measures the others of a scene, and returns it as it is sensed. As [`Sensor::look`].
    pub fn sense(&mut self, scene: &Scene) -> SensedScene {
        self.look(scene).apply_to(scene)
    }

    /// Makes the measurement of this tick.
    fn measure(&mut self, scene: &Scene, index: usize) {
        let (other, settings, tick) = (&scene.others[index], &self.settings, scene.tick);
        let noise = Noise::new(self.seed, &scene.ego.name, &other.name);
        let is_measured =
            visibility::is_visible(scene, index, settings) && noise.uniform(tick, Draw::Missing) >= settings.drop_rate;
        let erroneous = |value: f64, sd: f64, draw: Draw| {
            if sd == 0.0 { value } else { value + sd * noise.normal(tick, draw) }
        };
        let State { x_m, y_m, heading_rad, speed_mps } = other.state;
        let measured = is_measured.then(|| State {
            x_m: erroneous(x_m, settings.position_sd_m, Draw::X),
            y_m: erroneous(y_m, settings.position_sd_m, Draw::Y),
            heading_rad: erroneous(heading_rad, settings.heading_sd_rad, Draw::Heading),
            speed_mps: erroneous(speed_mps, settings.speed_sd_mps, Draw::Speed),
        });
        let known = self.tracks.iter().position(|track| track.name == other.name);
        let place = known.unwrap_or_else(|| {
            let name = other.name.clone();
            self.tracks.push(Track { name, under_way: VecDeque::new(), last: None });
            self.tracks.len() - 1
        });
        self.tracks[place].under_way.push_back((tick, measured));
    }
}

impl Track {
    /// Takes in the measurements that have arrived.
    fn receive(&mut self, scene: &Scene, observed: &Agent, settings: &Settings) {
        let delay = ticks_of(settings.delay_s, scene.step_s);
        while let Some(&(tick, measured)) = self.under_way.front() {
            if tick + delay > scene.tick && !(self.last.is_none() && measured.is_some()) {
                break;
            }
            self.under_way.pop_front();
            if let Some(state) = measured {
                self.take_in(tick, &state, observed, scene.step_s, settings);
            }
        }
    }

    fn take_in(&mut self, tick: usize, state: &State, observed: &Agent, step_s: f64, settings: &Settings) {
        let filter = match self.last {
            Some(Measured { tick: before, mut filter, .. }) => {
                (before..tick).for_each(|_| filter.advance(observed, step_s));
                filter.correct(state, settings);
                filter
            }
            None => Filter::new(state, settings),
        };
        self.last = Some(Measured { tick, state: *state, filter });
    }

    /// The vehicle as it is seen now; none if it has not been measured for too long, and then it is forgotten.
    fn seen(&mut self, scene: &Scene, other: &Agent, settings: &Settings) -> Option<SeenVehicle> {
        let Measured { tick, state: measured, filter } = self.last?;
        let age = scene.tick.saturating_sub(tick);
        let missed = age.saturating_sub(ticks_of(settings.delay_s, scene.step_s));
        if scene.step_s * missed as f64 > MAX_UNSEEN_S * other.body.time_ratio() {
            self.last = None;
            return None;
        }
        let state = driven_on(&filter.state, filter.acceleration_mps2, other, age, scene.step_s);
        let is_seen_as_it_is = settings.is_exact() && age == 0;
        let estimated = Input { acceleration_mps2: filter.acceleration_mps2, steering_rad: 0.0 };
        let sighting = Sighting {
            tick,
            measured,
            estimate: filter.state,
            measured_speed_sd_mps: settings.speed_sd_mps,
            measured_heading_sd_rad: settings.heading_sd_rad,
            speed_sd_mps: filter.speed_sd_mps(),
            heading_sd_rad: filter.heading_sd_rad(),
        };
        let estimated_input = (!is_seen_as_it_is).then_some(estimated);
        Some(SeenVehicle { name: other.name.clone(), state, estimated_input, sighting })
    }
}

/// A duration in ticks, rounded.
fn ticks_of(duration_s: f64, step_s: f64) -> usize {
    (duration_s / step_s).round().max(0.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{agent, scene};

    /// A scene at a tick with another vehicle that drives at 1 m/s until tick 5 and brakes by 0.5 m/s² from then on.
    fn at(tick: usize) -> Scene {
        let mut other = Agent { name: "other".to_owned(), ..agent(2.0, 0.5, 0.0, 1.0) };
        for k in 0..tick {
            other.state.x_m += 0.1 * other.state.speed_mps;
            other.state.speed_mps -= if k >= 5 { 0.05 } else { 0.0 };
        }
        Scene { tick, ..scene(agent(0.0, 0.0, 0.0, 1.0), vec![other]) }
    }

    fn sensed(settings: Settings, seed: u64, ticks: usize) -> Vec<SensedScene> {
        let mut sensor = Sensor::new(settings, seed);
        (0..ticks).map(|tick| sensor.sense(&at(tick))).collect()
    }

    #[test]
    fn perfect_sight_changes_no_bit() {
        for (tick, seen) in sensed(Settings::default(), 1, 15).into_iter().enumerate() {
            assert_eq!(seen, SensedScene::perfect(&Scene { others: seen.scene.others.clone(), ..at(tick) }));
            assert_eq!(seen.scene.others[0].state, at(tick).others[0].state);
        }
    }

    #[test]
    fn a_late_measurement_is_driven_on_at_its_acceleration() {
        let late = sensed(Settings { delay_s: 0.3, ..Settings::default() }, 1, 20);
        let surprise = |tick: usize| late[tick].scene.others[0].state.x_m - at(tick).others[0].state.x_m;
        assert_eq!(late[0].sightings[0].tick, 0, "what is measured first is known at once");
        assert_eq!(late[9].sightings[0], Sighting::perfect(6, &at(6).others[0].state).with_spread(&late[9]));
        assert!(surprise(4).abs() < 1e-12 && surprise(8) > 0.014, "the braking is not known yet");
        assert!(surprise(19).abs() < 0.01, "and then continued: {}", surprise(19));
    }

    impl Sighting {
        /// The same with the spread of another sighting, which is none of this test's business.
        fn with_spread(self, seen: &SensedScene) -> Sighting {
            let Sighting { speed_sd_mps, heading_sd_rad, .. } = seen.sightings[0];
            Sighting { speed_sd_mps, heading_sd_rad, ..self }
        }
    }

    #[test]
    fn errors_depend_on_the_seed_and_not_on_other_vehicles() {
        let noisy = Settings { position_sd_m: 0.02, speed_sd_mps: 0.05, heading_sd_rad: 0.01, ..Settings::default() };
        let state = |seen: &[SensedScene]| seen.iter().map(|seen| seen.scene.others[0].state).collect::<Vec<State>>();
        let one = state(&sensed(noisy, 1, 10));
        assert_eq!(one, state(&sensed(noisy, 1, 10)));
        assert_ne!(one, state(&sensed(noisy, 2, 10)));
        let mut sensor = Sensor::new(noisy, 1);
        for (tick, alone) in one.iter().enumerate() {
            let mut crowded = at(tick);
            crowded.others.insert(0, agent(-3.0, 0.0, 0.0, 1.0));
            assert_eq!(sensor.sense(&crowded).scene.others[1].state, *alone);
        }
    }

    #[test]
    fn a_vehicle_unmeasured_for_a_second_is_dropped_until_it_is_measured_again() {
        let mut sensor = Sensor::new(Settings { range_m: Some(3.0), ..Settings::default() }, 1);
        let away = |tick: usize| {
            let mut scene = at(0);
            scene.tick = tick;
            scene.others[0].state.x_m = if (3..20).contains(&tick) { 9.0 } else { 2.0 };
            sensor.sense(&scene).scene.others.len()
        };
        let counts: Vec<usize> = (0..22).map(away).collect();
        assert_eq!(counts[..13], [1; 13], "its last motion is continued");
        assert_eq!(counts[13..20], [0; 7]);
        assert_eq!(counts[20..], [1, 1]);
    }

    #[test]
    fn lost_measurements_leave_the_last_motion() {
        let half = sensed(Settings { drop_rate: 0.5, ..Settings::default() }, 3, 40);
        let lost = half.iter().enumerate().filter(|(tick, seen)| seen.sightings.iter().any(|s| s.tick < *tick)).count();
        assert!((8..32).contains(&lost), "{lost} of 40");
        let none = sensed(Settings { drop_rate: 1.0, ..Settings::default() }, 3, 5);
        assert!(none.iter().all(|seen| seen.scene.others.is_empty()));
    }
}
