//! Control: the controller plans at midnight and decides at every step; equipment gives what it can. A day without a plan
//! of its own is an event.

use std::time::Instant;

use bevy::ecs::prelude::*;
use interplay_building::control::{Control, ControlError, Morning, Observation};

use super::{Building, Equipment, Node, Temperature};
use crate::components::Present;
use crate::frame::{Event, Level};

/// Who speaks in the log.
const SPEAKER: &str = "controller";

/// Asks the controller for the heat of every zone.
pub fn control(
    mut zones: Query<(&Node, &Temperature, &mut Equipment)>,
    mut building: ResMut<Building>,
    mut present: ResMut<Present>,
) {
    let (_, step) = building.date();
    let mut temperatures_c = vec![0.0; building.targets.zones];
    for (node, temperature, _) in &zones {
        temperatures_c[node.index] = temperature.0;
    }
    match decide(&mut building, step, &temperatures_c) {
        Ok(requested_kw) => {
            for (node, _, mut equipment) in &mut zones {
                let Equipment { limit_kw, .. } = *equipment;
                equipment.requested_kw = requested_kw[node.index];
                equipment.heat_kw = equipment.requested_kw.clamp(-limit_kw, limit_kw);
            }
        }
        Err(error) => building.failure = Some(error),
    }
    if let (0, Some(why)) = (step, &building.today.record.design.fallback) {
        let text = format!("no plan for this day, which repeats the one before: {why}");
        present.0.events.push(Event { vehicle: SPEAKER.to_owned(), level: Level::Warning, text });
    }
}

fn decide(building: &mut Building, step: usize, temperatures_c: &[f64]) -> Result<Vec<f64>, ControlError> {
    let Building { regulator, targets, today, .. } = building;
    if step == 0 {
        let began = Instant::now();
        let (initial_c, forecast, actual) = (&today.initial_c, &today.forecast, Some(&today.actual));
        regulator.start_of_day(&Morning { initial_c, targets, forecast, actual })?;
        today.design_s += began.elapsed().as_secs_f64();
        today.record.design = regulator.design();
    }
    Ok(regulator.act(&Observation { step, temperatures_c, targets }))
}
