//! `interplay list`

use clap::Args;
use interplay_scenarios::{Scenario, embedded, load, names_matching};
use serde_json::json;

use crate::output::error::ExitStatus;
use crate::output::{print_error, print_load_error, printed};

/// List the embedded scenarios by family: name, what it shows, figure reproduced.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  interplay list\n  interplay list intersection '*/tough'\n  interplay list --json")]
pub(crate) struct List {
    /// Families, such as `intersection`, or patterns of names, such as `*/tough` [default: all]
    #[arg(value_name = "FAMILY|PATTERN")]
    names: Vec<String>,

    /// Print the list as one JSON document
    #[arg(long)]
    json: bool,
}

impl List {
    pub(crate) fn execute(self) -> ExitStatus {
        let mut names: Vec<String> = Vec::new();
        for pattern in &self.names {
            let found = names_matching(pattern);
            if found.is_empty() {
                print_error(&format!(
                    "no scenario is called `{pattern}`; `interplay list` without it shows all of them"
                ));
                return ExitStatus::BadInput;
            }
            names.extend(found);
        }
        if self.names.is_empty() {
            names = embedded().iter().map(|file| file.name.to_owned()).collect();
        }
        let mut rows = Vec::new();
        for name in &names {
            match load(name, &[]) {
                Ok(scenario) => rows.push((name.as_str(), scenario)),
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
        printed(&by_family(&rows))
    }
}

/// A heading for each family, and a line for each of its scenarios.
fn by_family(rows: &[(&str, Scenario)]) -> String {
    let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let (mut text, mut last) = (String::new(), "");
    for (name, scenario) in rows {
        let family = name.rsplit_once('/').map_or(*name, |(family, _)| family);
        if family != last {
            let break_line = if last.is_empty() { "" } else { "\n" };
            text += &format!("{break_line}{family}\n");
            last = family;
        }
        let figure = scenario.figure.as_ref().map(|figure| format!(" (Fig. {figure})")).unwrap_or_default();
        text += &format!("  {name:width$}  {}{figure}\n", scenario.shows);
    }
    text
}
