//! `interplay list`

use clap::Args;
use interplay_common::spelling::nearest;
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
                print_error(&no_such(pattern));
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

/// The error for a pattern that fits no scenario, with the family or the scenario that was probably meant.
fn no_such(pattern: &str) -> String {
    let known = || embedded().iter().map(|file| file.name);
    let families = known().filter_map(|name| Some(name.rsplit_once('/')?.0));
    let meant = nearest(pattern, families.chain(known()));
    let remedy = meant.map_or_else(
        || "`interplay list` without it shows all of them".to_owned(),
        |meant| format!("did you mean `{meant}`?"),
    );
    format!("no scenario is called `{pattern}`; {remedy}")
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_misspelt_family_or_scenario_is_corrected() {
        assert_eq!(no_such("peple"), "no scenario is called `peple`; did you mean `people`?");
        assert_eq!(
            no_such("narrow-pasage/nice"),
            "no scenario is called `narrow-pasage/nice`; did you mean `narrow-passage/nice`?"
        );
        assert!(no_such("*/elephant-and-castle").ends_with("`interplay list` without it shows all of them"));
    }
}
