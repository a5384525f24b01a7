//! Loading any bytes ends with a scenario or with an error that can be shown; it never panics.

use std::fs;

use interplay_scenarios::{LoadError, Override, Scenario, embedded, from_text, load};
use miette::{GraphicalReportHandler, GraphicalTheme};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index, select};

/// Shows the error, if it is one, as the command line would.
fn show(result: Result<Scenario, LoadError>) -> Option<String> {
    let error = result.err()?;
    let mut text = String::new();
    let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor()).with_width(100);
    handler.render_report(&mut text, &error).expect("every error can be shown");
    assert!(text.contains('×') && text.len() < 200_000, "{} bytes", text.len());
    assert!(!text.contains('\u{1b}'), "nothing from a file may steer the terminal");
    error.faults().iter().for_each(|fault| assert!(!fault.message().is_empty()));
    Some(text)
}

/// Pieces that reach deeper than random bytes would.
const PIECES: &[&str] = &[
    "nan",
    "-inf",
    "1e999",
    "-1",
    "0",
    "9223372036854775808",
    "0x7f",
    "''",
    "'x'",
    "\"\\u0000\"",
    "true",
    "{}",
    "[]",
    "[[]]",
    "{ kind = 'human' }",
    "{ kind = 3 }",
    "1979-05-27",
    "[[vehicle]]\n",
    "[expect]\n",
    "[[counterfactual]]\nname = 'x'\n",
    "set = { 'vehicle.ego' = {}, \"a.\\u0062\" = 1 }\n",
    "planner = 'idm'\n",
    "[vehicle]\n",
    "extends = 'x'\n",
    ".",
    "=",
    "\r\n",
    "\u{feff}",
    "é",
    "\u{85}",
    "\0",
    "# ",
    "'''",
    "kind",
    "vehicle",
    "name",
    "y_m = 1\n",
];

/// A change of a text: at a place, cut some bytes away and insert a piece.
fn edits() -> impl Strategy<Value = Vec<(Index, usize, &'static str)>> {
    vec((any::<Index>(), 0..12_usize, select(PIECES)), 1..6)
}

fn edited(text: &str, edits: &[(Index, usize, &str)]) -> String {
    edits.iter().fold(text.to_owned(), |mut text, (at, cut, piece)| {
        let start = text.floor_char_boundary(at.index(text.len() + 1));
        let end = text.floor_char_boundary((start + cut).min(text.len())).max(start);
        text.replace_range(start..end, piece);
        text
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes_never_crash_the_loader(bytes in vec(any::<u8>(), 0..400)) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("random.toml");
        fs::write(&path, &bytes).expect("a writable folder");
        show(load(&path.to_string_lossy(), &[]));
    }

    #[test]
    fn random_text_never_crashes_the_loader(text in "\\PC{0,200}") {
        show(from_text("random.toml", &text, &[]));
        show(load(&text, &[]));
        show(load("lane-change/front-nice", &[Override::Set(text.clone()), Override::Planner(text)]));
    }

    #[test]
    fn edited_scenarios_never_crash_the_loader(file in select(embedded()), edits in edits()) {
        show(from_text("spoiled.toml", &edited(file.text, &edits), &[]));
    }

    #[test]
    fn edited_overrides_never_crash_the_loader(edits in edits()) {
        let assignment = edited("vehicle.ego.goal.speed_mps=1.2", &edits);
        show(load("lane-change/both-tough", &[Override::Set(assignment)]));
    }
}

#[test]
fn deep_nesting_is_refused_without_a_crash() {
    let bombs = [
        format!("a = {}", "[".repeat(500_000)),
        format!("a = {}", "{a=".repeat(200_000)),
        format!("{}a = 1", "a.".repeat(400_000)),
        format!("[{}a]", "a.".repeat(400_000)),
        format!("[[{}a]]", "a.".repeat(400_000)),
        (1..1000).map(|depth| format!("[{}a]\n", "a.".repeat(depth))).collect(),
        (0..70).fold(String::from("1"), |value, _| format!("{{ vehicle = [{value}] }}")),
        format!("vehicle = {}{}", "[".repeat(70), "]".repeat(70)),
        "[[vehicle]]\n".repeat(50_000),
        (0..50_000).map(|index| format!("key_{index} = {index}\n")).collect(),
    ];
    for bomb in bombs {
        let shown = show(from_text("bomb.toml", &bomb, &[]));
        assert!(shown.is_some(), "{} was accepted", &bomb[..20]);
    }
}
