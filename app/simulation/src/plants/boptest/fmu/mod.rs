//! A test case that is an FMU on this machine: it runs in a separate process, and answers like a BOPTEST server.
//!
//! ```text
//! wrapped.fmu -> Unit -> Host (a child process)      resources/*.csv -> CaseData: forecasts, prices, bounds
//!                        FmuBench: initialize, advance, results
//! ```
//!
//! BOPTEST's own indicators are not available; the report contains those that Interplay computes from the results.

mod bench;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::plants::boptest::boptest_error::BoptestError;

pub use bench::FmuBench;

/// A year, after which the data repeat \[s\].
const YEAR_S: f64 = 365.0 * 86_400.0;
/// The table of the weather, whose values are interpolated linearly; those of other tables hold until the next time.
const WEATHER: &str = "weather.csv";

#[derive(Debug, Default)]
pub(crate) struct CaseData {
    series: BTreeMap<String, Series>,
}

#[derive(Debug)]
struct Series {
    times_s: Vec<f64>,
    values: Vec<f64>,
    is_linear: bool,
}

impl CaseData {
    /// Reads all tables of a folder that have a column `time`; a missing folder has none.
    ///
    /// # Errors
    /// [`BoptestError::Case`] if a table cannot be read.
    pub fn read(folder: &Path) -> Result<Self, BoptestError> {
        let mut data = Self::default();
        let Ok(entries) = fs::read_dir(folder) else { return Ok(data) };
        let mut paths: Vec<_> = entries.filter_map(Result::ok).map(|entry| entry.path()).collect();
        paths.sort();
        for path in paths.iter().filter(|path| path.extension().is_some_and(|ending| ending == "csv")) {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let failed = |reason: String| BoptestError::Case { reason: format!("its table `{name}`: {reason}") };
            let text = fs::read_to_string(path).map_err(|error| failed(error.to_string()))?;
            data.add(&text, name == WEATHER).map_err(failed)?;
        }
        Ok(data)
    }

    fn add(&mut self, text: &str, is_linear: bool) -> Result<(), String> {
        let mut lines = text.lines().filter(|line| !line.starts_with('#') && !line.trim().is_empty());
        let titles: Vec<&str> =
            lines.next().unwrap_or_default().split(',').map(|title| title.trim().trim_matches('"')).collect();
        let Some(time) = titles.iter().position(|title| *title == "time") else { return Ok(()) };
        let mut columns = vec![Vec::new(); titles.len()];
        for (row, line) in lines.enumerate() {
            let values: Result<Vec<f64>, _> = line.split(',').map(|value| value.trim().parse::<f64>()).collect();
            let values = values.ok().filter(|values| values.len() == titles.len());
            let values = values.ok_or_else(|| format!("row {} does not have {} numbers", row + 1, titles.len()))?;
            columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
        }
        let times_s = columns[time].clone();
        if times_s.is_empty() || times_s.windows(2).any(|pair| pair[1] <= pair[0]) {
            return Err("its times do not rise".to_owned());
        }
        for (title, values) in titles.iter().zip(columns).filter(|(title, _)| **title != "time") {
            let series = Series { times_s: times_s.clone(), values, is_linear };
            self.series.insert((*title).to_owned(), series);
        }
        Ok(())
    }

    /// The values of a series at some times of the year \[s\].
    ///
    /// # Errors
    /// [`BoptestError::Case`] if the series does not exist.
    pub fn at(&self, name: &str, times_s: &[f64]) -> Result<Vec<f64>, BoptestError> {
        let series = self.series.get(name).ok_or_else(|| BoptestError::Case {
            reason: format!("its resources have no series `{name}` for forecasts and indicators"),
        })?;
        Ok(times_s.iter().map(|time_s| series.at(*time_s)).collect())
    }
}

impl Series {
    fn at(&self, time_s: f64) -> f64 {
        let time_s = if time_s > YEAR_S { time_s.rem_euclid(YEAR_S) } else { time_s };
        let after = self.times_s.partition_point(|known_s| *known_s <= time_s + 1e-6);
        let before = after.saturating_sub(1);
        let next = after.min(self.values.len() - 1);
        if !self.is_linear || next == before {
            return self.values[before];
        }
        let share = (time_s - self.times_s[before]) / (self.times_s[next] - self.times_s[before]);
        self.values[before] + share.clamp(0.0, 1.0) * (self.values[next] - self.values[before])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weather_is_interpolated_and_prices_are_held() {
        let mut data = CaseData::default();
        data.add("# a note\ntime,TDryBul\n0,270\n3600,274\n", true).expect("weather");
        data.add("time,Price\n0.0,1\n900.0,2\n", false).expect("prices");
        data.add("name,value\na,b\n", false).expect("a table without times is skipped");
        assert_eq!(
            data.at("TDryBul", &[-1.0, 900.0, 5000.0, YEAR_S + 1800.0]).expect("known"),
            [270.0, 271.0, 274.0, 272.0]
        );
        assert_eq!(data.at("Price", &[0.0, 899.0, 900.0]).expect("known"), [1.0, 1.0, 2.0]);
        assert!(data.at("TDryBulb", &[]).is_err());
        assert!(data.add("time,x\n0,1\n0,2\n", false).is_err() && data.add("time,x\n0,warm\n", false).is_err());
    }
}
