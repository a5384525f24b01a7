//! A valid scenario, and refusals of changes that make it invalid.

use interplay_scenarios::from_text;

use crate::common::Catalogue;

/// A scenario without fault, for the cases to spoil.
pub const GOOD: &str = r#"title = "Two cars"
shows = "One follows the other"
duration_s = 5.0

[road]
kind = "lanes"
lane_count = 2

[[vehicle]]
name = "ego"
start = { x_m = 0.0, y_m = 0.185, speed_mps = 1.0 }
goal = { lane = 1 }
driver = { kind = "negotiation", beta = 0.8 }

[[vehicle]]
name = "front"
start = { x_m = 1.0, y_m = 0.185, speed_mps = 1.0 }
body = { width_m = 0.19 }
driver = { kind = "human", style = "nice" }

[expect]
no_collision = true
order = ["front", "ego"]

[[expect.completes]]
vehicle = "ego"
before_s = 4.0
"#;

/// The good scenario with each text replaced, which must be there.
pub fn spoiled(changes: &[(&str, &str)]) -> String {
    changes.iter().fold(GOOD.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from} is not in the good scenario");
        text.replacen(from, to, 1)
    })
}

/// Expects that the spoiled scenario is refused.
pub fn refusal(errors: &mut Catalogue, name: &str, changes: &[(&str, &str)], fragments: &[&str]) {
    errors.error(name, from_text("bad.toml", &spoiled(changes), &[]), fragments);
}
