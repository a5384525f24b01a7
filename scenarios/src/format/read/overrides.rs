//! Changes of a scenario from the command line, such as `--set vehicle.ego.goal.speed_mps=1.2`.
//!
//! A change is merged into the file as a file is merged into the one that it extends, and then checked in the same way. Its document is
//! the text of the flag, so errors point into the flag. The changes of a counterfactual are merged in the same way.

use std::sync::Arc;

use interplay_common::spelling::suggestion;

use crate::format::json_schema::SchemaNode;
use crate::format::read::merge::merge_tables;
use crate::format::read::planner_flag::{flow_help, refuse_unfit_planner};
use crate::format::read::tree::{Table, TomlEntry, TomlNode, TomlValue, kind_of, parse_value};
use crate::text::error::{Document, Fault, Place, quoted};
use crate::text::name::EGO;

/// The most words of a path; bounds the depth of the tables that `--set` can create.
const MAX_PATH_STEPS: usize = 16;

/// A change of a scenario by a flag.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Override {
    /// `--set path.to.key=value`. Vehicles are addressed by name (`vehicle.ego.goal.lane=1`), entries of
    /// `expect.completes` and `expect.speed` by their vehicle. The value is TOML; what is not TOML is taken as text.
    Set(String),
    /// `--seed N`.
    Seed(u64),
    /// `--planner KIND`: the driver of the ego. Settings that this kind does not know are dropped.
    Planner(String),
}

/// One word of a path and its place in the flag or in the file.
#[derive(Clone)]
struct Step {
    word: String,
    place: Place,
}

impl Override {
    /// Merges the change into a scenario.
    pub(crate) fn apply(&self, root: &mut Table, schema: SchemaNode) -> Result<(), Fault> {
        let (steps, value) = match self {
            Override::Set(assignment) => assignment_of(assignment)?,
            Override::Seed(seed) => {
                let place = whole("--seed", &seed.to_string());
                (steps_of(&["seed"], &place), TomlNode { place, value: TomlValue::Integer(i128::from(*seed)) })
            }
            Override::Planner(kind) => {
                let place = whole("--planner", kind);
                if !has_vehicles(root) {
                    return Err(no_vehicles(root, &place));
                }
                refuse_unfit_planner(root, &ego_name(root), kind, &place)?;
                return lay_planner(root, TomlNode { place, value: TomlValue::Text(kind.clone()) }, schema);
            }
        };
        lay(Some(schema), root, (&steps, 0), value)
    }
}

/// Merges the kind of driver that `node` holds into that of the ego.
pub(crate) fn lay_planner(root: &mut Table, node: TomlNode, schema: SchemaNode) -> Result<(), Fault> {
    let SettingPath(steps) = ego_kind(root, &node.place);
    lay(Some(schema), root, (&steps, 0), node)
}

/// The path of the kind of driver of a scenario's ego, written at `place`.
pub(crate) fn ego_kind(root: &Table, place: &Place) -> SettingPath {
    SettingPath(steps_of(&["vehicle", &ego_name(root), "driver", "kind"], place))
}

/// Lays a table over a scenario whose keys are paths as `--set` has them, or tables below one another that spell them.
/// Returns the faults; the scenario is then partly changed.
pub(crate) fn lay_paths(root: &mut Table, set: Table, schema: SchemaNode) -> Vec<Fault> {
    let mut faults = Vec::new();
    for (key, entry) in set {
        match assignments(Some(schema), &[], &key, entry) {
            Ok(all) => faults
                .extend(all.into_iter().filter_map(|(steps, value)| lay(Some(schema), root, (&steps, 0), value).err())),
            Err(fault) => faults.push(fault),
        }
    }
    faults
}

/// The paths and values that an entry of such a table stands for; `schema` is that of the table into which the steps before
/// lead, or of the list.
fn assignments(
    schema: Option<SchemaNode>,
    before: &[Step],
    key: &str,
    entry: TomlEntry,
) -> Result<Vec<(Vec<Step>, TomlNode)>, Fault> {
    let steps = extended(before, key, &entry.key)?;
    let (mut schema, mut in_list) = (schema, false);
    for step in &steps[before.len()..] {
        in_list = schema.is_some_and(|schema| schema.entries().is_some());
        schema = schema.and_then(|schema| schema.entries().or_else(|| schema.property(&step.word)));
    }
    let is_list = schema.is_some_and(|schema| schema.entries().is_some());
    match entry.node.value {
        // An entry of a list is found by its name and keeps the keys that are not stated.
        TomlValue::Table(table) if is_list || in_list || leads_to_entries(schema, &table) => {
            let mut all = Vec::new();
            for (key, entry) in table {
                all.extend(assignments(schema, &steps, &key, entry)?);
            }
            Ok(all)
        }
        value => Ok(vec![(steps, TomlNode { place: entry.node.place, value })]),
    }
}

/// Whether a table contains, at any depth, a table in place of a list: its keys are then names of entries, and the table is a path.
fn leads_to_entries(schema: Option<SchemaNode>, table: &Table) -> bool {
    table.iter().any(|(key, entry)| {
        let below = schema.and_then(|schema| schema.property(key));
        let is_list = below.is_some_and(|below| below.entries().is_some());
        matches!(&entry.node.value, TomlValue::Table(inner) if is_list || leads_to_entries(below, inner))
    })
}

/// The steps of a path extended by a key, in which dots separate the words.
fn extended(before: &[Step], key: &str, written: &Place) -> Result<Vec<Step>, Fault> {
    let mut steps = before.to_vec();
    // A quoted key is longer than its text by its quotes; with escapes in it, the whole key is underlined.
    let quotes = written.span.len().saturating_sub(key.len());
    let mut offset = written.span.start + usize::from(quotes > 0);
    for word in key.split('.') {
        let place = match quotes {
            0 | 2 => Place::new(&written.document, offset..offset + word.len()),
            _ => written.clone(),
        };
        offset += word.len() + 1;
        if word.trim().is_empty() || steps.len() == MAX_PATH_STEPS {
            let message = format!("{} is not the path of a setting", quoted(key));
            let example = "write for example `\"vehicle.ego.goal.speed_mps\" = 1.2`";
            return Err(Fault::at(&place, "here", message).help(example));
        }
        steps.push(Step { word: word.trim().to_owned(), place });
    }
    Ok(steps)
}

/// A path of a setting, as a plan of many runs has it: its second word may be `*`, for every vehicle but the ego.
#[derive(Clone)]
pub(crate) struct SettingPath(Vec<Step>);

/// The word of a path that stands for every vehicle but the ego.
const OTHER_VEHICLES: &str = "*";

impl SettingPath {
    /// The empty path.
    pub fn root() -> SettingPath {
        SettingPath(Vec::new())
    }

    /// The path extended by a key, which is written at `place`.
    pub fn join(&self, key: &str, place: &Place) -> Result<SettingPath, Fault> {
        extended(&self.0, key, place).map(SettingPath)
    }

    pub fn written(&self) -> String {
        let words: Vec<&str> = self.0.iter().map(|step| step.word.as_str()).collect();
        words.join(".")
    }

    /// The schema at the end of the path, if known.
    pub fn schema<'s>(&self, root: SchemaNode<'s>) -> Option<SchemaNode<'s>> {
        schema_at(root, self.0.iter().map(|step| step.word.as_str()))
    }

    /// The places of its words in the text.
    pub fn places(&self) -> impl Iterator<Item = &Place> {
        self.0.iter().map(|step| &step.place)
    }

    /// Merges a value into a scenario at this path.
    pub fn lay(&self, root: &mut Table, value: &TomlNode, schema: SchemaNode) -> Result<(), Fault> {
        let are_of_flows = root.contains_key("flow") && other_names(root).is_empty();
        if self.is_of_others() && (are_of_flows || !has_vehicles(root)) {
            let others = if are_of_flows { "all others are vehicles of flows" } else { "the scenario has no vehicles" };
            let message = format!("{others}, so {} changes nothing", quoted(&self.written()));
            let fault = Fault::at(&self.0[1].place, "no vehicle here", message);
            return Err(flow_help(root).map_or(fault.clone(), |help| fault.help(help)));
        }
        let mut paths = self.in_scenario(root).into_iter();
        paths.try_for_each(|path| lay(Some(schema), root, (&path.0, 0), value.clone()))
    }

    /// The paths in a scenario that this path stands for: with `*`, one for each vehicle except the ego, otherwise itself.
    fn in_scenario(&self, root: &Table) -> Vec<SettingPath> {
        if !self.is_of_others() {
            return vec![self.clone()];
        }
        let of = |name: String| {
            let mut steps = self.0.clone();
            steps[1].word = name;
            SettingPath(steps)
        };
        other_names(root).into_iter().map(of).collect()
    }

    /// Whether the path stands for every vehicle except the ego.
    fn is_of_others(&self) -> bool {
        let word = |index: usize| self.0.get(index).map(|step: &Step| step.word.as_str());
        (word(0), word(1)) == (Some("vehicle"), Some(OTHER_VEHICLES))
    }
}

/// The schema at the end of a path, if known.
fn schema_at<'a, 's>(root: SchemaNode<'s>, words: impl IntoIterator<Item = &'a str>) -> Option<SchemaNode<'s>> {
    let mut words = words.into_iter();
    words.try_fold(root, |schema, word| schema.entries().or_else(|| schema.property(word)))
}

/// The paths and values of a table of the form that [`lay_paths`] takes.
pub(crate) fn settings_of(set: Table, schema: SchemaNode) -> Result<Vec<(SettingPath, TomlNode)>, Vec<Fault>> {
    let (mut all, mut faults) = (Vec::new(), Vec::new());
    for (key, entry) in set {
        match assignments(Some(schema), &[], &key, entry) {
            Ok(found) => all.extend(found.into_iter().map(|(steps, value)| (SettingPath(steps), value))),
            Err(fault) => faults.push(fault),
        }
    }
    if faults.is_empty() { Ok(all) } else { Err(faults) }
}

/// The names of all vehicles but the ego.
fn other_names(root: &Table) -> Vec<String> {
    let ego = ego_name(root);
    let Some(TomlValue::Array(vehicles)) = root.get("vehicle").map(|entry| &entry.node.value) else {
        return Vec::new();
    };
    vehicles.iter().filter_map(TomlNode::label).filter(|name| *name != ego).map(str::to_owned).collect()
}

fn whole(flag: &str, argument: &str) -> Place {
    Place::new(&Document::new(flag, argument, 0), 0..argument.len())
}

fn steps_of(path: &[&str], place: &Place) -> Vec<Step> {
    path.iter().map(|word| Step { word: (*word).to_owned(), place: place.clone() }).collect()
}

fn assignment_of(assignment: &str) -> Result<(Vec<Step>, TomlNode), Fault> {
    let document = Document::new("--set", assignment, 0);
    let place = Place::new(&document, 0..assignment.len());
    let example = "write for example `--set vehicle.ego.goal.speed_mps=1.2`";
    let Some((path, value)) = assignment.split_once('=') else {
        return Err(Fault::at(&place, "no `=` here", "`--set` needs PATH=VALUE").help(example));
    };
    let mut steps = Vec::new();
    let mut offset = 0;
    for word in path.split('.') {
        if steps.len() == MAX_PATH_STEPS {
            let message = format!("no key of a scenario has more than {MAX_PATH_STEPS} words");
            return Err(Fault::at(&place, "too long", message).help(example));
        }
        let place = Place::new(&document, offset..offset + word.len());
        offset += word.len() + 1;
        if word.trim().is_empty() {
            return Err(Fault::at(&place, "a key is missing here", "`--set` needs PATH=VALUE").help(example));
        }
        steps.push(Step { word: word.trim().to_owned(), place });
    }
    Ok((steps, value_of(&document, path.len() + 1, value)))
}

/// The value after the `=`, without surrounding blanks.
fn value_of(document: &Arc<Document>, offset: usize, written: &str) -> TomlNode {
    let value = written.trim();
    let offset = offset + (written.len() - written.trim_start().len());
    let place = Place::new(document, offset..offset + value.len());
    let text = || TomlNode { place, value: TomlValue::Text(value.to_owned()) };
    parse_value(document, offset, value).unwrap_or_else(text)
}

/// Whether `vehicle` has entries; a value that is not a list is refused by the check.
fn has_vehicles(root: &Table) -> bool {
    root.get("vehicle").is_some_and(|entry| !entry.node.is_empty_list())
}

/// The refusal of `--planner` for a scenario without vehicles.
fn no_vehicles(root: &Table, place: &Place) -> Fault {
    let message = "the scenario has no vehicles, so `--planner` has nothing to change";
    let fault = Fault::at(place, "no vehicle to drive", message);
    if let Some(help) = flow_help(root) {
        return fault.help(help);
    }
    if root.contains_key("building") {
        return fault.help("the building has a controller, which `--set controller.kind=KIND` chooses");
    }
    fault.help("add a `[[vehicle]]`, or name another scenario: `interplay list` shows them")
}

fn ego_name(root: &Table) -> String {
    let Some(TomlValue::Array(vehicles)) = root.get("vehicle").map(|entry| &entry.node.value) else {
        return EGO.to_owned();
    };
    let names: Vec<&str> = vehicles.iter().filter_map(TomlNode::label).collect();
    let ego = names.iter().find(|name| **name == EGO).or(names.first());
    ego.map_or(EGO, |name| *name).to_owned()
}

/// The steps of a path, and how many of them have been taken.
type Progress<'a> = (&'a [Step], usize);

/// Merges a value into a table at the end of a path, and creates missing tables and lists on the way.
fn lay(schema: Option<SchemaNode>, table: &mut Table, path: Progress<'_>, value: TomlNode) -> Result<(), Fault> {
    let (steps, done) = path;
    let Some(step) = steps.get(done) else { return Ok(()) };
    if done + 1 == steps.len() {
        let change = Table::from([(step.word.clone(), TomlEntry { key: step.place.clone(), node: value })]);
        *table = merge_tables(schema, std::mem::take(table), change);
        return Ok(());
    }
    let property = schema.and_then(|table| table.property(&step.word));
    let is_list = property.is_some_and(|property| property.type_name() == Some("array"));
    let empty = if is_list { TomlValue::Array(Vec::new()) } else { TomlValue::Table(Table::new()) };
    let entry = table.entry(step.word.clone()).or_insert_with(|| TomlEntry {
        key: step.place.clone(),
        node: TomlNode { place: step.place.clone(), value: empty },
    });
    match &mut entry.node.value {
        TomlValue::Table(table) => lay(property, table, (steps, done + 1), value),
        TomlValue::Array(items) => lay_in_list(property.and_then(SchemaNode::entries), items, (steps, done + 1), value),
        other => {
            let message = format!("{} is {}, not a table", quoted(&step.word), kind_of(other));
            Err(Fault::at(&step.place, "nothing is below this", message))
        }
    }
}

/// Merges a value into the entry of a list that the next step names; `schema` is that of an entry.
fn lay_in_list(
    schema: Option<SchemaNode>,
    items: &mut [TomlNode],
    path: Progress<'_>,
    value: TomlNode,
) -> Result<(), Fault> {
    let (steps, done) = path;
    let Some(step) = steps.get(done) else { return Ok(()) };
    let labels: Vec<String> = items.iter().filter_map(|item| item.label().map(str::to_owned)).collect();
    let Some(item) = items.iter_mut().find(|item| item.label() == Some(step.word.as_str())) else {
        return Err(no_such_entry(path, &labels));
    };
    match (&mut item.value, value.value) {
        (TomlValue::Table(table), over) if done + 1 < steps.len() => {
            lay(schema, table, (steps, done + 1), TomlNode { value: over, ..value })
        }
        (TomlValue::Table(table), TomlValue::Table(over)) => {
            *table = merge_tables(schema, std::mem::take(table), over);
            Ok(())
        }
        (_, other) => {
            let message = format!("{} must be a table, not {}", quoted(&written(path)), kind_of(&other));
            let help = format!("set one of its keys, as `{}.KEY=VALUE`", written(path));
            Err(Fault::at(&value.place, "not a table", message).help(help))
        }
    }
}

/// The refusal of a step that names no entry of the list before it.
fn no_such_entry((steps, done): Progress<'_>, labels: &[String]) -> Fault {
    let (step, list) = (&steps[done], written((steps, done - 1)));
    let message = format!("there is no {} in {}", quoted(&step.word), quoted(&list));
    let known: Vec<&str> = labels.iter().map(String::as_str).collect();
    let help = match known.as_slice() {
        [] => format!("the scenario has no entries with a name in {}", quoted(&list)),
        known => suggestion(&step.word, "there are", known),
    };
    Fault::at(&step.place, "unknown", message).help(help)
}

/// The path up to and including the next step, as written.
fn written((steps, done): Progress<'_>) -> String {
    let words: Vec<&str> = steps.iter().take(done + 1).map(|step| step.word.as_str()).collect();
    words.join(".")
}
