//! Allocations of a tick of traffic are constant over time and proportional to the number of vehicles at
//! constant density. They are not zero: scenes, plans, and the values that the engine and measures keep of a tick are created anew.

use std::fmt::Write;

use interplay_scenarios::from_text;
use interplay_simulation::Simulation;
use interplay_simulation::measure::Subscriptions;

/// Cars with the intelligent driver model in three lanes, 40 m apart in each, with these measures.
fn motorway(vehicles: usize, subscriptions: Subscriptions) -> Simulation {
    let mut text = String::from(
        "title = 'Motorway'\nshows = 'Three lanes'\nduration_s = 100.0\nroad = { kind = 'lanes', lane_count = 3, lane_width_m = 3.5 }\n\
         defaults = { class = 'car', driver = { kind = 'idm' } }\nbudget = { plans = 1000000, steps = 100000000 }\n",
    );
    for index in 0..vehicles {
        let (lane, along_m) = (index % 3, -40.0 * (index / 3) as f64 - 13.0 * (index % 3) as f64);
        let start = format!("{{ lane = {lane}, along_m = {along_m:?}, speed_mps = 25.0 }}");
        writeln!(text, "[[vehicle]]\nname = 'car-{index}'\nstart = {start}\ngoal = {{ lane = {lane} }}")
            .expect("a text");
    }
    let scenario = from_text("motorway.toml", &text, &[]).expect("a scenario");
    Simulation::builder(&scenario).subscribed_to(subscriptions).build().expect("a world")
}

/// Allocations, and additional bytes held, over `ticks` ticks.
fn over(simulation: &mut Simulation, ticks: usize) -> (u64, i64) {
    let info = allocation_counter::measure(|| {
        for _ in 0..ticks {
            simulation.step().expect("a step");
        }
    });
    (info.count_total, info.bytes_current)
}

#[test]
fn allocations_per_tick_are_constant_in_time_and_proportional_to_vehicles() {
    const TICKS: usize = 100;
    let counted = [120, 240].map(|vehicles| {
        let mut simulation = motorway(vehicles, Subscriptions::everything());
        over(&mut simulation, TICKS);
        let (early, _) = over(&mut simulation, TICKS);
        over(&mut simulation, 2 * TICKS);
        let (late, held_more) = over(&mut simulation, TICKS);
        assert!(late <= early + early / 50, "{early} allocations in the second 10 s, {late} in the fifth");
        // Measures keep numbers of each tick: time gaps, and samples for medians.
        let held_per_tick = held_more / (TICKS * vehicles) as i64;
        assert!(held_per_tick < 100, "{held_per_tick} bytes more a vehicle and tick");
        // Some 18 of them are for what can be seen of each vehicle, and its expected motion.
        let each = late as f64 / (TICKS * vehicles) as f64;
        assert!(each < 175.0, "{each:.1} allocations a vehicle and tick of {vehicles}");
        late
    });
    assert!(counted[1] < counted[0] * 22 / 10, "{counted:?}");
}

/// Subscribed to contacts, progress and the digest of the states, a tick of drivers that react allocates nothing once its memory has grown.
#[test]
fn a_subscribed_tick_of_drivers_that_react_allocates_nothing() {
    let mut simulation = motorway(120, Subscriptions::only(&[], &[0]));
    over(&mut simulation, 300);
    let (count, held_more) = over(&mut simulation, 300);
    assert_eq!((count, held_more), (0, 0), "allocations, and bytes held, in 300 ticks");
}
