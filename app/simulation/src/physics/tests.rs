//! Contacts agree with closed forms: every contact is found, at its time and at any speed, and there is none without touching.

use bevy_ecs::prelude::World;
use bevy_ecs::system::RunSystemOnce;
use interplay_planners::{Body, State};
use interplay_scenarios::from_text;

use super::gap::MIN_STEP_TICKS;
use super::step;
use crate::measure::Subscriptions;
use crate::simulation::world_state::WorldState;
use crate::state::components::{CurrentFrame, CurrentTraffic};
use crate::state::frame::Collision;

const TWO_CARS: &str = r#"
    title = "Two cars"
    shows = "How they meet"
    [[vehicle]]
    name = "a"
    start = { x_m = 0.0, y_m = 0.185, speed_mps = 1.0 }
    [[vehicle]]
    name = "b"
    start = { x_m = 1.0, y_m = 0.185, speed_mps = 1.0 }
"#;
const STEP_S: f64 = 0.1;

fn states(world: &World) -> Vec<State> {
    world.resource::<CurrentTraffic>().0.road_users.iter().map(|user| user.agent.state).collect()
}

/// Lets two cars of Table 6.1 roll without input; returns the collisions and the smallest gap.
fn roll(starts: [State; 2], ticks: usize) -> (Vec<Collision>, f64) {
    let mut scenario = from_text("two.toml", TWO_CARS, &[]).expect("a sound scenario");
    for (vehicle, start) in scenario.vehicles.iter_mut().zip(starts) {
        vehicle.start = start;
    }
    let mut world =
        WorldState::initial(&scenario, &Subscriptions::everything()).expect("no building").into_world(Vec::new());
    let mut smallest_m = f64::INFINITY;
    for _ in 0..ticks {
        world.run_system_once(step).expect("physics runs");
        smallest_m = smallest_m.min(world.resource::<CurrentFrame>().0.smallest_gap_m.expect("there are two"));
    }
    let ends = states(&world);
    for (start, end) in starts.iter().zip(&ends) {
        let far = start.speed_mps * STEP_S * ticks as f64;
        assert!(((end.x_m - start.x_m).hypot(end.y_m - start.y_m) - far.abs()).abs() < 1e-9, "{start:?} {end:?}");
    }
    (world.resource::<CurrentFrame>().0.collisions.clone(), smallest_m)
}

fn at(x_m: f64, y_m: f64, heading_rad: f64, speed_mps: f64) -> State {
    State { x_m, y_m, heading_rad, speed_mps }
}

fn length_m() -> f64 {
    let body = Body::default();
    body.front_m + body.rear_m
}

/// From behind: the gap closes after `gap / speed`, early or late in the last simulated tick, and anywhere in
/// the world.
#[test]
fn a_collision_from_behind_is_timed_to_a_thousandth_of_a_tick() {
    for (gap_m, speed_mps) in [(0.02, 1.0), (0.0998, 1.0), (0.25, 1.0), (0.39, 2.0), (1.999, 20.0), (2.0, 300.0)] {
        for far_m in [0.0, 10_000.0] {
            let touch_s = gap_m / speed_mps;
            let ticks = (touch_s / STEP_S).ceil() as usize;
            let starts = [at(far_m, 0.185, 0.0, speed_mps), at(far_m + length_m() + gap_m, 0.185, 0.0, 0.0)];
            let (collisions, smallest_m) = roll(starts, ticks);
            let [collision] = collisions.as_slice() else { panic!("{gap_m} m at {speed_mps} m/s: {collisions:?}") };
            let late_s = collision.time_s - touch_s;
            assert!((-2e-5..=MIN_STEP_TICKS * STEP_S + 2e-5).contains(&late_s), "{late_s} s late at {speed_mps} m/s");
            assert_eq!((collision.between.clone(), smallest_m), (["a".to_owned(), "b".to_owned()], 0.0));
            let reduced = 0.5 * 185.0 * length_m() * Body::default().width_m;
            assert!((collision.impulse_ns / (reduced * speed_mps) - 1.0).abs() < 1e-6, "{}", collision.impulse_ns);
        }
    }
}

/// Two cars that touch and move through each other collide once.
#[test]
fn a_contact_is_reported_once_until_it_ends() {
    let starts = [at(0.0, 0.185, 0.0, 1.0), at(1.0, 0.185, 0.0, 0.0)];
    assert_eq!(roll(starts, 30).0.len(), 1);
}

/// From the side: `b` comes from below and its front corner meets the rear corner of `a`, which has nearly passed. They overlap
/// for a millisecond, or miss each other by a centimetre in each direction.
#[test]
fn corners_that_touch_for_an_instant_collide_and_corners_that_miss_do_not() {
    let (body, speed_mps) = (Body::default(), 20.0);
    let (half_m, way_m, quarter_rad) = (0.5 * body.width_m, 0.5 * speed_mps, std::f64::consts::FRAC_PI_2);
    // After half a second the rear of `a` is at x = −rear. It clears `b` at x = rear + width; `b` starts that far below.
    let to_clear_m = 2.0 * body.rear_m + body.width_m;
    let starts = |late_m: f64| {
        let below_m = way_m + body.front_m + half_m + to_clear_m + late_m;
        [at(-way_m, 0.0, 0.0, speed_mps), at(body.rear_m + half_m, -below_m, quarter_rad, speed_mps)]
    };
    let (collisions, smallest_m) = roll(starts(-0.02), 10);
    assert_eq!((collisions.len(), smallest_m), (1, 0.0), "{collisions:?}");
    assert!((collisions[0].time_s - (0.5 + (to_clear_m - 0.02) / speed_mps)).abs() < 2.0 * MIN_STEP_TICKS * STEP_S);
    let (collisions, smallest_m) = roll(starts(0.01), 10);
    assert!(collisions.is_empty(), "{collisions:?}");
    let nearest_m = 0.01 * 0.5_f64.sqrt();
    assert!((nearest_m - 1e-5..1.15 * nearest_m).contains(&smallest_m), "{smallest_m}");
}

/// A millimetre is enough room.
#[test]
fn a_gap_of_a_millimetre_is_not_a_collision() {
    let beside_m = Body::default().width_m + 0.001;
    let (collisions, smallest_m) = roll([at(0.0, 0.0, 0.0, 1.0), at(0.2, beside_m, 0.0, 1.5)], 20);
    assert!(collisions.is_empty(), "{collisions:?}");
    assert!((smallest_m - 0.001).abs() < 1e-5, "{smallest_m}");
}

/// The impulse of a scrape along the side depends on the lateral approach.
#[test]
fn the_impulse_depends_on_the_approach_along_the_normal() {
    let (slant_rad, speed_mps, body) = (0.05, 2.0, Body::default());
    let starts = [at(0.0, 0.0, 0.0, speed_mps), at(0.0, body.width_m + 0.05, -slant_rad, speed_mps)];
    let (collisions, _) = roll(starts, 10);
    let [collision] = collisions.as_slice() else { panic!("{collisions:?}") };
    let expected = 0.5 * 185.0 * length_m() * body.width_m * speed_mps * slant_rad.sin();
    assert!((collision.impulse_ns / expected - 1.0).abs() < 1e-4, "{} {expected}", collision.impulse_ns);
}
