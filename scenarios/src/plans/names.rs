//! The scenarios that an entry of a plan selects.

use std::path::{Path, PathBuf};

use interplay_building::energy::Tariff;
use interplay_common::spelling::suggestion;

use crate::format::read::embedded::embedded;
use crate::format::read::tree::{TomlEntry, TomlNode, TomlValue};
use crate::load::files::files_below;
use crate::model::building::weather::WeatherSource;
use crate::model::scenario::{Scenario, Vehicle};
use crate::streets::Street;
use crate::text::error::{Document, Fault, Place, quoted};
use crate::text::name::fits;

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct NamedScenario {
    pub name: String,
    /// Its family: the folder of an embedded scenario, otherwise its name.
    pub family: String,
    /// The name of the embedded scenario, or the path of the file.
    pub source: String,
}

/// The names of the scenarios in the binary that an entry stands for: one of them, a pattern with `*` such as `intersection/*`, a family, or
/// streets. Empty if there are none.
pub fn names_matching(entry: &str) -> Vec<String> {
    let matching = |fits: &dyn Fn(&str) -> bool| -> Vec<String> {
        embedded().iter().filter(|file| fits(file.name)).map(|file| file.name.to_owned()).collect()
    };
    let family = format!("{}/", entry.trim_end_matches('/'));
    let mut found = matching(&|name| fits(entry, name));
    if found.is_empty() {
        found = matching(&|name| name.starts_with(&family));
    }
    if found.is_empty() {
        found = Street::matching(entry).iter().map(Street::name).collect();
    }
    found
}

/// The scenarios of an entry: an embedded scenario, a pattern with `*` or a family of them, streets, a file, a pattern of files, or all
/// scenarios below a folder, sorted by name. Paths are relative to `folder`.
pub(super) fn find(entry: &str, place: &Place, folder: &Path) -> Result<Vec<NamedScenario>, Fault> {
    let found = names_matching(entry);
    if !found.is_empty() {
        return Ok(found.into_iter().map(embedded_scenario).collect());
    }
    let path = folder.join(entry);
    if path.is_dir() {
        let files = files_of(&path, entry, place)?;
        if files.is_empty() {
            return Err(Fault::at(place, "empty", format!("folder {} contains no scenario", quoted(entry))));
        }
        return Ok(files.iter().map(|file| in_folder(file, &path)).collect());
    }
    if let Some(star) = entry.find('*') {
        let (below, pattern) = entry[..star].rfind('/').map_or(("", entry), |end| (&entry[..end], &entry[end + 1..]));
        let base = folder.join(below);
        let base = if base.as_os_str().is_empty() { PathBuf::from(".") } else { base };
        let mut files = if base.is_dir() { files_of(&base, entry, place)? } else { Vec::new() };
        files.retain(|file| file.strip_prefix(&base).is_ok_and(|name| fits(pattern, &name.to_string_lossy())));
        if !files.is_empty() {
            return Ok(files.iter().map(|file| in_folder(file, &base)).collect());
        }
    }
    if path.is_file() {
        let name = path.file_stem().map_or_else(|| entry.to_owned(), |stem| stem.to_string_lossy().into_owned());
        let source = path.to_string_lossy().into_owned();
        return Ok(vec![NamedScenario { family: name.clone(), name, source }]);
    }
    let mut names: Vec<&str> = embedded().iter().map(|file| file.name).collect();
    names.extend(families());
    let message = format!("there is no scenario, no family and no file {}", quoted(entry));
    let help = format!("{}; `interplay list` shows all of them", suggestion(entry, "families are", &families()));
    let near = interplay_common::spelling::nearest(entry, names);
    let help = near.map_or(help, |near| format!("did you mean `{near}`? `interplay list` shows all of them"));
    Err(Fault::at(place, "unknown", message).help(help))
}

/// A scenario in the binary. The family of a street is the folder of its kind.
fn embedded_scenario(name: String) -> NamedScenario {
    let is_street = name.starts_with("streets/");
    let family = if is_street { name.rsplit_once('/') } else { name.split_once('/') };
    let family = family.map_or(&*name, |(family, _)| family).to_owned();
    NamedScenario { family, source: name.clone(), name }
}

/// The files of scenarios below a folder that an entry names.
fn files_of(path: &Path, entry: &str, place: &Place) -> Result<Vec<PathBuf>, Fault> {
    let unreadable = |reason: std::io::Error| {
        Fault::at(place, "unreadable", format!("cannot read folder {}: {reason}", quoted(entry)))
    };
    let files = files_below(path).map_err(unreadable)?;
    let files: Vec<PathBuf> = files.scenarios.into_iter().map(|scenario| scenario.path).collect();
    match files.iter().find(|file| file.to_str().is_none()) {
        None => Ok(files),
        Some(file) => {
            let message = format!("the name of {} is not UTF-8 text", quoted(&file.display().to_string()));
            Err(Fault::at(place, "a file in this folder", message).help("rename the file"))
        }
    }
}

fn in_folder(file: &Path, folder: &Path) -> NamedScenario {
    let name = file.strip_prefix(folder).unwrap_or(file).with_extension("").to_string_lossy().into_owned();
    let family = name.split('/').next().unwrap_or(&name).to_owned();
    NamedScenario { name, family, source: file.to_string_lossy().into_owned() }
}

/// The folders of the embedded scenarios.
fn families() -> Vec<&'static str> {
    let mut found: Vec<&str> = embedded().iter().filter_map(|file| file.name.split('/').next()).collect();
    found.dedup();
    found
}

/// The settings that name such files, by their first key.
pub(super) const SETTINGS: [&str; 4] = ["weather", "tariff", "gains", "vehicle"];

/// The contents of the weather file, of the tables of prices and gains and of recorded vehicles of a scenario, and the digests of files that
/// drivers name, where it has them, in words of which no two that differ have the same.
pub(super) fn contents(scenario: &Scenario) -> String {
    let weather = match &scenario.weather {
        WeatherSource::Epw(weather) => format!("{:?}{:?}", weather.stated, weather.rows),
        WeatherSource::Csv(weather) => format!("{:?}{:?}", weather.stated, weather.weather),
        WeatherSource::Synthetic(_) => String::new(),
    };
    // The interval of hourly prices is left out, so that plans keep the keys of their runs.
    let by_the_hour = |tariff: &Tariff| tariff.interval_s == 3600.0;
    let interval = |tariff: &Tariff| if by_the_hour(tariff) { String::new() } else { tariff.interval_s.to_string() };
    let told = |tariff: &Tariff| format!("{:?}{}", tariff.prices_per_kwh, interval(tariff));
    let prices: String = scenario.tariff.iter().map(told).collect();
    let gains: String = scenario.gains.iter().map(|gains| format!("{:?}", gains.zones)).collect();
    let is_recorded = |vehicle: &&Vehicle| vehicle.driver.record().is_some();
    let records: String =
        scenario.vehicles.iter().filter(is_recorded).map(|vehicle| format!("{:?}", vehicle.driver)).collect();
    let digest = |vehicle: &Vehicle| Some(serde_json::to_value(&vehicle.driver).ok()?.get("digest")?.to_string());
    let networks: String = scenario.vehicles.iter().filter_map(digest).collect();
    weather + &prices + &gains + &records + &networks
}

/// The key of a plan that states its number of samples.
const KEY: &str = "samples";

/// Replaces the number of samples of a plan by that of the flag `--samples`, which errors then name. Returns the text of the
/// plan with only this number changed.
///
/// A table in place of the number is kept: the check refuses it.
pub(super) fn replace(tree: &mut TomlNode, text: &str, samples: u64) -> String {
    let TomlValue::Table(root) = &mut tree.value else { return text.to_owned() };
    let written = samples.to_string();
    let whole = Place::new(&Document::new("--samples", &written, 0), 0..written.len());
    let node = TomlNode { place: whole.clone(), value: TomlValue::Integer(i128::from(samples)) };
    match root.get_mut(KEY) {
        Some(entry) if entry.node.table().is_some() => text.to_owned(),
        Some(entry) => {
            let span = entry.node.place.span.clone();
            entry.node = node;
            match (text.get(..span.start), text.get(span.end..)) {
                (Some(before), Some(behind)) => format!("{before}{written}{behind}"),
                _ => text.to_owned(),
            }
        }
        None => {
            root.insert(KEY.to_owned(), TomlEntry { key: whole, node });
            // The key is added at the beginning, because at the end it would belong to a table. A byte-order mark stays first.
            let (mark, rest) = text.strip_prefix('\u{feff}').map_or(("", text), |rest| ("\u{feff}", rest));
            format!("{mark}{KEY} = {written} # --samples\n{rest}")
        }
    }
}
