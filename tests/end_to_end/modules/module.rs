//! One module: what it defines, brings in, implements and names.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;
use syn::{Attribute, ImplItem, Item, ItemImpl, TraitItem, Type, UseTree, Visibility};

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

#[derive(Debug, Default)]
pub struct Uses {
    /// Paths of at least two words.
    pub paths: Vec<Vec<String>>,
    /// Words that stand alone, and are neither fields nor methods.
    pub words: BTreeSet<String>,
    /// Methods that are called on `self`, with the path of the type that implements the calling function.
    pub own_calls: BTreeSet<(Vec<String>, String)>,
    /// Methods that are called on anything else.
    pub calls: BTreeSet<String>,
}

impl Uses {
    /// Takes in what some code names, also inside macros. `own` is the path of the type that `Self` stands for, if any.
    pub fn collect(&mut self, code: TokenStream, own: &[String]) {
        let tokens: Vec<TokenTree> = code.into_iter().collect();
        let is_mark = |index: Option<usize>, mark: char| {
            let token = index.and_then(|index| tokens.get(index));
            matches!(token, Some(TokenTree::Punct(punct)) if punct.as_char() == mark)
        };
        let is_word = |index: Option<usize>, text: &str| {
            let token = index.and_then(|index| tokens.get(index));
            matches!(token, Some(TokenTree::Ident(word)) if word == text)
        };
        let mut index = 0;
        while let Some(token) = tokens.get(index) {
            match token {
                // `pub(in crate::a)` says who may see something, and uses nothing.
                TokenTree::Group(_) if is_word(index.checked_sub(1), "pub") => {}
                TokenTree::Group(group) => self.collect(group.stream(), own),
                // The end of a range is not a field.
                TokenTree::Ident(word) if is_mark(index.checked_sub(1), '.') && !is_mark(index.checked_sub(2), '.') => {
                    let has_types = is_mark(Some(index + 1), ':') && is_mark(Some(index + 2), ':');
                    if has_types || matches!(tokens.get(index + 1), Some(TokenTree::Group(_))) {
                        let is_own = is_word(index.checked_sub(2), "self") && !is_mark(index.checked_sub(3), '.');
                        self.call(word.to_string(), if is_own { own } else { &[] });
                    }
                }
                TokenTree::Ident(word) => {
                    let mut path = vec![word.to_string()];
                    while let (true, true, Some(TokenTree::Ident(next))) =
                        (is_mark(Some(index + 1), ':'), is_mark(Some(index + 2), ':'), tokens.get(index + 3))
                    {
                        path.push(next.to_string());
                        index += 3;
                    }
                    self.name(path, own);
                }
                _ => {}
            }
            index += 1;
        }
    }

    fn call(&mut self, method: String, own: &[String]) {
        match own {
            [] => self.calls.insert(method),
            own => self.own_calls.insert((own.to_vec(), method)),
        };
    }

    fn name(&mut self, path: Vec<String>, own: &[String]) {
        match &path[..] {
            [word] => drop(self.words.insert(word.clone())),
            [first, rest @ ..] if first == "Self" && !own.is_empty() => self.paths.push([own, rest].concat()),
            _ => self.paths.push(path),
        }
    }
}
