//! The smallest valid scenario, and changes of it.

use interplay_scenarios::{Override, Scenario, from_text};

/// The smallest valid scenario.
pub const LEAST: &str =
    "title = 'a'\nshows = 'b'\n[[vehicle]]\nname = 'car'\nstart = { x_m = 0, y_m = 0.2, speed_mps = 1 }\n";

pub fn least(more: &str, overrides: &[Override]) -> Scenario {
    from_text("least.toml", &format!("{more}\n{LEAST}"), overrides).expect("a scenario without fault")
}

pub fn set(assignment: &str) -> Override {
    Override::Set(assignment.to_owned())
}
