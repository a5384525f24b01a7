//! `interplay run`

use std::path::PathBuf;

use clap::Args;
use interplay_presentation::figures::{FrameLog, RecordedRun, run_page};
use interplay_presentation::record::{OpenRecording, RecordError, Recorder, Sink, Viewer};
use interplay_presentation::report::summary;
use interplay_presentation::shell;
use interplay_scenarios::{Override, Registry, Scenario};
use interplay_simulation::report::Report;
use interplay_simulation::run::run_on_threads;
use interplay_simulation::watch::Watcher;

use crate::flag_values::files::short_name;
use crate::flag_values::values;
use crate::output::error::{CommandError, ExitStatus};
use crate::output::{json, print, print_error, print_load_error, this_program, unwritten, without_input};
use crate::process::watch::WatchedFiles;
use crate::run_outputs::RunOutputs;

/// Run one scenario, say whether its expectations held, and record it.
#[derive(Debug, Default, Args)]
#[command(after_help = "Examples:\n  \
    interplay run lane-change/front-tough\n  \
    interplay run my.toml --planner conservative --set vehicle.ego.goal.speed_mps=1.2 --json\n  \
    interplay run my.toml --watch                        (again at every save, until Ctrl-C)\n  \
    interplay run intersection/nice --report my-report     (pictures and a page)\n  \
    interplay run intersection/nice --animate nice.gif     (a moving picture)\n  \
    interplay run intersection/nice --trajectories nice.csv\n  \
    interplay run building/office-and-flat --series week.parquet\n  \
    interplay run their.xml --planner conservative --export driven.xml")]
pub(crate) struct Run {
    /// Name of an embedded scenario (see `interplay list`) or path of a scenario file
    #[arg(value_name = "NAME|FILE", default_value = DEFAULT_SCENARIO)]
    scenario: Option<String>,

    /// Planner of the ego instead of the scenario's own
    #[arg(long, value_name = "KIND")]
    planner: Option<String>,

    /// Change one value of the scenario; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,

    /// Let the ego know where the recorded vehicles will be, as every planner of CommonRoad does; the report says so
    #[arg(long)]
    ego_knows_records: bool,

    /// Seed of all random numbers
    #[arg(long, value_name = "N", value_parser = values::seed, allow_negative_numbers = true)]
    seed: Option<u64>,

    /// Where the recording goes [default: recordings/NAME.rrd]
    #[arg(long, value_name = "FILE.rrd", conflicts_with = "no_record")]
    record: Option<PathBuf>,

    /// Do not record
    #[arg(long)]
    no_record: bool,

    /// Stream to a viewer that is running instead of writing a file [default: the one on this machine]
    #[arg(long, value_name = "URL", num_args = 0..=1, require_equals = true)]
    #[arg(conflicts_with_all = ["record", "no_record"])]
    connect: Option<Option<Viewer>>,

    /// Run again whenever the scenario file, or one that it extends, is saved
    #[arg(long)]
    watch: bool,

    /// Draw what there is to see into this folder, as SVG and PNG, with a page, index.html, that shows it; the recording
    /// goes there too unless --record says otherwise
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,

    #[command(flatten)]
    outputs: RunOutputs,

    /// Until when the moving picture shows the run [s] [default: until all is settled that is expected]
    #[arg(long, value_name = "SECONDS", value_parser = values::time, requires = "animate", allow_negative_numbers = true)]
    animate_until: Option<f64>,

    /// End with 0 although nothing is expected of the run and its ego begins a contact
    #[arg(long)]
    allow_contacts: bool,

    /// Threads on which vehicles decide whose decisions do not depend on each other: the run is the same with any number
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    threads: Option<u16>,

    /// Print the report as one JSON document
    #[arg(long)]
    json: bool,

    /// Whether the next commands to try follow the report.
    #[arg(skip)]
    introduces: bool,
}

/// The scenario of `run`, and the origin of `new`, if none is named.
pub(crate) const DEFAULT_SCENARIO: &str = "lane-change/front-nice";

impl Run {
    /// The run of the command without a subcommand: it writes no file, and ends with the commands to try next.
    pub(crate) fn first() -> Run {
        Run { scenario: Some(SCENARIO.to_owned()), no_record: true, introduces: true, ..Run::default() }
    }

    pub(crate) fn execute(self, registry: &Registry) -> ExitStatus {
        if self.watch { self.run_at_every_change(registry) } else { self.run_once(registry) }
    }

    /// Runs at every change of the scenario; never returns unless there is nothing to watch.
    fn run_at_every_change(&self, registry: &Registry) -> ExitStatus {
        let mut watched = WatchedFiles::look(registry, self.scenario());
        if watched.is_empty() {
            print_error(&format!(
                "--watch needs a scenario file, and `{}` is none; `interplay new my.toml --from {0}` makes one",
                self.scenario()
            ));
            return ExitStatus::BadInput;
        }
        loop {
            self.run_once(registry);
            print_error(&format!("watching {}; Ctrl-C ends", self.scenario()));
            watched = watched.wait(registry);
        }
    }

    fn run_once(&self, registry: &Registry) -> ExitStatus {
        let scenario = match registry.load(self.scenario(), &self.overrides()) {
            Ok(scenario) if self.ego_knows_records => self.without_foreign_claims(scenario.with_known_records()),
            Ok(scenario) => self.without_foreign_claims(scenario),
            Err(error) => {
                print_load_error(error);
                return ExitStatus::BadInput;
            }
        };
        print_remarks(&scenario);
        let name = short_name(self.scenario());
        let refused = without_input(&scenario).or_else(|| self.refused_output(&name, registry));
        if let Some(reason) = refused.or_else(|| self.without_subject(&scenario)) {
            print_error(&reason);
            return ExitStatus::BadInput;
        }
        let recording = match self.begin_recording(&scenario, &name) {
            Ok(recording) => recording,
            Err(error) => {
                print_error(&error.to_string());
                return ExitStatus::Unfinished;
            }
        };
        let mut outputs = match self.outputs.begin(&scenario, self.scenario()) {
            Ok(outputs) => outputs,
            Err(error) => return unwritten(error),
        };
        let passed = self.simulate(&name, scenario, recording, outputs.watchers()).and_then(|recorded| {
            self.page(&name, &recorded)?;
            outputs.finish(&recorded, print_error)?;
            self.print_report(&recorded.scenario.title, &recorded.report).map(|()| recorded.report.passed)
        });
        match passed {
            Ok(passed) => {
                if let Some(path) = self.recording(&name).filter(|_| self.connect.is_none()) {
                    let view = shell::line([this_program().as_str(), "view", &path.to_string_lossy()]);
                    let off = if self.record.is_none() { " (`--no-record` writes none)" } else { "" };
                    print_error(&format!("recorded to {}{off}; to open it: {view}", path.display()));
                }
                if self.introduces {
                    print_next_commands();
                }
                if passed { ExitStatus::Well } else { ExitStatus::Failed }
            }
            Err(error) => {
                print_error(&error.to_string());
                ExitStatus::Unfinished
            }
        }
    }

    /// Why an output must not be written.
    fn refused_output(&self, name: &str, registry: &Registry) -> Option<String> {
        let recording = self.recording(name);
        let (recording, page) = (recording.as_deref(), self.report.as_deref());
        self.outputs.refused(recording, page, registry, self.scenario(), &self.overrides())
    }

    /// Why there is nothing to write of what vehicles or the building did.
    fn without_subject(&self, scenario: &Scenario) -> Option<String> {
        let (flag, lacked) = self.outputs.without_subject(scenario)?;
        Some(format!("--{flag} needs {lacked}, and `{}` has none", self.scenario()))
    }

    /// The scenario without its counterfactuals if a flag replaces the planner: they are claims about the file's own planner.
    fn without_foreign_claims(&self, scenario: Scenario) -> Scenario {
        if self.planner.is_none() || scenario.counterfactuals.is_empty() && scenario.left_out.is_empty() {
            return scenario;
        }
        print_error(
            "counterfactuals are left out: they are claims about the scenario's own planner, not that of --planner",
        );
        scenario.without_counterfactuals()
    }

    /// The scenario that is run, with its changes.
    fn scenario(&self) -> &str {
        self.scenario.as_deref().unwrap_or(DEFAULT_SCENARIO)
    }

    /// Runs the scenario and its counterfactuals, and ends the recording; the frames are kept if something is to be drawn of them.
    fn simulate(
        &self,
        name: &str,
        scenario: Scenario,
        recording: Option<OpenRecording>,
        outputs: Vec<Box<dyn Watcher>>,
    ) -> Result<RecordedRun, CommandError> {
        let frame_log = FrameLog::default();
        let mut watchers: Vec<Box<dyn Watcher>> = Vec::new();
        if let Some(recording) = &recording {
            watchers.push(Box::new(recording.clone()));
        }
        watchers.extend(outputs);
        if self.report.is_some() || self.outputs.needs_frames() {
            watchers.push(Box::new(frame_log.clone()));
        }
        let report = run_on_threads(self.threads.map_or(1, usize::from), name, &scenario, watchers)?;
        let report = if self.allow_contacts { report } else { report.without_contacts_by_ego() };
        recording.map_or(Ok(()), |recording| recording.close(&report))?;
        let recorded = RecordedRun::to_draw(scenario, frame_log.frames(), report);
        Ok(RecordedRun { command: self.words(), shown_until_s: self.animate_until, ..recorded })
    }

    /// Draws the page, with `--report`.
    fn page(&self, name: &str, recorded: &RecordedRun) -> Result<(), CommandError> {
        let Some(folder) = &self.report else { return Ok(()) };
        let recording = self.recording(name).filter(|path| self.connect.is_none() && path.parent() == Some(folder));
        let file = recording.as_ref().and_then(|path| path.file_name()).map(|file| file.to_string_lossy().into_owned());
        let what = |file: &String| format!("the recording; \u{201c}interplay view {file}\u{201d} opens it");
        let page = run_page(recorded, folder, file.map(|file| (file.clone(), what(&file))).into_iter().collect())?;
        print_error(&format!("page in {}", page.display()));
        Ok(())
    }

    /// Prints the report, as text or as JSON.
    fn print_report(&self, title: &str, report: &Report) -> Result<(), CommandError> {
        let text = if self.json { json("the report", report)? } else { summary(title, report) };
        print(&text)
    }

    /// The arguments that repeat this run. Flags for its outputs are not among them.
    fn words(&self) -> Vec<String> {
        let planner = self.planner.iter().flat_map(|kind| ["--planner".to_owned(), kind.clone()]);
        let seed = self.seed.iter().flat_map(|seed| ["--seed".to_owned(), seed.to_string()]);
        let sets = self.sets.iter().flat_map(|change| ["--set".to_owned(), change.clone()]);
        let run = ["interplay", "run", self.scenario()].map(str::to_owned);
        run.into_iter().chain(planner).chain(seed).chain(sets).collect()
    }

    /// The same as one line for a shell.
    fn command(&self) -> String {
        shell::line(self.words().iter().map(String::as_str))
    }

    /// Changes of the scenario, the most specific last.
    fn overrides(&self) -> Vec<Override> {
        let planner = self.planner.iter().cloned().map(Override::Planner);
        let seed = self.seed.into_iter().map(Override::Seed);
        planner.chain(seed).chain(self.sets.iter().cloned().map(Override::Set)).collect()
    }

    /// Where the recording goes, if anywhere.
    fn recording(&self, name: &str) -> Option<PathBuf> {
        let default = || match &self.report {
            Some(folder) => folder.join("recording.rrd"),
            None => PathBuf::from("recordings").join(format!("{name}.rrd")),
        };
        (!self.no_record).then(|| self.record.clone().unwrap_or_else(default))
    }

    fn begin_recording(&self, scenario: &Scenario, name: &str) -> Result<Option<OpenRecording>, RecordError> {
        let sink = match &self.connect {
            Some(viewer) => Some(Sink::Live(viewer.clone().map_or_else(Viewer::here, Ok)?)),
            None => self.recording(name).map(Sink::File),
        };
        let Some(sink) = sink else { return Ok(None) };
        let mut recorder = Recorder::begin(scenario, name, &sink)?;
        recorder.set_command(&self.command())?;
        Ok(Some(OpenRecording::new(recorder)))
    }
}

/// Prints what is left out of a scenario, and what may not have been meant.
fn print_remarks(scenario: &Scenario) {
    for [counterfactual, reason] in &scenario.left_out {
        print_error(&format!("the counterfactual \"{counterfactual}\" does not fit the flags: {reason}"));
    }
    for remark in scenario.remarks.iter() {
        print_error(&format!("note: {remark}"));
    }
}

/// The scenario of the first run: two real cars come to a crossing without priority.
pub(crate) const SCENARIO: &str = "people/intersection";

/// Prints three commands to try next, a line each with its effect.
pub(crate) fn print_next_commands() {
    let program = this_program();
    let commands = [
        (vec!["why", SCENARIO], "what the order depends on"),
        (vec!["play", SCENARIO, "--as", "crossing"], "drive the other car yourself"),
        (vec!["new", "my.toml", "--from", SCENARIO], "a scenario of your own"),
    ];
    let lines = commands.map(|(words, effect)| (shell::line([program.as_str()].into_iter().chain(words)), effect));
    let width = lines.iter().map(|(command, _)| command.len()).max().unwrap_or_default();
    for (command, effect) in lines {
        print_error(&format!("next: {command:width$}  ({effect})"));
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Debug, Parser)]
    struct Alone {
        #[command(flatten)]
        run: Run,
    }

    fn parsed(words: &[&str]) -> Run {
        Alone::try_parse_from([&["run"], words].concat()).expect("sound arguments").run
    }

    #[test]
    fn the_repeat_command_keeps_the_flags_that_change_the_run() {
        assert_eq!(Run::default().command(), "interplay run lane-change/front-nice");
        let words = ["my file.toml", "--json", "--set", "title=\"It's\"", "--no-record", "--seed", "7"];
        let run = parsed(&[&words[..], &["--set", "seed=3", "--planner", "human"]].concat());
        let expected = r#"interplay run 'my file.toml' --planner human --seed 7 --set 'title="It'\''s"' --set seed=3"#;
        assert_eq!(run.command(), expected);
        let again =
            parsed(&["my file.toml", "--planner", "human", "--seed", "7", "--set", words[3], "--set", "seed=3"]);
        assert_eq!((again.scenario(), again.overrides()), (run.scenario(), run.overrides()));
    }
}
