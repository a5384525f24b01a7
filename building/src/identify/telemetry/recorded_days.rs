//! The weather of telemetry, as a table that a scenario reads.

use std::fmt::Write as _;
use std::ops::Range;

use super::measurements::{Hold, Telemetry};

const DAY_S: f64 = 86_400.0;
/// The longest gap within days that are taken \[s\]; a scenario bridges as much by default.
const MAX_GAP_S: f64 = 6.0 * 3600.0;
/// The most rows of a table.
const MAX_ROWS: f64 = 2e6;

/// Whole days of recorded weather.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedDays {
    /// The table: `time_s` since the midnight before the first row, `outdoor_c`, and `sun_w_per_m2` where irradiance was measured.
    pub csv: String,
    /// Whether a row states the mean until the next one; otherwise it states values at its time.
    pub are_means: bool,
    /// Days of the table before the first whole one.
    pub skip_days: usize,
    /// How many whole days follow each other from there without a gap of more than six hours.
    pub days: usize,
    /// The sampling time, where a day is a whole number of steps that a building may take \[s\].
    pub step_s: Option<f64>,
    /// Whether zones have different irradiance, of which the table holds that of the first.
    pub has_other_sun: bool,
}

impl Telemetry {
    /// The longest stretch of whole days with recorded weather: the temperature of the first boundary, and the first irradiance.
    /// `None` without a boundary, or without a whole day.
    pub fn recorded_days(&self) -> Option<RecordedDays> {
        let boundary = self.boundaries.first()?;
        let suns: Vec<&Vec<f64>> = self.zones.iter().filter_map(|zone| zone.irradiance_kw_per_m2.as_ref()).collect();
        let places = self.places()?;
        let (first_s, rows) = (self.time_s[*places.iter().flatten().next()?], places.len());
        let mut csv = String::from(if suns.is_empty() { "time_s,outdoor_c" } else { "time_s,outdoor_c,sun_w_per_m2" });
        for (place, row) in places.iter().enumerate() {
            // Writing to a string cannot fail.
            let _ = write!(csv, "\n{}", first_s + place as f64 * self.step_s);
            let cell =
                |value: Option<f64>| value.filter(|value| value.is_finite()).map_or(String::new(), |it| it.to_string());
            let _ = write!(csv, ",{}", cell(row.map(|row| boundary.temperature_c[row])));
            if let Some(sun) = suns.first() {
                let _ = write!(csv, ",{}", cell(row.map(|row| 1000.0 * sun[row])));
            }
        }
        csv.push('\n');
        let known: Vec<f64> =
            (0..rows).filter(|place| places[*place].is_some()).map(|p| first_s + p as f64 * self.step_s).collect();
        let whole = longest_stretch(&known, self.step_s)?;
        let steps = DAY_S / self.step_s;
        let fits = (60.0..=3600.0).contains(&self.step_s) && (steps - steps.round()).abs() < 1e-9;
        Some(RecordedDays {
            csv,
            are_means: boundary.hold == Hold::ZeroOrder,
            skip_days: whole.start,
            days: whole.len(),
            step_s: fits.then_some(self.step_s),
            has_other_sun: suns.windows(2).any(|pair| pair[0] != pair[1]),
        })
    }

    /// The row at each sampling time from the first row on; recordings that go back in time are left out.
    fn places(&self) -> Option<Vec<Option<usize>>> {
        let first_s = *self.time_s.first()?;
        let mut places: Vec<Option<usize>> = Vec::new();
        for row in self.segments.iter().cloned().flatten() {
            let place = ((self.time_s[row] - first_s) / self.step_s).round();
            if place > MAX_ROWS {
                break;
            }
            if place < places.len() as f64 {
                continue;
            }
            places.resize(place as usize, None);
            places.push(Some(row));
        }
        Some(places)
    }
}

/// The most whole days in a row that have no long gap, counted from the midnight before the first of these times, which rise.
fn longest_stretch(known_s: &[f64], step_s: f64) -> Option<Range<usize>> {
    let last_day = (known_s.last()? / DAY_S).ceil() as usize;
    let is_whole = |day: usize| {
        let (from_s, to_s) = (day as f64 * DAY_S, (day + 1) as f64 * DAY_S);
        let first = known_s.partition_point(|time_s| *time_s < from_s - step_s - 1e-6);
        let end = known_s.partition_point(|time_s| *time_s <= to_s + 1e-6);
        let inside = &known_s[first..end];
        let gap = |pair: &[f64]| pair[1] - pair[0] > MAX_GAP_S + step_s;
        let reaches =
            |time_s: Option<&f64>, wanted_s: f64| time_s.is_some_and(|t| (t - wanted_s).abs() <= step_s + 1e-6);
        reaches(inside.first(), from_s) && reaches(inside.last(), to_s) && !inside.windows(2).any(gap)
    };
    let mut best = 0..0;
    let mut begin = 0;
    for day in 0..=last_day {
        if !is_whole(day) {
            begin = day + 1;
        } else if day + 1 - begin > best.len() {
            best = begin..day + 1;
        }
    }
    (!best.is_empty()).then_some(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_with_long_gaps_are_not_whole() {
        let hours = |hours: &[Range<usize>]| -> Vec<f64> {
            hours.iter().cloned().flatten().map(|hour| 3600.0 * hour as f64).collect()
        };
        // From 10:00 of the first day to 10:00 of the fifth.
        assert_eq!(longest_stretch(&hours(std::slice::from_ref(&(10..107))), 3600.0), Some(1..4));
        assert_eq!(longest_stretch(&hours(&[10..55, 61..107]), 3600.0), Some(1..4), "six hours are bridged");
        assert_eq!(longest_stretch(&hours(&[10..55, 63..107]), 3600.0), Some(1..2));
        assert_eq!(longest_stretch(&hours(std::slice::from_ref(&(10..40))), 3600.0), None);
        assert_eq!(
            longest_stretch(&hours(std::slice::from_ref(&(0..24))), 3600.0),
            Some(0..1),
            "to the last step of the day"
        );
    }
}
