//! Weather and people of each day, and their forecasts.

use crate::control::Disturbance;
use crate::discretise::Model;
use crate::network::Network;
use crate::occupancy::{People, RecordedGains};
use crate::weather::{Forecast, TimeSeries, Weather};

/// A day \[s\].
const DAY_S: f64 = 86_400.0;

/// Weather and people on every day of a run, from which disturbances follow.
#[derive(Clone, Debug)]
pub struct Surroundings {
    /// The weather since the first midnight.
    pub weather: Weather,
    /// How the weather of a day is forecast.
    pub forecast: Forecast,
    /// Seed of the forecast's errors.
    pub forecast_seed: u64,
    /// The people.
    pub people: People,
    /// Radiation on the planes of the building's windows over time \[W/m²\], in the order of
    /// [`Network::window_planes`](crate::network::Network::window_planes).
    pub planes_w_per_m2: Vec<TimeSeries>,
    /// Recorded heat of people and machines, for the zones that have it.
    pub recorded: RecordedGains,
}

impl Surroundings {
    /// Weather and people of a building without recorded gains. Windows receive no sun if the weather does not state
    /// the position of the sun.
    pub fn new(
        weather: Weather,
        (forecast, forecast_seed): (Forecast, u64),
        people: People,
        network: &Network,
    ) -> Self {
        let dark = || TimeSeries { first_s: 0.0, interval_s: DAY_S, cyclic: false, values: vec![0.0] };
        let planes = network.window_planes().iter();
        let planes_w_per_m2 = planes.map(|plane| weather.on_plane_w_per_m2(plane).unwrap_or_else(dark)).collect();
        Self { weather, forecast, forecast_seed, people, planes_w_per_m2, recorded: RecordedGains::default() }
    }

    /// The disturbance that is forecast at the midnight before day `day`, counted from zero. The forecast of people is their
    /// schedule. The forecast of the sun has no error, except under [`Forecast::Persistence`], which repeats the day before.
    pub fn forecast(&self, model: &Model, steps: usize, day: usize) -> Disturbance {
        let Self { weather, forecast, forecast_seed, people, .. } = self;
        let step_s = model.step_s();
        let days_back = if *forecast == Forecast::Persistence { 1.0 } else { 0.0 };
        let sun_start_s = (day as f64 - days_back) * DAY_S;
        let (zones, scheduled_kw) = (model.network().zone_count(), people.scheduled_kw(day, step_s, steps));
        Disturbance {
            ambient_c: forecast.ambient_steps_c(weather, *forecast_seed, day, step_s, steps),
            gains_kw: self.with_sun(
                self.recorded.forecast_kw(scheduled_kw, day, zones, step_s),
                model,
                steps,
                sun_start_s,
            ),
        }
    }

    /// The disturbance that is forecast for day `day + 1` at the midnight before day `day`; the error of the outdoor
    /// temperature continues from the first day. `None` if the weather ends before.
    pub fn outlook(&self, model: &Model, steps: usize, day: usize) -> Option<Disturbance> {
        let (step_s, from_s) = (model.step_s(), (day + 1) as f64 * DAY_S);
        let scheduled_kw = self.people.scheduled_kw(day + 1, step_s, steps);
        let people_kw = self.recorded.forecast_kw(scheduled_kw, day + 1, model.network().zone_count(), step_s);
        if !self.weather.covers(from_s + DAY_S) {
            return None;
        }
        if self.forecast == Forecast::Persistence {
            return Some(self.forecast(model, steps, day)).map(|forecast| Disturbance {
                gains_kw: self.with_sun(people_kw, model, steps, from_s - 2.0 * DAY_S),
                ..forecast
            });
        }
        let ambient_c = self.forecast.ambient_steps_c(&self.weather, self.forecast_seed, day, step_s, 2 * steps);
        let gains_kw = self.with_sun(people_kw, model, steps, from_s);
        Some(Disturbance { ambient_c: ambient_c[steps..].to_vec(), gains_kw })
    }

    /// The actual disturbance of day `day`, counted from zero.
    pub fn actual(&self, model: &Model, steps: usize, day: usize) -> Disturbance {
        let (start_s, step_s) = (day as f64 * DAY_S, model.step_s());
        let people_kw = self.people_kw(day, model.network().zone_count(), step_s, steps);
        Disturbance {
            ambient_c: self.weather.ambient_steps_c(start_s, step_s, steps),
            gains_kw: self.with_sun(people_kw, model, steps, start_s),
        }
    }

    /// Real heat of people and machines in `zones` zones in the steps of a day \[kW\], stacked.
    pub fn people_kw(&self, day: usize, zones: usize, step_s: f64, steps: usize) -> Vec<f64> {
        self.recorded.actual_kw(self.people.actual_kw(day, step_s, steps), day, zones, step_s)
    }

    /// Heat that the sun brings into each node in the steps from `start_s` on \[kW\], stacked.
    pub fn sun_kw(&self, network: &Network, start_s: f64, step_s: f64, steps: usize) -> Vec<f64> {
        let middles_s = (0..steps).map(|step| start_s + (step as f64 + 0.5) * step_s);
        let gains_kw = middles_s.flat_map(|time_s| {
            let planes: Vec<f64> = self.planes_w_per_m2.iter().map(|plane| plane.at(time_s)).collect();
            network.sun_gains_kw(self.weather.sun_w_per_m2.at(time_s), &planes)
        });
        gains_kw.collect()
    }

    /// The solar gains of the steps from `start_s` on, and the stacked gains of the zones.
    fn with_sun(&self, zone_gains_kw: Vec<f64>, model: &Model, steps: usize, start_s: f64) -> Vec<f64> {
        let network = model.network();
        let mut gains_kw = self.sun_kw(network, start_s, model.step_s(), steps);
        let rows = gains_kw.chunks_exact_mut(network.gain_count());
        for (row_kw, zones_kw) in rows.zip(zone_gains_kw.chunks_exact(network.zone_count())) {
            row_kw.iter_mut().zip(zones_kw).for_each(|(gain_kw, zone_kw)| *gain_kw += zone_kw);
        }
        gains_kw
    }
}
