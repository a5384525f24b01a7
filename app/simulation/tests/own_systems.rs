//! Systems and state of a caller between the phases of the loop.

use bevy_ecs::prelude::*;
use interplay_scenarios::{Scenario, load};
use interplay_simulation::components::TrafficRow;
use interplay_simulation::phases::{Phase, Slot};
use interplay_simulation::time_points::TimePoint;
use interplay_simulation::{NotCopied, Simulation};

/// Counts the time points, and records the order of the systems.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
struct Counted {
    ticks: usize,
    vehicles: usize,
    order: Vec<Slot>,
}

#[derive(Resource, Default)]
struct Unregistered;

fn count(time_point: Res<TimePoint>, vehicles: Query<&TrafficRow>, mut counted: ResMut<Counted>) {
    counted.ticks += usize::from(time_point.vehicles);
    counted.vehicles += vehicles.iter().count();
}

fn scenario() -> Scenario {
    load("lane-change/front-nice", &[]).expect("authored")
}

fn counting(scenario: &Scenario) -> Simulation {
    let builder = Simulation::builder(scenario).with_state(Counted::default(), Counted::clone);
    builder.with_system(Slot::After(Phase::Physics), count).build().expect("a world")
}

/// The reason why a world with an additional system has no snapshot after a step.
fn refusal<M: 'static>(system: impl IntoSystem<(), (), M> + Clone + Send + Sync + 'static) -> NotCopied {
    let mut world =
        Simulation::builder(&scenario()).with_system(Slot::Before(Phase::Act), system).build().expect("built");
    world.step().expect("the run goes on");
    world.snapshot().err().expect("a system keeps what has no copy")
}

#[test]
fn a_resumed_world_continues_the_state_of_an_added_system_and_the_same_run() {
    let scenario = scenario();
    let mut world = counting(&scenario);
    world.advance_to(1.0).expect("the run goes on");
    assert_eq!(world.time_s(), 1.0);
    let counted = Counted { ticks: 10, vehicles: 10 * scenario.vehicles.len(), order: Vec::new() };
    assert_eq!(world.state(), Some(&counted));
    let snapshot = world.snapshot().expect("all state is registered");
    let mut resumed = snapshot.resume().expect("a copy");
    assert_eq!(resumed.state(), Some(&counted));
    let mut plain = Simulation::new(&scenario).expect("a world");
    for world in [&mut world, &mut resumed, &mut plain] {
        world.advance_to(3.0).expect("the run goes on");
    }
    assert_eq!(world.state::<Counted>().map(|counted| counted.ticks), Some(30));
    assert_eq!(world.state::<Counted>(), resumed.state::<Counted>());
    // A read-only system changes no vehicle.
    assert_eq!(world.states(), resumed.states());
    assert_eq!(world.states(), plain.states());
    world.restore(&snapshot).expect("a snapshot");
    assert_eq!(world.state(), Some(&counted));
}

#[test]
fn systems_run_in_the_order_of_their_slots() {
    let slots = Phase::IN_ORDER.into_iter().flat_map(|phase| [Slot::Before(phase), Slot::After(phase)]);
    let slots: Vec<Slot> = slots.collect();
    let scenario = scenario();
    let mut builder = Simulation::builder(&scenario).with_state(Counted::default(), Counted::clone);
    for slot in slots.iter().rev().copied() {
        builder = builder.with_system(slot, move |mut counted: ResMut<Counted>| counted.order.push(slot));
    }
    let mut world = builder.build().expect("no two systems share a slot");
    world.step().expect("the run goes on");
    assert_eq!(world.state::<Counted>().map(|counted| counted.order.clone()), Some(slots));
}

#[test]
fn systems_of_ambiguous_order_are_an_error_with_their_names() {
    fn also_count(mut counted: ResMut<Counted>) {
        counted.ticks += 1;
    }
    let scenario = scenario();
    let builder = Simulation::builder(&scenario).with_state(Counted::default(), Counted::clone);
    let ambiguous = builder
        .with_system(Slot::After(Phase::Physics), count)
        .with_system(Slot::After(Phase::Physics), also_count)
        .build();
    let text = ambiguous.err().expect("two systems write one resource").to_string();
    assert!(text.contains("count") && text.contains("also_count") && text.contains("Counted"), "{text}");
}

#[test]
fn state_that_no_world_has_is_refused_before_the_first_step() {
    let scenario = scenario();
    let system = |_: Res<Unregistered>| {};
    let built = Simulation::builder(&scenario).with_system(Slot::After(Phase::Physics), system).build();
    let text = built.err().expect("nothing adds the resource").to_string();
    assert!(text.contains("Unregistered`, which"), "{text}");
}

#[test]
fn a_snapshot_refuses_unregistered_state_by_name() {
    let inserted = refusal(|mut commands: Commands| commands.insert_resource(Unregistered));
    assert!(inserted.who.contains("Unregistered"), "{inserted}");
    fn keeps(mut ticks: Local<usize>) {
        *ticks += 1;
    }
    let local = refusal(keeps);
    assert!(local.who.contains("keeps") && local.why.contains("Local"), "{local}");
}

#[test]
fn a_snapshot_with_added_systems_is_not_written_as_text() {
    let snapshot = counting(&scenario()).snapshot().expect("all state is registered");
    let text = snapshot.to_json().expect_err("a file does not have the system").to_string();
    assert!(text.contains("count"), "{text}");
}
