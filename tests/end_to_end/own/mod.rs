//! Metrics, controllers and planners of one's own, and worlds that are stepped: the examples of `docs/extending.md` and
//! `docs/stepping.md`, which show these files from the first to the last line that is marked.

mod controller;
mod metric;
mod planner;
mod stepping;

use std::fs;
use std::path::Path;

/// What the document shows of each file is what is compiled here.
#[test]
fn the_document_shows_what_is_compiled() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let pages =
        [("metric", "extending"), ("controller", "extending"), ("planner", "extending"), ("stepping", "stepping")];
    for (name, page) in pages {
        let document = fs::read_to_string(root.join(format!("../docs/{page}.md"))).expect("the document");
        let file = root.join(format!("end_to_end/own/{name}.rs"));
        let source = fs::read_to_string(&file).expect("the example");
        let (_, rest) = source.split_once("// shown from here\n").expect("a first mark");
        let (shown, _) = rest.split_once("// shown until here\n").expect("a last mark");
        assert!(
            document.contains(&format!("```rust\n{}\n```", shown.trim_end())),
            "docs/{page}.md: {name} has changed"
        );
    }
}
