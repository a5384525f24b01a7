//! Converts a scenario of CommonRoad to one of Interplay, one file per concept.

mod ego;
mod lanes;
mod line;
mod notes;
mod places;
mod rights;
mod vehicles;

use interplay_planners::drivers::recorded;
use interplay_planners::{Driver, DriverKind};
use serde_json::{Value as Json, json};

use super::ImportOptions;
use super::model::CommonRoad;
use super::xml::Unread;
use crate::format::obstacle::ObstacleConfig;
use crate::format::scenario_file::ScenarioFile;
use crate::format::stated::Stated;
use crate::format::vehicle_config::VehicleConfig;
use crate::model::scenario::BudgetLimits;
use crate::model::traffic::goal::GoalConfig;
use crate::resolve::check::consistency::overlap;
use crate::roads::{LaneConfig, LaneNetwork, Road};
use crate::text::error::{Fault, Place, quoted};
use ego::Ego;
pub(super) use ego::begin;
use lanes::Lanes;
use notes::NOT_YET;
pub(super) use notes::Notes;
use places::OnLanes;
use vehicles::{Follower, followers, in_world};

/// The most vehicles of a scenario.
const MAX_VEHICLES: usize = 256;
const MAX_OBSTACLES: usize = 256;
/// The longest run \[s\], and the shortest.
const DURATIONS_S: [f64; 2] = [1.0, 3600.0];
/// The duration of the run of a map without vehicles \[s\].
const MAP_DURATION_S: f64 = 10.0;
/// The time between two plans, rounded to a whole number of steps \[s\].
const PLANNING_PERIOD_S: f64 = 0.2;
const HORIZON_S: f64 = 8.0;
/// The most stages of a plan.
const MAX_STAGES: f64 = 200.0;

/// A scenario as a file states it, and the places of its parts in the imported text.
pub(super) struct Mapped {
    pub file: ScenarioFile,
    /// Paths of keys, each with its place.
    pub places: Vec<(String, Place)>,
}

/// Converts an imported scenario.
///
/// # Errors
/// For lanelets that cannot become lanes.
pub(super) fn mapped(
    scenario: &CommonRoad<'_>,
    root: &Place,
    unread: Unread,
    options: &ImportOptions,
    notes: &mut Notes,
) -> Result<Mapped, Fault> {
    let lanes = Lanes::of(scenario, root, notes)?;
    let begin = begin(scenario);
    let followers = followers(scenario, begin, notes);
    let ego = scenario.problems.first().and_then(|problem| ego::of_problem(problem, scenario.step_s, &lanes, notes));
    let has_no_driver = ego.is_none() && followers.iter().all(|follower| follower.stands);
    let ego = if has_no_driver { ego::on_longest_lane(&lanes, notes) } else { ego };
    let further = scenario.problems.len().saturating_sub(1);
    notes.several(further, ["further planning problem", "further planning problems"], NOT_YET);
    let lights = lanes::lights(scenario, &lanes, begin, notes);
    for (element, count) in unread.into_counts() {
        notes.several(count, [&format!("element `{element}`"), &format!("elements `{element}`")], NOT_YET);
    }
    let duration_s = duration_s(scenario, begin);
    let mut vehicles: Vec<(VehicleConfig, Option<Place>)> = Vec::new();
    let mut obstacles: Vec<(ObstacleConfig, Place)> = Vec::new();
    for follower in near_the_ego(followers, ego.as_ref(), notes) {
        if follower.stands && obstacles.len() < MAX_OBSTACLES {
            obstacles.push((follower.obstacle(), follower.place));
            continue;
        }
        let mut config = driven(&follower, &lanes, options, notes);
        // A vehicle whose record ends before the run leaves at that time; a vehicle with a driver of Interplay drives
        // to the end of its route.
        config.leaves_at_end = (!config.route.is_empty()).then_some(true);
        config.leaves_s = follower.leaves_s(duration_s).filter(|_| config.route.is_empty());
        // Without an ego, another driver may take the place of the first record: it needs a route.
        if ego.is_none() && vehicles.is_empty() && follower.is_car && config.route.is_empty() {
            config.route = on_its_way(&follower, &lanes).map(|place| place.lanes).unwrap_or_default();
        }
        vehicles.push((config, Some(follower.place)));
    }
    let problem = scenario.problems.first().map(|problem| problem.element.place());
    if let Some(Ego { mut config, .. }) = ego {
        config.driver = options.ego.as_deref().map(Stated::kind);
        vehicles.insert(0, (config, problem));
    }
    if vehicles.is_empty() {
        return Err(Fault::at(root, "without vehicles", "no vehicle can be placed on the lanes of the scenario"));
    }
    let mut places = vec![("road".to_owned(), root.clone())];
    places.extend(lanes.places.iter().enumerate().map(|(index, place)| (format!("road.lane.{index}"), place.clone())));
    let of_vehicles = vehicles.iter().enumerate();
    places.extend(of_vehicles.filter_map(|(index, (_, place))| Some((format!("vehicle.{index}"), place.clone()?))));
    let of_obstacles = obstacles.iter().enumerate();
    places.extend(of_obstacles.map(|(index, (_, place))| (format!("obstacle.{index}"), place.clone())));
    let obstacles: Vec<ObstacleConfig> = obstacles.into_iter().map(|(config, _)| config).collect();
    let network = without_defaults(Road::Network(LaneNetwork { lanes: lanes.configs }).into());
    let vehicles: Vec<VehicleConfig> = vehicles.into_iter().map(|(config, _)| config).collect();
    let budget = budget(vehicles.len() + obstacles.len(), duration_s / scenario.step_s);
    let file = ScenarioFile { road: Some(network), lights, obstacles, vehicles, budget, ..timed(scenario, duration_s) };
    Ok(Mapped { file, places })
}

/// A network whose lanes state only values that differ from the defaults, so that the file stays readable.
fn without_defaults(mut network: Stated<Road>) -> Stated<Road> {
    let Some(Json::Array(mut lanes)) = network.take("lane") else { return network };
    let usual = serde_json::to_value(LaneConfig::through("", &[], 1.0)).unwrap_or_default();
    for lane in lanes.iter_mut().filter_map(Json::as_object_mut) {
        for key in ["tolerance_m", "right_of_way", "users", "zebra"] {
            if lane.get(key) == usual.get(key) {
                lane.remove(key);
            }
        }
    }
    network.with("lane", Json::Array(lanes))
}

/// The limits that a long run with many vehicles needs; `None` if the default ones suffice.
fn budget(vehicles: usize, ticks: f64) -> Option<Stated<BudgetLimits>> {
    let plans = (vehicles as f64 * ticks.ceil()) as u64;
    let steps = plans * (vehicles as u64 + 1);
    let usual = BudgetLimits::default();
    let is_more = plans > usual.plans || steps > usual.steps;
    is_more.then(|| Stated::default().with("plans", plans.max(usual.plans)).with("steps", steps.max(usual.steps)))
}

/// A scenario with the times of the imported one only.
fn timed(scenario: &CommonRoad<'_>, duration_s: f64) -> ScenarioFile {
    let name: String = scenario.benchmark.chars().filter(|c| !c.is_control()).take(80).collect();
    let name = if name.trim().is_empty() { "A scenario of CommonRoad".to_owned() } else { name };
    let step_s = scenario.step_s;
    let ticks_per_plan = (PLANNING_PERIOD_S / step_s).round().max(1.0);
    let period_s = vehicles::rounded(ticks_per_plan * step_s, 9);
    ScenarioFile {
        duration_s: Some(duration_s),
        step_s: Some(step_s),
        planning_period_s: (ticks_per_plan > 1.0).then_some(period_s),
        horizon_steps: Some((HORIZON_S / period_s).ceil().clamp(2.0, MAX_STAGES) as usize),
        ..ScenarioFile::new(&name, "Lanes, vehicles and the planning problem of a scenario of CommonRoad")
    }
}

/// The duration of the run: until the latest time of the goal, or else to the end of the records \[s\].
fn duration_s(scenario: &CommonRoad<'_>, begin: f64) -> f64 {
    let known_s = (ego::end(scenario) - begin) * scenario.step_s;
    let is_map = scenario.problems.is_empty() && scenario.obstacles.is_empty();
    let wanted_s = if is_map { MAP_DURATION_S } else { known_s };
    let most_s = DURATIONS_S[1].min(90_000.0 * scenario.step_s);
    vehicles::rounded(wanted_s.max(DURATIONS_S[0]).max(scenario.step_s).min(most_s), 6)
}

/// The vehicles that fit into a scenario, those nearest to the ego first, without any that overlap the ego.
fn near_the_ego(followers: Vec<Follower>, ego: Option<&Ego>, notes: &mut Notes) -> Vec<Follower> {
    let before = followers.len();
    let meets = |follower: &Follower| {
        follower.config.enters_s.is_none()
            && ego.is_some_and(|ego| overlap(&ego.body, &ego.state, &follower.body, &follower.start))
    };
    let mut kept: Vec<Follower> = followers.into_iter().filter(|follower| !meets(follower)).collect();
    notes.several(
        before - kept.len(),
        ["vehicle that overlaps the ego", "vehicles that overlap the ego"],
        "left out: the ego takes their place",
    );
    let room = MAX_VEHICLES - usize::from(ego.is_some());
    if kept.len() > room {
        let beyond = kept.len() - room;
        notes.several(
            beyond,
            ["vehicle farthest from the ego", "vehicles farthest from the ego"],
            "left out, beyond 256",
        );
        if let Some(Ego { state, .. }) = ego {
            let away_m =
                |follower: &Follower| libm::hypot(follower.start.x_m - state.x_m, follower.start.y_m - state.y_m);
            kept.sort_by(|a, b| away_m(a).total_cmp(&away_m(b)));
        }
        kept.truncate(room);
    }
    kept
}

/// A vehicle with its driver: its record, or the driver in the options, which needs a route along lanes.
fn driven(follower: &Follower, lanes: &Lanes, options: &ImportOptions, notes: &mut Notes) -> VehicleConfig {
    let config = follower.config.clone();
    let recorded = |config| {
        let driver = Stated::kind(recorded_kind()).with("points", json!(follower.rows));
        VehicleConfig { driver: Some(driver), ..config }
    };
    let replacement = options.replacement(&follower.id, &config.name);
    let Some(driver) = replacement.filter(|_| follower.is_car) else { return recorded(config) };
    match on_its_way(follower, lanes) {
        Some(place) => {
            let first = place.lanes.first().and_then(|lane| lanes.network.lane(lane));
            let limit_mps = first.and_then(|lane| lane.speed_limit_mps);
            let goal = GoalConfig { speed_mps: Some(follower.wanted_mps(limit_mps)), ..GoalConfig::default() };
            VehicleConfig { start: in_world(&place.state), route: place.lanes, goal, driver: Some(driver), ..config }
        }
        None => {
            notes.one(
                ["vehicle beside the lanes", "vehicles beside the lanes"],
                "not replaced, since no lane leads along their records",
            );
            recorded(config)
        }
    }
}

/// A vehicle at the start of its record, with the lanes that the record follows; `None` beside the lanes.
fn on_its_way(follower: &Follower, lanes: &Lanes) -> Option<OnLanes> {
    let network = &lanes.network;
    places::lanes_at(network, &follower.start).into_iter().find_map(|lane| {
        let way = places::along_record(network, &follower.rows, lane);
        places::on(network, way, &follower.start, &follower.body)
    })
}

/// The word for drivers that follow a record.
fn recorded_kind() -> &'static str {
    recorded::Settings::default().kind()
}

impl ImportOptions {
    /// The driver in the options that replaces a record, if any.
    fn replacement(&self, id: &str, name: &str) -> Option<Stated<Driver>> {
        let is_it = |vehicle: &str| vehicle == id || vehicle == name;
        let named = self.replace.iter().find(|it| it.vehicle.as_deref().is_some_and(is_it));
        // An option for one vehicle takes precedence over the option for all.
        let found = named.or_else(|| self.replace.iter().find(|it| it.vehicle.is_none()))?;
        let driver = Stated::kind(&found.kind);
        Some(match &found.style {
            Some(style) => driver.with("style", style.as_str()),
            None => driver,
        })
    }

    /// Refuses names of vehicles that the scenario does not have.
    ///
    /// # Errors
    /// For the first of them.
    pub(super) fn check_names(&self, scenario: &CommonRoad<'_>) -> Result<(), Fault> {
        let is_known =
            |name: &str| scenario.obstacles.iter().any(|it| it.id == name || name.ends_with(&format!("-{}", it.id)));
        let unknown = self.replace.iter().filter_map(|it| it.vehicle.as_deref()).find(|name| !is_known(name));
        unknown.map_or(Ok(()), |name| Err(Fault::new(format!("the scenario has no obstacle {}", quoted(name)))))
    }
}
