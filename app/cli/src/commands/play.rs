//! `interplay play`

use std::net::{IpAddr, Ipv4Addr};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::Args;
use interplay_play::{
    PlannedStudy, PlayServer, Score, ScoreRow, ServeOptions, Session, Study, StudyError, check_seats, play_script,
    read_script, save_played, write_played,
};
use interplay_scenarios::{Registry, Scenario, read_regular};
use serde_json::json;

use crate::commands::sweep::{folder_of_plan, make_missing_rows};
use crate::flag_values::files::{destroyed, is_same_file};
use crate::output::error::ExitStatus;
use crate::output::{ending, gave_up, json, print, print_error, print_load_error};

/// Drive a vehicle of a scenario yourself, in the browser; what you played is kept as a scenario that repeats it.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    interplay play                                        (a menu of all scenarios)\n  \
    interplay play lane-change/front-nice --as front      (be the driver whom the negotiator asks)\n  \
    interplay play intersection/nice --join crossing      (a second page, for another player)\n  \
    interplay play lane-change/front-nice --input drive.jsonl --out played.toml\n  \
    interplay play --study people.toml --as front         (walk people through a plan, a row a run)\n\n\
    On another machine: `interplay play --no-browser --port 7777` there, `ssh -L 7777:localhost:7777 THERE` here, and the\n\
    address that it prints in the browser here.")]
pub(crate) struct Play {
    /// Name of an embedded scenario or path of a scenario file [default: a menu]
    #[arg(value_name = "NAME|FILE", group = "played")]
    scenario: Option<String>,

    /// Walk people through the runs of a plan in random order, a row a run beside those of the planners: a file, or one in the binary
    #[arg(long, value_name = "PLAN", group = "played", conflicts_with_all = ["join", "input"])]
    study: Option<String>,

    /// The vehicle that you drive; in a study several, after commas [default: the ego]
    #[arg(long = "as", value_name = "VEHICLE", requires = "played")]
    seat: Option<String>,

    /// A second vehicle, which another player drives from a second page; its address is printed, too
    #[arg(long, value_name = "VEHICLE", requires = "scenario", conflicts_with = "input")]
    join: Option<String>,

    /// The port of the page [default: a free one]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    port: u16,

    /// Address to listen on instead of this machine's own: anyone who reaches it and knows the page's address can play
    #[arg(long, value_name = "ADDRESS")]
    listen: Option<IpAddr>,

    /// Only print the address of the page
    #[arg(long)]
    no_browser: bool,

    /// Play from a file instead of a page: a message of a page with its tick in each line
    #[arg(long, value_name = "FILE", requires = "scenario")]
    input: Option<PathBuf>,

    /// Where what was played goes: a folder, or with --input a file [default: played/, of a study studies/PLAN]
    #[arg(long, value_name = "PATH")]
    out: Option<PathBuf>,

    /// With --input, print the score as one JSON document
    #[arg(long, requires = "input")]
    json: bool,
}

/// The largest file of inputs that is read \[bytes\].
const MAX_INPUT_BYTES: u64 = 1 << 28;

impl Play {
    pub(crate) fn execute(self, registry: &Registry) -> ExitStatus {
        if let Some(plan) = &self.study {
            return match self.study(registry, plan) {
                Ok((study, folder)) => self.serve(registry, None, Some((study, folder))),
                Err(status) => status,
            };
        }
        let chosen = match self.chosen(registry) {
            Ok(chosen) => chosen,
            Err(status) => return status,
        };
        match (&self.input, chosen) {
            (Some(input), Some((name, scenario, seat))) => self.play_file(registry, input, &name, &scenario, &seat),
            (_, chosen) => self.serve(registry, chosen.map(|(name, _, seat)| (name, seat)), None),
        }
    }

    /// The study of a plan and its folder, in which the rows of planners are made first.
    fn study(&self, registry: &Registry, name: &str) -> Result<(Study, PathBuf), ExitStatus> {
        let plan = registry.sweep_plan(name, None).map_err(|error| {
            print_load_error(error);
            ExitStatus::BadInput
        })?;
        let folder = self.out.clone().unwrap_or_else(|| folder_of_plan("studies", name));
        let seats: Vec<&str> = self.seat.iter().flat_map(|seats| seats.split(',')).map(str::trim).collect();
        let planned = PlannedStudy::of(plan, &seats).map_err(refused_study)?;
        make_missing_rows(planned.plan(), &folder).map_err(gave_up)?;
        let study = planned.open(&folder).map_err(gave_up)?;
        print_error(&format!(
            "rows are in {}; `interplay compare {} --by scenario` reads them",
            folder.display(),
            folder.display()
        ));
        Ok((study, folder))
    }

    /// The scenario and the seat, if a scenario is named; both are checked before anything is served.
    fn chosen(&self, registry: &Registry) -> Result<Option<(String, Scenario, String)>, ExitStatus> {
        let Some(name) = &self.scenario else { return Ok(None) };
        let scenario = registry.load(name, &[]).map_err(|error| {
            print_load_error(error);
            ExitStatus::BadInput
        })?;
        let ego = scenario.ego().map(|ego| ego.name.clone()).unwrap_or_default();
        let seat = self.seat.clone().unwrap_or(ego);
        let seats: Vec<&str> = [seat.as_str()].into_iter().chain(self.join.as_deref()).collect();
        let refused = |text: String| {
            print_error(&text);
            Err(ExitStatus::BadInput)
        };
        if self.join.as_ref() == Some(&seat) {
            return refused(format!("`--join {seat}` is the seat of the first page already"));
        }
        match check_seats(name, &scenario, &seats) {
            Ok(_) => Ok(Some((name.clone(), scenario, seat))),
            Err(error) => refused(error.to_string()),
        }
    }

    fn serve(
        &self,
        registry: &Registry,
        chosen: Option<(String, String)>,
        study: Option<(Study, PathBuf)>,
    ) -> ExitStatus {
        let in_study = study.as_ref().map(|(_, folder)| folder.join("played"));
        let options = ServeOptions {
            address: self.listen.unwrap_or(Ipv4Addr::LOCALHOST.into()),
            port: self.port,
            chosen,
            joined: self.join.clone(),
            folder: in_study.or_else(|| self.out.clone()).unwrap_or_else(|| PathBuf::from("played")),
            ..ServeOptions::new(registry)
        };
        if self.listen.is_some_and(|address| !address.is_loopback()) {
            print_error("anybody who reaches this machine and knows the address below can play: nothing is encrypted");
        }
        let server = match PlayServer::bind(options) {
            Ok(server) => match study {
                Some((study, _)) => server.with_study(study),
                None => server,
            },
            Err(error) => {
                print_error(&error.to_string());
                return ExitStatus::Unfinished;
            }
        };
        let url = server.url();
        let joined = self.join.as_ref().map(|seat| format!("{url}?seat={seat}\n")).unwrap_or_default();
        if let Err(error) = print(&format!("{url}\n{joined}")) {
            print_error(&error.to_string());
            return ExitStatus::Unfinished;
        }
        if self.no_browser || !open(&url) {
            print_error(
                "open the address above in a browser; over SSH, forward the port first (see --help); Ctrl-C ends",
            );
        } else {
            print_error("playing in the browser; Ctrl-C ends");
        }
        match server.run() {
            Ok(()) => ExitStatus::Well,
            Err(error) => {
                print_error(&error.to_string());
                ExitStatus::Unfinished
            }
        }
    }

    fn play_file(&self, registry: &Registry, input: &Path, name: &str, scenario: &Scenario, seat: &str) -> ExitStatus {
        let refused = |text: &str| {
            print_error(text);
            ExitStatus::BadInput
        };
        if let Some(out) = self.out.as_deref() {
            let taken = destroyed(registry, out, [name].into_iter(), &[]);
            if let Some(path) = taken.or_else(|| is_same_file(out, input).then(|| input.to_owned())) {
                return refused(&format!("what is played would overwrite `{}`; choose another name", path.display()));
            }
        }
        let text = match text_of(input) {
            Ok(text) => text,
            Err(reason) => return refused(&reason),
        };
        let lines = match read_script(&input.display().to_string(), &text) {
            Ok(lines) => lines,
            Err(error) => return refused(&error.to_string()),
        };
        let mut session = match Session::new(name, scenario, &[seat]) {
            Ok(session) => session,
            Err(error) => return refused(&error.to_string()),
        };
        if let Err(error) = play_script(&mut session, seat, &lines) {
            return refused(&error.to_string());
        }
        let kept = match &self.out {
            Some(path) => write_played(&session, path).map(|()| path.clone()),
            None => save_played(&session, Path::new("played")),
        };
        match kept {
            Ok(path) => print_error(&format!("what was played is in {}", path.display())),
            Err(reason) => {
                print_error(&format!("what was played cannot be written: {reason}"));
                return ExitStatus::Unfinished;
            }
        }
        ending(self.print_score(&session, seat))
    }

    fn print_score(&self, session: &Session, seat: &str) -> Result<(), crate::output::error::CommandError> {
        let score = session.score(seat);
        let digest = session.report().digest;
        let text = if self.json {
            json("the score", &json!({ "score": score, "digest": digest }))?
        } else {
            format!("{}digest {digest}\n", words(&score))
        };
        print(&text)
    }
}

/// Prints why a study cannot begin.
fn refused_study(error: StudyError) -> ExitStatus {
    match error {
        StudyError::Plan(error) => gave_up(error),
        other => {
            print_error(&other.to_string());
            ExitStatus::BadInput
        }
    }
}

fn text_of(path: &Path) -> Result<String, String> {
    let cannot = |reason: &dyn std::fmt::Display| format!("cannot read {}: {reason}", path.display());
    let bytes = read_regular(path, MAX_INPUT_BYTES).map_err(|reason| cannot(&reason))?;
    let bytes = bytes.ok_or_else(|| cannot(&"it is larger than 256 MiB"))?;
    String::from_utf8(bytes).map_err(|_| cannot(&"it is not UTF-8 text"))
}

fn words(score: &Score) -> String {
    let seconds = |at: Option<f64>| at.map_or_else(|| "never".to_owned(), |at| format!("after {at:.1} s"));
    let row = |row: &ScoreRow| {
        let gap = row.smallest_gap_m.map(|m| format!(", smallest gap {m:.2} m")).unwrap_or_default();
        let touched = if row.contact { ", touched another vehicle" } else { "" };
        format!("{}: goal {}{gap}{touched}\n", row.name, seconds(row.reached_s))
    };
    let story = score.story.iter().map(|line| format!("{line}\n"));
    std::iter::once(&score.you).chain(&score.others).map(row).chain(story).collect()
}

/// Opens an address in the browser; whether there is one.
fn open(url: &str) -> bool {
    let has_screen =
        cfg!(target_os = "macos") || ["DISPLAY", "WAYLAND_DISPLAY"].iter().any(|name| std::env::var_os(name).is_some());
    let program = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
    has_screen && Command::new(program).arg(url).stdout(Stdio::null()).stderr(Stdio::null()).spawn().is_ok()
}
