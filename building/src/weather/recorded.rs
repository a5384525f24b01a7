//! Weather from a table, recorded or made by another program.

use interplay_common::spelling::suggestion;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Forecast, Sky, TimeSeries, Weather};
use crate::series::{SeriesColumn, SeriesError, SeriesTable, bridge, gaps};
use crate::sun::{Site, SplitRadiation};

const HOUR_S: f64 = 3600.0;
/// The lowest and the highest temperature outdoors \[°C\].
const PLAUSIBLE_C: (f64, f64) = (-90.0, 70.0);
/// The least and the largest radiation; sensors may read a little below 0 at night \[W/m²\].
const PLAUSIBLE_W_PER_M2: (f64, f64) = (-50.0, 2000.0);

/// Weather from a table of comma-separated values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RecordedWeather {
    /// The table: a header, whose first title is that of the times (`hour` or `time_s` since the first midnight, or any other with
    /// dates), and rows at equal intervals. The path is relative to the scenario or plan that states it, and in a flag to the current
    /// folder.
    #[schemars(example = &"weather.csv")]
    pub file: String,
    /// Title of the outdoor temperatures \[°C\].
    #[serde(default = "default_temperature")]
    pub temperature: String,
    /// Title of the global radiation on a horizontal plane \[W/m²\]; without it `sun_w_per_m2`, if the table has that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(example = &"ghi")]
    pub sun: Option<String>,
    /// Title of the direct radiation on a plane towards the sun \[W/m²\]; with `diffuse`. Without both they are estimated from the
    /// global radiation (Erbs et al., 1982).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(example = &"dni")]
    pub direct_normal: Option<String>,
    /// Title of the diffuse radiation on a horizontal plane \[W/m²\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(example = &"dhi")]
    pub diffuse: Option<String>,
    /// What a row states.
    #[serde(default)]
    pub rows: RowMeaning,
    /// Latitude, positive to the north; windows need it \[deg\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -90.0, max = 90.0), example = 47.4)]
    pub latitude_deg: Option<f64>,
    /// Longitude, positive to the east; windows need it \[deg\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -180.0, max = 180.0), example = 8.5)]
    pub longitude_deg: Option<f64>,
    /// Hours by which the clocks of the table are ahead of Greenwich; windows need it \[h\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = -14.0, max = 14.0), example = 1.0)]
    pub time_zone_h: Option<f64>,
    /// Days of the table before the first day of the run.
    #[serde(default)]
    #[schemars(range(min = 0, max = 100000))]
    pub skip_days: usize,
    /// Whether the table begins anew after its end; otherwise it must cover the run.
    #[serde(default)]
    pub repeats: bool,
    /// The longest gap in what the run uses that is bridged, with a remark; a longer one is refused \[h\].
    #[serde(default = "default_bridge_gaps_h")]
    #[schemars(range(min = 0.0, max = 100000.0))]
    pub bridge_gaps_h: f64,
    /// How a day's temperatures are forecast at its start; by default without error.
    #[serde(default)]
    pub forecast: Forecast,
}

/// What a row of a table of weather states.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RowMeaning {
    /// Values at the time of the row; they are linear in between.
    #[default]
    Instant,
    /// Means over the interval that begins at the time of the row.
    MeanFrom,
    /// Means over the interval that ends at the time of the row.
    MeanUntil,
}

fn default_temperature() -> String {
    "outdoor_c".to_owned()
}

/// The longest gap in weather that is bridged unless something else is stated \[h\].
pub fn default_bridge_gaps_h() -> f64 {
    6.0
}

/// The time span of a run within a table of weather.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunSpan {
    /// Midnight at the start of the first day, after that of the table's first \[s\].
    pub start_s: f64,
    /// How long the run is \[s\].
    pub duration_s: f64,
    /// The first day at its midnight, in days since noon of the 1st of January 2000, on the clocks of the table; `None` where no
    /// date is known.
    pub local_days: Option<f64>,
    /// Whether the sun warms anything.
    pub uses_sun: bool,
}

/// Weather that was read from a table.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadWeather {
    /// The weather, its times counted from the first midnight of the run.
    pub weather: Weather,
    /// What is allowed and may not have been meant, each with a line.
    pub remarks: Vec<SeriesError>,
}

impl RecordedWeather {
    /// The weather of a table over the span of a run.
    ///
    /// # Errors
    /// [`SeriesError`] with the line, for a column that is not there, a value that cannot be, a gap that is too long, or a table that
    /// does not cover the run.
    pub fn read(&self, table: &SeriesTable, span: &RunSpan) -> Result<ReadWeather, SeriesError> {
        let mut reader = Reader { settings: self, table, span, remarks: Vec::new() };
        reader.covers()?;
        let ambient_c = reader.values(&self.temperature, PLAUSIBLE_C, true)?;
        let is_there = self.sun.is_some() || table.column("sun_w_per_m2").is_some();
        let global = is_there.then(|| self.sun.as_deref().unwrap_or("sun_w_per_m2"));
        let global = global.map(|title| reader.values(title, PLAUSIBLE_W_PER_M2, span.uses_sun)).transpose()?;
        let parts = reader.parts()?;
        let sky = reader.sky(parts, ambient_c.len());
        let global = global.or_else(|| sky.as_ref()?.global_w_per_m2());
        if global.is_none() && span.uses_sun {
            let problem = "the table has no sun, and the building lets it in: name the column as `sun`";
            return Err(SeriesError { line: 1, problem: problem.to_owned() });
        }
        let remarks = std::mem::take(&mut reader.remarks);
        let series = |values: Vec<f64>| reader.series(values);
        let sky = sky.filter(|_| global.is_some());
        let dark = vec![0.0; ambient_c.len()];
        let sun = global.unwrap_or(dark).into_iter().map(|sun| sun.max(0.0)).collect();
        Ok(ReadWeather { weather: Weather { ambient_c: series(ambient_c), sun_w_per_m2: series(sun), sky }, remarks })
    }
}

struct Reader<'a> {
    settings: &'a RecordedWeather,
    table: &'a SeriesTable,
    span: &'a RunSpan,
    remarks: Vec<SeriesError>,
}

impl Reader<'_> {
    /// When the value of the first row holds, since the first midnight of the table \[s\].
    fn first_s(&self) -> f64 {
        let shift = match self.settings.rows {
            RowMeaning::Instant => 0.0,
            RowMeaning::MeanFrom => 0.5,
            RowMeaning::MeanUntil => -0.5,
        };
        self.table.first_s + shift * self.table.interval_s
    }

    /// Values at the times of the rows, their times counted from the first midnight of the run.
    fn series(&self, values: Vec<f64>) -> TimeSeries {
        let first_s = self.first_s() - self.span.start_s;
        TimeSeries { first_s, interval_s: self.table.interval_s, cyclic: self.settings.repeats, values }
    }

    /// Whether there are rows for the whole run, up to an interval at its ends.
    fn covers(&self) -> Result<(), SeriesError> {
        let interval_s = self.table.interval_s;
        let (first_s, rows) = (self.first_s(), self.table.lines.len());
        let last_s = first_s + (rows - 1) as f64 * interval_s;
        let (from_s, to_s) = (self.span.start_s, self.span.start_s + self.span.duration_s);
        if self.settings.repeats || (first_s <= from_s + 1.5 * interval_s && last_s >= to_s - 1.5 * interval_s - 1e-6) {
            return Ok(());
        }
        let problem = format!(
            "the table covers the hours {:.2} to {:.2} after its first midnight, and the run takes {:.2} to {:.2}; lower \
             `iterations`, change `skip_days`, or state `repeats = true`",
            self.table.first_s / HOUR_S,
            (last_s + interval_s) / HOUR_S,
            from_s / HOUR_S,
            to_s / HOUR_S
        );
        let line = self.table.lines.last().copied().unwrap_or(1);
        Err(SeriesError { line, problem })
    }

    /// The values of a column, bridged; what is wrong where the run uses them.
    fn values(&mut self, title: &str, (least, greatest): (f64, f64), is_used: bool) -> Result<Vec<f64>, SeriesError> {
        let column = self.column(title)?;
        let mut values = column.values.clone();
        let used = self.used_rows();
        for (row, value) in values.iter_mut().enumerate() {
            if value.is_nan() || (least..=greatest).contains(value) {
                continue;
            }
            let problem = format!("`{title}` is {value}; possible are {least} to {greatest}");
            let fault = SeriesError { line: self.table.lines[row], problem };
            if is_used && used.contains(&row) {
                return Err(fault);
            }
            self.remarks.push(SeriesError { problem: format!("{}; the run does not use it", fault.problem), ..fault });
            *value = f64::NAN;
        }
        let gaps = gaps(&values);
        let hours = |gap: &std::ops::Range<usize>| gap.len() as f64 * self.table.interval_s / HOUR_S;
        let in_use: Vec<_> =
            gaps.iter().filter(|gap| is_used && gap.start < used.end && gap.end > used.start).collect();
        let limit_h = self.settings.bridge_gaps_h;
        if let Some(gap) = in_use.iter().find(|gap| hours(gap) > limit_h || gap.len() == values.len()) {
            let problem = format!(
                "`{title}` is missing for {:.2} h from here on, and at most {limit_h} h are bridged; `bridge_gaps_h` changes that",
                hours(gap)
            );
            return Err(SeriesError { line: self.table.lines[gap.start], problem });
        }
        if let Some(first) = in_use.first() {
            let rows: usize = in_use.iter().map(|gap| gap.len()).sum();
            let problem = format!("`{title}` is missing in {rows} rows that the run uses, and is bridged");
            self.remarks.push(SeriesError { line: self.table.lines[first.start], problem });
        }
        bridge(&mut values, &gaps);
        Ok(values)
    }

    fn column(&self, title: &str) -> Result<&SeriesColumn, SeriesError> {
        let refused = || {
            let titles = self.table.titles();
            let problem = format!("there is no column `{title}`; {}", suggestion(title, "the columns are", &titles));
            SeriesError { line: self.table.header_line, problem }
        };
        self.table.column(title).ok_or_else(refused)
    }

    fn used_rows(&self) -> std::ops::Range<usize> {
        let rows = self.table.lines.len();
        if self.settings.repeats {
            return 0..rows;
        }
        // A forecast that repeats the day before uses that day, too.
        let back_s = if self.settings.forecast == Forecast::Persistence { 86_400.0 } else { 0.0 };
        let row = |time_s: f64| (time_s - self.first_s()) / self.table.interval_s;
        let first = row(self.span.start_s - back_s).floor().max(0.0) as usize;
        let last = row(self.span.start_s + self.span.duration_s).ceil().max(0.0) as usize;
        first..(last + 1).min(rows)
    }

    /// Direct and diffuse radiation, where both are named.
    fn parts(&mut self) -> Result<Option<Vec<SplitRadiation>>, SeriesError> {
        let (direct, diffuse) = match (&self.settings.direct_normal, &self.settings.diffuse) {
            (Some(direct), Some(diffuse)) => (direct.clone(), diffuse.clone()),
            (None, None) => return Ok(None),
            _ => {
                let problem = "`direct_normal` and `diffuse` need each other: name both columns, or none";
                return Err(SeriesError { line: self.table.header_line, problem: problem.to_owned() });
            }
        };
        let direct = self.values(&direct, PLAUSIBLE_W_PER_M2, self.span.uses_sun)?;
        let diffuse = self.values(&diffuse, PLAUSIBLE_W_PER_M2, self.span.uses_sun)?;
        let part = |(direct, diffuse): (f64, f64)| SplitRadiation {
            direct_normal_w_per_m2: direct.max(0.0),
            diffuse_w_per_m2: diffuse.max(0.0),
        };
        Ok(Some(direct.into_iter().zip(diffuse).map(part).collect()))
    }

    /// The sky over the place, if it and the date are known.
    fn sky(&self, parts: Option<Vec<SplitRadiation>>, rows: usize) -> Option<Sky> {
        let RecordedWeather { latitude_deg, longitude_deg, time_zone_h, .. } = self.settings;
        let site = Site { latitude_deg: (*latitude_deg)?, longitude_deg: (*longitude_deg)?, elevation_m: 0.0 };
        let first_s = self.first_s() - self.span.start_s - (*time_zone_h)? * HOUR_S;
        let day = self.span.local_days?;
        let moment = |row: usize| day + (first_s + row as f64 * self.table.interval_s) / 86_400.0;
        Some(Sky { site, utc_days: (0..rows).map(moment).collect(), parts })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DAY_S: f64 = 86_400.0;

    fn settings() -> RecordedWeather {
        serde_json::from_value(serde_json::json!({ "file": "w.csv" })).expect("defaults")
    }

    /// Two days by the hour, with 10 °C more each hour of the second.
    fn text() -> String {
        let rows = (0..48).map(|hour| format!("{hour},{},{}\n", hour % 24 + 10 * (hour / 24), 100 * (hour % 5)));
        format!("hour,outdoor_c,sun_w_per_m2\n{}", rows.collect::<String>())
    }

    fn span(start_s: f64, days: f64) -> RunSpan {
        RunSpan { start_s, duration_s: days * DAY_S, local_days: None, uses_sun: true }
    }

    #[test]
    fn weather_rows_are_read_as_instants_or_means_as_stated() {
        let table = SeriesTable::parse(&text()).expect("a table");
        let at = |rows: RowMeaning, hours: f64| {
            let read = RecordedWeather { rows, ..settings() }.read(&table, &span(DAY_S, 1.0)).expect("weather");
            read.weather.ambient_c.at(hours * HOUR_S)
        };
        assert_eq!((at(RowMeaning::Instant, 3.0), at(RowMeaning::Instant, 3.5)), (13.0, 13.5));
        assert_eq!((at(RowMeaning::MeanFrom, 3.5), at(RowMeaning::MeanUntil, 3.5)), (13.0, 14.0));
    }

    #[test]
    fn missing_or_implausible_values_are_refused_only_if_the_run_uses_them() {
        let refused = |text: &str, settings: RecordedWeather, span: RunSpan| {
            let table = SeriesTable::parse(text).expect("a table");
            settings.read(&table, &span).expect_err("must be refused")
        };
        let short = refused(&text(), settings(), span(DAY_S, 2.0));
        assert!(short.line == 49 && short.problem.contains("repeats = true"), "{short}");
        let cold = text().replace("\n30,16,", "\n30,-999,");
        let fault = refused(&cold, settings(), span(DAY_S, 1.0));
        assert!(fault.line == 32 && fault.problem.contains("-999"), "{fault}");
        let read = settings().read(&SeriesTable::parse(&cold).expect("a table"), &span(0.0, 1.0)).expect("not used");
        assert!(read.remarks[0].line == 32 && read.remarks[0].problem.contains("does not use"), "{:?}", read.remarks);
        let other = refused(&text(), RecordedWeather { temperature: "outdor".into(), ..settings() }, span(0.0, 1.0));
        assert!(other.line == 1 && other.problem.contains("outdoor_c"), "{other}");
        let no_sun = text().replace("sun_w_per_m2", "rain");
        assert!(refused(&no_sun, settings(), span(0.0, 1.0)).problem.contains("no sun"));
    }

    #[test]
    fn short_gaps_are_bridged_with_a_remark_and_long_ones_refused() {
        let missing = |hours: std::ops::Range<usize>| {
            let is_missing =
                |line: &&str| line.split(',').next().and_then(|h| h.parse().ok()).is_some_and(|h| hours.contains(&h));
            let text: Vec<String> = text()
                .lines()
                .map(|line| {
                    if is_missing(&line) {
                        format!("{},,0", line.split(',').next().unwrap_or(""))
                    } else {
                        line.to_owned()
                    }
                })
                .collect();
            settings().read(&SeriesTable::parse(&text.join("\n")).expect("a table"), &span(0.0, 1.0))
        };
        let read = missing(3..5).expect("bridged");
        assert_eq!(read.weather.ambient_c.at(3.5 * HOUR_S), 3.5);
        assert!(read.remarks[0].line == 5 && read.remarks[0].problem.contains("2 rows"), "{:?}", read.remarks);
        let fault = missing(3..13).expect_err("too long");
        assert!(fault.line == 5 && fault.problem.contains("10.00 h"), "{fault}");
        assert_eq!(missing(30..45).expect("not used").remarks, []);
    }
}
