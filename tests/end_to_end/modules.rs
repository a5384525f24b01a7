//! The graph of modules of every crate: no circles, and no two public types of one name.
//!
//! # What an edge is
//!
//! A module uses another if its code, or a private `use` of it, names something that the other defines; a re-export is
//! followed to the module that defines the item. `mod` and `pub use` alone are no use: that is how a folder shows what it
//! holds. Modules that are compiled for tests only are left out, for a test may use everything.
//!
//! # What a circle is
//!
//! At each level, the children of a module are nodes, each with all that lies below it, and the module's own items are one
//! more node. Their edges must have no circle. So siblings form an order at every level. A child may use what its parent
//! defines, and a parent may use what its children define, but not both with the same child.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;
use syn::{Attribute, Item, UseTree, Visibility};

use crate::architecture::{members, root};

/// Public types of one name in several modules of the workspace, and why that is no confusion.
const SHARED_NAMES: &[(&str, &str)] =
    &[("Settings", "each planner has its own, and its module is always named beside it: `idm::Settings`")];

/// The path of a module within its crate; the root's is empty.
type Place = Vec<String>;

/// The node of a level that stands for the module's own items.
const OWN: &str = "(own items)";

/// One module.
#[derive(Debug, Default)]
struct Module {
    children: BTreeSet<String>,
    /// Names that `use` brings in, with the path that each stands for.
    imports: BTreeMap<String, Vec<String>>,
    /// Modules of which `use` brings in everything.
    globs: Vec<Vec<String>>,
    /// Names that are defined here.
    items: BTreeSet<String>,
    /// Public structs, enums, traits and type aliases.
    public_types: BTreeSet<String>,
    /// Paths in code and private imports.
    used: Vec<Vec<String>>,
}

/// All modules of a crate.
#[derive(Debug, Default)]
struct Crate(BTreeMap<Place, Module>);

impl Crate {
    /// Reads a crate from its root file.
    fn read(root: &Path) -> Crate {
        let mut modules = Crate::default();
        let folder = root.parent().expect("a file lies in a folder");
        modules.read_file(Place::new(), root, folder);
        modules
    }

    /// Reads a module; files of its children lie in `folder`.
    fn read_file(&mut self, place: Place, file: &Path, folder: &Path) {
        let text = fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        let parsed = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        self.read_items(place, &parsed.items, folder);
    }

    fn read_items(&mut self, place: Place, items: &[Item], folder: &Path) {
        let mut module = Module::default();
        for item in items {
            match item {
                Item::Mod(child) if is_for_tests(&child.attrs) => {}
                Item::Mod(child) => {
                    let name = child.ident.to_string();
                    let below = [&place[..], std::slice::from_ref(&name)].concat();
                    match &child.content {
                        Some((_, items)) => self.read_items(below, items, &folder.join(&name)),
                        None => self.read_file(below, &file_of(folder, &name), &folder.join(&name)),
                    }
                    module.children.insert(name);
                }
                Item::Use(import) if is_for_tests(&import.attrs) => {}
                Item::Use(import) => module.import(&import.tree, matches!(import.vis, Visibility::Inherited)),
                _ => module.define(item),
            }
        }
        self.0.insert(place, module);
    }

    /// The module that defines what `path`, seen from `from`, leads to; `None` if that is outside of this crate.
    fn resolve(&self, from: &Place, path: &[String], hops: usize) -> Option<Place> {
        let (first, rest) = path.split_first()?;
        match first.as_str() {
            "crate" => self.descend(Place::new(), rest, hops),
            "self" => self.descend(from.clone(), rest, hops),
            "super" => {
                let (_, parent) = from.split_last()?;
                // `super::super` goes on from the parent.
                let more = rest.iter().take_while(|word| *word == "super").count();
                let above = parent.get(..parent.len().checked_sub(more)?)?.to_vec();
                self.descend(above, &rest[more..], hops)
            }
            _ if self.0[from].children.contains(first) || self.0[from].imports.contains_key(first) => {
                self.descend(from.clone(), path, hops)
            }
            _ => None,
        }
    }

    /// The same, from a module downwards.
    fn descend(&self, at: Place, path: &[String], hops: usize) -> Option<Place> {
        let hops = hops.checked_sub(1)?;
        let module = self.0.get(&at)?;
        let Some((first, rest)) = path.split_first() else { return Some(at) };
        if module.children.contains(first) {
            return self.descend([at, vec![first.clone()]].concat(), rest, hops);
        }
        if module.items.contains(first) {
            return Some(at);
        }
        if let Some(import) = module.imports.get(first) {
            return self.resolve(&at, &[import, rest].concat(), hops);
        }
        let globs = module.globs.iter().filter_map(|glob| self.resolve(&at, glob, hops));
        globs.filter(|place| *place != at).find(|place| self.0[place].items.contains(first)).or(Some(at))
    }

    /// The edges of each level, each with a place where it comes from.
    fn edges(&self) -> BTreeMap<Place, BTreeMap<(String, String), String>> {
        let mut edges: BTreeMap<Place, BTreeMap<(String, String), String>> = BTreeMap::new();
        for (source, module) in &self.0 {
            for path in &module.used {
                let Some(target) = self.resolve(source, path, 32) else { continue };
                let common = source.iter().zip(&target).take_while(|(a, b)| a == b).count();
                let node = |place: &Place| place.get(common).cloned().unwrap_or_else(|| OWN.to_owned());
                let (from, to) = (node(source), node(&target));
                if from != to {
                    let level = edges.entry(source[..common].to_vec()).or_default();
                    level.entry((from, to)).or_insert_with(|| format!("{}: {}", source.join("::"), path.join("::")));
                }
            }
        }
        edges
    }
}

impl Module {
    /// Takes in what a `use` says. A private one is a use of what it names.
    fn import(&mut self, tree: &UseTree, private: bool) {
        let mut found = Vec::new();
        flatten(tree, &mut Vec::new(), &mut found);
        for (path, name) in found {
            if private {
                self.used.push(path.clone());
            }
            match name {
                Some(name) => drop(self.imports.insert(name, path)),
                None => self.globs.push(path),
            }
        }
    }

    /// Takes in what an item defines and which paths it names.
    fn define(&mut self, item: &Item) {
        let (name, public) = match item {
            Item::Struct(item) => (Some(&item.ident), Some(&item.vis)),
            Item::Enum(item) => (Some(&item.ident), Some(&item.vis)),
            Item::Trait(item) => (Some(&item.ident), Some(&item.vis)),
            Item::Type(item) => (Some(&item.ident), Some(&item.vis)),
            Item::Fn(item) => (Some(&item.sig.ident), None),
            Item::Const(item) => (Some(&item.ident), None),
            Item::Static(item) => (Some(&item.ident), None),
            Item::Macro(item) => (item.ident.as_ref(), None),
            _ => (None, None),
        };
        let Some(name) = name.map(ToString::to_string) else {
            return collect_paths(item.to_token_stream(), &mut self.used);
        };
        if matches!(public, Some(Visibility::Public(_))) {
            self.public_types.insert(name.clone());
        }
        self.items.insert(name);
        collect_paths(item.to_token_stream(), &mut self.used);
    }
}

/// Whether `#[cfg(test)]` stands on it.
fn is_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| attribute.to_token_stream().to_string().replace(' ', "") == "#[cfg(test)]")
}

/// The file of a module that is declared in a folder.
fn file_of(folder: &Path, name: &str) -> PathBuf {
    let file = folder.join(format!("{name}.rs"));
    if file.exists() { file } else { folder.join(name).join("mod.rs") }
}

/// The paths of a `use`, each with the name that it brings in; no name for everything.
fn flatten(tree: &UseTree, path: &mut Vec<String>, found: &mut Vec<(Vec<String>, Option<String>)>) {
    let with = |path: &[String], name: String| if name == "self" { path.to_vec() } else { [path, &[name]].concat() };
    match tree {
        UseTree::Path(step) => {
            path.push(step.ident.to_string());
            flatten(&step.tree, path, found);
            path.pop();
        }
        UseTree::Name(name) => {
            let whole = with(path, name.ident.to_string());
            found.push((whole.clone(), whole.last().cloned()));
        }
        UseTree::Rename(name) => found.push((with(path, name.ident.to_string()), Some(name.rename.to_string()))),
        UseTree::Glob(_) => found.push((path.clone(), None)),
        UseTree::Group(group) => group.items.iter().for_each(|tree| flatten(tree, path, found)),
    }
}

/// Every `a::b::c` in some code, also inside macros.
fn collect_paths(code: TokenStream, found: &mut Vec<Vec<String>>) {
    let mut path: Vec<String> = Vec::new();
    let mut colons = 0;
    let mut end = |path: &mut Vec<String>| {
        if path.len() > 1 {
            found.push(path.clone());
        }
        path.clear();
    };
    let mut inner = Vec::new();
    let mut visibility = false;
    for token in code {
        // `pub(in crate::a)` says who may see something, and uses nothing.
        let is_restriction = visibility && matches!(token, TokenTree::Group(_));
        visibility = matches!(&token, TokenTree::Ident(word) if word == "pub");
        match token {
            _ if is_restriction => end(&mut path),
            TokenTree::Ident(word) => {
                if colons != 2 {
                    end(&mut path);
                }
                path.push(word.to_string());
                colons = 0;
            }
            TokenTree::Punct(mark) if mark.as_char() == ':' => colons += 1,
            other => {
                end(&mut path);
                colons = 0;
                if let TokenTree::Group(group) = other {
                    inner.push(group.stream());
                }
            }
        }
    }
    end(&mut path);
    inner.into_iter().for_each(|code| collect_paths(code, found));
}

/// The nodes of a level from which a way leads back to them.
fn on_circles(edges: &BTreeMap<(String, String), String>) -> BTreeSet<&str> {
    let reached = |from: &str| {
        let mut reached = BTreeSet::new();
        let mut open = vec![from];
        while let Some(node) = open.pop() {
            let next = edges.keys().filter(|(a, _)| a == node).map(|(_, b)| b.as_str());
            open.extend(next.filter(|node| reached.insert(*node)).collect::<Vec<_>>());
        }
        reached
    };
    edges.keys().map(|(from, _)| from.as_str()).filter(|node| reached(node).contains(node)).collect()
}

/// Every library of the workspace.
fn libraries() -> Vec<(String, Crate)> {
    let roots = members().into_iter().map(|member| (root().join(&member).join("src/lib.rs"), member));
    roots.filter(|(file, _)| file.exists()).map(|(file, member)| (member, Crate::read(&file))).collect()
}

#[test]
fn modules_form_no_circles() {
    let mut circles = Vec::new();
    for (member, modules) in libraries() {
        for (level, edges) in modules.edges() {
            let level = level.join("::");
            let nodes = on_circles(&edges);
            for ((from, to), example) in &edges {
                if nodes.contains(from.as_str()) && nodes.contains(to.as_str()) {
                    circles.push(format!("{member} at `{level}`: {from} -> {to}, in {example}"));
                }
            }
        }
    }
    assert!(circles.is_empty(), "{} edges on circles:\n{}", circles.len(), circles.join("\n"));
}

#[test]
fn a_public_type_s_name_is_in_one_module_only() {
    let mut places: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (member, modules) in libraries() {
        for (place, module) in &modules.0 {
            for name in &module.public_types {
                places.entry(name.clone()).or_default().push(format!("{member}: {}", place.join("::")));
            }
        }
    }
    let shared = |(name, _): &(&str, &str)| places.get(*name).is_some_and(|places| places.len() > 1);
    let outdated: Vec<_> = SHARED_NAMES.iter().filter(|entry| !shared(entry)).collect();
    assert!(outdated.is_empty(), "not shared any more: {outdated:?}");
    places.retain(|name, places| places.len() > 1 && !SHARED_NAMES.iter().any(|(known, _)| known == name));
    assert!(places.is_empty(), "{} names are shared without a reason: {places:#?}", places.len());
}

/// The rules see what they are to see: a made-up crate with a circle of siblings, one of a parent and its child, and
/// none where a child only shows what it holds.
#[test]
fn circles_are_found_where_there_are_some() {
    let circles = |files: &[(&str, &str)]| {
        let mut modules = Crate::default();
        for (place, code) in files {
            let place: Place = place.split("::").filter(|word| !word.is_empty()).map(str::to_owned).collect();
            let parsed = syn::parse_file(code).expect("sound code");
            let mut module = Module::default();
            for item in &parsed.items {
                match item {
                    Item::Mod(child) => drop(module.children.insert(child.ident.to_string())),
                    Item::Use(import) => module.import(&import.tree, matches!(import.vis, Visibility::Inherited)),
                    _ => module.define(item),
                }
            }
            modules.0.insert(place, module);
        }
        let edges = modules.edges();
        edges.values().map(|level| on_circles(level).len()).sum::<usize>()
    };
    let root = ("", "mod a; mod b; pub use a::A;");
    let a = ("a", "pub struct A; fn f() { vec![crate::b::B::new()]; }");
    assert_eq!(circles(&[root, a, ("b", "use crate::A; pub struct B;")]), 2);
    assert_eq!(circles(&[root, a, ("b", "/// [`crate::A`]\npub struct B;")]), 0);
    let parent = ("", "mod a; pub use a::A; pub struct P;");
    assert_eq!(circles(&[parent, ("a", "pub struct A(super::P);")]), 0);
    let parent = ("", "mod a; use a::A; pub struct P(A);");
    assert_eq!(circles(&[parent, ("a", "use super::P; pub struct A;")]), 2);
}
