//! The lines of Rust in this repository, by crate and kind, against a budget.
//!
//! `cargo test --release -p interplay-tests lines_of_rust -- --nocapture` prints the table.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::architecture::{all_rust_files, members, root};

/// The most lines of product code, and of all Rust. Before an issue is started, it states how many lines it adds or removes, and the
/// change that closes it moves these numbers by no more than that. Until 0.4.0 more lines are a warning.
const PRODUCT_BUDGET: usize = 119_500;
const TOTAL_BUDGET: usize = 166_500;

/// The first version, major and minor, that may not exceed the budget.
const ENFORCED_FROM: (u64, u64) = (0, 4);

const KINDS: [&str; 6] = ["product", "beside", "tests", "experiments", "benches", "examples"];
const PRODUCT: usize = 0;
const BESIDE: usize = 1;
const TESTS: usize = 2;
const EXPERIMENTS: usize = 3;
const BENCHES: usize = 4;
const EXAMPLES: usize = 5;

/// The crate of a file, and the column of its lines that are not below `#[cfg(test)]`. The path is relative to the root.
fn crate_and_kind(path: &str, members: &[String]) -> (String, usize) {
    let belongs = |member: &&String| path.strip_prefix(member.as_str()).is_some_and(|rest| rest.starts_with('/'));
    let first = path.split('/').next().unwrap_or_default();
    let owner = members.iter().find(belongs).map_or(first, String::as_str);
    let inside = path.strip_prefix(owner).unwrap_or(path).trim_start_matches('/');
    let kind = match inside.split('/').next() {
        _ if first == "examples" => EXAMPLES,
        _ if owner == "tests" => TESTS,
        Some("tests") => TESTS,
        Some("experiments") => EXPERIMENTS,
        Some("benches") => BENCHES,
        _ => PRODUCT,
    };
    (owner.to_owned(), kind)
}

/// How a file is divided: lines below `#[cfg(test)]`, and the modules of other files that are declared there.
#[derive(Debug, Default, PartialEq)]
struct ForTests {
    lines: usize,
    modules: Vec<String>,
}

fn for_tests(text: &str) -> ForTests {
    let lines: Vec<&str> = text.lines().collect();
    let mut result = ForTests::default();
    let mut at = 0;
    while at < lines.len() {
        if lines[at].trim() == "#[cfg(test)]" {
            let length = item_length(&lines[at..]);
            result.lines += length;
            let declared = lines[at..at + length].iter().find_map(|line| declared_module(line));
            result.modules.extend(declared);
            at += length;
        } else {
            at += 1;
        }
    }
    result
}

/// The name in `mod name;`, whatever its visibility.
fn declared_module(line: &str) -> Option<String> {
    let (before, name) = line.trim().strip_suffix(';')?.rsplit_once("mod ")?;
    (before.is_empty() || before.starts_with("pub")).then(|| name.to_owned())
}

/// The lines of an item with its attributes, which begins at the first line. A module of tests is the last item of its file.
fn item_length(lines: &[&str]) -> usize {
    let indent = |line: &str| line.len() - line.trim_start().len();
    let mut header = "";
    for (at, line) in lines.iter().enumerate() {
        let code = line.trim();
        if code.is_empty() || code.starts_with("#[") || code.starts_with("//") {
            continue;
        }
        let outer = indent(line) == indent(lines[0]);
        if outer {
            header = code;
        }
        if outer && indent(line) == 0 && code.ends_with('{') && is_module(code) {
            return lines.len();
        }
        if (outer && code.ends_with([';', '}', ','])) || (header.ends_with('=') && code.ends_with(';')) {
            return at + 1;
        }
    }
    lines.len()
}

fn is_module(code: &str) -> bool {
    code.starts_with("mod ") || (code.starts_with("pub") && code.contains(" mod "))
}

/// The files, and the folders without an extension, that hold the modules which a file declares for tests.
fn places_of_modules(file: &Path, modules: &[String]) -> Vec<PathBuf> {
    let folder = file.parent().expect("a file is in a folder");
    modules.iter().flat_map(|name| [folder.join(format!("{name}.rs")), folder.join(name)]).collect()
}

type Table = BTreeMap<String, [usize; KINDS.len()]>;

/// Lines by crate and kind.
fn counted() -> Table {
    let mut files = all_rust_files();
    let examples = fs::read_dir(root().join("examples")).expect("the folder of examples");
    let examples = examples.map(|entry| entry.expect("the entry can be read").path());
    files.extend(examples.filter(|path| path.extension().is_some_and(|extension| extension == "rs")));
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        (for_tests(&text), text.lines().count(), path)
    };
    let files: Vec<(ForTests, usize, PathBuf)> = files.into_iter().map(read).collect();
    let places: Vec<PathBuf> =
        files.iter().flat_map(|(tests, _, file)| places_of_modules(file, &tests.modules)).collect();
    let members = members();
    let mut table = Table::new();
    for (tests, lines, file) in &files {
        let relative = file.strip_prefix(root()).expect("below the root").to_string_lossy().replace('\\', "/");
        let (owner, kind) = crate_and_kind(&relative, &members);
        let row = table.entry(owner).or_default();
        let beside = match kind {
            PRODUCT if places.iter().any(|place| file.starts_with(place)) => *lines,
            PRODUCT => tests.lines,
            _ => 0,
        };
        row[BESIDE] += beside;
        row[kind] += lines - beside;
    }
    table
}

fn sums(table: &Table) -> [usize; KINDS.len()] {
    table.values().fold([0; KINDS.len()], |mut sums, row| {
        for (sum, lines) in sums.iter_mut().zip(row) {
            *sum += lines;
        }
        sums
    })
}

fn rendered(table: &Table) -> String {
    let line = |name: &str, cells: &[String]| {
        let cells: String = cells.iter().map(|cell| format!("{cell:>12}")).collect();
        format!("{name:<22}{cells}\n")
    };
    let row = |name: &str, lines: &[usize; KINDS.len()]| {
        let cells: Vec<String> = lines.iter().chain([&lines.iter().sum::<usize>()]).map(usize::to_string).collect();
        line(name, &cells)
    };
    let titles: Vec<String> = KINDS.iter().chain([&"total"]).map(|title| (*title).to_owned()).collect();
    let rows: String = table.iter().map(|(name, lines)| row(name, lines)).collect();
    format!("{}{rows}{}", line("crate", &titles), row("total", &sums(table)))
}

/// Whether a version such as `0.4.1` may not exceed the budget.
fn is_enforced(version: &str) -> bool {
    let mut numbers = version.split('.').map(|number| number.parse::<u64>().expect("a version has numbers"));
    let major = numbers.next().expect("a version has a major number");
    (major, numbers.next().expect("a version has a minor number")) >= ENFORCED_FROM
}

#[test]
#[expect(clippy::print_stderr, reason = "the table is what the test shows")]
fn lines_of_rust_stay_within_the_budget() {
    let table = counted();
    let sums = sums(&table);
    let total: usize = sums.iter().sum();
    eprintln!("{}", rendered(&table));
    for (name, lines, budget) in [("product", sums[PRODUCT], PRODUCT_BUDGET), ("total", total, TOTAL_BUDGET)] {
        if lines > budget {
            let message = format!("{name}: {lines} lines of Rust, {} above the budget of {budget}", lines - budget);
            assert!(!is_enforced(env!("CARGO_PKG_VERSION")), "{message}");
            eprintln!("warning: {message}");
        }
    }
}

#[test]
fn every_line_has_a_crate_and_a_kind() {
    let members = ["planners", "app/fmu", "app/fmu_host", "examples/own-planner", "tests"].map(str::to_owned);
    for (path, owner, kind) in [
        ("planners/src/lib.rs", "planners", PRODUCT),
        ("planners/tests/a.rs", "planners", TESTS),
        ("planners/experiments/a.rs", "planners", EXPERIMENTS),
        ("planners/benches/a.rs", "planners", BENCHES),
        ("app/fmu_host/src/lib.rs", "app/fmu_host", PRODUCT),
        ("examples/own-planner/tests/a.rs", "examples/own-planner", EXAMPLES),
        ("examples/first_run.rs", "examples", EXAMPLES),
        ("tests/end_to_end/main.rs", "tests", TESTS),
        ("python/src/lib.rs", "python", PRODUCT),
    ] {
        assert_eq!(crate_and_kind(path, &members), (owner.to_owned(), kind), "{path}");
    }
}

#[test]
fn test_code_is_distinguished_from_product_code() {
    let cases: [(&str, usize, &[&str]); 7] = [
        ("fn f() {}\n\n#[cfg(test)]\nmod tests {\n    fn g() {}\n}\n", 4, &[]),
        ("#[cfg(test)]\nmod tests;\nfn f() {}\n", 2, &["tests"]),
        ("#[cfg(test)]\npub(crate) mod fixture;\n", 2, &["fixture"]),
        ("#[cfg(test)]\nuse a::b;\nuse c::d;\n", 2, &[]),
        ("#[cfg(test)]\nstatic A: B =\n    B::new();\nfn f() {}\n", 3, &[]),
        ("impl A {\n    #[cfg(test)]\n    fn f() {\n        g();\n    }\n\n    fn h() {}\n}\n", 4, &[]),
        ("fn f() {}\n", 0, &[]),
    ];
    for (text, lines, modules) in cases {
        let modules = modules.iter().map(|name| (*name).to_owned()).collect();
        assert_eq!(for_tests(text), ForTests { lines, modules }, "{text}");
    }
}

#[test]
fn the_budget_is_enforced_from_its_version_on() {
    assert!(!is_enforced("0.3.9"));
    assert!(is_enforced("0.4.0") && is_enforced("0.10.0") && is_enforced("1.0.0"));
}
