//! What human drivers take to plan in dense traffic: a motorway with three lanes, a car every 40 m in each.
//!
//! ```sh
//! cargo run --release -p interplay-planners --example dense_traffic -- [VEHICLES [PLANS [SEED]]]
//! ```
//!
//! Each car drives at about 25 m/s; the drivers are people of all styles, who want 22 to 30 m/s, and every fifth wants another lane. A row
//! says how many others a driver has in its scene, how many ellipses in its problem, the QP subproblems and interior-point iterations of a
//! plan, and its time. The digest is that of all states that were driven, to the last bit: it is the same as long as no plan changes.

#[path = "../tests/common/world.rs"]
mod world;

use std::error::Error;
use std::io::Write;
use std::time::Instant;

use interplay_common::random::SplitMix64;
use interplay_planners::drivers::human::{REACTION_S, Settings, Style};
use interplay_planners::traffic::{RoadUser, Traffic};
use interplay_planners::trajectory::Term;
use interplay_planners::{
    Agent, Body, ComfortLimits, Corridor, Driver, Goal, Limits, Planner, SafetyEllipse, prediction,
};
use world::{Vehicle, vehicle};

const LANES: usize = 3;
const LANE_WIDTH_M: f64 = 3.5;
const SPACING_M: f64 = 40.0;
/// Time from one plan to the next, and of a stage \[s\].
const STEP_S: f64 = 0.2;
const HORIZON: usize = 40;

#[derive(Default)]
struct Work {
    plans: usize,
    others: usize,
    ellipses: usize,
    programmes: usize,
    iterations: usize,
    failures: usize,
    times_ms: Vec<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |index: usize, usual: u64| words.get(index).map_or(Ok(usual), |word| word.parse());
    let (vehicles, plans, seed) = (number(0, 40)?, number(1, 20)?, number(2, 1)?);
    let mut random = SplitMix64::new(seed);
    let cars: Vec<Vehicle> = (0..vehicles).map(|index| car(index as usize, &mut random)).collect();
    let mut planners: Vec<Planner> = cars.iter().map(|car| car.driver.planner()).collect();
    let road_user =
        |car: Vehicle| RoadUser { keeps_rules: true, ..RoadUser::new(car.agent, car.goal, car.driver.goes_first()) };
    let road_users = cars.into_iter().map(road_user).collect();
    let mut traffic = Traffic { step_s: STEP_S, horizon: HORIZON, road_users, ..Traffic::default() };
    let mut work = Work::default();
    for _ in 0..plans {
        traffic.drive(|index, scene| {
            let began = Instant::now();
            let outcome = planners[index].plan(scene);
            work.times_ms.push(1e3 * began.elapsed().as_secs_f64());
            work.plans += 1;
            work.others += scene.others.len();
            work.failures += usize::from(outcome.is_err());
            if let Ok(plan) = &outcome {
                work.programmes += plan.statistics.programmes;
                work.iterations += plan.statistics.inner_iterations;
                let terms = plan.problem.iter().flat_map(|problem| &problem.terms);
                work.ellipses += terms.filter(|term| matches!(term, Term::KeepOut(_))).count();
            }
            outcome
        });
    }
    report(&mut work, digest(&traffic))
}

/// A car of the motorway; one after the other they fill its lanes from the front.
fn car(index: usize, random: &mut SplitMix64) -> Vehicle {
    let (row, lane) = (index / LANES, index % LANES);
    let centre_m = |lane: usize| LANE_WIDTH_M * (lane as f64 + 0.5);
    let start = [
        random.uniform(-6.0, 6.0) - SPACING_M * row as f64,
        centre_m(lane) + random.uniform(-0.1, 0.1),
        random.uniform(24.0, 26.0),
    ];
    let style = Style::ALL[(random.uniform(0.0, 5.0) as usize).min(4)];
    let settings = Settings { style: Some(style), reaction_s: REACTION_S, ..Settings::default() };
    let wanted_lane = if random.uniform(0.0, 1.0) < 0.2 { (lane + 1) % LANES } else { lane };
    let wants = [centre_m(wanted_lane), random.uniform(22.0, 30.0)];
    let name = format!("car-{index}");
    let mut car = vehicle(&name, start, wants, [0.0, 1.0, 31.0, 1.0], Driver::Human(settings));
    let road = Corridor { heading_rad: 0.0, right_m: 0.0, left_m: LANE_WIDTH_M * LANES as f64, end: None };
    let body = Body { front_m: 2.2, rear_m: 2.3, width_m: 1.8, front_axle_m: 1.25, rear_axle_m: 1.45, scale: 10.0 };
    let limits = Limits {
        acceleration_min_mps2: -6.4,
        acceleration_max_mps2: 3.0,
        steering_max_rad: 0.55,
        speed_max_mps: 50.0,
        lateral_acceleration_max_mps2: Some(7.0),
        comfort: Some(ComfortLimits::default()),
        ..Limits::default()
    };
    let prediction = prediction::constant_velocity(&car.agent.state, HORIZON, STEP_S).into();
    car.agent = Agent { body, limits, route: road.into(), prediction, ..car.agent };
    car.goal = Goal { comfort: [0.1, 390.0], safety: SafetyEllipse { along_m: 12.0, across_m: 3.3 }, ..car.goal };
    car
}

/// FNV-1a over the bits of all states.
fn digest(traffic: &Traffic) -> u64 {
    let numbers = traffic.road_users.iter().flat_map(|user| user.agent.state.to_array());
    let bytes = numbers.flat_map(|number| number.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

fn report(work: &mut Work, digest: u64) -> Result<(), Box<dyn Error>> {
    let Work { plans, others, ellipses, programmes, iterations, failures, times_ms } = work;
    times_ms.sort_by(f64::total_cmp);
    let each = |sum: usize| sum as f64 / *plans as f64;
    let at = |share: f64| times_ms.get(((times_ms.len() as f64 - 1.0) * share) as usize).copied().unwrap_or(f64::NAN);
    let mut out = std::io::stdout();
    writeln!(
        out,
        "| plans | not found | others | ellipses | programmes | iterations | mean ms | median ms | p99 ms | digest |"
    )?;
    writeln!(out, "|---|---|---|---|---|---|---|---|---|---|")?;
    writeln!(
        out,
        "| {plans} | {failures} | {:.1} | {:.1} | {:.2} | {:.1} | {:.2} | {:.2} | {:.2} | {digest:016x} |",
        each(*others),
        each(*ellipses),
        each(*programmes),
        each(*iterations),
        times_ms.iter().sum::<f64>() / times_ms.len() as f64,
        at(0.5),
        at(0.99),
    )?;
    Ok(())
}
