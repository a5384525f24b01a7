//! One module: what it defines, brings in, implements and names.

use std::collections::{BTreeMap, BTreeSet};

use quote::ToTokens;
use syn::{Attribute, ImplItem, Item, ItemImpl, TraitItem, Type, UseTree, Visibility};

use super::uses::Uses;

#[derive(Debug, Default)]
pub struct Module {
    pub children: BTreeSet<String>,
    /// Names that `use` brings in, with the path that each stands for.
    pub imports: BTreeMap<String, Vec<String>>,
    /// Modules of which `use` brings in everything.
    pub globs: Vec<Vec<String>>,
    pub items: BTreeSet<String>,
    /// Public structs, enums, traits and type aliases.
    pub public_types: BTreeSet<String>,
    /// Methods, associated functions and constants that types are given here, each with the path of its type.
    pub methods: Vec<(Vec<String>, String)>,
    /// Names of methods of traits: declared here, or implemented here for a type.
    pub trait_methods: BTreeSet<String>,
    /// What code and private imports name.
    pub used: Uses,
}

impl Module {
    /// Takes in all items but modules.
    pub fn read(&mut self, item: &Item) {
        match item {
            Item::Mod(_) => {}
            Item::Use(import) if is_for_tests(&import.attrs) => {}
            Item::Use(import) => self.import(&import.tree, matches!(import.vis, Visibility::Inherited)),
            Item::Impl(block) if is_for_tests(&block.attrs) => {}
            Item::Impl(block) => self.implement(block),
            Item::Fn(function) if is_for_tests(&function.attrs) => {}
            _ => self.define(item),
        }
    }

    /// Whether a path that begins with this word begins in this module.
    pub fn names(&self, word: &str) -> bool {
        self.children.contains(word) || self.imports.contains_key(word) || self.items.contains(word)
    }

    /// Takes in what a `use` says. A private one is a use of what it names.
    fn import(&mut self, tree: &UseTree, private: bool) {
        let mut found = Vec::new();
        flatten(tree, &mut Vec::new(), &mut found);
        for (path, name) in found {
            if private {
                self.used.paths.push(path.clone());
            }
            match name {
                Some(name) => drop(self.imports.insert(name, path)),
                None => self.globs.push(path),
            }
        }
    }

    /// Takes in what is implemented for a type, and what that names.
    fn implement(&mut self, block: &ItemImpl) {
        let own: Vec<String> = match &*block.self_ty {
            Type::Path(path) => path.path.segments.iter().map(|word| word.ident.to_string()).collect(),
            _ => Vec::new(),
        };
        let mut block = block.clone();
        block.items.retain(|item| !matches!(item, ImplItem::Fn(function) if is_for_tests(&function.attrs)));
        for item in &block.items {
            let name = match item {
                ImplItem::Fn(function) => function.sig.ident.to_string(),
                ImplItem::Const(constant) => constant.ident.to_string(),
                _ => continue,
            };
            match block.trait_ {
                Some(_) => drop(self.trait_methods.insert(name)),
                None => self.methods.push((own.clone(), name)),
            }
        }
        self.used.collect(block.into_token_stream(), &own);
    }

    /// Takes in what an item defines and what it names.
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
        if let Item::Trait(item) = item {
            self.trait_methods.extend(item.items.iter().filter_map(|item| match item {
                TraitItem::Fn(function) => Some(function.sig.ident.to_string()),
                _ => None,
            }));
        }
        if let Some(name) = name.map(ToString::to_string) {
            if matches!(public, Some(Visibility::Public(_))) {
                self.public_types.insert(name.clone());
            }
            self.items.insert(name);
        }
        self.used.collect(item.to_token_stream(), &[]);
    }
}

/// Whether `#[cfg(test)]` stands on it.
pub fn is_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| attribute.to_token_stream().to_string().replace(' ', "") == "#[cfg(test)]")
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
