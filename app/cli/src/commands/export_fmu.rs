//! `interplay export-fmu`

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use interplay_fmu::{FmiVersion, export};
use interplay_presentation::figures::FrameLog;
use interplay_scenarios::{Override, Registry, Scenario};
use interplay_simulation::run::run;

use crate::flag_values::files::{destroyed, is_same_file, short_name};
use crate::output::error::{CommandError, ExitStatus, write_file};
use crate::output::{print_error, print_load_error};

/// Write the building of a scenario, with its weather, as a functional mock-up unit (FMI 2.0 or 3.0, co-simulation).
///
/// The heat of each zone is an input, its temperature an output. People, sun and the air outside are those of the scenario.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    interplay export-fmu building/four-room-pid --out rooms.fmu\n  \
    interplay export-fmu building/four-room-pid --out rooms.fmu --fmi 3.0\n  \
    interplay export-fmu my.toml --out my.fmu --reference my.csv   (and heat and temperatures of a run of ours)")]
pub(crate) struct ExportFmu {
    /// Name of an embedded scenario (see `interplay list`) or path of a scenario file
    #[arg(value_name = "NAME|FILE")]
    scenario: String,

    /// Where the FMU goes
    #[arg(long, value_name = "FILE.fmu")]
    out: PathBuf,

    /// Version of the standard that the importer knows; both compute the same
    #[arg(long, value_name = "VERSION", value_enum, default_value_t = Version::Two)]
    fmi: Version,

    /// Run the scenario, too, and write heat and temperatures of every step into this table, to compare an importer with
    #[arg(long, value_name = "FILE.csv")]
    reference: Option<PathBuf>,

    /// Change one value of the scenario; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,
}

/// The versions of FMI by their names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Version {
    #[value(name = "2.0")]
    Two,
    #[value(name = "3.0")]
    Three,
}

impl From<Version> for FmiVersion {
    fn from(version: Version) -> Self {
        match version {
            Version::Two => Self::Two,
            Version::Three => Self::Three,
        }
    }
}

impl ExportFmu {
    pub(crate) fn execute(self, registry: &Registry) -> ExitStatus {
        let scenario = match registry.load(&self.scenario, &self.overrides()) {
            Ok(scenario) => scenario,
            Err(error) => {
                print_load_error(error);
                return ExitStatus::BadInput;
            }
        };
        if let Some(reason) = self.refused_output(registry) {
            print_error(&reason);
            return ExitStatus::BadInput;
        }
        let fmu = match export(&scenario, self.fmi.into()) {
            Ok(fmu) => fmu,
            Err(error) => {
                print_error(&format!("Error: {}: {error}", self.scenario));
                return ExitStatus::BadInput;
            }
        };
        let written = self.write_reference(&scenario).and_then(|()| write_file(&self.out, &fmu));
        if let Err(error) = written {
            print_error(&format!("Error: {error}"));
            return ExitStatus::Unfinished;
        }
        print_error(&format!("wrote {} ({} KiB)", self.out.display(), fmu.len().div_ceil(1024)));
        ExitStatus::Well
    }

    fn overrides(&self) -> Vec<Override> {
        self.sets.iter().cloned().map(Override::Set).collect()
    }

    /// Why a file must not be written: it would take the place of an input or of the other file.
    fn refused_output(&self, registry: &Registry) -> Option<String> {
        let outputs = [Some(self.out.as_path()), self.reference.as_deref()];
        for path in outputs.into_iter().flatten() {
            if let Some(path) = destroyed(registry, path, [self.scenario.as_str()].into_iter(), &self.overrides()) {
                let path = path.display();
                return Some(format!(
                    "`{path}` would be overwritten, of which the scenario is made; choose another name"
                ));
            }
        }
        let reference = self.reference.as_ref().filter(|reference| is_same_file(reference, &self.out))?;
        Some(format!("the FMU and the table cannot both be `{}`; choose another name for one", reference.display()))
    }

    /// Runs the scenario and writes its steps, with `--reference`.
    fn write_reference(&self, scenario: &Scenario) -> Result<(), CommandError> {
        let Some(path) = &self.reference else { return Ok(()) };
        let building = Scenario { vehicles: Vec::new(), counterfactuals: Vec::new(), ..scenario.clone() };
        let log = FrameLog::default();
        run(&short_name(&self.scenario), &building, vec![Box::new(log.clone())])?;
        write_file(Path::new(path), table(&building, &log).as_bytes())?;
        print_error(&format!("wrote {}", path.display()));
        Ok(())
    }
}

/// A row for each step: time, heat of each zone during the step, and its temperature at the end.
fn table(scenario: &Scenario, log: &FrameLog) -> String {
    let network = scenario.building.as_ref().and_then(|building| building.network().ok());
    let names = network.map_or(Vec::new(), |network| network.names()[..network.zone_count()].to_vec());
    let mut text = "time_s".to_owned();
    // Writing to a text cannot fail.
    for name in &names {
        let _ = write!(text, ",{}", quoted(&format!("{name}.heat_kw")));
    }
    for name in &names {
        let _ = write!(text, ",{}", quoted(&format!("{name}.end_temperature_c")));
    }
    text.push('\n');
    for frame in log.frames().iter() {
        let Some(building) = &frame.building else { continue };
        let _ = write!(text, "{}", frame.time_s);
        for zone in &building.zones {
            let _ = write!(text, ",{}", zone.heat_kw);
        }
        for zone in &building.zones {
            let _ = write!(text, ",{}", zone.next_c);
        }
        text.push('\n');
    }
    text
}

fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}
