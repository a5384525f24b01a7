//! The rules of this repository: which crate may depend on which, which folder may name which library, how long a file may
//! be, and that no dependency is built twice.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use toml::Table;

/// Each crate and the crates that it may depend on. Data flows one way.
const ARROWS: &[(&str, &[&str])] = &[
    ("common", &[]),
    ("convex", &[]),
    ("planners", &["common", "convex"]),
    ("building", &["common", "convex"]),
    ("scenarios", &["common", "planners", "building"]),
    ("app/fmu_host", &[]),
    ("app/simulation", &["common", "planners", "building", "scenarios", "app/fmu_host"]),
    ("app/files", &[]),
    ("app/recordings", &["common", "planners", "scenarios"]),
    ("app/fmu", &["building", "scenarios", "app/simulation"]),
    ("app/tables", &["scenarios", "app/files", "app/simulation"]),
    ("app/sweep", &["common", "scenarios", "app/files", "app/simulation", "app/tables"]),
    ("app/bench", &["planners", "scenarios", "app/files", "app/simulation", "app/sweep"]),
    (
        "app/presentation",
        &["common", "planners", "building", "scenarios", "app/files", "app/recordings", "app/simulation", "app/sweep"],
    ),
    ("app/play", &["planners", "scenarios", "app/files", "app/simulation", "app/sweep", "app/presentation"]),
    (
        "app/cli",
        &[
            "common",
            "app/play",
            "planners",
            "building",
            "scenarios",
            "app/files",
            "app/recordings",
            "app/simulation",
            "app/fmu",
            "app/fmu_host",
            "app/sweep",
            "app/bench",
            "app/presentation",
        ],
    ),
    ("examples/own-planner", &["planners", "building", "scenarios", "app/simulation", "app/cli"]),
    ("tests", &["common", "planners", "building", "scenarios", "app/simulation", "app/sweep", "app/cli"]),
];

/// Libraries that only one crate may depend on, or those that are listed.
const OWNERS: &[(&str, &str)] = &[
    ("rand_chacha", "common"),
    ("strsim", "common"),
    ("clarabel", "convex"),
    ("libloading", "app/fmu_host"),
    ("roxmltree", "scenarios"),
    ("roxmltree", "app/fmu_host"),
    ("bevy", "app/simulation"),
    ("rapier", "app/simulation"),
    ("parry", "app/simulation"),
    ("parquet", "app/tables"),
    ("rerun", "app/presentation"),
    ("re_sdk", "app/presentation"),
    ("plotters", "app/presentation"),
    ("tiny-skia", "app/presentation"),
    ("ab_glyph", "app/presentation"),
    ("gif", "app/presentation"),
    ("image-webp", "app/presentation"),
    ("clap", "app/cli"),
    ("axum", "app/play"),
    ("tokio", "app/play"),
];

/// Libraries that only one folder of their crate may name. Cargo limits a library to the crate that depends on it; this list
/// limits it to a folder.
const PARTS: &[(&str, &str)] = &[
    ("rapier2d", "app/simulation/src/physics"),
    ("parry2d", "app/simulation/src/physics"),
    ("parquet", "app/tables/src/table"),
    ("roxmltree", "scenarios/src/commonroad"),
    ("rerun", "app/presentation/src/record"),
    ("re_sdk_types", "app/presentation/src/record"),
    ("plotters", "app/presentation/src/plot"),
    ("tiny_skia", "app/presentation/src/animation"),
    ("ab_glyph", "app/presentation/src/animation"),
    ("gif", "app/presentation/src/animation"),
    ("image_webp", "app/presentation/src/animation"),
];

/// Nouns of the planners, and what their files may name of the optimiser (`trajectory`): problems are posed, solved and checked
/// beside them, not in them.
const NOUNS: &[(&str, &[&str])] = &[
    ("planners/src/scene/mod.rs", &[]),
    ("planners/src/plan/mod.rs", &["Problem", "Statistics"]),
    ("planners/src/plan/violation.rs", &[]),
];

/// The most lines of a file, and of a function.
const FILE_LINES: usize = 400;
const FUNCTION_LINES: usize = 60;

pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the tests are a crate of the repository")
}

pub fn manifest(folder: &Path) -> Table {
    let path = folder.join("Cargo.toml");
    let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    text.parse().unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

pub fn members() -> Vec<String> {
    let workspace = manifest(root());
    let members = workspace["workspace"]["members"].as_array().expect("a list");
    members.iter().map(|member| member.as_str().expect("a path").to_owned()).collect()
}

/// All dependencies of a crate: normal, development and build dependencies, for every target.
pub fn dependencies(table: &Table) -> Vec<String> {
    let mut found = Vec::new();
    for (key, value) in table {
        let Some(below) = value.as_table() else { continue };
        match key.as_str() {
            "dependencies" | "dev-dependencies" | "build-dependencies" => found.extend(below.keys().cloned()),
            _ => found.extend(dependencies(below)),
        }
    }
    found
}

/// The folder of a package of the workspace.
pub fn crate_folder(package: &str) -> Option<String> {
    members().into_iter().find(|member| manifest(&root().join(member))["package"]["name"].as_str() == Some(package))
}

/// The Rust files below a folder, sorted.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
        let path = entry.expect("the entry can be read").path();
        if path.is_dir() {
            found.extend(rust_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Every Rust file of the workspace and of the package for Python, except the examples outside the crate `own-planner`.
pub fn all_rust_files() -> Vec<PathBuf> {
    let folders = members().into_iter().chain(["python/src".to_owned()]);
    folders.flat_map(|folder| rust_files(&root().join(folder))).collect()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn every_crate_has_stated_dependencies() {
    let mut crates: Vec<&str> = ARROWS.iter().map(|(folder, _)| *folder).collect();
    let mut members = members();
    crates.sort_unstable();
    members.sort_unstable();
    assert_eq!(members, crates, "a new crate needs a line in ARROWS");
}

#[test]
fn crate_dependencies_match_the_architecture() {
    for (name, allowed) in ARROWS {
        for dependency in dependencies(&manifest(&root().join(name))) {
            if let Some(other) = crate_folder(&dependency) {
                assert!(allowed.contains(&other.as_str()), "{name} must not depend on {other}");
            }
        }
    }
}

#[test]
fn every_engine_is_a_dependency_of_one_crate() {
    for member in members() {
        for dependency in dependencies(&manifest(&root().join(&member))) {
            let mut owners = OWNERS.iter().filter(|(library, _)| dependency.starts_with(library)).peekable();
            assert!(
                owners.peek().is_none() || owners.any(|(_, owner)| member == *owner),
                "{member} must not depend on {dependency}"
            );
        }
    }
    for (library, owner) in OWNERS {
        let owned = dependencies(&manifest(&root().join(owner))).iter().any(|name| name.starts_with(library));
        assert!(owned, "{owner} does not depend on {library} any more: this rule is out of date");
    }
}

#[test]
fn inside_a_crate_only_one_folder_names_an_engine() {
    for (library, owner) in PARTS {
        let (folder, _) = owner.split_once("/src/").expect("a folder of sources");
        let mut named = false;
        for file in rust_files(&root().join(folder)) {
            let text = read(&file);
            let code = text.lines().map(|line| line.split("//").next().unwrap_or_default());
            let names = code.filter(|line| has_word(line, library)).count() > 0;
            let owns = file.starts_with(root().join(owner));
            assert!(!names || owns, "{} names {library}, which only {owner} may", file.display());
            named |= names;
        }
        assert!(named, "{owner} does not name {library} any more: this rule is out of date");
    }
}

#[test]
fn basic_types_do_not_depend_on_cost_terms_certificates_or_the_optimiser() {
    for (noun, allowed) in NOUNS {
        let text = read(&root().join(noun));
        let code: String = text.lines().filter_map(|line| line.split("//").next()).collect();
        for module in ["problem", "certificate"] {
            assert!(!code.contains(&format!("{module}::")), "{noun} names {module}");
        }
        for (at, path) in code.match_indices("trajectory::") {
            let rest = &code[at + path.len()..];
            let named = rest.split([';', '(', ')', '<', '>']).next().unwrap_or_default();
            for name in named.trim_matches(['{', '}']).split(", ") {
                assert!(allowed.contains(&name), "{noun} names {name} of the optimiser");
            }
        }
    }
}

/// Whether a line names a crate: the word, followed by a path.
fn has_word(line: &str, word: &str) -> bool {
    let path = format!("{word}::");
    line.match_indices(&path).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        before.is_none_or(|character| !character.is_alphanumeric() && character != '_')
    })
}

#[test]
fn source_files_keep_the_line_limit() {
    for file in all_rust_files() {
        let lines = read(&file).lines().count();
        assert!(lines <= FILE_LINES, "{}: {lines} lines, more than {FILE_LINES}", file.display());
    }
}

/// A module with parts is a folder with a `mod.rs`: no file stands beside a folder of its name.
#[test]
fn a_module_with_parts_is_a_folder() {
    for file in all_rust_files() {
        assert!(
            !file.with_extension("").is_dir(),
            "{} stands beside its folder: move it there, as `mod.rs`",
            file.display()
        );
    }
}

/// Formatted code ends a function with a brace below its first line.
#[test]
fn functions_keep_the_line_limit() {
    for file in all_rust_files() {
        let text = read(&file);
        let lines: Vec<&str> = text.lines().collect();
        for (start, line) in lines.iter().enumerate() {
            let indent = line.len() - line.trim_start().len();
            if !begins_function(line) || line.trim_end().ends_with(['}', ';']) {
                continue;
            }
            let brace = format!("{}}}", " ".repeat(indent));
            let length = lines[start..].iter().position(|line| *line == brace).unwrap_or_default() + 1;
            let name = line.trim();
            assert!(length <= FUNCTION_LINES, "{}: {length} lines in `{name}`", file.display());
        }
    }
}

/// Whether a line begins a function, whatever stands before `fn`.
fn begins_function(line: &str) -> bool {
    let line = line.trim_start();
    // A restriction may have a path, as in `pub(in crate::plot)`.
    let restricted = line.strip_prefix("pub(").and_then(|rest| rest.split_once(") ")).map(|(_, rest)| rest);
    let rest = restricted.or_else(|| line.strip_prefix("pub ")).unwrap_or(line);
    let mut words = rest
        .split_whitespace()
        .skip_while(|word| ["default", "const", "async", "unsafe", "extern"].contains(word) || word.starts_with('"'));
    words.next() == Some("fn")
}

#[test]
fn the_line_count_finds_functions_with_any_qualifiers() {
    let before = ["", "pub ", "pub(crate) ", "pub(super) ", "pub(in crate::plot) ", "    "];
    for (visibility, kind) in before.iter().flat_map(|visibility| {
        ["", "const ", "unsafe ", "async ", "const unsafe ", "extern \"C\" ", "unsafe extern \"C\" "]
            .map(|kind| (visibility, kind))
    }) {
        let line = format!("{visibility}{kind}fn f() {{");
        assert!(begins_function(&line), "{line}");
    }
    for line in ["// fn f() {", "let fn_count = 1;", "pub struct S {", "F: Fn() {", "pub const LIMIT: f64 = 1.0;"] {
        assert!(!begins_function(line), "{line}");
    }
}

/// `cargo test` after `cargo run` builds no dependency again: with the dependencies of the tests in the tree, every
/// dependency of the application keeps its features.
#[test]
fn tests_do_not_change_how_dependencies_are_built() {
    let [built, tested] =
        [&["--package", "interplay", "--edges", "no-dev"][..], &["--workspace"]].map(packages_with_features);
    let again: Vec<&String> = built.difference(&tested).collect();
    assert!(
        again.is_empty(),
        "ask for the same features in app/presentation/Cargo.toml, or these are built twice: {again:#?}"
    );
}

/// Every package of a dependency tree with its features.
fn packages_with_features(tree: &[&str]) -> BTreeSet<String> {
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["tree", "--offline", "--locked", "--prefix", "none", "--format", "{p} [{f}]"]);
    let output = cargo.args(tree).current_dir(root()).output().expect("cargo can be started");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8_lossy(&output.stdout);
    text.lines().map(|line| line.trim_end_matches(" (*)").to_owned()).collect()
}

/// Lints are set once, in the workspace. A crate that does not inherit them would be checked with the defaults only.
#[test]
fn every_crate_inherits_the_lints_of_the_workspace() {
    for member in members() {
        let manifest = manifest(&root().join(&member));
        assert_eq!(manifest["lints"]["workspace"].as_bool(), Some(true), "{member}");
    }
}

/// Whether a line names a variant of an enumeration, as in `Driver::Human`, or imports variants. Methods do not count.
fn names_variant(line: &str, enumeration: &str) -> bool {
    line.match_indices(&format!("{enumeration}::")).any(|(at, path)| {
        let before = line[..at].chars().next_back();
        let after = line[at + path.len()..].chars().next();
        before.is_none_or(|character| !character.is_alphanumeric() && character != '_')
            && after.is_some_and(|character| character.is_uppercase() || "{*".contains(character))
    })
}

/// Planners and controllers declare which of their quantities are recorded, reported and measured. So the code that shows
/// these quantities names no planner, no controller, and no variant of `Driver` or `Controller`. Comments and tests may.
#[test]
fn recorder_report_and_measures_do_not_name_planners_or_controllers() {
    let kinds = interplay_scenarios::Registry::standard().driver_kinds();
    let controllers = interplay_scenarios::Registry::standard().controller_kinds();
    assert!(kinds.contains(&"negotiation") && controllers.contains(&"pid"), "{kinds:?}, {controllers:?}");
    // Quantities that one planner alone reports, and one controller alone.
    let quantities = ["acceptance", "centralised"];
    let folders = [
        "app/presentation/src/record",
        "app/presentation/src/report",
        "app/simulation/src/report",
        "app/simulation/src/measure",
    ];
    for file in folders.iter().flat_map(|folder| rust_files(&root().join(folder))) {
        let text = read(&file);
        let shown = text.split("#[cfg(test)]").next().unwrap_or_default();
        if file.ends_with("tests.rs") {
            continue;
        }
        for line in shown.lines().filter(|line| !line.trim_start().starts_with("//")) {
            for word in kinds.iter().chain(&controllers).chain(&quantities) {
                assert!(!line.contains(&format!("\"{word}")), "{} names {word}: {line}", file.display());
            }
            for list in ["Controller", "Driver"] {
                assert!(!names_variant(line, list), "{} names a variant of {list}: {line}", file.display());
            }
        }
    }
}
