//! Tyres and actuators agree with closed forms.

use bevy_ecs::prelude::World;
use bevy_ecs::system::RunSystemOnce;
use interplay_planners::{Input, State};
use interplay_scenarios::{Dynamic, Plant, Scenario, from_text};

use super::step;
use super::tyres::GRAVITY_MPS2;
use crate::measure::Subscriptions;
use crate::simulation::world_state::WorldState;
use crate::state::components::{CurrentFrame, CurrentTraffic};
use crate::state::frame::Collision;

const STEP_S: f64 = 0.1;

/// Actuators without lag and rate limits.
fn prompt() -> Dynamic {
    Dynamic {
        acceleration_lag_s: 0.0,
        jerk_max_mps3: 1e6,
        steering_lag_s: 0.0,
        steering_rate_max_radps: 1e6,
        ..Dynamic::default()
    }
}

/// Cars of Table 6.1 with limits that are never reached.
fn scenario(plant: Dynamic, starts: &[State]) -> Scenario {
    let mut text = "title = \"Cars\"\nshows = \"How they move\"\n".to_owned();
    for index in 0..starts.len() {
        text +=
            &format!("[[vehicle]]\nname = \"car-{index}\"\nstart = {{ x_m = {index}, y_m = 0.2, speed_mps = 0 }}\n");
    }
    let mut scenario = from_text("cars.toml", &text, &[]).expect("a sound scenario");
    for (vehicle, start) in scenario.vehicles.iter_mut().zip(starts) {
        vehicle.start = *start;
    }
    scenario.plant = Plant::Dynamic(plant);
    scenario
}

fn states(world: &World) -> Vec<State> {
    world.resource::<CurrentTraffic>().0.road_users.iter().map(|user| user.agent.state).collect()
}

/// The states after every tick in which each vehicle applies its own constant input, and the collisions.
fn drive(plant: Dynamic, starts: &[State], inputs: &[Input], ticks: usize) -> (Vec<Vec<State>>, Vec<Collision>) {
    let mut world = WorldState::initial(&scenario(plant, starts), &Subscriptions::everything())
        .expect("no building")
        .into_world(Vec::new());
    for (user, input) in world.resource_mut::<CurrentTraffic>().0.road_users.iter_mut().zip(inputs) {
        user.agent.previous_input = *input;
    }
    let mut all = Vec::new();
    for _ in 0..ticks {
        world.run_system_once(step).expect("physics runs");
        all.push(states(&world));
    }
    (all, world.resource::<CurrentFrame>().0.collisions.clone())
}

fn alone(plant: Dynamic, start: State, input: Input, ticks: usize) -> Vec<State> {
    drive(plant, &[start], &[input], ticks).0.into_iter().flatten().collect()
}

fn at(x_m: f64, y_m: f64, heading_rad: f64, speed_mps: f64) -> State {
    State { x_m, y_m, heading_rad, speed_mps }
}

fn input(acceleration_mps2: f64, steering_rad: f64) -> Input {
    Input { acceleration_mps2, steering_rad }
}

/// Radius of the circle on which the mass centre drives, from the last two states \[m\].
fn radius_m(states: &[State]) -> f64 {
    let [.., a, b] = states else { panic!("two states") };
    let (chord, turned) = ((b.x_m - a.x_m).hypot(b.y_m - a.y_m), b.heading_rad - a.heading_rad);
    0.5 * chord / (0.5 * turned).sin()
}

/// With the lag `τ` the speed after a step of the acceleration is `a (t − τ (1 − e^(−t/τ)))`.
#[test]
fn the_speed_is_the_integral_of_the_lagged_acceleration() {
    let (plant, heading) = (Dynamic { acceleration_lag_s: 0.2, jerk_max_mps3: 1e6, ..prompt() }, 0.7);
    let states = alone(plant, at(0.0, 0.0, heading, 0.5), input(0.8, 0.0), 15);
    for (tick, state) in states.iter().enumerate() {
        let t = STEP_S * (tick + 1) as f64;
        let expected = 0.5 + 0.8 * (t - 0.2 * (1.0 - (-t / 0.2).exp()));
        assert!((state.speed_mps - expected).abs() < 1e-3, "{} {expected}", state.speed_mps);
        assert!((state.heading_rad - heading).abs() < 1e-4);
    }
}

/// At low speed tyres hardly slip: the circle is that of the bicycle model, `R = √(L_r² + (L/tan δ)²)`, within a percent.
#[test]
fn a_slow_circle_agrees_with_the_bicycle_model() {
    for steering_rad in [-0.6, -0.2, 0.1, 0.4_f64] {
        let states = alone(prompt(), at(0.0, 0.0, 0.0, 0.3), input(0.0, steering_rad), 8);
        let bicycle_m = steering_rad.signum() * 0.19_f64.hypot(0.4 / steering_rad.tan());
        let found_m = radius_m(&states);
        assert!((found_m / bicycle_m - 1.0).abs() < 0.01, "{steering_rad}: {found_m} {bicycle_m}");
    }
}

/// At higher speed the front slips more than the rear: `δ = L/R + (a_y/g)(1/c_f − 1/c_r)` for small angles.
#[test]
fn a_fast_circle_is_wider_by_the_understeer_gradient() {
    let plant = Dynamic { front_stiffness_per_rad: 6.0, ..prompt() };
    let states = alone(plant, at(0.0, 0.0, 0.0, 3.0), input(0.0, 0.06), 20);
    let (radius, speed) = (radius_m(&states), states[19].speed_mps);
    let lateral = speed * speed / radius;
    let steering = 0.4 / radius + lateral / GRAVITY_MPS2 * (1.0 / 6.0 - 1.0 / 12.0);
    assert!((steering / 0.06 - 1.0).abs() < 0.02, "{steering}");
    assert!(radius > 1.05 * 0.4 / 0.06, "{radius}");
}

/// At any steering angle the lateral acceleration is at most `μ g`, and at the limit nearly that.
#[test]
fn friction_limits_the_lateral_acceleration() {
    for friction in [0.3, 0.9] {
        let plant = Dynamic { friction, ..prompt() };
        let states = alone(plant, at(0.0, 0.0, 0.0, 4.0), input(0.0, 0.5), 12);
        let sharpest = states.windows(2).map(|pair| {
            let course = |from: State, to: State| (to.y_m - from.y_m).atan2(to.x_m - from.x_m);
            (course(pair[0], pair[1]), pair[1].speed_mps)
        });
        let courses: Vec<(f64, f64)> = sharpest.collect();
        let lateral = courses.windows(2).map(|pair| (pair[1].0 - pair[0].0) / STEP_S * pair[1].1);
        let most = lateral.map(f64::abs).fold(0.0, f64::max) / (friction * GRAVITY_MPS2);
        assert!((0.8..1.03).contains(&most), "{friction}: {most}");
    }
}

/// With brakes stronger than the tyres the stopping distance is `v²/(2 μ g)`; then the car stands, exactly.
#[test]
fn friction_determines_the_shortest_stopping_distance() {
    for (friction, speed) in [(0.3, 2.0), (0.9, 5.0)] {
        let plant = Dynamic { friction, ..prompt() };
        let states = alone(plant, at(0.0, 0.0, 0.0, speed), input(-20.0, 0.0), 20);
        let expected = speed * speed / (2.0 * friction * GRAVITY_MPS2);
        let last = states[states.len() - 1];
        assert!((last.x_m / expected - 1.0).abs() < 0.01, "{} {expected}", last.x_m);
        assert!(last.speed_mps.abs() < 1e-6 && last.x_m == states[states.len() - 2].x_m, "{last:?}");
    }
}

/// With turned wheels and the brake on, a standing car does not move; from standstill a turn begins without a jump.
#[test]
fn standstill_is_not_a_singularity() {
    let states = alone(prompt(), at(0.0, 0.0, 0.3, 0.0), input(-1.0, 0.9), 10);
    assert!(states.iter().all(|state| state.x_m.abs() < 1e-9 && state.speed_mps.abs() < 1e-9), "{states:?}");
    let states = alone(prompt(), at(0.0, 0.0, 0.0, 0.0), input(0.5, 0.9), 10);
    let bicycle_m = 0.19_f64.hypot(0.4 / 0.9_f64.tan());
    assert!((radius_m(&states) / bicycle_m - 1.0).abs() < 0.02, "{}", radius_m(&states));
    assert!((states[9].speed_mps - 0.5).abs() < 0.06, "{:?}", states[9]);
}

/// Straight ahead and without braking, tyres transmit nothing: one car gains the momentum that the other loses, and the impulse
/// between them is `m_1 m_2/(m_1 + m_2) (1 + e) Δv`.
#[test]
fn a_crash_from_behind_conserves_momentum() {
    let plant = Dynamic { restitution: 0.2, ..prompt() };
    let starts = [at(0.0, 0.0, 0.0, 2.0), at(0.5, 0.0, 0.0, 0.5)];
    let (states, collisions) = drive(plant, &starts, &[Input::default(); 2], 6);
    let speeds: Vec<f64> = states[5].iter().map(|state| state.speed_mps).collect();
    let mass = 185.0 * 0.4 * 0.19;
    let [collision] = collisions.as_slice() else { panic!("{collisions:?}") };
    assert!((speeds[0] + speeds[1] - 2.5).abs() < 1e-4, "{speeds:?}");
    // Rapier adds a velocity that separates overlapping bodies.
    assert!((speeds[1] - speeds[0] - 0.2 * 1.5).abs() < 0.03 * 1.5, "{speeds:?}");
    assert!((collision.impulse_ns - mass * (speeds[1] - 0.5)).abs() < 0.02 * collision.impulse_ns, "{collision:?}");
    assert!((collision.time_s - 0.1 / 1.5).abs() < 2e-3, "{collision:?}");
}

/// In a crash from the side the struck car is pushed aside and rotated; on ice, where tyres transmit little, total linear and angular
/// momentum are conserved.
#[test]
fn on_ice_a_crash_conserves_momentum_and_angular_momentum() {
    let plant = Dynamic { friction: 1e-6, ..prompt() };
    let quarter = std::f64::consts::FRAC_PI_2;
    let starts = [at(-0.7, 0.1, 0.0, 2.0), at(0.0, 0.0, quarter, 0.0)];
    let mut world = WorldState::initial(&scenario(plant, &starts), &Subscriptions::everything())
        .expect("no building")
        .into_world(Vec::new());
    world.run_system_once(step).expect("physics runs");
    let before = super::momentum(&world);
    assert!(world.resource::<CurrentFrame>().0.collisions.is_empty() && before[0] > 1.0, "{before:?}");
    for _ in 0..4 {
        world.run_system_once(step).expect("physics runs");
    }
    let after = super::momentum(&world);
    let collisions = &world.resource::<CurrentFrame>().0.collisions;
    assert_eq!(collisions.len(), 1, "{collisions:?}");
    for (was, is) in before.into_iter().zip(after) {
        assert!((was - is).abs() < 1e-3 * before[0].abs(), "{before:?} {after:?}");
    }
    let hit = states(&world)[1];
    assert!(hit.x_m > 0.05 && (hit.heading_rad - quarter).abs() > 0.05, "{hit:?}");
}
