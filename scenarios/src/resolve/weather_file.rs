//! Reads the weather file of a scenario, EPW or a table, when the scenario is loaded; its faults are reported then, with their lines.

use std::sync::Arc;

use interplay_building::calendar::Weekday;
use interplay_building::weather::epw::{EpwProblem, EpwRemark, EpwUse, Field};
use interplay_building::weather::{Epw, EpwError, Forecast, ReadWeather, RecordedWeather, RunSpan};
use interplay_common::spelling::suggestion;

use super::series_file::SeriesFile;
use crate::format::read::regular_file::read_regular;
use crate::format::read::stated_path::{base_in_words, path_beside};
use crate::format::read::text_line::{line_of, line_without_text};
use crate::format::read::tree::TomlNode;
use crate::model::building::config::DAY_S;
use crate::model::building::plant::BuildingPlant;
use crate::model::building::weather::{CsvWeather, EpwFile, EpwWeather};
use crate::model::remark::ScenarioRemark;
use crate::model::scenario::Scenario;
use crate::text::error::{Fault, Place, quoted};

/// Weather files in the binary, by the name that a scenario gives as `file`.
static EMBEDDED: &[(&str, &str)] = &[("tropical-july.epw", include_str!("../../weather/tropical-july.epw"))];
/// The largest file that is read; a year of minutes needs less \[bytes\].
const MAX_FILE_BYTES: u64 = 1 << 27;
/// Errors in weather are listed after those in the scenario.
const RANK: usize = 1000;

/// Reads an EPW file and checks that it covers the days of the simulation and is correct on them; faults elsewhere are
/// remarks.
pub(crate) fn read(
    stated: EpwFile,
    scenario: &Scenario,
    tree: &TomlNode,
) -> Result<(EpwWeather, Vec<ScenarioRemark>), Fault> {
    let (place, file, days) = (tree.place_of("weather.file"), &stated, scenario.days());
    let EpwText { title, found, text } = text_of(&file.file, place)?;
    let epw = Epw::parse(&text).map_err(|error| located(&title, error.line, &error.problem.to_string()))?;
    let Some(start_s) = file.start_s(&epw) else {
        let (month, day) = (file.month.unwrap_or(1), file.day.unwrap_or(1));
        let message = format!("{} has no day {day} of month {month}", quoted(&title));
        let place = tree.place_of(if file.day.is_some() { "weather.day" } else { "weather.month" });
        return Err(Fault::at(place, "no such day", message).help("without `month` and `day` its first day is taken"));
    };
    let covered = ((epw.rows() as f64 * epw.interval_s - start_s) / DAY_S).floor() as usize;
    if !epw.is_whole_year() && days > covered {
        let message = format!("{} covers {covered} days from there, and {days} are simulated", quoted(&title));
        let fault = Fault::at(place, "too short", message);
        return Err(fault.help("lower `iterations`, start earlier, or take a file of a whole year, which repeats"));
    }
    // A forecast that repeats the day before uses that day, too.
    let back_s = if file.forecast == Forecast::Persistence { DAY_S } else { 0.0 };
    let usage = EpwUse {
        fields: used_fields(scenario),
        from_s: start_s - back_s,
        to_s: start_s + days as f64 * DAY_S,
        bridge_gaps_h: file.bridge_gaps_h,
    };
    let remarks = epw.check_use(&usage).map_err(|error| unusable(&title, &text, &error))?;
    let remark = |remark: EpwRemark| {
        let message = format!("{}: line {}: {}", quoted(&title), remark.line, remark.text);
        ScenarioRemark(Fault::at(&line_of(&title, &text, remark.line, RANK), "this line", message))
    };
    let remarks = remarks.into_iter().map(remark).collect();
    Ok((EpwWeather { stated, found, rows: Arc::new(epw), start_s }, remarks))
}

/// The columns of a weather file that a run uses: temperatures, and solar radiation if the building has windows.
fn used_fields(scenario: &Scenario) -> &'static [Field] {
    const ALL: [Field; 4] = [Field::DryBulb, Field::GlobalHorizontal, Field::DirectNormal, Field::DiffuseHorizontal];
    let building = scenario.building.as_ref();
    let is_foreign = building.is_some_and(|building| !matches!(building.plant, BuildingPlant::Network(_)));
    match building.and_then(|building| building.network().ok()) {
        Some(network) if !network.window_planes().is_empty() => &ALL,
        Some(network) if network.has_sun() || is_foreign => &ALL[..2],
        _ => &ALL[..1],
    }
}

/// Reads a table of weather.
pub(crate) fn read_table(
    stated: RecordedWeather,
    scenario: &Scenario,
    tree: &TomlNode,
) -> Result<(CsvWeather, Vec<ScenarioRemark>), Fault> {
    let file = SeriesFile::read(&stated.file, "weather.file", tree, "table of weather", RANK)?;
    let start = file.start(scenario, stated.skip_days);
    let span = RunSpan {
        start_s: start.start_s,
        duration_s: scenario.days() as f64 * DAY_S,
        local_days: start.local_days,
        uses_sun: used_fields(scenario).len() > 1,
    };
    let ReadWeather { weather, remarks } = stated.read(&file.table, &span).map_err(|error| file.fault(&error))?;
    let remarks = remarks.iter().map(|remark| ScenarioRemark(file.remark(remark))).collect();
    let first_weekday = file.table.first_day.and(start.local_days).map(Weekday::of_local_days);
    Ok((CsvWeather { stated, found: file.found, weather: Arc::new(weather), first_weekday }, remarks))
}

/// Whether a file of weather of that name is in the binary.
pub(crate) fn is_embedded_weather(name: &str) -> bool {
    EMBEDDED.iter().any(|(known, _)| *known == name)
}

/// The text of an EPW file.
struct EpwText {
    /// The name of the file in errors.
    title: String,
    /// Its absolute path, or its name in the binary.
    found: String,
    text: String,
}

/// The EPW file that is called `file` at `place`.
fn text_of(file: &str, place: &Place) -> Result<EpwText, Fault> {
    if let Some((name, text)) = EMBEDDED.iter().find(|(name, _)| *name == file) {
        let name = (*name).to_owned();
        return Ok(EpwText { title: name.clone(), found: name, text: (*text).to_owned() });
    }
    let path = path_beside(place, file);
    let title = path.display().to_string();
    let refused = |reason: String| {
        let names: Vec<&str> = EMBEDDED.iter().map(|(name, _)| *name).collect();
        let help = format!("{}; {}", base_in_words(place), suggestion(file, "in the binary there are", &names));
        Fault::at(place, "this file", format!("cannot read {}: {reason}", quoted(&title))).help(help)
    };
    let bytes = read_regular(&path, MAX_FILE_BYTES).map_err(|error| refused(error.to_string()))?;
    let too_large = || refused("it is larger than 128 MiB, and no weather file is".to_owned());
    let bytes = bytes.ok_or_else(too_large)?;
    let found = std::path::absolute(&path).unwrap_or(path).to_string_lossy().into_owned();
    Ok(EpwText { title, found, text: String::from_utf8_lossy(&bytes).into_owned() })
}

/// A fault in the part of an EPW file that a run uses.
fn unusable(title: &str, text: &str, error: &EpwError) -> Fault {
    let message = format!("{}: line {}: {}", quoted(title), error.line, error.problem);
    let help = match error.problem {
        EpwProblem::Gap { .. } => "`weather.bridge_gaps_h` bridges longer gaps; or take other days, or another file",
        EpwProblem::NoValues { .. } => {
            "take a file that has it, or leave `solar_aperture_m2` and `window` out of the building"
        }
        _ => "the run uses this cell: correct it, take other days, or another file",
    };
    Fault::at(&line_of(title, text, error.line, RANK), "this line", message).help(help)
}

/// A fault in a line of an EPW file, counted from 1.
fn located(title: &str, line: usize, fault: &str) -> Fault {
    let message = format!("{} is not a complete EPW file: line {line}: {fault}", quoted(title));
    let help =
        "`weather.file` must name an EPW file as EnergyPlus reads it: 8 lines of header, then a row for each interval";
    Fault::at(&line_without_text(title, line, RANK), "this line", message).help(help)
}
