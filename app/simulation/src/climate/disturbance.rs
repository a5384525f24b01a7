//! Disturb: applies weather and people, and makes their forecasts.

use bevy_ecs::prelude::*;
use interplay_building::day::Day;

use super::{Building, Gains, Node, Temperature};

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
