//! Merges a file and all files that it extends into one tree.

use crate::commonroad::{ImportOptions, Imported, import_file, is_commonroad};
use crate::format::json_schema::SchemaNode;
use crate::format::read::merge::merge_tables;
use crate::format::read::source::Source;
use crate::format::read::tree::{self, Table, TomlNode, TomlValue};
use crate::text::error::{Fault, Place, quoted};

/// The most files of a chain of `extends`.
const MAX_CHAIN_LENGTH: usize = 16;

#[derive(Clone, Copy, PartialEq)]
pub(super) enum NamedBy {
    /// The user of the command: errors may show the text of the source.
    Command,
    /// Another file, whose author may not be the user: errors show no text of a file that is not a scenario.
    File,
}

/// Whether the faults are about the source as a whole, so that the reference to it is to blame.
pub(super) type Refusal = (bool, Vec<Fault>);

/// The faults of a source that is named at `place`.
pub(super) fn blamed_on(place: &Place, (to_blame, faults): Refusal) -> Vec<Fault> {
    let moved = |fault: Fault| if to_blame { fault.moved_to(place) } else { fault };
    faults.into_iter().map(moved).collect()
}

/// Reads a source and all that it extends.
pub(super) fn read_link(
    source: &Source,
    named_by: NamedBy,
    chain: &mut Vec<Source>,
    schema: SchemaNode,
) -> Result<TomlNode, Refusal> {
    chain.push(source.clone());
    let is_foreign = named_by == NamedBy::File;
    if let Source::File(path) = source
        && is_commonroad(path)
    {
        let imported = import_file(path, &ImportOptions::default());
        return imported.map(Imported::into_tree).map_err(|fault| (fault.file().is_none(), vec![fault]));
    }
    let unread = |fault: Fault| (is_foreign || fault.file().is_none(), vec![fault]);
    let (document, text) = source.read(chain.len()).map_err(unread)?;
    let unparsed = |faults| if is_foreign { vec![no_scenario(source, faults)] } else { faults };
    let node = tree::parse(&document, &text).map_err(|faults| (is_foreign, unparsed(faults)))?;
    extended(source, node, chain, schema).map_err(|faults| (false, faults))
}

/// The fault of a source that is not TOML, without its text.
fn no_scenario(source: &Source, faults: Vec<Fault>) -> Fault {
    let title = quoted(&source.title());
    let line = faults.iter().filter_map(Fault::line_and_column).map(|(line, _)| line).min().unwrap_or(1);
    Fault::new(format!("{title} is not a scenario: its line {line} is not valid TOML"))
        .help(format!("name a scenario; if it is one, `interplay check` of {title} itself shows what is wrong there"))
}

/// The tree merged into the one that it extends, if any.
pub(super) fn extended(
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
    let below = read_link(&parent, NamedBy::File, chain, schema).map_err(|refusal| blamed_on(place, refusal))?;
    if let (TomlValue::Table(under), TomlValue::Table(over)) = (below.value, &mut node.value) {
        *over = merge_tables(Some(schema), inherited(under), std::mem::take(over));
    }
    Ok(node)
}

/// The keys that a file inherits from the one that it extends: all but the figure, which a variant does not reproduce, and the
/// counterfactuals, which explain the outcome of the parent.
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
