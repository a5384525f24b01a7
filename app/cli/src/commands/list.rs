//! `interplay list`

use clap::Args;
use interplay_scenarios::{Scenario, embedded, load};
use serde_json::json;

use crate::output::error::ExitStatus;
use crate::output::{print_load_error, printed};

/// List the embedded scenarios: name, what it shows, figure reproduced.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  interplay list --json")]
pub(crate) struct List {
    /// Print the list as one JSON document
    #[arg(long)]
    json: bool,
}

impl List {
    pub(crate) fn execute(self) -> ExitStatus {
        let mut rows = Vec::new();
        for file in embedded() {
            match load(file.name, &[]) {
                Ok(scenario) => rows.push((file.name, scenario)),
                Err(error) => {
                    print_load_error(error);
                    return ExitStatus::BadInput;
                }
            }
        }
        if self.json {
            let rows = rows.iter().map(|(name, scenario)| {
                json!({ "name": name, "title": scenario.title, "shows": scenario.shows, "figure": scenario.figure })
            });
            return printed(&format!("{:#}\n", serde_json::Value::Array(rows.collect())));
        }
        let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
        let line = |(name, scenario): &(&str, Scenario)| {
            let figure = scenario.figure.as_ref().map(|figure| format!(" (Fig. {figure})")).unwrap_or_default();
            format!("{name:width$}  {}{figure}\n", scenario.shows)
        };
        printed(&rows.iter().map(line).collect::<String>())
    }
}
