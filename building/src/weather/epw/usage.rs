//! Checks the part of a file that a run uses. Faults in other parts are allowed.

use std::ops::Range;

use super::header::{EpwError, EpwProblem};
use super::rows::{FIELDS, Field};
use super::{Epw, HOUR_S};

/// The part of a file that a run uses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EpwUse<'a> {
    /// The fields.
    pub fields: &'a [Field],
    /// The time from which they are taken, after the midnight of the file's first day \[s\].
    pub from_s: f64,
    /// The time up to which they are taken \[s\].
    pub to_s: f64,
    /// The longest gap that is bridged \[h\].
    pub bridge_gaps_h: f64,
}

/// A property of a file that is allowed, but may be a mistake.
#[derive(Clone, Debug, PartialEq)]
pub struct EpwRemark {
    /// The first line that it is about, from one.
    pub line: usize,
    /// What it is.
    pub text: String,
}

impl Epw {
    /// Checks the rows and fields that a run uses. Returns a remark for each used field with bridged gaps, and for each
    /// unused field with impossible values.
    ///
    /// # Errors
    /// [`EpwError`] with the first line in which a used field has an impossible value, or is missing for too long.
    pub fn check_use(&self, usage: &EpwUse<'_>) -> Result<Vec<EpwRemark>, EpwError> {
        let rows = self.used_rows(usage);
        let mut remarks = Vec::new();
        let mut faults: Vec<EpwError> = Vec::new();
        for specification in &FIELDS {
            let field = specification.field;
            let is_used = usage.fields.contains(&field);
            if is_used && self.column(field).is_none() && self.has_substitute(field) {
                continue;
            }
            if is_used && self.column(field).is_none() && !self.doubts.iter().any(|doubt| doubt.field == field) {
                let line = self.lines.first().copied().unwrap_or(1);
                let words = format!("every {} is marked as missing, and the run uses it", field.name());
                faults.push(EpwError { line, problem: EpwProblem::NoValues(words) });
                continue;
            }
            let doubtful = |inside: bool| {
                let here = self.doubts.iter().filter(move |doubt| doubt.field == field);
                here.filter(move |doubt| (is_used && rows.contains(doubt.row)) == inside)
            };
            if let Some(doubt) = doubtful(true).next() {
                faults.push(EpwError::malformed(self.lines[doubt.row], doubt.problem.clone()));
                continue;
            }
            if let Some(doubt) = doubtful(false).next() {
                let text = match doubtful(false).count() {
                    1 => format!("{}; the run does not use this cell", doubt.problem),
                    count => format!("{}; there are {count} such cells, and the run uses none of them", doubt.problem),
                };
                remarks.push(EpwRemark { line: self.lines[doubt.row], text });
            }
            if is_used {
                match self.bridged(field, specification.column + 1, rows, usage.bridge_gaps_h) {
                    Ok(remark) => remarks.extend(remark),
                    Err(fault) => faults.push(fault),
                }
            }
        }
        faults.into_iter().min_by_key(|fault| fault.line).map_or(Ok(remarks), Err)
    }

    /// Whether radiation that is missing everywhere follows from the others: global radiation from direct and diffuse radiation, and
    /// these from it (Erbs et al., 1982).
    fn has_substitute(&self, field: Field) -> bool {
        let has = |field: Field| self.column(field).is_some();
        match field {
            Field::GlobalHorizontal => has(Field::DirectNormal) && has(Field::DiffuseHorizontal),
            Field::DirectNormal | Field::DiffuseHorizontal => has(Field::GlobalHorizontal),
            _ => false,
        }
    }

    /// A remark on the gaps of a field in these rows, or the first that is too long.
    fn bridged(
        &self,
        field: Field,
        column: usize,
        rows: UsedRows,
        limit_h: f64,
    ) -> Result<Option<EpwRemark>, EpwError> {
        let hours = |gap: &Range<usize>| gap.len() as f64 * self.interval_s / HOUR_S;
        let used: Vec<&Range<usize>> =
            self.gaps[field as usize].iter().filter(|gap| (gap.start..gap.end).any(|row| rows.contains(row))).collect();
        if let Some(gap) = used.iter().find(|gap| hours(gap) > limit_h) {
            let words = format!(
                "column {column}, {}, is missing for {} h from here on, and at most {limit_h} h are bridged",
                field.name(),
                hours(gap)
            );
            return Err(EpwError { line: self.lines[gap.start], problem: EpwProblem::Gap(words) });
        }
        let Some(first) = used.first() else { return Ok(None) };
        let count: usize = used.iter().map(|gap| gap.len()).sum();
        let longest_h = used.iter().map(|gap| hours(gap)).fold(0.0, f64::max);
        let rows = if count == 1 { "1 row".to_owned() } else { format!("{count} rows") };
        let text = format!(
            "column {column}, {}, is missing in {rows} that the run uses, for at most {longest_h} h, and is bridged",
            field.name()
        );
        Ok(Some(EpwRemark { line: self.lines[first.start], text }))
    }

    /// The rows that a run uses, those between which it interpolates included.
    fn used_rows(&self, usage: &EpwUse<'_>) -> UsedRows {
        let count = self.rows();
        let first = (usage.from_s / self.interval_s).floor() as i64 - 1;
        let last = (usage.to_s / self.interval_s).ceil() as i64;
        if !self.is_whole_year() {
            let within = |row: i64| usize::try_from(row.max(0)).unwrap_or(0).min(count.saturating_sub(1));
            return UsedRows { first: within(first), last: within(last) };
        }
        if last - first >= count as i64 {
            return UsedRows { first: 0, last: count };
        }
        let around = |row: i64| usize::try_from(row.rem_euclid(count as i64)).unwrap_or(0);
        UsedRows { first: around(first), last: around(last) }
    }
}

/// Rows from a first to a last one; where the last lies before the first they go on at the beginning.
#[derive(Clone, Copy, Debug)]
struct UsedRows {
    first: usize,
    last: usize,
}

impl UsedRows {
    fn contains(self, row: usize) -> bool {
        if self.first <= self.last {
            return (self.first..=self.last).contains(&row);
        }
        row >= self.first || row <= self.last
    }
}
