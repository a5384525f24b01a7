//! EPW files (EnergyPlus weather).
//!
//! The hour of a row is the hour that *ends* at its time: hour 1 of 1 January ends at 01:00. Temperatures, humidity, pressure and wind
//! are those at the end of the interval; radiation is the sum over it. So row k (from zero) of an hourly file states its temperature
//! k + 1 hours after the first midnight, and its mean radiation at k + ½ hours. A file of a whole year is cyclic: the temperature between
//! 00:00 and 01:00 of the first day lies between those of the last and the first row.
//!
//! Times are local standard time all year, as in the file. Daylight saving in the header is ignored, and so are the years and minutes of
//! the rows (typical years mix years; hourly files write minute 0 or 60). A year is a leap year if the rows include 29 February, whatever
//! the header says. Missing values are bridged, and counted in [`Epw::filled`]. A cell with an impossible value also counts as missing
//! unless a run uses it: [`Epw::check_use`] returns the faults of the rows and fields that a run uses, and remarks on the others. If
//! global radiation is missing everywhere, it is computed from direct and diffuse radiation, if these exist.

mod calendar;
mod header;
mod rows;
mod usage;

use std::ops::Range;

use calendar::Date;
use header::Header;
pub use header::{EpwError, EpwProblem, Location};
pub use rows::Field;
use rows::{Doubt, FIELDS, Rows};
pub use usage::{EpwRemark, EpwUse};

use super::{Sky, TimeSeries, Weather};
use crate::calendar::Weekday;
use crate::series::{bridge, gaps};
use crate::sun::{Site, SplitRadiation, days_since_2000};

const HOUR_S: f64 = 3600.0;
const DAY_S: f64 = 86_400.0;
/// The year assumed for rows that state none; from year to year the sun's position differs by less than half a degree.
const USUAL_YEAR: i16 = 2001;

/// The content of an EPW file.
#[derive(Clone, Debug, PartialEq)]
pub struct Epw {
    /// Where the weather was measured.
    pub location: Location,
    /// Time between two rows \[s\].
    pub interval_s: f64,
    /// How many values of each field were missing and were bridged; fields without gaps are left out.
    pub filled: Vec<(Field, usize)>,
    first: Date,
    weekday: Option<Weekday>,
    leap: bool,
    whole_year: bool,
    /// Values of each field in the order of [`FIELDS`]; none if all are missing.
    columns: Vec<Option<Vec<f64>>>,
    /// The rows in which each field was missing, in the same order.
    gaps: Vec<Vec<Range<usize>>>,
    /// Cells with impossible values, which count as missing.
    doubts: Vec<Doubt>,
    /// The line of each row, from one.
    lines: Vec<usize>,
    /// The year that each day's first row states; none if that is not a year.
    years: Vec<Option<i16>>,
}

impl Epw {
    /// Reads the text of a file. (Old files are Latin-1: decode them lossily, other letters occur in names only.)
    ///
    /// # Errors
    /// [`EpwError`] with the line, if the text is not an EPW file, is cut off, or skips or repeats a row. What a run does not use
    /// may be wrong; [`Epw::check_use`] says whether it uses that.
    pub fn parse(text: &str) -> Result<Self, EpwError> {
        let header = Header::parse(text)?;
        let Rows { columns, leap, doubts, lines, years } = Rows::parse(text, &header)?;
        let missing: Vec<Vec<Range<usize>>> = columns.iter().map(|values| gaps(values)).collect();
        let mut filled = Vec::new();
        let columns: Vec<Option<Vec<f64>>> = (FIELDS.iter().zip(columns).zip(&missing))
            .map(|((specification, mut values), gaps)| {
                let count = gaps.iter().map(Range::len).sum();
                if count == values.len() {
                    return None;
                }
                bridge(&mut values, gaps);
                if count > 0 {
                    filled.push((specification.field, count));
                }
                Some(values)
            })
            .collect();
        let Some(rows) = columns[Field::DryBulb as usize].as_ref().map(Vec::len) else {
            return Err(EpwError::malformed(header.lines + 1, "every dry-bulb temperature is marked as missing"));
        };
        let days = if leap { 366 } else { 365 };
        Ok(Self {
            location: header.location,
            interval_s: HOUR_S / f64::from(header.intervals_per_hour),
            filled,
            first: header.first,
            weekday: header.weekday,
            leap,
            whole_year: rows == days * 24 * header.intervals_per_hour as usize,
            columns,
            gaps: missing,
            doubts,
            lines,
            years,
        })
    }

    /// The values of a field, one per row, with gaps bridged; `None` if all are missing.
    pub fn column(&self, field: Field) -> Option<&[f64]> {
        self.columns[field as usize].as_deref()
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns[Field::DryBulb as usize].as_ref().map_or(0, Vec::len)
    }

    /// Whether the rows include 29 February.
    pub fn is_leap(&self) -> bool {
        self.leap
    }

    /// Whether the rows cover a year, so that the first row follows the last.
    pub fn is_whole_year(&self) -> bool {
        self.whole_year
    }

    /// Midnight at the start of a day, as time after that of the first day \[s\]; `None` if the file has no such day.
    pub fn midnight_s(&self, month: u32, day: u32) -> Option<f64> {
        let date = Date::new(month, day).filter(|date| self.leap || *date != Date::FEBRUARY_29)?;
        let start_s = f64::from(date.days_after(self.first, self.leap)) * DAY_S;
        (start_s < self.rows() as f64 * self.interval_s).then_some(start_s)
    }

    /// The weekday of the day that begins at a midnight, as time after that of the first day \[s\]; `None` if the file states
    /// no weekday. (Typical years are put together from several, so it need not be that of the calendar.)
    pub fn weekday(&self, midnight_s: f64) -> Option<Weekday> {
        self.weekday.map(|first| first.after((midnight_s / DAY_S).round() as usize))
    }

    /// Temperature and sunshine as functions of time; without radiation in the file the sun does not shine.
    pub fn weather(&self) -> Weather {
        let series = |first_s: f64, values: Vec<f64>| TimeSeries {
            first_s,
            interval_s: self.interval_s,
            cyclic: self.whole_year,
            values,
        };
        let per_hour = HOUR_S / self.interval_s;
        let power =
            |field: Field| -> Option<Vec<f64>> { Some(self.column(field)?.iter().map(|sum| sum * per_hour).collect()) };
        let mid_s = 0.5 * self.interval_s;
        let parts = power(Field::DirectNormal).zip(power(Field::DiffuseHorizontal)).map(|(direct, diffuse)| {
            let part = |(direct_normal_w_per_m2, diffuse_w_per_m2)| SplitRadiation {
                direct_normal_w_per_m2,
                diffuse_w_per_m2,
            };
            direct.into_iter().zip(diffuse).map(part).collect()
        });
        let sky = Sky { site: self.site(), utc_days: self.utc_days(), parts };
        let global = power(Field::GlobalHorizontal).or_else(|| sky.global_w_per_m2());
        let sky = global.is_some().then_some(sky);
        let sun = global.unwrap_or_else(|| vec![0.0]);
        let ambient_c = self.column(Field::DryBulb).unwrap_or_default().to_vec();
        Weather { ambient_c: series(self.interval_s, ambient_c), sun_w_per_m2: series(mid_s, sun), sky }
    }

    /// Where the weather was measured, as the sun sees it.
    fn site(&self) -> Site {
        let Location { latitude_deg, longitude_deg, elevation_m, .. } = self.location;
        Site { latitude_deg, longitude_deg, elevation_m }
    }

    /// The middle of each row's interval in universal time, in days since noon of the 1st of January 2000. The year is that of
    /// the row's day, since its radiation came from the sun of that day.
    fn utc_days(&self) -> Vec<f64> {
        let per_day = (DAY_S / self.interval_s).round() as usize;
        let mut date = self.first;
        let mut days = Vec::with_capacity(self.rows());
        for year in &self.years {
            let (month, day) = date.month_and_day();
            let midnight = days_since_2000(i32::from(year.unwrap_or(USUAL_YEAR)), month, day);
            let middle_s = |row: usize| (row as f64 + 0.5) * self.interval_s - self.location.time_zone_h * HOUR_S;
            days.extend((0..per_day).map(|row| midnight + middle_s(row) / DAY_S));
            date = date.next(self.leap);
        }
        days
    }
}
