//! Reads a text as a plan and checks it.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::LazyLock;

use interplay_common::spelling::suggestion;
use serde_json::Value as Json;

use super::assignment::Arm;
use super::factor::{DrawSettings, factors};
use super::names::{self, NamedScenario, find};
use super::plan::{PlannedScenario, SweepPlan};
use crate::format::json_schema::{self, SchemaNode};
use crate::format::read::overrides::settings_of;
use crate::format::read::source::Source;
use crate::format::read::tree::{self, TomlNode, TomlValue};
use crate::format::registry::Registry;
use crate::load::{self, stated_counterfactuals};
use crate::model::traffic::weights::StartJitter;
use crate::plans::plan_file::{PlanFile, PlanJitter};
use crate::resolve::check::shape;
use crate::resolve::placement::KnownRoads;
use crate::text::error::{Document, Fault, LoadError, Place, quoted};

static SCHEMA: LazyLock<Json> = LazyLock::new(json_schema::generated::<PlanFile>);

/// The plans in the binary: name and text.
const EMBEDDED: [(&str, &str); 13] = [
    ("quick", include_str!("../../plans/quick.toml")),
    ("people-encounters", include_str!("../../plans/people-encounters.toml")),
    ("perturbed-starts", include_str!("../../plans/perturbed-starts.toml")),
    ("contingency", include_str!("../../plans/contingency.toml")),
    ("inferred", include_str!("../../plans/inferred.toml")),
    ("real-roads", include_str!("../../plans/real-roads.toml")),
    ("any-weight", include_str!("../../plans/any-weight.toml")),
    ("people", include_str!("../../plans/people.toml")),
    ("streets", include_str!("../../plans/streets.toml")),
    ("every-street", include_str!("../../plans/every-street.toml")),
    ("partners", include_str!("../../plans/partners.toml")),
    ("study", include_str!("../../plans/study.toml")),
    ("benchmark", include_str!("../../plans/benchmark.toml")),
];

/// The names of the plans in the binary.
pub fn embedded_plans() -> Vec<&'static str> {
    EMBEDDED.iter().map(|(name, _)| *name).collect()
}

impl SweepPlan {
    /// [`Registry::sweep_plan`] with the standard registry.
    ///
    /// # Errors
    /// As [`Registry::sweep_plan`].
    pub fn load(name_or_path: &str, samples: Option<u64>) -> Result<SweepPlan, LoadError> {
        Registry::standard().sweep_plan(name_or_path, samples)
    }

    /// [`Registry::sweep_plan_from_text`] with the standard registry.
    ///
    /// # Errors
    /// As [`Registry::sweep_plan`].
    pub fn from_text(name: &str, text: &str, folder: &Path) -> Result<SweepPlan, LoadError> {
        Registry::standard().sweep_plan_from_text(name, text, folder)
    }
}

impl Registry {
    /// The plan of that name in the binary, otherwise the file at that path; `samples`, if stated, replaces its own number of
    /// samples.
    ///
    /// # Errors
    /// All its faults, each located.
    pub fn sweep_plan(&self, name_or_path: &str, samples: Option<u64>) -> Result<SweepPlan, LoadError> {
        if let Some((name, text)) = EMBEDDED.iter().find(|(name, _)| *name == name_or_path) {
            return with_samples(self, name, text, Path::new(""), samples);
        }
        let refused = |fault: Fault| LoadError::of_plan(name_or_path, vec![fault]);
        let path = Path::new(name_or_path);
        if !path.exists() {
            let message = format!("there is no plan and no file {}", quoted(name_or_path));
            return Err(refused(Fault::new(message).help(suggestion(
                name_or_path,
                "plans in the binary are",
                &embedded_plans(),
            ))));
        }
        let (_, text) = Source::File(path.to_owned()).read(0).map_err(refused)?;
        with_samples(self, name_or_path, &text, path.parent().unwrap_or(Path::new("")), samples)
    }

    /// The plan of a text whose name in errors is `name`; paths in it are relative to `folder`.
    ///
    /// # Errors
    /// As [`Registry::sweep_plan`].
    pub fn sweep_plan_from_text(&self, name: &str, text: &str, folder: &Path) -> Result<SweepPlan, LoadError> {
        with_samples(self, name, text, folder, None)
    }
}

fn with_samples(
    registry: &Registry,
    name: &str,
    text: &str,
    folder: &Path,
    samples: Option<u64>,
) -> Result<SweepPlan, LoadError> {
    let document = Document::new(name, text, 0);
    let place = Place::new(&document, 0..0);
    let plan = tree::parse(&document, text).and_then(|mut tree| {
        let replaced = samples.map(|samples| names::replace(&mut tree, text, samples));
        read(registry, name, replaced.as_deref().unwrap_or(text), place, &tree, folder)
    });
    plan.map_err(|faults| LoadError::of_plan(name, faults))
}

/// The fault of a file that is a scenario and not a plan.
fn scenario_in_its_place(tree: &TomlNode, name: &str) -> Option<Fault> {
    let table = tree.table().filter(|table| !table.contains_key("scenario"))?;
    let entry = ["vehicle", "building", "extends", "road"].into_iter().find_map(|key| table.get(key))?;
    let message = format!("{} is a scenario, not a plan of runs", quoted(name));
    let help = format!("to run it from 20 starts: `interplay sweep --scenario {name} --starts 20`");
    Some(Fault::at(&entry.key, "plans have no such key", message).help(help))
}

fn read(
    registry: &Registry,
    name: &str,
    text: &str,
    place: Place,
    tree: &TomlNode,
    folder: &Path,
) -> Result<SweepPlan, Vec<Fault>> {
    if let Some(fault) = scenario_in_its_place(tree, name) {
        return Err(vec![fault]);
    }
    let faults = shape::check(tree, SchemaNode::new(&SCHEMA));
    if !faults.is_empty() {
        return Err(faults);
    }
    let file: PlanFile = serde_json::from_value(tree.to_json())
        .map_err(|error| vec![Fault::at(&tree.place, "in this file", error.to_string())])?;
    if file.seed.checked_add(file.samples).is_none() {
        let message = "`seed` and `samples` together are more than the largest seed";
        return Err(vec![Fault::at(tree.place_of("seed"), "too large", message)]);
    }
    let settings = (file.sampling, file.seed, file.samples);
    let mut plan = SweepPlan {
        registry: registry.clone(),
        name: name.to_owned(),
        title: file.title,
        text: text.to_owned(),
        scenarios: Vec::new(),
        styles: arms(tree, "style", |node| Arm::style(node, settings, registry))?,
        planners: arms(tree, "planner", |node| Arm::planner(node, registry))?,
        changes: changes(tree, settings, registry.complete())?,
        sampling: file.sampling,
        samples: file.samples,
        samples_place: tree.at("samples").map(|node| node.place.clone()),
        seed: file.seed,
        place,
        jitter_place: tree.at("jitter").map(|node| node.place.clone()),
        known_roads: KnownRoads::default(),
    };
    refuse(plan.conflicts())?;
    let named = scenarios(tree, folder)?;
    refuse_too_many(plan.count_for(named.len()), file.max_runs, tree)?;
    let jitter = file.jitter.zip(tree.at("jitter").map(|node| &node.place));
    let read = |(named, place)| planned(registry, named, place, jitter, file.counterfactuals);
    plan.scenarios = named.into_iter().map(read).collect::<Result<_, _>>()?;
    refuse_too_many(plan.count(), file.max_runs, tree)?;
    refuse_equal_names(&plan, tree)?;
    refuse_seeded_counterfactuals(&plan, tree)?;
    refuse(plan.idle_deadlines())?;
    refuse(plan.without_effect())?;
    refuse(plan.check_extremes())?;
    Ok(plan)
}

/// The name of the planner that the text of a plan lists first; none without a list.
pub fn first_planner(plan: &str) -> Option<String> {
    let tree = tree::parse(&Document::new("plan.toml", plan, 1), plan).ok()?;
    let TomlValue::Array(planners) = &tree.at("planner")?.value else { return None };
    let first = planners.first()?;
    let name = first.text().or_else(|| first.at("name").and_then(TomlNode::text));
    name.map(str::to_owned)
}

fn refuse(faults: Vec<Fault>) -> Result<(), Vec<Fault>> {
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// The entries of a list of arms; without any, the scenario as it is.
fn arms(
    tree: &TomlNode,
    key: &str,
    arm: impl Fn(&TomlNode) -> Result<Arm, Vec<Fault>>,
) -> Result<Vec<Arm>, Vec<Fault>> {
    let Some(TomlValue::Array(items)) = tree.at(key).map(|node| &node.value) else {
        return Ok(vec![Arm::as_written()]);
    };
    let mut found: Vec<Arm> = Vec::new();
    for node in items {
        let arm = arm(node)?;
        if found.iter().any(|other| other.name == arm.name) {
            let message = format!("there are two entries {} in `{key}`", quoted(&arm.name));
            let help = "their runs could not be told apart; give one of them another `name`";
            return Err(vec![Fault::at(&node.place, "the second", message).help(help)]);
        }
        found.push(arm);
    }
    Ok(if found.is_empty() { vec![Arm::as_written()] } else { found })
}

/// The changes and factors of all runs.
fn changes(tree: &TomlNode, settings: DrawSettings, schema: SchemaNode) -> Result<Arm, Vec<Fault>> {
    let table = |key: &str| tree.at(key).and_then(TomlNode::table).cloned().unwrap_or_default();
    let (set, vary) = (settings_of(table("set"), schema)?, factors(&table("vary"), settings, schema)?);
    Ok(Arm::changing("everywhere", set, vary))
}

/// The scenarios of a plan with their places. Two of one name are refused.
fn scenarios<'a>(tree: &'a TomlNode, folder: &Path) -> Result<Vec<(NamedScenario, &'a Place)>, Vec<Fault>> {
    let Some(TomlValue::Array(items)) = tree.at("scenario").map(|node| &node.value) else { return Ok(Vec::new()) };
    let (mut found, mut faults) = (BTreeMap::new(), Vec::new());
    let mut order = Vec::new();
    for node in items {
        match find(node.text().unwrap_or_default(), &node.place, folder) {
            Ok(all) => {
                for named in all {
                    if let Some(before) = found.insert(named.name.clone(), named.clone()) {
                        let message = if before == named {
                            format!("{} is in the plan twice", quoted(&named.name))
                        } else {
                            format!("two scenarios are called {}", quoted(&named.name))
                        };
                        faults.push(Fault::at(&node.place, "the second", message));
                    }
                    order.push((named, &node.place));
                }
            }
            Err(fault) => faults.push(fault),
        }
    }
    if faults.is_empty() { Ok(order) } else { Err(faults) }
}

/// Refuses a counterfactual with the name of a planner of the plan, since the results could not distinguish them.
fn refuse_equal_names(plan: &SweepPlan, tree: &TomlNode) -> Result<(), Vec<Fault>> {
    let counterfactuals = plan.scenarios.iter().flat_map(|scenario| {
        scenario.counterfactuals.iter().map(|counterfactual| (&scenario.named.name, &counterfactual.name))
    });
    let is_planner = |name: &str| plan.planners.iter().any(|planner| planner.name == name);
    let Some((scenario, name)) = counterfactuals.into_iter().find(|(_, name)| is_planner(name)) else { return Ok(()) };
    let message = format!("{} has a counterfactual {}, which a planner is called, too", quoted(scenario), quoted(name));
    let place = tree.at("counterfactuals").map_or(&tree.place, |node| &node.place);
    Err(vec![Fault::at(place, "could not be told apart", message).help("give the planner another `name`")])
}

/// Refuses a counterfactual that sets the seed: the seed of a run follows from its sample, so it would repeat one run.
fn refuse_seeded_counterfactuals(plan: &SweepPlan, tree: &TomlNode) -> Result<(), Vec<Fault>> {
    let is_seeded = |arm: &&Arm| arm.settings().iter().any(|(path, _)| path.written() == "seed");
    let seeded = plan.scenarios.iter().find_map(|scenario| {
        let counterfactual = scenario.counterfactuals.iter().find(is_seeded)?;
        Some((&scenario.named.name, &counterfactual.name))
    });
    let Some((scenario, name)) = seeded else { return Ok(()) };
    let message = format!("{} has a counterfactual {} that sets the seed", quoted(scenario), quoted(name));
    let place = tree.at("counterfactuals").map_or(&tree.place, |node| &node.place);
    let help = "the seed of a run follows from its sample; `interplay run` runs this counterfactual as it is";
    Err(vec![Fault::at(place, "one run in all samples", message).help(help)])
}

fn refuse_too_many(count: Option<u64>, most: u64, tree: &TomlNode) -> Result<(), Vec<Fault>> {
    if count.is_some_and(|count| count <= most) {
        return Ok(());
    }
    let asked = count.map_or("more runs than can be counted".to_owned(), |count| format!("{count} runs"));
    let blamed = ["samples", "vary", "max_runs", "scenario"].iter().find_map(|key| tree.at(key));
    let message = format!("the plan asks for {asked}, and at most {most} are allowed");
    let help = "state fewer samples or values, or a larger `max_runs`";
    Err(vec![Fault::at(blamed.map_or(&tree.place, |node| &node.place), "too many", message).help(help)])
}

/// Reads a scenario and what it extends, with its counterfactuals only if the plan runs them.
fn planned(
    registry: &Registry,
    named: NamedScenario,
    place: &Place,
    jitter: Option<(PlanJitter, &Place)>,
    with_counterfactuals: bool,
) -> Result<PlannedScenario, Vec<Fault>> {
    let mut tree = load::tree_named_at(registry, &named.source, place)?;
    let counterfactuals = if with_counterfactuals { counterfactuals(registry, &tree)? } else { Vec::new() };
    if let TomlValue::Table(root) = &mut tree.value {
        root.remove("counterfactual");
    }
    let scenario = load::assemble(registry, &tree)?;
    if let Some((_, place)) = jitter.filter(|_| scenario.vehicles.is_empty()) {
        let message = format!("{} has no vehicles, so `jitter` has no start to change", quoted(&named.name));
        return Err(vec![Fault::at(place, "no vehicle starts", message)]);
    }
    let vehicle_scale = scenario.vehicles.first().map_or(1.0, |vehicle| vehicle.body.scale);
    let scaled = |jitter: PlanJitter| {
        let scale = if jitter.scaled { vehicle_scale } else { 1.0 };
        StartJitter { position_m: jitter.position_m * scale, speed_mps: jitter.speed_mps * scale.sqrt() }
    };
    let canonical = format!("{}{}{}", tree.to_json(), names::contents(&scenario), registry.versions());
    Ok(PlannedScenario { named, tree, canonical, jitter: jitter.map(|(jitter, _)| scaled(jitter)), counterfactuals })
}

/// The counterfactuals of a scenario as planners.
fn counterfactuals(registry: &Registry, tree: &TomlNode) -> Result<Vec<Arm>, Vec<Fault>> {
    let scenario = load::assemble(registry, tree)?;
    let faults = crate::resolve::check::consistency::counterfactual::check(
        &scenario,
        &stated_counterfactuals(tree)?,
        tree,
        None,
    );
    if !faults.is_empty() {
        return Err(faults);
    }
    let Some(TomlValue::Array(stated)) = tree.at("counterfactual").map(|node| &node.value) else {
        return Ok(Vec::new());
    };
    let stated = stated.iter().filter_map(TomlNode::table);
    stated.map(|table| Arm::counterfactual(table, registry)).collect()
}
