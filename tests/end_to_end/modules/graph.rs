//! The modules of a crate, and the edges and circles between them.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use syn::Item;

use super::module::{Module, is_for_tests};

/// The path of a module within its crate; the root's is empty.
pub type Place = Vec<String>;

/// The node of a level that stands for the module's own items.
const OWN: &str = "(own items)";

/// An item: the module that defines it, and its name with what follows the name in a path. No name for a module itself.
type Found = (Place, Vec<String>);

/// Where the methods of a crate are.
#[derive(Debug, Default)]
struct Methods {
    /// The module that implements a type's method; the type is given by its module and its name.
    of_type: BTreeMap<(Place, String), BTreeMap<String, Place>>,
    /// The modules of all methods of one name that are implemented outside of their type's module.
    apart: BTreeMap<String, BTreeSet<Place>>,
    /// Names of methods that are in their type's module or belong to a trait.
    in_place: BTreeSet<String>,
}

#[derive(Debug, Default)]
pub struct Crate(pub BTreeMap<Place, Module>);

impl Crate {
    pub fn read(root: &Path) -> Crate {
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
        // A macro that is given modules declares them, and lists what they hold.
        let declared = items.iter().filter_map(|item| if let Item::Macro(call) = item { Some(call) } else { None });
        let declared = declared.filter_map(|call| syn::parse2::<syn::File>(call.mac.tokens.clone()).ok());
        let declared: Vec<Item> = declared.flat_map(|file| file.items).collect();
        for item in items.iter().chain(&declared) {
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
                _ => module.read(item),
            }
        }
        self.0.insert(place, module);
    }

    /// The item of this crate to which `path`, seen from `from`, leads; `None` if it is outside of this crate.
    fn resolve(&self, from: &Place, path: &[String], hops: usize) -> Option<Found> {
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
            _ if self.0[from].names(first) => self.descend(from.clone(), path, hops),
            _ => None,
        }
    }

    /// The same, from a module downwards.
    fn descend(&self, at: Place, path: &[String], hops: usize) -> Option<Found> {
        let hops = hops.checked_sub(1)?;
        let module = self.0.get(&at)?;
        let Some((first, rest)) = path.split_first() else { return Some((at, Vec::new())) };
        if module.children.contains(first) {
            return self.descend([at, vec![first.clone()]].concat(), rest, hops);
        }
        if module.items.contains(first) {
            return Some((at, path.to_vec()));
        }
        if let Some(import) = module.imports.get(first) {
            return self.resolve(&at, &[import, rest].concat(), hops);
        }
        let place = self.in_globs(&at, first, hops).unwrap_or(at);
        Some((place, path.to_vec()))
    }

    /// The module that defines an item which `use` brings in together with everything else of that module.
    fn in_globs(&self, at: &Place, item: &str, hops: usize) -> Option<Place> {
        let globs = self.0[at].globs.iter().filter_map(|glob| self.resolve(at, glob, hops)).map(|(place, _)| place);
        globs.filter(|place| place != at).find(|place| self.0[place].items.contains(item))
    }

    /// Where the methods of all types are.
    fn methods(&self) -> Methods {
        let mut methods = Methods::default();
        for (place, module) in &self.0 {
            methods.in_place.extend(module.trait_methods.iter().cloned());
            for (path, method) in &module.methods {
                let Some((home, words)) = self.resolve(place, path, 32) else { continue };
                let Some(name) = words.first() else { continue };
                if home == *place {
                    methods.in_place.insert(method.clone());
                } else {
                    methods.apart.entry(method.clone()).or_default().insert(place.clone());
                }
                methods.of_type.entry((home, name.clone())).or_default().insert(method.clone(), place.clone());
            }
        }
        methods
    }

    /// The modules that one module uses, each with the words that use it.
    fn used_by(&self, source: &Place, methods: &Methods) -> Vec<(Place, String)> {
        let module = &self.0[source];
        let mut targets = Vec::new();
        let method_of = |found: &Found, method: &str| {
            let name = found.1.first()?.clone();
            methods.of_type.get(&(found.0.clone(), name))?.get(method).cloned()
        };
        for path in &module.used.paths {
            let Some(found) = self.resolve(source, path, 32) else { continue };
            let method = found.1.get(1).and_then(|method| method_of(&found, method));
            targets.extend(method.into_iter().chain([found.0]).map(|place| (place, path.join("::"))));
        }
        for word in module.used.words.iter().filter(|word| !module.items.contains(*word)) {
            let import = module.imports.get(word).and_then(|path| self.resolve(source, path, 32));
            let place = import.map(|(place, _)| place).or_else(|| self.in_globs(source, word, 32));
            targets.extend(place.map(|place| (place, word.clone())));
        }
        for (path, method) in &module.used.own_calls {
            let found = self.resolve(source, path, 32);
            let place = found.and_then(|found| method_of(&found, method));
            targets.extend(place.map(|place| (place, format!("self.{method}()"))));
        }
        for method in module.used.calls.iter().filter(|method| !methods.in_place.contains(*method)) {
            let places = methods.apart.get(method).filter(|places| places.len() == 1);
            targets.extend(places.into_iter().flatten().map(|place| (place.clone(), format!(".{method}()"))));
        }
        targets
    }

    /// The edges of each level, each with a place where it comes from.
    pub fn edges(&self) -> BTreeMap<Place, BTreeMap<(String, String), String>> {
        let methods = self.methods();
        let mut edges: BTreeMap<Place, BTreeMap<(String, String), String>> = BTreeMap::new();
        for source in self.0.keys() {
            for (target, words) in self.used_by(source, &methods) {
                let common = source.iter().zip(&target).take_while(|(a, b)| a == b).count();
                let node = |place: &Place| place.get(common).cloned().unwrap_or_else(|| OWN.to_owned());
                let (from, to) = (node(source), node(&target));
                if from != to {
                    let level = edges.entry(source[..common].to_vec()).or_default();
                    level.entry((from, to)).or_insert_with(|| format!("{}: {words}", source.join("::")));
                }
            }
        }
        edges
    }
}

/// The file of a module that is declared in a folder.
fn file_of(folder: &Path, name: &str) -> PathBuf {
    let file = folder.join(format!("{name}.rs"));
    if file.exists() { file } else { folder.join(name).join("mod.rs") }
}

/// The nodes of a level from which a way leads back to them.
pub fn on_circles(edges: &BTreeMap<(String, String), String>) -> BTreeSet<&str> {
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
