//! Balance: computes heat flows and advances the temperatures by a step.

use bevy_ecs::prelude::*;
use interplay_building::day::{Day, Heat};

use super::{Building, Equipment, Gains, Node, Temperature};
use crate::plants::StepInputs;
use crate::state::components::CurrentFrame;
use crate::state::frame::{BuildingFrame, ZoneFrame};

/// Advances every temperature by a step and records the inputs. Temperatures stay when the controller or the plant has
/// failed.
pub fn balance(
    mut nodes: Query<(&Node, &mut Temperature)>,
    zones: Query<(&Node, &Equipment, &Gains)>,
    mut building: ResMut<Building>,
    mut current_frame: ResMut<CurrentFrame>,
) {
    if building.failure.is_some() {
        return;
    }
    let count = building.targets.zones;
    let mut temperatures_c = vec![0.0; building.model.network().node_count()];
    for (node, temperature) in &nodes {
        temperatures_c[node.index] = temperature.0;
    }
    let (day, step) = building.date();
    let (mut applied_kw, mut requested_kw) = (vec![0.0; count], vec![0.0; count]);
    // The gains of the nodes include those of the sun on walls.
    let mut gains_kw = building.today.gains_kw(&building.model, step).to_vec();
    for (node, equipment, gains) in &zones {
        applied_kw[node.index] = equipment.heat_kw;
        requested_kw[node.index] = equipment.requested_kw;
        gains_kw[node.index] = gains.0;
    }
    let (ambient_c, before_c) = (building.today.actual.ambient_c[step], temperatures_c.clone());
    let heat = Heat { requested_kw, applied_kw };
    let inputs = StepInputs { step: building.step, heat_kw: &heat.applied_kw, gains_kw: &gains_kw, ambient_c };
    if let Err(error) = building.plant.step(&inputs, &mut temperatures_c) {
        building.failure = Some(error.into());
        return;
    }
    building.today.record_step(&temperatures_c[..count], &heat);
    for (node, mut temperature) in &mut nodes {
        temperature.0 = temperatures_c[node.index];
    }
    let (reference_c, weight) = (building.targets.reference_at(step), building.targets.weight_at(step));
    let (band_k, sun) = (building.targets.band_at(step), building.sun(day, step));
    let zone = |index: usize| ZoneFrame {
        temperature_c: before_c[index],
        next_c: temperatures_c[index],
        reference_c: (weight[index] > 0.0).then_some(reference_c[index]),
        band_k: band_k[index],
        requested_kw: heat.requested_kw[index],
        heat_kw: heat.applied_kw[index],
        gains_kw: gains_kw[index],
        sun_kw: sun.nodes_kw[index],
        electric_kw: building.electric_kw(heat.applied_kw[index], ambient_c),
    };
    current_frame.0.building = Some(BuildingFrame {
        day,
        step,
        zones: (0..count).map(zone).collect(),
        ambient_c,
        forecast_c: building.today.forecast.ambient_c[step],
        walls_c: before_c[count..].to_vec(),
        sun_w_per_m2: sun.horizontal_w_per_m2,
        price_per_kwh: building.price_per_kwh(step),
        design: (step == 0).then(|| Box::new(building.today.record.design.clone())),
        figures: None,
    });
}

/// Draws and forecasts the day at midnight, and applies the heat of people and sun to the zones at every step.
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
        let Building { model, surroundings, .. } = &*building;
        let steps = building.steps_per_day();
        let (forecast, actual) = (surroundings.forecast(model, steps, day), surroundings.actual(model, steps, day));
        let outlook = surroundings.outlook(model, steps, day);
        building.today = Day::new(initial_c, forecast, actual).before(outlook);
        building.targets = building.agenda.of_day(day);
        building.design_s = 0.0;
    }
    let gains_kw = building.today.gains_kw(&building.model, step);
    for (node, mut gains) in &mut zones {
        gains.0 = gains_kw[node.index];
    }
}
