//! From a name to a checked [`Scenario`]; see the crate's documentation for the way.

use crate::error::{Document, LoadError, Place, Problem, quoted};
use crate::merge::merge_tables;
use crate::overrides::Override;
use crate::scenario::Scenario;
use crate::source::Source;
use crate::tree::{self, Node, Table, Value};
use crate::{building, meaning, schema, shape};

/// How many files may extend one another.
const LONGEST_CHAIN: usize = 16;

/// Loads the authored scenario of that name, otherwise the file at that path, changed by `overrides` in their order.
///
/// # Errors
///
/// Whatever is wrong with the file, the ones that it extends, or the overrides, each error located.
pub fn load(name_or_path: &str, overrides: &[Override]) -> Result<Scenario, LoadError> {
    finish(name_or_path, tree(name_or_path)?, overrides)
}

/// The tree of a scenario, `extends` resolved, unchecked.
pub(crate) fn tree(name_or_path: &str) -> Result<Node, LoadError> {
    read_chain(&Source::find(name_or_path)?).map_err(|problems| LoadError::new(name_or_path, problems))
}

/// Loads a scenario from a text; `name` is what errors call it. It may extend authored scenarios, and
/// files relative to `name` taken as a path.
///
/// # Errors
///
/// As [`load`].
pub fn from_text(name: &str, text: &str, overrides: &[Override]) -> Result<Scenario, LoadError> {
    let document = Document::new(name, text, 1);
    let tree = tree::parse(&document, text)
        .and_then(|node| extended(&Source::File(name.into()), node, &mut Vec::new()))
        .map_err(|problems| LoadError::new(name, problems))?;
    finish(name, tree, overrides)
}

fn finish(name: &str, mut tree: Node, overrides: &[Override]) -> Result<Scenario, LoadError> {
    let refused = |problems| LoadError::new(name, problems);
    if let Value::Table(root) = &mut tree.value {
        let problems: Vec<Problem> = overrides.iter().filter_map(|change| change.apply(root).err()).collect();
        if !problems.is_empty() {
            return Err(refused(problems));
        }
    }
    let problems = shape::check(&tree);
    if !problems.is_empty() {
        return Err(refused(problems));
    }
    let mut scenario: Scenario = serde_json::from_value(tree.to_json())
        .map_err(|error| refused(vec![Problem::at(&tree.place, "in this file", error.to_string())]))?;
    let unread = building::attach(&mut scenario, &tree).err();
    let problems: Vec<Problem> = meaning::check(&scenario, &tree).into_iter().chain(unread).collect();
    if problems.is_empty() { Ok(scenario) } else { Err(refused(problems)) }
}

/// Reads a source and all that it extends.
fn read_chain(source: &Source) -> Result<Node, Vec<Problem>> {
    read_link(source, &mut Vec::new()).map_err(|(_, problems)| problems)
}

/// Whether the problems are about opening the source itself, so that whoever refers to it is to blame.
type Refusal = (bool, Vec<Problem>);

fn read_link(source: &Source, chain: &mut Vec<Source>) -> Result<Node, Refusal> {
    chain.push(source.clone());
    let (document, text) = source.read(chain.len()).map_err(|problem| (problem.file().is_none(), vec![problem]))?;
    let node = tree::parse(&document, &text).map_err(|problems| (false, problems))?;
    extended(source, node, chain).map_err(|problems| (false, problems))
}

/// The tree laid over the one that it extends, if it extends any.
fn extended(source: &Source, mut node: Node, chain: &mut Vec<Source>) -> Result<Node, Vec<Problem>> {
    let Value::Table(table) = &mut node.value else { return Ok(node) };
    let Some(extends) = table.remove("extends") else { return Ok(node) };
    let place = &extends.node.place;
    let blame = |problem: Problem| vec![problem.moved_to(place)];
    let Some(target) = extends.node.text() else {
        let message = "`extends` must be a text: the path of a file or the name of an embedded scenario";
        return Err(vec![Problem::at(place, "not a text", message)]);
    };
    let parent = source.parent(target).map_err(blame)?;
    refuse_cycle(&parent, chain, place).map_err(|problem| vec![problem])?;
    let below = read_link(&parent, chain).map_err(|(to_blame, problems)| {
        let moved = |problem: Problem| if to_blame { problem.moved_to(place) } else { problem };
        problems.into_iter().map(moved).collect::<Vec<_>>()
    })?;
    if let (Value::Table(under), Value::Table(over)) = (below.value, &mut node.value) {
        *over = merge_tables(Some(schema::complete()), inherited(under), std::mem::take(over));
    }
    Ok(node)
}

/// What a file takes over from the one that it extends: all but the figure, since a variant is another picture.
fn inherited(mut under: Table) -> Table {
    under.remove("figure");
    under
}

fn refuse_cycle(parent: &Source, chain: &[Source], place: &Place) -> Result<(), Problem> {
    let names = || chain.iter().chain([parent]).map(Source::name).collect::<Vec<_>>().join(" -> ");
    if chain.iter().any(|link| link.identity() == parent.identity()) {
        let message = format!("{} extends itself: {}", quoted(&parent.title()), names());
        return Err(Problem::at(place, "back to the beginning", message));
    }
    if chain.len() >= LONGEST_CHAIN {
        let message = format!("more than {LONGEST_CHAIN} files extend one another");
        return Err(Problem::at(place, "one too many", message));
    }
    Ok(())
}
