//! `interplay identify`

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use interplay_building::identify::{Identification, Mapping, Telemetry, identify};
use interplay_presentation::{plot, report};

use crate::ending::Ending;
use crate::output::{complain, print};

/// Find thermal parameters in telemetry, with uncertainty and residual diagnostics.
///
/// A small TOML file beside the table, the mapping, says which column is what, in which unit, and sampled how.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    interplay identify office.csv                        (its mapping is office.toml)\n  \
    interplay identify office.csv --mapping columns.toml --out plots/ --json\n\n\
    A mapping:\n  \
    walls = [[\"office\", \"outdoor\"]]\n  \
    time = { column = \"time\", format = \"%Y-%m-%d %H:%M:%S\", step_s = 900.0, gaps = \"split\" }\n  \
    boundary = [{ name = \"outdoor\", temperature = \"T_out\" }]\n  \
    zone = [{ name = \"office\", temperature = \"T_in\", heat = [{ kind = \"power\", column = \"P\", unit = \"kw\" }] }]\n  \
    identify = { method = \"prediction-error\", train_days = 9.0 }")]
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
}

impl Identify {
    pub(crate) fn execute(self) -> Ending {
        let found = match self.identify() {
            Ok(found) => found,
            Err(error) => {
                complain(&format!("Error: {error}"));
                return Ending::BadInput;
            }
        };
        let told = self.tell(&found);
        if let Err(error) = told {
            complain(&format!("Error: {error}"));
            return Ending::Unfinished;
        }
        Ending::Well
    }

    fn identify(&self) -> Result<Identification, String> {
        let mapping_file = self.mapping.clone().unwrap_or_else(|| self.table.with_extension("toml"));
        let table = read(&self.table, "")?;
        let help = match self.mapping {
            Some(_) => "",
            None => "; a mapping says which column is what: name one with --mapping (see `interplay identify --help`)",
        };
        let described = read(&mapping_file, help)?;
        let said = |error: interplay_building::identify::TelemetryError| error.to_string();
        let mapping = Mapping::parse(&mapping_file.display().to_string(), &described).map_err(said)?;
        let name = self.table.display().to_string();
        let telemetry = Telemetry::read(&name, &table, &mapping).map_err(said)?;
        identify(&telemetry, &mapping.identify).map_err(|error| format!("{name}: {error}"))
    }

    /// Prints what was found, and draws it if that is asked for.
    fn tell(&self, found: &Identification) -> Result<(), String> {
        if let Some(folder) = &self.out {
            let written = plot::identification(folder, found).map_err(|error| error.to_string())?;
            complain(&format!("{} plots in {}", written.len(), folder.display()));
        }
        let text = if self.json {
            let text = serde_json::to_string_pretty(&found.report);
            text.map_err(|error| format!("the findings cannot be written as JSON: {error}"))? + "\n"
        } else {
            report::identification(&self.table.display().to_string(), found)
        };
        print(&text);
        Ok(())
    }
}

/// A file as text; the error says what would work.
fn read(path: &Path, help: &str) -> Result<String, String> {
    let bytes = fs::read(path).map_err(|error| format!("cannot read {}: {error}{help}", path.display()))?;
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").map(<[u8]>::to_vec).unwrap_or(bytes);
    String::from_utf8(bytes).map_err(|error| {
        let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = valid.iter().filter(|byte| **byte == b'\n').count() + 1;
        format!("{}:{line}: not UTF-8 text; save it as UTF-8", path.display())
    })
}
