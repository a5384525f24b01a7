//! A small plan from flags, as the text of a plan file.

use std::fmt::Write;
use std::num::NonZeroU64;

use clap::Args;

use crate::flag_values::values;

/// Flags that make a plan.
#[derive(Debug, Default, Args)]
pub(crate) struct PlanFlags {
    /// A scenario, a family or a file, instead of a plan; may be repeated
    #[arg(long, value_name = "NAME|FILE|DIR")]
    scenario: Vec<String>,

    /// Planner of the ego; may be repeated, to compare [default: as each file says]
    #[arg(long, value_name = "KIND", requires = "scenario")]
    planner: Vec<String>,

    /// Changes to compare with the scenario as it is written; may be repeated
    #[arg(long = "arm", value_name = "PATH=VALUE[; PATH=VALUE]...", value_parser = values::assignments, requires = "scenario")]
    arms: Vec<String>,

    /// Compare each scenario with its own counterfactuals, too
    #[arg(long, requires = "scenario")]
    counterfactuals: bool,

    /// Drivers of the other vehicles: a style of humans or a kind of driver; may be repeated [default: as each file says]
    #[arg(long, value_name = "STYLE|KIND", requires = "scenario")]
    style: Vec<String>,

    /// Let a value vary, such as vehicle.front.start.speed_mps='{ uniform = [1.0, 1.5] }'; may be repeated
    #[arg(long, value_name = "PATH=VALUES", value_parser = values::assignment, requires = "scenario")]
    vary: Vec<String>,

    /// Change one value in all runs; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE", value_parser = values::assignment, requires = "scenario")]
    sets: Vec<String>,

    /// How many samples of what varies there are; with a plan, instead of the plan's own
    #[arg(long, value_name = "N", value_parser = values::count::<NonZeroU64>, allow_negative_numbers = true)]
    pub samples: Option<NonZeroU64>,

    /// How many starts there are: samples in each of which every vehicle starts up to 0.1 m further ahead or behind and up to 0.1
    /// m/s faster or slower, at 1/10 scale
    #[arg(long, value_name = "N", value_parser = values::count::<NonZeroU64>, allow_negative_numbers = true)]
    #[arg(requires = "scenario", conflicts_with = "samples")]
    starts: Option<NonZeroU64>,
}

impl PlanFlags {
    /// The text of the plan that these flags state; each line names the flag that it comes from. `None` if no scenario is given.
    pub fn text(&self) -> Option<String> {
        if self.scenario.is_empty() {
            return None;
        }
        let mut text = String::new();
        // Writing to a String cannot fail.
        let _ = self.write(&mut text);
        Some(text)
    }

    /// Refuses a setting that a flag states twice: a plan cannot express it.
    ///
    /// # Errors
    /// Names the flag and the path of the setting.
    pub fn check(&self) -> Result<(), String> {
        let all = |flag, changes: &[String]| {
            let path = values::stated_twice(changes.iter().map(String::as_str));
            path.map(|path| format!("`{flag}` states `{path}` twice; state it once"))
        };
        let arms = || self.arms.iter().find_map(|arm| Some((arm, values::stated_twice(values::changes_of(arm))?)));
        let in_arm = || arms().map(|(arm, path)| format!("`--arm '{arm}'` states `{path}` twice; state it once"));
        all("--set", &self.sets).or_else(|| all("--vary", &self.vary)).or_else(in_arm).map_or(Ok(()), Err)
    }

    fn write(&self, text: &mut String) -> std::fmt::Result {
        let all = |words: &[String]| -> Vec<String> { words.iter().map(|word| quoted(word)).collect() };
        if self.counterfactuals {
            writeln!(text, "counterfactuals = true # --counterfactuals")?;
        }
        let is_compared = self.counterfactuals || !self.arms.is_empty();
        let as_written = if !is_compared { None } else { Some(quoted("as-written")) };
        let arms = self.arms.iter().map(|arm| arm_of(arm));
        let planners = as_written.into_iter().chain(all(&self.planner)).chain(arms).collect();
        let lists = [("scenario", all(&self.scenario)), ("planner", planners), ("style", all(&self.style))];
        for (key, entries) in lists {
            let flag = if key == "planner" { self.planner_flags() } else { format!("--{key}") };
            if !entries.is_empty() {
                writeln!(text, "{key} = [{}] # {flag}", entries.join(", "))?;
            }
        }
        if let Some(samples) = self.samples {
            writeln!(text, "samples = {samples} # --samples")?;
        }
        if let Some(starts) = self.starts {
            writeln!(text, "samples = {starts} # --starts")?;
            writeln!(text, "jitter = {{ position_m = 0.1, speed_mps = 0.1, scaled = true }} # --starts")?;
        }
        for (table, assignments) in [("set", &self.sets), ("vary", &self.vary)] {
            if !assignments.is_empty() {
                writeln!(text, "\n[{table}]")?;
            }
            for assignment in assignments {
                writeln!(text, "{} # --{table}", entry_of(assignment))?;
            }
        }
        Ok(())
    }

    /// The flags of which the planners of the plan are made.
    fn planner_flags(&self) -> String {
        let given = [
            ("--planner", !self.planner.is_empty()),
            ("--arm", !self.arms.is_empty()),
            ("--counterfactuals", self.counterfactuals),
        ];
        given.into_iter().filter_map(|(flag, is_given)| is_given.then_some(flag)).collect::<Vec<_>>().join(" ")
    }
}

/// A planner that differs from the scenario's own by changes, and is called after them.
fn arm_of(arm: &str) -> String {
    let changes: Vec<String> = values::changes_of(arm).map(entry_of).collect();
    format!("{{ name = {}, set = {{ {} }} }}", quoted(arm.trim()), changes.join(", "))
}

/// The entry of a table for `PATH=VALUE`.
fn entry_of(assignment: &str) -> String {
    let (path, value) = assignment.split_once('=').unwrap_or((assignment, ""));
    format!("{} = {}", quoted(path.trim()), value_of(value.trim()))
}

/// A word as a text of TOML, whose escapes are those of JSON.
fn quoted(word: &str) -> String {
    serde_json::Value::from(word).to_string()
}

/// A value as it is written in TOML; what is a bare word is taken as text, as `--set` does.
fn value_of(value: &str) -> String {
    let is_word =
        value.chars().all(|c| c.is_alphanumeric() || "-_".contains(c)) && value.starts_with(char::is_alphabetic);
    if is_word && !["true", "false", "inf", "nan"].contains(&value) || value.is_empty() {
        quoted(value)
    } else {
        value.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use clap::Parser;
    use interplay_scenarios::SweepPlan;

    use super::*;

    #[derive(Debug, Parser)]
    struct Alone {
        #[command(flatten)]
        flags: PlanFlags,
    }

    #[test]
    fn sweep_flags_are_written_as_a_plan() {
        let words = ["x", "--scenario", "intersection/nice", "--planner", "idm", "--planner", "conservative"];
        let more =
            ["--style", "tough", "--vary", "vehicle.ego.start.speed_mps={ uniform = [0.6, 0.8] }", "--starts", "5"];
        let flags = Alone::try_parse_from(words.into_iter().chain(more)).expect("sound").flags;
        let plan = SweepPlan::from_text("the flags", &flags.text().expect("a plan"), Path::new("")).expect("sound");
        assert_eq!(plan.run_count(), 10);
        let text = flags.text().expect("a plan");
        assert!(text.contains("planner = [\"idm\", \"conservative\"] # --planner\n"), "{text}");
        assert!(text.contains("samples = 5 # --starts\n"), "{text}");
        let unnamed: Vec<&str> = text.lines().filter(|line| line.contains('=') && !line.contains("# --")).collect();
        assert!(unnamed.is_empty(), "{unnamed:?}");
        assert_eq!(plan.names(), [vec!["intersection/nice"], vec!["tough"], vec!["idm", "conservative"]]);
        assert_eq!(plan.inputs(), [("vehicle.ego.start.speed_mps".to_owned(), true)]);
        let arm = "vehicle.ego.driver.settled_steps=29; vehicle.ego.driver.gamma=0.5";
        let words = ["x", "--scenario", "intersection/nice", "--arm", arm];
        let flags = Alone::try_parse_from(words).expect("sound").flags;
        let plan = SweepPlan::from_text("the flags", &flags.text().expect("a plan"), Path::new("")).expect("sound");
        assert_eq!(plan.names()[2], ["as-written", arm]);
        assert_eq!(value_of("nice"), "\"nice\"");
        assert_eq!(value_of("[1, 2]"), "[1, 2]");
    }
}
