//! The graph of modules of every crate: no circles, and no two public types of one name.
//!
//! # What an edge is
//!
//! A module uses another if its code, or a private `use` of it, names something that the other defines; a re-export is
//! followed to the module that defines the item. `mod` and `pub use` alone are no use: that is how a folder shows what it
//! holds. But if the module's own code names what it re-exports, that is a use. Modules and functions that are compiled for
//! tests only are left out, for a test may use everything.
//!
//! A module also uses another if it calls a method that the other implements. Types are not inferred, so these calls are seen:
//!
//! - `self.method()`, `Self::method` and `Type::method`, wherever the type's method is;
//! - `value.method()`, if the method is implemented outside of the module that defines its type, and if no other type or trait
//!   of the crate has a method of that name.
//!
//! # What a circle is
//!
//! At each level, the children of a module are nodes, each with all that lies below it, and the module's own items are one
//! more node. Their edges must have no circle. So siblings form an order at every level. A child may use what its parent
//! defines, and a parent may use what its children define, but not both with the same child.

mod graph;
mod module;

use std::collections::BTreeMap;

use syn::Item;

use self::graph::{Crate, Place, on_circles};
use self::module::Module;
use crate::architecture::{members, root};

/// Public types of one name in several modules of the workspace, and why that is not confusing.
const SHARED_NAMES: &[(&str, &str)] =
    &[("Settings", "each planner has its own, and its module is always named beside it: `idm::Settings`")];

/// Levels that may have circles, by crate and parent module, and why.
const ACCEPTED_CIRCLES: &[(&str, &str, &str)] = &[
    ("app/simulation", "simulation", "a simulation makes snapshots, and a snapshot resumes simulations"),
    (
        "app/simulation",
        "state::standing",
        "each kind of reason is a method, in a file of its own, of the type that the folder defines",
    ),
    ("app/simulation", "plants", "an error of a plant wraps that of BOPTEST, whose plant is one of them"),
    (
        "app/cli",
        "run_outputs",
        "the list of outputs names each file, and each file implements the trait beside the list",
    ),
    ("app/fmu", "description", "one description has the forms of two versions of the standard"),
    ("app/play", "server", "the server starts a game with the options that it was given"),
    ("app/presentation", "figures", "an entry names its drawing, and a drawing reads its entry"),
    ("app/presentation", "plot", "a drawing is written by a backend, whose size it asks for"),
    ("app/presentation", "record", "the layers of a recording share the types of the folder"),
    ("building", "identify", "settings, telemetry and state space share the types of the folder"),
    ("building", "identify::state_space::wrong_world", "each test of a wrong world is given the world of the folder"),
    ("building", "network", "openings are a part of a network and are found from it"),
    ("building", "sun", "the sky model is given the plane that it shines on"),
    ("building", "weather", "the sky is computed from the weather that holds it"),
    ("planners", "traffic", "the steps of a tick are methods of the traffic that the folder defines"),
    ("scenarios", "commonroad", "a map is imported with the options of the folder"),
];

fn libraries() -> Vec<(String, Crate)> {
    let roots = members().into_iter().map(|member| (root().join(&member).join("src/lib.rs"), member));
    roots.filter(|(file, _)| file.exists()).map(|(file, member)| (member, Crate::read(&file))).collect()
}

#[test]
fn modules_have_no_cyclic_dependencies() {
    let mut circles = Vec::new();
    let mut outdated = ACCEPTED_CIRCLES.to_vec();
    for (member, modules) in libraries() {
        for (level, edges) in modules.edges() {
            let level = level.join("::");
            let nodes = on_circles(&edges);
            let is_accepted = |(crate_, parent, _): &(&str, &str, &str)| *crate_ == member && *parent == level;
            outdated.retain(|entry| !is_accepted(entry) || nodes.is_empty());
            if ACCEPTED_CIRCLES.iter().any(is_accepted) {
                continue;
            }
            for ((from, to), example) in &edges {
                if nodes.contains(from.as_str()) && nodes.contains(to.as_str()) {
                    circles.push(format!("{member} at `{level}`: {from} -> {to}, in {example}"));
                }
            }
        }
    }
    assert!(circles.is_empty(), "{} edges on circles:\n{}", circles.len(), circles.join("\n"));
    assert!(outdated.is_empty(), "no circles any more: {outdated:?}");
}

#[test]
fn each_public_type_name_occurs_in_one_module_only() {
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

/// The number of nodes on circles in a made-up crate, given as modules with their code.
fn nodes_on_circles(files: &[(&str, &str)]) -> usize {
    let mut modules = Crate::default();
    for (place, code) in files {
        let place: Place = place.split("::").filter(|word| !word.is_empty()).map(str::to_owned).collect();
        let parsed = syn::parse_file(code).expect("sound code");
        let mut module = Module::default();
        for item in &parsed.items {
            match item {
                Item::Mod(child) => drop(module.children.insert(child.ident.to_string())),
                _ => module.read(item),
            }
        }
        modules.0.insert(place, module);
    }
    modules.edges().values().map(|level| on_circles(level).len()).sum()
}

/// A circle of siblings and one of a parent and its child are found, and none where a parent only shows what its child holds.
#[test]
fn cyclic_dependencies_through_paths_are_found() {
    let root = ("", "mod a; mod b; pub use a::A;");
    let a = ("a", "pub struct A; fn f() { vec![crate::b::B::new()]; }");
    assert_eq!(nodes_on_circles(&[root, a, ("b", "use crate::A; pub struct B;")]), 2);
    assert_eq!(nodes_on_circles(&[root, a, ("b", "/// [`crate::A`]\npub struct B;")]), 0);
    let parent = ("", "mod a; pub use a::A; pub struct P;");
    assert_eq!(nodes_on_circles(&[parent, ("a", "pub struct A(super::P);")]), 0);
    let parent = ("", "mod a; use a::A; pub struct P(A);");
    assert_eq!(nodes_on_circles(&[parent, ("a", "use super::P; pub struct A;")]), 2);
}

#[test]
fn cycles_through_re_exports_of_a_parent_are_found() {
    let child = ("a", "pub struct A(super::P);");
    for import in ["pub use a::A;", "pub(crate) use a::A;", "pub use a::*;"] {
        let parent = |code: &str| format!("mod a; {import} pub struct P; {code}");
        assert_eq!(nodes_on_circles(&[("", &parent("")), child]), 0, "{import}");
        assert_eq!(nodes_on_circles(&[("", &parent("impl A { fn f() {} }")), child]), 2, "{import}");
        assert_eq!(nodes_on_circles(&[("", &parent("fn f(a: Vec<A>) {}")), child]), 2, "{import}");
        assert_eq!(nodes_on_circles(&[("", &parent("fn f(p: P) { p.A; }")), child]), 0, "{import}: a field");
        assert_eq!(nodes_on_circles(&[("", &parent("#[cfg(test)] fn f(a: A) {}")), child]), 0, "{import}: for tests");
    }
}

#[test]
fn cycles_through_methods_that_a_child_implements_are_found() {
    let child = ("a", "use super::P; impl P { pub fn m(&self) {} }");
    let parent = |code: &str| format!("mod a; pub struct P; pub struct Q; {code}");
    let calls = ["impl P { fn f(&self) { self.m() } }", "impl P { fn f() { Self::m } }", "fn f() { P::m }"];
    for call in
        calls.into_iter().chain(["fn f(p: P) { p.m() }", "struct R { p: P } impl R { fn f(&self) { self.p.m() } }"])
    {
        assert_eq!(nodes_on_circles(&[("", &parent(call)), child]), 2, "{call}");
    }
    for none in ["impl Q { fn m(&self) {} fn f(&self) { self.m() } }", "fn f(p: P) { p.m }", "fn f() { Q::m }"] {
        assert_eq!(nodes_on_circles(&[("", &parent(none)), child]), 0, "{none}");
    }
    let sibling = ("b", "pub struct P; impl P { fn f(&self) { self.m() } }");
    assert_eq!(nodes_on_circles(&[("", "mod a; mod b;"), ("a", "impl crate::b::P { fn m(&self) {} }"), sibling]), 2);
}
