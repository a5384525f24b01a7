//! The files that a scenario is made of.

use std::path::PathBuf;

use crate::source::Source;
use crate::tree;

/// The scenario file and those that it extends, as far as they can be read: what to look at to see whether it has changed.
/// Scenarios in the binary never change and are not among them.
pub fn files(name_or_path: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut next = Source::find(name_or_path).ok();
    while let Some(source @ Source::File(path)) = &next {
        if found.contains(path) {
            break;
        }
        found.push(path.clone());
        next = parent(source);
    }
    found
}

/// What a file extends, if it can be read that far.
fn parent(source: &Source) -> Option<Source> {
    let (document, text) = source.read(1).ok()?;
    let node = tree::parse(&document, &text).ok()?;
    source.parent(node.table()?.get("extends")?.node.text()?).ok()
}
