//! Sense: begins the tick; sensors measure the vehicles.

use bevy_ecs::prelude::*;
use interplay_planners::perception::sensing::SensedScene;

use crate::state::components::{Clock, CurrentFrame, CurrentTraffic, Driving, Fleet, HandedIn, TrafficRow};
use crate::state::frame::Frame;

/// Opens the tick's [`Frame`] and prepares [`CurrentTraffic`] for it.
pub fn sense(
    mut vehicles: Query<(&TrafficRow, &mut Driving, &HandedIn)>,
    clock: Res<Clock>,
    mut traffic: ResMut<CurrentTraffic>,
    mut current_frame: ResMut<CurrentFrame>,
) {
    let plans = clock.ticks_since_plan() == 0;
    current_frame.0 = Frame { tick: clock.tick, time_s: clock.time_s(), plans, ..Frame::default() };
    for (row, mut driving, handed_in) in &mut vehicles {
        driving.plan_ms = 0.0;
        traffic.0.road_users[row.0].may_react = driving.may_react(handed_in);
    }
    if plans {
        traffic.0.begin_plan(clock.plans(), clock.time_s());
    } else {
        traffic.0.follow_plans();
    }
}

/// Whether vehicles plan in this tick.
pub fn plans_now(clock: Res<Clock>) -> bool {
    clock.ticks_since_plan() == 0
}

/// Lets every sensor measure the other vehicles. Their plans are added in the phase Plan. The sensor of a driver who knows no plans measures
/// what that driver observes, in the phase Plan.
pub fn look(mut vehicles: Query<(&TrafficRow, &mut Driving)>, mut traffic: ResMut<CurrentTraffic>) {
    if vehicles.iter().any(|(_, driving)| driving.sensor.is_some()) {
        traffic.0.find_neighbours();
    }
    for (row, mut driving) in &mut vehicles {
        if traffic.0.road_users[row.0].observes() {
            continue;
        }
        let Driving { sensor, sight, .. } = &mut *driving;
        *sight = sensor.as_mut().map(|sensor| sensor.look(&traffic.0.moment(row.0)));
    }
}

/// The scenes that the drivers of some vehicles would receive at the next tick, before any of them has planned in it; `None` if a
/// vehicle does not exist. Vehicles are rows of [`CurrentTraffic`].
pub fn observed(world: &World, wanted: &[usize]) -> Option<Vec<SensedScene>> {
    let (clock, fleet) = (world.get_resource::<Clock>()?, world.get_resource::<Fleet>()?);
    let mut traffic = world.get_resource::<CurrentTraffic>()?.0.clone();
    traffic.begin_plan(clock.plans(), clock.time_s());
    traffic.predict();
    let sensed = |row: &usize| {
        let driving = world.get::<Driving>(*fleet.0.get(*row)?)?;
        let scene = traffic.scene(*row);
        let mut sensor = driving.sensor.clone();
        Some(sensor.as_mut().map_or_else(|| SensedScene::perfect(&scene), |sensor| sensor.sense(&scene)))
    };
    wanted.iter().map(sensed).collect()
}
