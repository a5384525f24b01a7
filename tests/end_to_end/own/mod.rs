//! Metrics and controllers of one's own, and worlds that are stepped: the examples of `docs/guide/extending.md` and `docs/guide/stepping.md`,
//! which show these files from the first to the last line that is marked. A planner of one's own is a crate,
//! `examples/own-planner`, with tests of its own.

mod controller;
mod metric;
mod stepping;

use std::fs;
use std::path::Path;

/// What the documents show of each file is what is compiled.
#[test]
fn examples_in_the_extension_guide_match_the_compiled_code() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let shown = |file: &str| {
        let source = fs::read_to_string(root.join(file)).expect("the example");
        let (_, rest) = source.split_once("// shown from here\n").expect("a first mark");
        let (shown, _) = rest.split_once("// shown until here\n").expect("a last mark");
        shown.trim_end().to_owned()
    };
    let planner = "../examples/own-planner/src/lib.rs";
    let pages = [
        ("end_to_end/own/metric.rs", "extending"),
        ("end_to_end/own/controller.rs", "extending"),
        (planner, "extending"),
        ("../examples/own-planner/src/main.rs", "extending"),
        ("end_to_end/own/stepping.rs", "stepping"),
    ];
    for (file, page) in pages {
        let document = fs::read_to_string(root.join(format!("../docs/guide/{page}.md"))).expect("the document");
        assert!(
            document.contains(&format!("```rust\n{}\n```", shown(file))),
            "docs/guide/{page}.md: {file} has changed"
        );
    }
    let lines = shown(planner).lines().count();
    assert!(lines <= 60, "a planner of one's own takes {lines} lines");
}
