//! `interplay run`

use std::path::PathBuf;

use clap::Args;
use interplay_scenarios::{Override, Scenario, load};

use super::{Ending, complain, complain_about, print};
use crate::record::{Recorder, Sink};
use crate::report::summary;
use crate::run::run;
use crate::watch::Watcher;

/// Run one scenario, say whether its expectations held, and record it.
#[derive(Debug, Default, Args)]
#[command(after_help = "Examples:\n  \
    interplay run lane-change/front-tough\n  \
    interplay run my.toml --planner conservative --set vehicle.ego.goal.speed_mps=1.2 --json")]
pub(super) struct Run {
    /// Name of an embedded scenario (see `interplay list`) or path of a scenario file
    #[arg(value_name = "NAME|FILE", default_value = DEFAULT)]
    scenario: Option<String>,

    /// Who drives the ego instead of the scenario's choice: human, conservative, negotiation
    #[arg(long, value_name = "KIND")]
    planner: Option<String>,

    /// Change one value of the scenario; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,

    /// Seed of all random numbers
    #[arg(long, value_name = "N")]
    seed: Option<u64>,

    /// Where the recording goes [default: recordings/NAME.rrd]
    #[arg(long, value_name = "FILE.rrd", conflicts_with = "no_record")]
    record: Option<PathBuf>,

    /// Do not record
    #[arg(long)]
    no_record: bool,

    /// Stream to a viewer that is running instead of writing a file
    #[arg(long, conflicts_with_all = ["record", "no_record"])]
    connect: bool,

    /// Print the report as one JSON document
    #[arg(long)]
    json: bool,
}

const DEFAULT: &str = "lane-change/front-nice";

impl Run {
    pub(super) fn execute(self) -> Ending {
        let name = self.scenario.clone().unwrap_or_else(|| DEFAULT.to_owned());
        let scenario = match load(&name, &self.overrides()) {
            Ok(scenario) => scenario,
            Err(error) => {
                complain_about(error);
                return Ending::BadInput;
            }
        };
        let name = short_name(&name);
        let watchers = match self.watchers(&scenario, &name) {
            Ok(watchers) => watchers,
            Err(error) => {
                complain(&error);
                return Ending::Unfinished;
            }
        };
        match run(&name, &scenario, watchers) {
            Ok(report) => {
                match serde_json::to_string_pretty(&report) {
                    Ok(text) if self.json => print(&format!("{text}\n")),
                    _ => print(&summary(&scenario.title, &report)),
                }
                if let Some(path) = self.recording(&name).filter(|_| !self.connect) {
                    complain(&format!("recorded to {}", path.display()));
                }
                if report.passed { Ending::Well } else { Ending::Failed }
            }
            Err(error) => {
                complain(&error.to_string());
                Ending::Unfinished
            }
        }
    }

    /// Changes of the scenario, the most specific last.
    fn overrides(&self) -> Vec<Override> {
        let planner = self.planner.iter().cloned().map(Override::Planner);
        let seed = self.seed.into_iter().map(Override::Seed);
        planner.chain(seed).chain(self.sets.iter().cloned().map(Override::Set)).collect()
    }

    /// Where the recording goes, if anywhere.
    fn recording(&self, name: &str) -> Option<PathBuf> {
        let default = || PathBuf::from("recordings").join(format!("{name}.rrd"));
        (!self.no_record).then(|| self.record.clone().unwrap_or_else(default))
    }

    /// What a reader of the recording types to get the run again.
    fn command(&self) -> String {
        let quoted = |word: &str| {
            let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:".contains(c);
            if word.chars().all(plain) { word.to_owned() } else { format!("'{}'", word.replace('\'', r"'\''")) }
        };
        let mut words = vec!["interplay run".to_owned(), quoted(self.scenario.as_deref().unwrap_or(DEFAULT))];
        words.extend(self.planner.iter().map(|kind| format!("--planner {}", quoted(kind))));
        words.extend(self.sets.iter().map(|set| format!("--set {}", quoted(set))));
        words.extend(self.seed.iter().map(|seed| format!("--seed {seed}")));
        words.join(" ")
    }

    fn watchers(&self, scenario: &Scenario, name: &str) -> Result<Vec<Box<dyn Watcher>>, String> {
        let sink = if self.connect { Some(Sink::Live) } else { self.recording(name).map(Sink::File) };
        let Some(sink) = sink else { return Ok(Vec::new()) };
        let recorder = Recorder::begin(scenario, name, &sink).map_err(|error| error.to_string())?;
        recorder.repeat_with(&self.command()).map_err(|error| error.to_string())?;
        Ok(vec![Box::new(recorder)])
    }
}

/// The name of a scenario without the extension and without leading folders of a path that is not below this one.
fn short_name(name: &str) -> String {
    let path = std::path::Path::new(name);
    let stem = || path.file_stem().map_or_else(|| name.to_owned(), |stem| stem.to_string_lossy().into_owned());
    if path.extension().is_some() { stem() } else { name.to_owned() }
}
