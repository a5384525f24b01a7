//! The check of a building: keys that exclude one another, and numbers that no building can have.
//!
//! The building crate checks the rest itself.

use interplay_building::day::MAX_REGRET_INPUTS;
use interplay_building::discretise::{Model, ModelError};
use interplay_building::network::{Network, NetworkError, Part};

use super::zones;
use crate::format::json_schema::{Concern, SchemaNode};
use crate::format::read::tree::TomlNode;
use crate::model::building::boptest_plant::BoptestPlantConfig;
use crate::model::building::config::{BuildingConfig, DAY_S};
use crate::model::building::plant::BuildingPlant;
use crate::model::scenario::Scenario;
use crate::text::error::{Fault, quoted};

/// The most steps that a building may take.
const MAX_STEPS: usize = 100_000;
const MAX_ZONES: usize = 1000;
/// All faults of the building.
pub(crate) fn check(scenario: &Scenario, tree: &TomlNode, schema: SchemaNode) -> Vec<Fault> {
    let mut faults = Vec::new();
    if scenario.vehicles.is_empty() {
        faults.extend(stated(Concern::Vehicles, tree, schema).map(|key| {
            let message = format!("{} is stated, but there are no vehicles", quoted(&key));
            let help = "a building takes its step from `building.step_s` and its days from `iterations`";
            Fault::at(tree.place_of(&key), "for vehicles only", message).help(help)
        }));
    }
    let Some(building) = &scenario.building else {
        if scenario.vehicles.is_empty() {
            let message = "there is nothing to simulate: neither a `[[vehicle]]` nor a `[building]`";
            let help = "state vehicles, a building, or both; or start with `extends = \"lane-change/front-nice\"`";
            faults.push(Fault::at(&tree.place, "in this file", message).help(help));
        }
        faults.extend(stated(Concern::Building, tree, schema).map(|key| {
            let message = format!("{} is stated, but there is no building", quoted(&key));
            Fault::at(tree.place_of(&key), "for a building only", message).help("add a `[building]`")
        }));
        return faults;
    };
    let mut checker = Checker { scenario, tree, faults };
    checker.times(building);
    checker.plant(building);
    if checker.sources(building) {
        match building.network() {
            Ok(network) => checker.controlled(building, &network),
            Err(error) => checker.network(&error),
        }
    }
    checker.faults
}

/// The keys of the file and of its expectations that have this concern and differ from the default.
fn stated(concern: Concern, tree: &TomlNode, root: SchemaNode) -> impl Iterator<Item = String> {
    let of_file = root.properties().map(|(key, property)| (key.clone(), property));
    let expectations = root.property("expect").into_iter().flat_map(SchemaNode::properties);
    let all = of_file.chain(expectations.map(|(key, property)| (format!("expect.{key}"), property)));
    all.filter(move |(key, property)| {
        let stated = tree.at(key).filter(|node| !node.is_empty_list());
        property.concerns() == Some(concern) && stated.is_some_and(|node| !property.is_default(&node.to_json()))
    })
    .map(|(key, _)| key)
}

struct Checker<'a> {
    scenario: &'a Scenario,
    tree: &'a TomlNode,
    faults: Vec<Fault>,
}

impl Checker<'_> {
    fn refuse(&mut self, path: &str, label: &str, message: String, help: &str) {
        let fault = Fault::at(self.tree.place_of(path), label, message);
        self.faults.push(if help.is_empty() { fault } else { fault.help(help) });
    }

    fn times(&mut self, building: &BuildingConfig) {
        let (step_s, steps) = (building.step_s, building.steps_per_day());
        if (steps as f64 * step_s - DAY_S).abs() > 1e-6 {
            let message = format!("`building.step_s` ({step_s}) does not divide a day of 86400 s");
            self.refuse(
                "building.step_s",
                "no whole number of steps",
                message,
                "choose 900, 1800 or 3600, for example",
            );
        } else if self.scenario.days() * steps > MAX_STEPS {
            let message = format!("{} days of {steps} steps are more than {MAX_STEPS} steps", self.scenario.days());
            self.refuse("iterations", "too many", message, "lower `iterations` or lengthen `building.step_s`");
        }
    }

    /// Whether another program can be the building, and whether its expectations can then be judged.
    fn plant(&mut self, building: &BuildingConfig) {
        match &building.plant {
            BuildingPlant::Network(_) => return,
            BuildingPlant::Socket(socket) => {
                if let Some(fault) = socket.address_fault() {
                    let message = format!("`building.plant.address` is {}: {fault}", quoted(&socket.address));
                    let help = "state host and port, such as \"127.0.0.1:7878\"";
                    self.refuse("building.plant.address", "no address", message, help);
                }
            }
            BuildingPlant::Boptest(config) => self.boptest(building, config),
        }
        if self.scenario.expect.building.is_some_and(|expect| expect.regret_at_most.is_some()) {
            let message = "the regret is not known where another program is the building: its optimum is not computed";
            let help = "leave it out, or compare with a run of `controller.kind = \"clairvoyant\"`";
            self.refuse("expect.building.regret_at_most", "not known", message.to_owned(), help);
        }
    }

    /// Whether a BOPTEST test case fits the zones, and whether the file also states what it forecasts.
    fn boptest(&mut self, building: &BuildingConfig, config: &BoptestPlantConfig) {
        // An invalid network is refused elsewhere.
        let network = building.network().ok();
        let zones = network.as_ref().map_or(config.zones.len(), Network::zone_count);
        if let Some((key, problem)) = config.fault(zones) {
            let path = format!("building.plant.{key}");
            let message = format!("{} {problem}", quoted(&path));
            self.refuse(&path, "does not fit", message, "");
        }
        let samples = building.step_s / config.sampling_s;
        if config.fmu.is_some() && (samples < 0.5 || (samples - samples.round()).abs() > 1e-9) {
            let message = format!(
                "`building.step_s` ({}) is not a multiple of `building.plant.sampling_s` ({})",
                building.step_s, config.sampling_s
            );
            self.refuse(
                "building.plant.sampling_s",
                "no divisor",
                message,
                "choose 30, 60 or `building.step_s`, for example",
            );
        }
        let Some(foretold) = &config.forecast else { return };
        if foretold.tariff && self.scenario.tariff.is_some() {
            let message = "prices are stated twice: here, and by `building.plant.forecast`".to_owned();
            self.refuse(
                "tariff",
                "not used",
                message,
                "leave it out, or state `building.plant.forecast.tariff = false`",
            );
        }
        if network.is_some_and(|network| !network.window_planes().is_empty()) {
            let message =
                "windows need the sun by its direction, and the forecast of a case has that on a horizontal plane only";
            let help = "state `solar_aperture_m2` of the zones in place of windows";
            self.refuse("building.plant.forecast", "no direction", message.to_owned(), help);
        }
    }

    /// Whether the zones of the building are stated unambiguously.
    fn sources(&mut self, building: &BuildingConfig) -> bool {
        let before = self.faults.len();
        if building.zones.is_empty() && !building.walls.is_empty() {
            let message = "`building` has walls but no zones".to_owned();
            self.refuse(
                "building.wall.0",
                "between what?",
                message,
                "add a `[[building.zone]]` for each place, or no walls",
            );
        }
        if let Some(grid) = building.grid.filter(|grid| grid.rooms() > MAX_ZONES) {
            let message = format!("a grid of {} rooms has more than {MAX_ZONES} zones", grid.rooms());
            self.refuse("building.grid", "too many", message, "");
        }
        self.faults.len() == before
    }

    fn network(&mut self, error: &NetworkError) {
        let key = error.key().map_or(String::new(), |key| format!(".{key}"));
        let path = match error.part() {
            Some(Part::Zone(zone)) => format!("building.zone.{zone}{key}"),
            Some(Part::Wall(wall)) => format!("building.wall.{wall}{key}"),
            None => "building".to_owned(),
        };
        self.refuse(&path, "here", error.to_string(), "");
    }

    /// Whether the model can be simulated and controlled, with targets for its zones.
    fn controlled(&mut self, building: &BuildingConfig, network: &Network) {
        let steps = building.steps_per_day();
        let setpoints = self.scenario.setpoints.clone().unwrap_or_default();
        if let Err(error) = setpoints.targets(network.zone_count(), building.step_s, steps) {
            self.refuse(&format!("setpoints.{}", error.key()), "here", format!("`setpoints`: {error}"), "");
        }
        self.faults.extend(zones::check(self.scenario, self.tree, network));
        self.regret(network.zone_count() * steps);
        match Model::new(network, building.method, building.step_s) {
            Err(error @ ModelError::BadStep { .. }) => {
                self.refuse("building.step_s", "here", error.to_string(), "");
            }
            Err(error @ ModelError::Unstable { .. }) => {
                self.refuse("building.method", "unstable", error.to_string(), "");
            }
            Ok(_) => self.believed(building, steps),
        }
    }

    /// Whether a bound on the regret can be judged.
    fn regret(&mut self, inputs: usize) {
        let stated = self.scenario.expect.building.is_some_and(|expect| expect.regret_at_most.is_some());
        if stated && inputs > MAX_REGRET_INPUTS {
            let message = format!(
                "regret is computed for at most {MAX_REGRET_INPUTS} inputs a day (zones times steps), and this building has \
                 {inputs}"
            );
            let help = "leave it out, or compare with a run of `controller.kind = \"clairvoyant\"`";
            self.refuse("expect.building.regret_at_most", "not computed", message, help);
        }
    }

    /// Whether the controller works with its model of the building.
    fn believed(&mut self, building: &BuildingConfig, steps: usize) {
        let network = match building.believed_network() {
            Ok(network) => network,
            Err(error) => {
                let key = error.key().map_or(String::new(), |key| format!(".{key}"));
                return self.refuse(&format!("building.believed{key}"), "here", error.to_string(), "");
            }
        };
        let model = match Model::new(&network, building.method, building.step_s) {
            Ok(model) => model,
            Err(error) => return self.refuse("building.believed", "here", error.to_string(), ""),
        };
        if let Err(error) = self.scenario.controller().controller(&model, steps) {
            self.refuse(&format!("controller.{}", error.key()), "here", format!("`controller`: {error}"), "");
        }
    }
}
