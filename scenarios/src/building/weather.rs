//! The weather of a scenario: synthetic, or from an EPW file.
//!
//! An EPW file is read when the scenario is loaded, so that whatever is wrong with it is said then, with its line.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use interplay_building::weather::{Climate, Epw, Forecast, TimeSeries};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DAY_S;
use crate::Scenario;
use crate::error::{Document, Place, Problem, quoted};
use crate::nearest::suggestion;
use crate::tree::Node;

/// Weather files in the binary, by the name that a scenario gives as `file`.
static EMBEDDED: &[(&str, &str)] = &[("tropical-july.epw", include_str!("../../weather/tropical-july.epw"))];
/// The largest file that is read; a year by the minute takes less \[bytes\].
const LARGEST_BYTES: u64 = 1 << 27;
/// Errors in weather are listed after those in the scenario.
const RANK: usize = 1000;

/// The weather outside and how well it is known beforehand; `kind` chooses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Weather {
    /// A synthetic tropical climate, drawn from the scenario's seed.
    Synthetic(Synthetic),
    /// A file in the format of EnergyPlus.
    Epw(EpwFile),
}

impl Default for Weather {
    fn default() -> Self {
        Weather::Synthetic(Synthetic::default())
    }
}

/// A synthetic tropical climate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Synthetic {
    /// What the climate is like; by default like Singapore's.
    pub climate: Climate,
    /// How a day's temperatures are forecast at its start; by default without error.
    pub forecast: Forecast,
}

/// Weather from an EPW file, from a midnight on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EpwFile {
    /// The file, relative to the scenario file; or the name of one in the binary: `tropical-july.epw`.
    #[schemars(example = &"tropical-july.epw")]
    pub file: String,
    /// The month in which the first day lies; without month and day, the first day of the file.
    #[serde(default)]
    #[schemars(range(min = 1, max = 12), example = 7)]
    pub month: Option<u32>,
    /// The first day, in its month.
    #[serde(default)]
    #[schemars(range(min = 1, max = 31), example = 8)]
    pub day: Option<u32>,
    /// How a day's temperatures are forecast at its start; by default without error.
    #[serde(default)]
    pub forecast: Forecast,
    /// What the file says, once it was read.
    #[serde(skip)]
    content: Option<Arc<Epw>>,
}

impl EpwFile {
    /// Midnight at the start of the first day, as time after that of the file's first \[s\].
    fn start_s(&self, epw: &Epw) -> Option<f64> {
        match (self.month, self.day) {
            (None, None) => Some(0.0),
            (month, day) => epw.midnight_s(month.unwrap_or(1), day.unwrap_or(1)),
        }
    }
}

impl Weather {
    /// How a day's temperatures are forecast.
    pub fn forecast(&self) -> Forecast {
        match self {
            Weather::Synthetic(synthetic) => synthetic.forecast,
            Weather::Epw(file) => file.forecast,
        }
    }

    /// The weather as functions of the time since the first midnight, for so many days. `None` only for an EPW file of
    /// a scenario that was not loaded.
    pub fn days(&self, days: usize, seed: u64) -> Option<interplay_building::weather::Weather> {
        match self {
            Weather::Synthetic(synthetic) => Some(synthetic.climate.weather(seed, days)),
            Weather::Epw(file) => {
                let epw = file.content.as_ref()?;
                let start_s = file.start_s(epw)?;
                let shifted = |series: TimeSeries| TimeSeries { first_s: series.first_s - start_s, ..series };
                let interplay_building::weather::Weather { ambient_c, sun_w_per_m2 } = epw.weather();
                Some(interplay_building::weather::Weather {
                    ambient_c: shifted(ambient_c),
                    sun_w_per_m2: shifted(sun_w_per_m2),
                })
            }
        }
    }
}

/// Reads the EPW file of a scenario, if it has one, and sees that it covers the days that are simulated.
pub(crate) fn attach(scenario: &mut Scenario, tree: &Node) -> Result<(), Problem> {
    let days = scenario.days();
    let Some(Weather::Epw(file)) = &mut scenario.weather else { return Ok(()) };
    let place = tree.place_of("weather.file");
    let (title, text) = read(&file.file, place)?;
    let epw = Epw::parse(&text).map_err(|error| located(&title, &text, error.line, &error.problem.to_string()))?;
    let Some(start_s) = file.start_s(&epw) else {
        let (month, day) = (file.month.unwrap_or(1), file.day.unwrap_or(1));
        let message = format!("{} has no day {day} of month {month}", quoted(&title));
        let place = tree.place_of(if file.day.is_some() { "weather.day" } else { "weather.month" });
        return Err(Problem::at(place, "no such day", message).help("without `month` and `day` its first day is taken"));
    };
    let covered = ((epw.rows() as f64 * epw.interval_s - start_s) / DAY_S).floor() as usize;
    if !epw.is_whole_year() && days > covered {
        let message = format!("{} covers {covered} days from there, and {days} are simulated", quoted(&title));
        let problem = Problem::at(place, "too short", message);
        return Err(problem.help("lower `iterations`, start earlier, or take a file of a whole year, which repeats"));
    }
    file.content = Some(Arc::new(epw));
    Ok(())
}

/// Whether a file of weather of that name is in the binary.
pub(crate) fn is_embedded_weather(name: &str) -> bool {
    EMBEDDED.iter().any(|(known, _)| *known == name)
}

/// Title and text of the EPW file that is called `file` at `place`.
fn read(file: &str, place: &Place) -> Result<(String, String), Problem> {
    if let Some((name, text)) = EMBEDDED.iter().find(|(name, _)| *name == file) {
        return Ok(((*name).to_owned(), (*text).to_owned()));
    }
    let beside = Path::new(&place.document.name).parent().unwrap_or(Path::new(""));
    // A flag is no file: what it names is relative to the current folder, and so is the flag's parent.
    let path: PathBuf = beside.join(file);
    let title = path.display().to_string();
    let refused = |reason: String| {
        let names: Vec<&str> = EMBEDDED.iter().map(|(name, _)| *name).collect();
        let help = format!(
            "the path is relative to the scenario file; {}",
            suggestion(file, "in the binary there are", &names)
        );
        Problem::at(place, "this file", format!("cannot read {}: {reason}", quoted(&title))).help(help)
    };
    let opened = File::open(&path).map_err(|error| refused(error.to_string()))?;
    if opened.metadata().is_ok_and(|found| found.is_dir()) {
        return Err(refused("it is a directory".to_owned()));
    }
    let mut bytes = Vec::new();
    opened.take(LARGEST_BYTES + 1).read_to_end(&mut bytes).map_err(|error| refused(error.to_string()))?;
    if bytes.len() as u64 > LARGEST_BYTES {
        return Err(refused("it is larger than 128 MiB, and no weather file is".to_owned()));
    }
    Ok((title, String::from_utf8_lossy(&bytes).into_owned()))
}

/// A problem in a line of an EPW file, counted from 1.
fn located(title: &str, text: &str, line: usize, problem: &str) -> Problem {
    let ends = text.match_indices('\n').map(|(end, _)| end + 1);
    let start = [0].into_iter().chain(ends).nth(line.saturating_sub(1)).unwrap_or(text.len());
    let length = text[start..].find(['\r', '\n']).unwrap_or(text.len() - start);
    let document = Document::new(title, text, RANK);
    let place = Place::new(&document, start..start + length);
    let message = format!("{} is no whole EPW file: line {line}: {problem}", quoted(title));
    let help =
        "`weather.file` must name an EPW file as EnergyPlus reads it: 8 lines of header, then a row for each interval";
    Problem::at(&place, "this line", message).help(help)
}
