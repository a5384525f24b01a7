//! Control: the controller plans at midnight and decides at every step; the equipment limits the heat. A day without a
//! plan of its own is logged as an event.

use std::time::Instant;

use bevy_ecs::prelude::*;
use interplay_building::control::{Control, ControlError, DayAhead, DayRecord, Observation};
use interplay_building::day::Heat;

use super::{Building, Equipment, Node, Temperature};
use crate::state::components::CurrentFrame;
use crate::state::frame::{Event, Level};

const CONTROLLER_SOURCE: &str = "controller";

/// Obtains the heat of every zone from the controller.
pub fn control(
    mut zones: Query<(&Node, &Temperature, &mut Equipment)>,
    mut building: ResMut<Building>,
    mut current_frame: ResMut<CurrentFrame>,
) {
    let (_, step) = building.date();
    let mut temperatures_c = vec![0.0; building.targets.zones];
    for (node, temperature, _) in &zones {
        temperatures_c[node.index] = temperature.0;
    }
    let had_trouble = step > 0 && building.today.record.design.fallback.is_some();
    match heat(&mut building, step, &temperatures_c) {
        Ok(heat) => {
            for (node, _, mut equipment) in &mut zones {
                equipment.requested_kw = heat.requested_kw[node.index];
                equipment.heat_kw = heat.applied_kw[node.index];
            }
        }
        Err(error) => building.failure = Some(error.into()),
    }
    let design = &building.today.record.design;
    let no_plan = design.fallback.as_ref().filter(|_| !had_trouble);
    let no_plan = no_plan.map(|why| {
        let what = if why.has_plan() { "unstable feedback" } else { "no plan" };
        format!("{what}: this day {}: {why}", why.consequence())
    });
    let weaker = design.weaker_feedback.as_ref().filter(|_| step == 0).map(ToString::to_string);
    current_frame.0.events.extend(no_plan.into_iter().chain(weaker).map(|text| Event {
        vehicle: CONTROLLER_SOURCE.to_owned(),
        level: Level::Warning,
        text,
    }));
}

/// Plans at midnight and computes the heat of the step. All the controller's time of a day counts as design time.
fn heat(building: &mut Building, step: usize, temperatures_c: &[f64]) -> Result<Heat, ControlError> {
    let Building { model, controller, targets, today, design_s, handed_in_kw, .. } = building;
    if step == 0 {
        let began = Instant::now();
        today.plan(&mut **controller, targets)?;
        *design_s += began.elapsed().as_secs_f64();
    }
    // A controller that plans at every step needs planning time in every step.
    let began = Instant::now();
    let heat = match handed_in_kw.take() {
        Some(heat_kw) => today.control(model, &mut HandedHeat(heat_kw), targets, step, temperatures_c),
        None => today.control(model, &mut **controller, targets, step, temperatures_c),
    };
    *design_s += began.elapsed().as_secs_f64();
    Ok(heat)
}

/// Heat that was decided from outside, instead of by the controller, for one step.
#[derive(Debug)]
struct HandedHeat(Vec<f64>);

impl Control for HandedHeat {
    fn start_of_day(&mut self, _: &DayAhead<'_>) -> Result<(), ControlError> {
        Ok(())
    }

    fn act(&mut self, _: &Observation<'_>) -> Vec<f64> {
        self.0.clone()
    }

    fn end_of_day(&mut self, _: &DayRecord) -> Result<(), ControlError> {
        Ok(())
    }
}

/// Lets the controller learn when the day is over, and advances the clock.
pub fn learn(mut building: ResMut<Building>) {
    let (_, step) = building.date();
    if step + 1 == building.steps_per_day() && building.failure.is_none() {
        let began = Instant::now();
        let Building { controller, today, design_s, failure, .. } = &mut *building;
        *failure = today.learn(&mut **controller).err().map(Into::into);
        *design_s += began.elapsed().as_secs_f64();
    }
    building.step += 1;
}
