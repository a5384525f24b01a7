//! Lane changes, ramp merges, intersections and curved roads in the loop of the application, with the bicycle as the plant.

use interplay_planners::drivers::human::Style::{self, Nice, Tough};
use interplay_planners::{Driver, Plan, Scene, Trajectory};

use crate::Result;
use crate::curved::{self, CurvedRoad};
use crate::world::{Vehicle, begin, intersection, lane_change, ramp_merge};

const TICKS: usize = 80;

#[derive(Clone, Copy)]
enum Place {
    LaneChange([Style; 2]),
    RampMerge([Style; 2]),
    /// The crossing driver, how far it is from the ego's road and where the ego starts \[m\].
    Intersection(Style, f64, f64),
    Curved(CurvedRoad, [Style; 2]),
}

#[derive(Clone, Copy)]
pub struct Scenario {
    pub name: &'static str,
    place: Place,
}

/// What is recorded on straight roads.
pub const SCENARIOS: [Scenario; 9] = [
    Scenario { name: "front-nice", place: Place::LaneChange([Nice, Nice]) },
    Scenario { name: "front-tough", place: Place::LaneChange([Tough, Nice]) },
    Scenario { name: "both-tough", place: Place::LaneChange([Tough, Tough]) },
    Scenario { name: "ramp-nice", place: Place::RampMerge([Nice, Nice]) },
    Scenario { name: "ramp-tough", place: Place::RampMerge([Tough, Nice]) },
    Scenario { name: "crossing-nice", place: Place::Intersection(Nice, 1.965, -2.4) },
    Scenario { name: "crossing-tough", place: Place::Intersection(Tough, 1.965, -2.4) },
    Scenario { name: "crossing-near-nice", place: Place::Intersection(Nice, 1.9, -2.0) },
    Scenario { name: "crossing-near-tough", place: Place::Intersection(Tough, 1.75, -2.0) },
];

/// What is recorded on curved roads.
pub const CURVED_SCENARIOS: [Scenario; 8] = [
    Scenario { name: "bend-nice", place: Place::Curved(CurvedRoad::Bend, [Nice, Nice]) },
    Scenario { name: "bend-tough", place: Place::Curved(CurvedRoad::Bend, [Tough, Nice]) },
    Scenario { name: "lane-drop-nice", place: Place::Curved(CurvedRoad::LaneDrop, [Nice, Nice]) },
    Scenario { name: "lane-drop-tough", place: Place::Curved(CurvedRoad::LaneDrop, [Tough, Nice]) },
    Scenario { name: "left-turn", place: Place::Curved(CurvedRoad::LeftTurn, [Nice, Tough]) },
    Scenario { name: "merge", place: Place::Curved(CurvedRoad::Merge, [Tough, Nice]) },
    Scenario { name: "roundabout-nice", place: Place::Curved(CurvedRoad::Roundabout, [Nice, Nice]) },
    Scenario { name: "roundabout-tough", place: Place::Curved(CurvedRoad::Roundabout, [Tough, Nice]) },
];

pub struct Decision<'a> {
    pub driver: &'a Driver,
    pub scene: &'a Scene,
    /// What it planned the step before.
    pub last: Option<&'a Trajectory>,
    /// What it proposed the step before.
    pub last_proposal: Option<&'a Trajectory>,
    pub plan: &'a Plan,
}

/// The vehicles of a scenario with `ego` as the ego's driver. A cooperative ego needs a partner: then it
/// drives the first of the others too.
fn vehicles(scenario: &Scenario, ego: &Driver) -> Vec<Vehicle> {
    let mut vehicles = match scenario.place {
        Place::LaneChange(styles) => lane_change(ego.clone(), styles),
        Place::RampMerge(styles) => ramp_merge(ego.clone(), styles),
        Place::Curved(road, styles) => curved::vehicles(road, ego, styles),
        Place::Intersection(style, away_m, start_m) => {
            let mut vehicles = intersection(ego.clone(), style, away_m);
            vehicles[0].agent.state.x_m = start_m;
            vehicles
        }
    };
    if matches!(ego, Driver::Cooperative(_)) {
        vehicles[1].drive(ego.clone());
    }
    vehicles
}

/// Drives a scenario with `ego` as the ego's driver and shows every decision to `watch`.
///
/// # Errors
/// A planner's, or the first one of `watch`.
pub fn run(scenario: &Scenario, ego: &Driver, mut watch: impl FnMut(&Decision) -> Result<()>) -> Result<()> {
    let vehicles = vehicles(scenario, ego);
    let (mut traffic, mut planners) = begin(&vehicles);
    let mut last: Vec<Option<Plan>> = vec![None; vehicles.len()];
    for _ in 0..TICKS {
        let mut watched = Ok(());
        let decisions = traffic.drive(|index, scene| {
            let plan = planners[index].plan(scene)?;
            let before = last[index].as_ref();
            let decision = Decision {
                driver: &vehicles[index].driver,
                scene,
                last: before.map(|plan| &plan.trajectory),
                last_proposal: before.and_then(|plan| Some(&plan.proposals.first()?.trajectory)),
                plan: &plan,
            };
            if watched.is_ok() {
                watched = watch(&decision);
            }
            last[index] = Some(plan.clone());
            Ok(plan)
        });
        watched?;
        if let Some(error) = decisions.into_iter().find_map(|decision| decision.failure) {
            return Err(error.into());
        }
    }
    Ok(())
}
