//! Disturb: what the weather and the people do, and what was expected of them.

use bevy::ecs::prelude::*;
use interplay_building::control::{DayRecord, Design, Disturbance};
use interplay_building::weather::Forecast;

use super::{Building, Gains, Node, Temperature, Today};

/// A day \[s\].
const DAY_S: f64 = 86_400.0;

/// Draws and forecasts the day at midnight, and lets people and sun warm the zones at every step.
pub fn disturb(
    temperatures: Query<(&Node, &Temperature)>,
    mut zones: Query<(&Node, &mut Gains)>,
    mut building: ResMut<Building>,
) {
    let (day, step) = building.date();
    if step == 0 {
        let mut initial_c = vec![0.0; building.model.network().node_count()];
        for (node, temperature) in &temperatures {
            initial_c[node.index] = temperature.0;
        }
        building.today = today(&building, day, initial_c);
    }
    let count = building.targets.zones;
    for (node, mut gains) in &mut zones {
        gains.0 = building.today.actual.gains_kw[step * count + node.index];
    }
}

fn today(building: &Building, day: usize, initial_c: Vec<f64>) -> Today {
    let Building { model, weather, people, forecast: (forecast, seed), .. } = building;
    let (step_s, steps) = (model.step_s(), building.steps_per_day());
    let (start_s, start_sun_s) = (day as f64 * DAY_S, if *forecast == Forecast::Persistence { -DAY_S } else { 0.0 });
    let sunlit = |mut gains_kw: Vec<f64>, start_s: f64| {
        let sun = weather.sun_steps_w_per_m2(start_s, step_s, steps);
        let solar_kw = sun.iter().flat_map(|sun_w_per_m2| model.network().solar_gains_kw(*sun_w_per_m2));
        gains_kw.iter_mut().zip(solar_kw).for_each(|(gain_kw, solar_kw)| *gain_kw += solar_kw);
        gains_kw
    };
    let size = building.targets.reference_c.len();
    let empty = || Vec::with_capacity(size);
    Today {
        initial_c,
        forecast: Disturbance {
            ambient_c: forecast.ambient_steps_c(weather, *seed, day, step_s, steps),
            gains_kw: sunlit(people.scheduled_kw(step_s, steps), start_s + start_sun_s),
        },
        actual: Disturbance {
            ambient_c: weather.ambient_steps_c(start_s, step_s, steps),
            gains_kw: sunlit(people.actual_kw(day, step_s, steps), start_s),
        },
        record: DayRecord {
            temperatures_c: empty(),
            heat_kw: empty(),
            requested_kw: empty(),
            design: Design::default(),
        },
        design_s: 0.0,
    }
}
