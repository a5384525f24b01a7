//! From a name to a checked [`Scenario`]; see the crate's documentation for the way.

use crate::error::{Document, Fault, LoadError, Place, quoted};
use crate::expansion::{expand, with_defaults};
use crate::merge::merge_tables;
use crate::overrides::Override;
use crate::placement::{KnownRoads, resolve_starts};
use crate::registry::Registry;
use crate::scenario::Scenario;
use crate::schema::SchemaNode;
use crate::source::Source;
use crate::tree::{self, Table, TomlNode, TomlValue};
use crate::weather::WeatherConfig;
use crate::{budget, changed, consistency, degrees, remarks, schema_check, tariff_file, weather_file};

/// How many files may extend one another.
const MAX_CHAIN_LENGTH: usize = 16;

/// [`Registry::load`] with what Interplay has.
///
/// # Errors
///
/// As [`Registry::load`].
pub fn load(name_or_path: &str, overrides: &[Override]) -> Result<Scenario, LoadError> {
    Registry::standard().load(name_or_path, overrides)
}

/// [`Registry::from_text`] with what Interplay has.
///
/// # Errors
///
/// As [`Registry::load`].
pub fn from_text(name: &str, text: &str, overrides: &[Override]) -> Result<Scenario, LoadError> {
    Registry::standard().from_text(name, text, overrides)
}

impl Registry {
    /// Loads the authored scenario of that name, otherwise the file at that path, changed by `overrides` in their order.
    ///
    /// # Errors
    ///
    /// Whatever is wrong with the file, the ones that it extends, or the overrides, each error located.
    pub fn load(&self, name_or_path: &str, overrides: &[Override]) -> Result<Scenario, LoadError> {
        finish(self, name_or_path, tree(self, name_or_path)?, overrides)
    }

    /// Loads a scenario from a text; `name` is what errors call it. It may extend authored scenarios, and
    /// files relative to `name` taken as a path.
    ///
    /// # Errors
    ///
    /// As [`Registry::load`].
    pub fn from_text(&self, name: &str, text: &str, overrides: &[Override]) -> Result<Scenario, LoadError> {
        let (source, document) = (Source::File(name.into()), Document::new(name, text, 1));
        let tree = tree::parse(&document, text)
            .and_then(|node| extended(&source, node, &mut vec![source.clone()], self.complete()))
            .map_err(|faults| LoadError::new(name, faults))?;
        finish(self, name, tree, overrides)
    }
}

/// The tree of a scenario, `extends` resolved, unchecked.
pub(crate) fn tree(registry: &Registry, name_or_path: &str) -> Result<TomlNode, LoadError> {
    let read = read_chain(&Source::find(name_or_path)?, registry.complete());
    read.map_err(|faults| LoadError::new(name_or_path, faults))
}

fn finish(registry: &Registry, name: &str, mut tree: TomlNode, overrides: &[Override]) -> Result<Scenario, LoadError> {
    let refused = |faults| LoadError::new(name, faults);
    let as_written = tree.clone();
    if let TomlValue::Table(root) = &mut tree.value {
        let changes = overrides.iter();
        let faults: Vec<Fault> = changes.filter_map(|change| change.apply(root, registry.complete()).err()).collect();
        if !faults.is_empty() {
            return Err(refused(faults));
        }
    }
    let mut scenario = assemble(registry, &tree).map_err(refused)?;
    let as_written = Some(&as_written).filter(|_| !overrides.is_empty());
    let mut faults = assemble_counterfactuals(registry, &mut scenario, &tree, as_written);
    if faults.is_empty() {
        faults = budget::check_all(&scenario, &tree);
    }
    if faults.is_empty() { Ok(scenario) } else { Err(refused(faults)) }
}

/// The scenario that a whole tree describes, but for what its counterfactuals run.
pub(crate) fn assemble(registry: &Registry, tree: &TomlNode) -> Result<Scenario, Vec<Fault>> {
    assemble_on(registry, tree, &KnownRoads::default())
}

/// The same; what is known of its road is not computed again.
pub(crate) fn assemble_on(
    registry: &Registry,
    tree: &TomlNode,
    known_roads: &KnownRoads,
) -> Result<Scenario, Vec<Fault>> {
    let schema = registry.complete();
    let tree = &with_defaults(tree.clone(), schema)?;
    let faults = schema_check::check(tree, schema);
    if !faults.is_empty() {
        return Err(faults);
    }
    let mut stated = tree.to_json();
    degrees::to_radians(schema, &mut stated);
    expand(&mut stated, schema);
    let placed = resolve_starts(&mut stated, tree, schema, known_roads)?;
    let foreign_drivers = registry.take_foreign_drivers(&mut stated, tree)?;
    let mut scenario: Scenario = serde_json::from_value(stated)
        .map_err(|error| vec![Fault::at(&tree.place, "in this file", error.to_string())])?;
    scenario.network = placed.network;
    for (vehicle, route) in scenario.vehicles.iter_mut().zip(placed.routes) {
        vehicle.route = route;
    }
    for (index, driver) in foreign_drivers {
        scenario.vehicles[index].driver = driver;
    }
    let days = scenario.days();
    let unread = match &mut scenario.weather {
        Some(WeatherConfig::Epw(file)) => weather_file::attach(file, days, tree).err(),
        Some(WeatherConfig::Synthetic(_)) | None => None,
    };
    let unpriced = scenario.tariff.as_mut().and_then(|tariff| tariff_file::attach(tariff, tree).err());
    let faults = consistency::check(&scenario, tree, schema);
    let faults: Vec<Fault> = faults.into_iter().chain(unread).chain(unpriced).collect();
    scenario.remarks = remarks::of(&scenario, tree, schema);
    if faults.is_empty() { Ok(scenario) } else { Err(faults) }
}

/// Makes the scenario that each counterfactual runs; returns what is wrong with them. One that flags have made impossible is
/// left out: `as_written` is the tree without these flags, if there are any.
fn assemble_counterfactuals(
    registry: &Registry,
    scenario: &mut Scenario,
    tree: &TomlNode,
    as_written: Option<&TomlNode>,
) -> Vec<Fault> {
    let assembled = |tree: &TomlNode, index: usize| {
        let stated = tree.at(&format!("counterfactual.{index}")).and_then(TomlNode::table);
        let changed = |stated| changed::tree(tree, stated, registry.complete());
        stated.map_or_else(|| Err(Vec::new()), |stated| assemble(registry, &changed(stated)?))
    };
    let (mut faults, mut changed) = (Vec::new(), Vec::new());
    for (index, counterfactual) in scenario.counterfactuals.iter().enumerate() {
        match assembled(tree, index) {
            Ok(scenario) => changed.push(Ok(scenario)),
            Err(found) if as_written.is_some_and(|tree| assembled(tree, index).is_ok()) => {
                changed.push(Err(found.first().map(|fault| fault.message().to_owned()).unwrap_or_default()));
            }
            Err(found) => faults.extend(found.into_iter().map(|fault| fault.in_counterfactual(&counterfactual.name))),
        }
    }
    if faults.is_empty() {
        scenario.changed = changed.iter().flatten().cloned().collect();
    }
    faults.extend(consistency::counterfactual::check(scenario, tree, as_written.is_none()));
    if faults.is_empty() {
        for (counterfactual, outcome) in std::mem::take(&mut scenario.counterfactuals).into_iter().zip(changed) {
            match outcome {
                Ok(_) => scenario.counterfactuals.push(counterfactual),
                Err(reason) => scenario.left_out.push([counterfactual.name, reason]),
            }
        }
    }
    faults
}

/// Reads a source and all that it extends.
fn read_chain(source: &Source, schema: SchemaNode) -> Result<TomlNode, Vec<Fault>> {
    read_link(source, &mut Vec::new(), schema).map_err(|(_, faults)| faults)
}

/// Whether the faults are about opening the source itself, so that whoever refers to it is to blame.
type Refusal = (bool, Vec<Fault>);

fn read_link(source: &Source, chain: &mut Vec<Source>, schema: SchemaNode) -> Result<TomlNode, Refusal> {
    chain.push(source.clone());
    let (document, text) = source.read(chain.len()).map_err(|fault| (fault.file().is_none(), vec![fault]))?;
    let node = tree::parse(&document, &text).map_err(|faults| (false, faults))?;
    extended(source, node, chain, schema).map_err(|faults| (false, faults))
}

/// The tree laid over the one that it extends, if it extends any.
fn extended(
    source: &Source,
    mut node: TomlNode,
    chain: &mut Vec<Source>,
    schema: SchemaNode,
) -> Result<TomlNode, Vec<Fault>> {
    let TomlValue::Table(table) = &mut node.value else { return Ok(node) };
    let Some(extends) = table.remove("extends") else { return Ok(node) };
    let place = &extends.node.place;
    let blame = |fault: Fault| vec![fault.moved_to(place)];
    let Some(target) = extends.node.text() else {
        let message = "`extends` must be a text: the path of a file or the name of an embedded scenario";
        return Err(vec![Fault::at(place, "not a text", message)]);
    };
    let parent = source.parent(target).map_err(blame)?;
    refuse_cycle(&parent, chain, place).map_err(|fault| vec![fault])?;
    let below = read_link(&parent, chain, schema).map_err(|(to_blame, faults)| {
        let moved = |fault: Fault| if to_blame { fault.moved_to(place) } else { fault };
        faults.into_iter().map(moved).collect::<Vec<_>>()
    })?;
    if let (TomlValue::Table(under), TomlValue::Table(over)) = (below.value, &mut node.value) {
        *over = merge_tables(Some(schema), inherited(under), std::mem::take(over));
    }
    Ok(node)
}

/// What a file takes over from the one that it extends: all but the figure, since a variant is another picture, and the
/// counterfactuals, which say what that one's outcome is owed to.
fn inherited(mut under: Table) -> Table {
    under.remove("figure");
    under.remove("counterfactual");
    under
}

fn refuse_cycle(parent: &Source, chain: &[Source], place: &Place) -> Result<(), Fault> {
    let names = || chain.iter().chain([parent]).map(Source::name).collect::<Vec<_>>().join(" -> ");
    if chain.iter().any(|link| link.identity() == parent.identity()) {
        let message = format!("{} extends itself: {}", quoted(&parent.title()), names());
        return Err(Fault::at(place, "back to the beginning", message));
    }
    if chain.len() >= MAX_CHAIN_LENGTH {
        let message = format!("more than {MAX_CHAIN_LENGTH} files extend one another");
        return Err(Fault::at(place, "one too many", message));
    }
    Ok(())
}
