//! `interplay import`

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use interplay_files::{NewFolders, write_new};
use interplay_presentation::shell;
use interplay_scenarios::{
    Completes, ImportOptions, LoadError, Registry, Replacement, ScenarioFile, VehicleConfig, import_commonroad_file,
};
use thiserror::Error;

use crate::output::error::ExitStatus;
use crate::output::{print_error, print_load_error, printed};

/// A network with more lanes stands in a file of its own.
const MAX_LANES_BESIDE_VEHICLES: usize = 12;

/// Make a scenario of one of CommonRoad (XML, versions 2018b and 2020a), which you can then edit.
///
/// Lanelets become lanes, obstacles become vehicles that follow their records, and the planning problem becomes the ego. The records
/// stand in a table beside the scenario, and so does a large network. A line is printed for each kind of thing that a scenario
/// cannot say yet. `check`, `run` and `suite` take the XML file as it is, too.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  interplay import USA_US101-4_1_T-1.xml && interplay run USA_US101-4_1_T-1.toml\n  \
    interplay import crossing.xml --out mine.toml --ego negotiation --replace all=human:normal"
)]
pub(crate) struct Import {
    /// The file to import
    #[arg(value_name = "FILE.xml")]
    file: PathBuf,

    /// The scenario to write; files that exist are never overwritten [default: the same name with .toml, in the current folder]
    #[arg(long, value_name = "SCENARIO.toml")]
    out: Option<PathBuf>,

    /// The kind of driver of the ego
    #[arg(long, value_name = "PLANNER")]
    ego: Option<String>,

    /// Let a driver take the place of a record: `all`, `all=human:tough`, or `ID=idm`; may be repeated
    #[arg(long, value_name = "all|ID=DRIVER[:STYLE]", value_parser = replacement)]
    replace: Vec<Replacement>,
}

/// A replaced vehicle and its driver: `all`, `all=human:tough`, `1213=idm`.
fn replacement(text: &str) -> Result<Replacement, String> {
    let (vehicle, driver) = text.split_once('=').unwrap_or((text, "human"));
    if vehicle != "all" && !text.contains('=') {
        return Err("write `all`, or the id of a vehicle with its driver, such as `1213=human:nice`".to_owned());
    }
    let (kind, style) = driver.split_once(':').map_or((driver, None), |(kind, style)| (kind, Some(style)));
    if kind.is_empty() || vehicle.is_empty() || style.is_some_and(str::is_empty) {
        return Err("nothing may be empty beside `=` and `:`".to_owned());
    }
    let vehicle = (vehicle != "all").then(|| vehicle.to_owned());
    Ok(Replacement { vehicle, kind: kind.to_owned(), style: style.map(str::to_owned) })
}

/// Why an import wrote no scenario.
#[derive(Debug, Error)]
enum ImportError {
    #[error(transparent)]
    Refused(#[from] LoadError),
    #[error("`{}` exists already, and `interplay import` overwrites nothing; choose another name with `--out`", .0.display())]
    Exists(PathBuf),
    #[error("cannot write `{}`: {reason}", path.display())]
    Unwritable { path: PathBuf, reason: std::io::Error },
}

impl Import {
    pub(crate) fn execute(self, registry: &Registry) -> ExitStatus {
        match self.import(registry) {
            Ok(said) => printed(&said),
            Err(ImportError::Refused(error)) => {
                print_load_error(error);
                ExitStatus::BadInput
            }
            Err(error) => {
                print_error(&error.to_string());
                if matches!(error, ImportError::Exists(_)) { ExitStatus::BadInput } else { ExitStatus::Unfinished }
            }
        }
    }

    /// Writes the scenario and what stands beside it; what is printed.
    fn import(&self, registry: &Registry) -> Result<String, ImportError> {
        let stem = self.file.file_stem().map_or_else(|| "scenario".into(), |stem| stem.to_string_lossy().into_owned());
        let out = self.out.clone().unwrap_or_else(|| PathBuf::from(format!("{stem}.toml")));
        let options = ImportOptions { ego: self.ego.clone(), replace: self.replace.clone() };
        let imported = import_commonroad_file(&self.file, &options)?;
        // A scenario that could not be run is refused with its place in the imported file.
        imported.resolve(registry)?;
        let beside = |ending: &str| out.with_extension(ending);
        let named = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let records = beside("csv");
        let (mut file, rows) = imported.with_records_in(&named(&records));
        let are_replaced = self.replace.iter().any(|replacement| replacement.vehicle.is_none());
        let warning = expect_and_warn(&mut file, are_replaced);
        let mut head = String::new();
        let _ = writeln!(head, "# Imported from {}.", plain_line(&named(&self.file)));
        for note in imported.notes.iter().chain(&warning) {
            let _ = writeln!(head, "# - {note}");
        }
        let network = beside("network.toml");
        let (text, network_text) = texts(file, &named(&network));
        let mut files = vec![(out.clone(), head + "\n" + &text)];
        files.extend(network_text.map(|text| (network, text)));
        files.extend(rows.map(|rows| (records, rows)));
        write_all(&files)?;
        let lines: String = imported.notes.iter().chain(&warning).map(|note| format!("{note}\n")).collect();
        let names: Vec<String> = files.iter().map(|(path, _)| path.display().to_string()).collect();
        let run = shell::line(["interplay", "run", &out.to_string_lossy()]);
        Ok(format!("{lines}wrote {}; to run it: {run}\n", names.join(", ")))
    }
}

/// Expects that no two vehicles touch, and that an ego which has to reach another lane does; returns a warning where vehicles follow
/// records, since these do not react. `are_replaced`: whether all that can be replaced are.
fn expect_and_warn(file: &mut ScenarioFile, are_replaced: bool) -> Option<String> {
    file.expect.no_collision = Some(true);
    let ego = file.vehicles.iter().find(|vehicle| vehicle.name == "ego" && vehicle.route.len() > 1);
    let completes = ego.map(|ego| Completes { vehicle: ego.name.clone(), after_s: None, before_s: None });
    file.expect.completes.extend(completes);
    let is_recorded = |vehicle: &&VehicleConfig| {
        vehicle.driver.as_ref().and_then(|driver| driver.get("kind")?.as_str()) == Some("recorded")
    };
    let recorded = file.vehicles.iter().filter(is_recorded).count();
    let follow = if recorded == 1 { "follows its record and reacts" } else { "follow their records and react" };
    let remedy = if are_replaced { "" } else { "; `--replace all` gives them drivers" };
    (recorded > 0).then(|| format!("recorded vehicles: {recorded} {follow} to no other{remedy}"))
}

/// The text of the scenario, and that of its network where it is large.
fn texts(mut file: ScenarioFile, network: &str) -> (String, Option<String>) {
    let lanes = file.road.as_ref().and_then(|road| road.get("lane")?.as_array().map(Vec::len)).unwrap_or_default();
    if lanes <= MAX_LANES_BESIDE_VEHICLES {
        return (file.to_toml(), None);
    }
    let road = ScenarioFile { road: file.road.take(), ..ScenarioFile::new(&file.title, &file.shows) };
    let extends = toml_text(network);
    (format!("extends = {extends}\n{}", file.to_toml()), Some(road.to_toml()))
}

/// A text as TOML has it.
fn toml_text(text: &str) -> String {
    format!("{text:?}")
}

/// A text without line breaks and other control characters, as a comment has it.
fn plain_line(text: &str) -> String {
    text.replace(char::is_control, "·")
}

/// Writes files that must not exist, all or none.
fn write_all(files: &[(PathBuf, String)]) -> Result<(), ImportError> {
    if let Some((path, _)) = files.iter().find(|(path, _)| path.exists()) {
        return Err(ImportError::Exists(path.clone()));
    }
    let unwritable = |path: &Path, reason| ImportError::Unwritable { path: path.to_owned(), reason };
    let mut folders = Vec::new();
    for (index, (path, text)) in files.iter().enumerate() {
        let made = NewFolders::make_above(path).map_err(|reason| unwritable(path, reason));
        let written = made.and_then(|made| {
            folders.push(made);
            write_new(path, text.as_bytes()).map_err(|reason| unwritable(path, reason))
        });
        if let Err(error) = written {
            for (path, _) in &files[..index] {
                let _ = std::fs::remove_file(path);
            }
            return Err(error);
        }
    }
    folders.into_iter().for_each(NewFolders::keep);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_replace_flag_names_a_vehicle_and_a_driver() {
        let of = |vehicle: Option<&str>, kind: &str, style: Option<&str>| {
            let [vehicle, style] = [vehicle, style].map(|word| word.map(str::to_owned));
            Ok(Replacement { vehicle, kind: kind.to_owned(), style })
        };
        assert_eq!(replacement("all"), of(None, "human", None));
        assert_eq!(replacement("all=human:tough"), of(None, "human", Some("tough")));
        assert_eq!(replacement("1213=idm"), of(Some("1213"), "idm", None));
        assert!(replacement("1213").is_err() && replacement("=idm").is_err() && replacement("1213=").is_err());
    }
}
