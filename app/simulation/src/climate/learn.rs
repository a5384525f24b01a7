//! Learn: at the end of a day the controller learns from its record.

use std::time::Instant;

use bevy_ecs::prelude::*;

use super::Building;

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
