//! `interplay identify`

use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use interplay_building::identify::{
    Identification, IdentifyError, Mapping, RecordedDays, Telemetry, TelemetryError, expected_processor_s,
    identify_with_progress,
};
use interplay_presentation::report::{self, Believed};
use interplay_presentation::{plot, shell};
use interplay_scenarios::{Fault, read_regular};
use thiserror::Error;

use crate::output::error::{CommandError, ExitStatus, write_file};
use crate::output::{json, print, print_error};

/// Find thermal parameters in telemetry, with uncertainty and residual diagnostics.
///
/// A small TOML file beside the table, the mapping, says which column is what, in which unit, and sampled how.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    interplay identify assets/telemetry/cabin.csv        (a sample; its mapping is cabin.toml beside it)\n  \
    interplay identify office.csv --mapping columns.toml --out plots/ --json\n  \
    interplay identify office.csv --validate             (the error a day ahead on days that were not trained on)\n  \
    interplay identify office.csv --details              (models, tests and reasons)\n  \
    interplay identify office.csv --scenario office-scenario.toml\n\n\
    A mapping:\n  \
    walls = [[\"office\", \"outdoor\"]]\n  \
    time = { column = \"time\", format = \"%Y-%m-%d %H:%M:%S\", step_s = 900.0, gaps = \"split\" }\n  \
    boundary = [{ name = \"outdoor\", temperature = \"T_out\" }]\n  \
    zone = [{ name = \"office\", temperature = \"T_in\", heat = [{ kind = \"power\", column = \"P\", unit = \"kw\" }] }]\n  \
    identify = { train_days = 9.0 }")]
pub(crate) struct Identify {
    /// The table, with a header
    #[arg(value_name = "FILE.csv")]
    table: PathBuf,

    /// What its columns are [default: the table's name with .toml]
    #[arg(long, value_name = "FILE.toml")]
    mapping: Option<PathBuf>,

    /// Print the findings as one JSON document
    #[arg(long)]
    json: bool,

    /// Draw fit, residuals and autocorrelation of each zone into this folder, as SVG and PNG
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Train on the first three quarters of the days and print the error of day-ahead predictions on the others
    #[arg(long)]
    validate: bool,

    /// Print all numbers, the models that were compared, the tests of residuals, and every reason
    #[arg(long, conflicts_with = "json")]
    details: bool,

    /// Write a scenario with the network that was found, and beside it NAME-weather.csv, the recorded weather; a file that exists is
    /// never overwritten
    #[arg(long, value_name = "FILE.toml")]
    scenario: Option<PathBuf>,

    /// Let the controller of the scenario believe in the upper ends of the 95 % intervals, to see what a wrong model costs
    #[arg(long, requires = "scenario")]
    believe_upper_ends: bool,
}

impl Identify {
    pub(crate) fn execute(self) -> ExitStatus {
        let (found, recorded) = match self.identify() {
            Ok(found) => found,
            Err(error) => {
                print_error(&format!("Error: {error}"));
                return ExitStatus::BadInput;
            }
        };
        if let Err(error) = self.print_findings(&found) {
            print_error(&format!("Error: {error}"));
            return ExitStatus::Unfinished;
        }
        let scenario = match self.scenario_texts(&found, recorded) {
            Ok(scenario) => scenario,
            // The findings give the reason.
            Err(error) => {
                print_error(&format!("Error: {error}"));
                return ExitStatus::BadInput;
            }
        };
        if let Err(error) = self.write_scenario(scenario) {
            print_error(&format!("Error: {error}"));
            return ExitStatus::Unfinished;
        }
        ExitStatus::Well
    }

    /// The text of the scenario, and the table of its weather where whole days were recorded, with `--scenario`.
    fn scenario_texts(
        &self,
        found: &Identification,
        recorded: Option<RecordedDays>,
    ) -> Result<Option<ScenarioTexts>, InputError> {
        let Some(path) = &self.scenario else { return Ok(None) };
        let table = self.table.display().to_string();
        let network = found
            .network
            .as_ref()
            .map_err(|reason| InputError::NoNetwork { table: table.clone(), reason: reason.clone() })?;
        // Only the network can be wrong here: the table of weather is not written yet.
        let believed = if self.believe_upper_ends { Believed::UpperEnds } else { Believed::Estimate };
        let text = report::identified_scenario(&table, &found.report, network, None, believed);
        if let Err(error) = interplay_scenarios::from_text(&path.display().to_string(), &text, &[]) {
            let faults: Vec<&str> = error.faults().iter().map(Fault::message).collect();
            let reason = format!("no scenario can hold it: {}", faults.join("; "));
            return Err(InputError::NoNetwork { table, reason });
        }
        let weather = self.weather_path().zip(recorded);
        let Some((weather_path, recorded)) = weather else { return Ok(Some(ScenarioTexts { text, weather: None })) };
        let name = weather_path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let text = report::identified_scenario(&table, &found.report, network, Some((&name, &recorded)), believed);
        Ok(Some(ScenarioTexts { text, weather: Some((weather_path, recorded.csv)) }))
    }

    /// Where the recorded weather of the scenario goes.
    fn weather_path(&self) -> Option<PathBuf> {
        let scenario = self.scenario.as_ref()?;
        let stem = scenario.file_stem()?.to_string_lossy().into_owned();
        Some(scenario.with_file_name(format!("{stem}-weather.csv")))
    }

    fn write_scenario(&self, texts: Option<ScenarioTexts>) -> Result<(), CommandError> {
        let (Some(path), Some(ScenarioTexts { text, weather })) = (&self.scenario, texts) else { return Ok(()) };
        if let Some((weather_path, csv)) = weather {
            write_file(&weather_path, csv.as_bytes())?;
            print_error(&format!("recorded weather in {}", weather_path.display()));
        }
        write_file(path, text.as_bytes())?;
        let run = shell::line(["interplay", "run", &path.to_string_lossy()]);
        print_error(&format!("wrote {}; to run it: {run}", path.display()));
        Ok(())
    }

    fn identify(&self) -> Result<(Identification, Option<RecordedDays>), InputError> {
        let mut outputs = self.scenario.clone().into_iter().chain(self.weather_path());
        if let Some(path) = outputs.find(|path| path.exists()) {
            return Err(InputError::ScenarioExists { path });
        }
        let mapping_file = self.mapping.clone().unwrap_or_else(|| self.table.with_extension("toml"));
        let table = read(&self.table, "")?;
        let help = match self.mapping {
            Some(_) => "",
            None => "; a mapping says which column is what: name one with --mapping (see `interplay identify --help`)",
        };
        let described = read(&mapping_file, help)?;
        let mut mapping = Mapping::parse(&mapping_file.display().to_string(), &described)?;
        let name = self.table.display().to_string();
        let telemetry = Telemetry::read(&name, &table, &mapping)?;
        if self.validate && mapping.identify.train_days.is_none() {
            mapping.identify.train_days = Some(days_to_train(&telemetry));
        }
        let begun = Instant::now();
        let expected_s = expected_processor_s(&telemetry, &mapping.identify);
        if (TOLD_S..=mapping.identify.processor_s).contains(&expected_s) {
            print_error(&format!("this takes about {expected_s:.0} s of a processor"));
        }
        // A short fit ends before the user needs a sign of progress.
        let progress = |words: &str| {
            let seconds = begun.elapsed().as_secs();
            if seconds >= SILENT_S {
                print_error(&format!("{seconds} s: {words}"));
            }
        };
        let found =
            identify_with_progress(&telemetry, &mapping.identify, &progress).map_err(|reason| match reason {
                // Errors of these kinds are in the mapping, not in the table.
                IdentifyError::Setting(_)
                | IdentifyError::NothingToIdentify { .. }
                | IdentifyError::TooMuchWork { .. }
                | IdentifyError::TooManyZones { .. } => {
                    InputError::Identify { name: mapping_file.display().to_string(), reason }
                }
                _ => InputError::Identify { name, reason },
            })?;
        Ok((found, telemetry.recorded_days()))
    }

    /// Prints the findings, and draws them with `--out`.
    fn print_findings(&self, found: &Identification) -> Result<(), CommandError> {
        if let Some(folder) = &self.out {
            let written = plot::identification(folder, found)?;
            print_error(&format!("{} plots in {}", written.len(), folder.display()));
        }
        let text = if self.json {
            json("the findings", &found.report)?
        } else {
            let table = self.table.display().to_string();
            let mut text = match self.details {
                true => report::identification(&table, found),
                false => report::identified_summary(&table, found),
            };
            if self.validate {
                text.push_str(&held_out(found));
            }
            text
        };
        print(&text)
    }
}

/// The files written of an identified network.
struct ScenarioTexts {
    text: String,
    /// The recorded weather, and where it goes.
    weather: Option<(PathBuf, String)>,
}

/// A fit that is expected to take longer than this says so before it starts \[s\].
const TOLD_S: f64 = 10.0;
/// Seconds after which a fit tells what it does.
const SILENT_S: u64 = 5;
/// The share of the days that is trained on to validate.
const TRAINED_SHARE: f64 = 0.75;

/// The first three quarters of a record, in whole days if it has four \[d\].
fn days_to_train(telemetry: &Telemetry) -> f64 {
    let first_s = telemetry.time_s.first().copied().unwrap_or(0.0);
    let days = telemetry.time_s.last().map_or(0.0, |last_s| (last_s - first_s + telemetry.step_s) / 86_400.0);
    let trained = TRAINED_SHARE * days;
    if trained >= 3.0 { trained.floor() } else { trained.max(0.001) }
}

/// The errors of free runs on the days that were held out.
fn held_out(found: &Identification) -> String {
    let mut text = String::from("\nheld-out days\n");
    for zone in &found.report.zones {
        let Some(free) = zone.test.as_ref().map(|test| &test.free_run).filter(|free| free.runs > 0) else {
            text.push_str(&format!("  {}: too few days are left for a prediction of a day\n", zone.name));
            continue;
        };
        // The last forecast includes everything that the method models.
        let error = free.errors_k.iter().rev().find_map(|(_, error_k)| *error_k);
        let error = error.map_or_else(|| "-".to_owned(), |error_k| format!("{error_k:.3} K"));
        let mean = free.mean_of_data_k.map_or_else(String::new, |mean_k| format!(", mean of the data {mean_k:.3} K"));
        text.push_str(&format!(
            "  {}: {} h ahead {error} (root mean square of {} predictions{mean})\n",
            zone.name, free.horizon_h, free.runs
        ));
    }
    text
}

#[derive(Debug, Error)]
enum InputError {
    #[error("cannot read {}: {reason}{help}", path.display())]
    Unreadable { path: PathBuf, reason: io::Error, help: &'static str },
    #[error("{}:{line}: not UTF-8 text; save it as UTF-8", path.display())]
    NotUtf8 { path: PathBuf, line: usize },
    #[error("`{}` exists already, and `--scenario` overwrites nothing; choose another name", path.display())]
    ScenarioExists { path: PathBuf },
    #[error("{table}: no scenario is written: {reason}")]
    NoNetwork { table: String, reason: String },
    #[error(transparent)]
    Telemetry(#[from] TelemetryError),
    #[error("{name}: {reason}")]
    Identify { name: String, reason: IdentifyError },
}

/// The largest table that is read \[bytes\].
const MAX_FILE_BYTES: u64 = 1 << 30;

/// A file as text; the error ends with `help`.
fn read(path: &Path, help: &'static str) -> Result<String, InputError> {
    let path = path.to_owned();
    let bytes = match read_regular(&path, MAX_FILE_BYTES) {
        Ok(Some(bytes)) => bytes,
        Ok(None) => {
            let reason = io::Error::other("it is larger than 1 GiB");
            return Err(InputError::Unreadable { path, reason, help });
        }
        Err(reason) => return Err(InputError::Unreadable { path, reason, help }),
    };
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").map(<[u8]>::to_vec).unwrap_or(bytes);
    String::from_utf8(bytes).map_err(|error| {
        let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = valid.iter().filter(|byte| **byte == b'\n').count() + 1;
        InputError::NotUtf8 { path, line }
    })
}
