//! The embedded lane changes in the loop of the application, with the bicycle as the plant.

use interplay_planners::human::Style;
use interplay_planners::{Driver, Plan, Scene, Trajectory};

use crate::Result;
use crate::world::{LANES, Vehicle, begin, human, vehicle};

const TICKS: usize = 120;

/// What sets the lane changes apart.
#[derive(Clone, Copy)]
pub struct Scenario {
    /// Its name.
    pub name: &'static str,
    front: Style,
    rear: Style,
    /// Where the front one starts \[m\]; the other is 1.3 m behind it.
    front_x_m: f64,
    /// How fast both drive \[m/s\].
    speed_mps: f64,
}

/// The lane changes of `scenarios/files/lane-change/`.
pub const SCENARIOS: [Scenario; 3] = [
    Scenario { name: "front-nice", front: Style::Nice, rear: Style::Nice, front_x_m: -0.35, speed_mps: 1.25 },
    Scenario { name: "front-tough", front: Style::Tough, rear: Style::Nice, front_x_m: -0.35, speed_mps: 1.25 },
    Scenario { name: "both-tough", front: Style::Tough, rear: Style::Tough, front_x_m: -0.4, speed_mps: 1.4 },
];

/// One driver's decision.
pub struct Decision<'a> {
    /// Who decides.
    pub driver: &'a Driver,
    /// What it was shown.
    pub scene: &'a Scene,
    /// What it planned the step before.
    pub last: Option<&'a Trajectory>,
    /// What it answered.
    pub plan: &'a Plan,
}

/// The vehicles of a scenario with `ego` as the ego's driver. A cooperative ego needs somebody to cooperate with: then it
/// drives the front car too.
fn vehicles(scenario: &Scenario, ego: &Driver) -> Vec<Vehicle> {
    let front = if matches!(ego, Driver::Cooperative(_)) { ego.clone() } else { human(scenario.front) };
    let (steady, wants) = ([0.0, 4.0, 1.0, 1.0], [LANES[1], scenario.speed_mps]);
    let driving = |name: &str, x_m: f64, driver: Driver| {
        vehicle(name, [x_m, LANES[1], scenario.speed_mps], wants, steady, driver)
    };
    vec![
        driving("front", scenario.front_x_m, front),
        driving("rear", scenario.front_x_m - 1.3, human(scenario.rear)),
        vehicle("ego", [0.0, LANES[0], 1.0], [LANES[1], 1.0], [0.0, 1.0, 0.5, 1.0], ego.clone()),
    ]
}

/// Drives a scenario with `ego` as the ego's driver and shows every decision to `watch`.
///
/// # Errors
/// A planner's, or the first one of `watch`.
pub fn run(scenario: &Scenario, ego: &Driver, mut watch: impl FnMut(&Decision) -> Result<()>) -> Result<()> {
    let vehicles = vehicles(scenario, ego);
    let (mut traffic, mut planners) = begin(&vehicles);
    let mut last: Vec<Option<Trajectory>> = vec![None; vehicles.len()];
    for _ in 0..TICKS {
        let mut watched = Ok(());
        let decisions = traffic.drive(|index, scene| {
            let plan = planners[index].plan(scene)?;
            let decision = Decision { driver: &vehicles[index].driver, scene, last: last[index].as_ref(), plan: &plan };
            if watched.is_ok() {
                watched = watch(&decision);
            }
            last[index] = Some(plan.trajectory.clone());
            Ok(plan)
        });
        watched?;
        if let Some(error) = decisions.into_iter().find_map(|decision| decision.failure) {
            return Err(error.into());
        }
    }
    Ok(())
}
