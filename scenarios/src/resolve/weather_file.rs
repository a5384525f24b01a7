//! Reads the weather file of a scenario, when the scenario is loaded: whatever is wrong with it is said then, with its line.

use std::sync::Arc;

use interplay_building::weather::Epw;
use interplay_common::spelling::suggestion;

use crate::error::{Fault, Place, quoted};
use crate::file_format::building::DAY_S;
use crate::file_format::weather::{EpwFile, EpwWeather};
use crate::read::regular_file::read_regular;
use crate::read::stated_path::{base_in_words, path_beside};
use crate::read::text_line::line_of;
use crate::read::tree::TomlNode;

/// Weather files in the binary, by the name that a scenario gives as `file`.
static EMBEDDED: &[(&str, &str)] = &[("tropical-july.epw", include_str!("../../weather/tropical-july.epw"))];
/// The largest file that is read; a year by the minute takes less \[bytes\].
const MAX_FILE_BYTES: u64 = 1 << 27;
/// Errors in weather are listed after those in the scenario.
const RANK: usize = 1000;

/// Reads an EPW file and checks that it covers `days` days of simulation.
pub(crate) fn read(stated: EpwFile, days: usize, tree: &TomlNode) -> Result<EpwWeather, Fault> {
    let (place, file) = (tree.place_of("weather.file"), &stated);
    let EpwText { title, found, text } = text_of(&file.file, place)?;
    let epw = Epw::parse(&text).map_err(|error| located(&title, &text, error.line, &error.problem.to_string()))?;
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
    Ok(EpwWeather { stated, found, rows: Arc::new(epw), start_s })
}

/// Whether a file of weather of that name is in the binary.
pub(crate) fn is_embedded_weather(name: &str) -> bool {
    EMBEDDED.iter().any(|(known, _)| *known == name)
}

/// The text of an EPW file.
struct EpwText {
    /// How errors call the file.
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

/// A fault in a line of an EPW file, counted from 1.
fn located(title: &str, text: &str, line: usize, fault: &str) -> Fault {
    let message = format!("{} is no whole EPW file: line {line}: {fault}", quoted(title));
    let help =
        "`weather.file` must name an EPW file as EnergyPlus reads it: 8 lines of header, then a row for each interval";
    Fault::at(&line_of(title, text, line, RANK), "this line", message).help(help)
}
