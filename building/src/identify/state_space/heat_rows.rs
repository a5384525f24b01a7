//! Rows in which a heater was on for a part of the time.
//!
//! A meter states the mean heat of a row, not when in the row it came. A thermostat that switches inside a row makes rows between
//! its two levels; a heater whose heat is held makes none. Which of both a record shows is decided by the likelihood, with one
//! number a zone ([`ParameterKind::HeatSwing`](super::elements::ParameterKind::HeatSwing)).

use std::collections::BTreeMap;
use std::ops::Range;

use crate::identify::telemetry::{Hold, MeasuredZone, Telemetry};

/// Parts into which a row is divided: heat is on for a whole number of them. Even, so that Simpson's rule applies.
pub(super) const PARTS: usize = 48;
/// On-times are multiples of two parts: then the parts that are left for the begin are even in number, too.
const PARTS_OF_ON_TIME: usize = 2;
/// Share of the range of the heat within which a row counts as off or as fully on.
const LEVEL_SHARE: f64 = 0.02;
/// A row repeats the heat of its neighbour if both differ by less than this share of the range: then that is a level, which is held.
const SAME_SHARE: f64 = 1e-6;
/// With fewer rows between its levels, a zone's heat is taken for constant within each row.
const LEAST_PARTIAL_ROWS: usize = 10;

/// The class of rows whose heat is known and constant until the next row.
pub(super) const HELD: usize = 0;
/// The class of rows whose heat is not known until the next row.
pub(super) const UNKNOWN: usize = 1;

/// Where in a row the heat is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Placement {
    /// Off before the row and on after it, or in the next row.
    AtEnd,
    /// On before the row, or in the one before, and off after it.
    AtStart,
    /// Anywhere, with equal probability.
    Anywhere,
}

/// One interval of heat within a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PartialHeat {
    pub zone: usize,
    /// Column of the zone's heat among the inputs.
    pub column: usize,
    /// Heat while it is on, less that while it is off \[kW\].
    pub swing_kw: f64,
    /// For how many of the [`PARTS`] of the row it is on.
    pub on_parts: usize,
    pub placement: Placement,
}

/// What is known of the timing of heat within each row.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct HeatRows {
    /// The class of each row.
    pub of_row: Vec<usize>,
    /// The partial heats of each class, none of [`HELD`] and [`UNKNOWN`].
    pub classes: Vec<Vec<PartialHeat>>,
}

impl HeatRows {
    /// The rows of `segments`, with a column of heat for each zone that has one; `unknown` are rows whose heat is not known.
    pub fn new(telemetry: &Telemetry, heat: &[Option<usize>], segments: &[Range<usize>], unknown: &[usize]) -> Self {
        let rows = telemetry.rows();
        let mut of_row: Vec<Vec<PartialHeat>> = vec![Vec::new(); rows];
        for (zone, measured) in telemetry.zones.iter().enumerate() {
            let (Some(column), Some(levels)) = (heat[zone], Levels::new(measured)) else { continue };
            for segment in segments {
                for row in segment.start..segment.end.saturating_sub(1) {
                    let partial = levels.partial(&measured.power_kw, segment, row);
                    of_row[row].extend(partial.map(|partial| PartialHeat { zone, column, ..partial }));
                }
            }
        }
        Self::numbered(of_row, unknown)
    }

    /// Rows of which every one has heat that is held.
    #[cfg(test)]
    pub fn held(rows: usize) -> Self {
        Self { of_row: vec![HELD; rows], classes: vec![Vec::new(), Vec::new()] }
    }

    fn numbered(of_row: Vec<Vec<PartialHeat>>, unknown: &[usize]) -> Self {
        let mut classes = vec![Vec::new(), Vec::new()];
        let mut known = BTreeMap::new();
        let mut class = |(row, partial): (usize, Vec<PartialHeat>)| {
            if unknown.binary_search(&row).is_ok() {
                return UNKNOWN;
            }
            if partial.is_empty() {
                return HELD;
            }
            let key: Vec<_> =
                partial.iter().map(|it| (it.zone, it.swing_kw.to_bits(), it.on_parts, it.placement)).collect();
            *known.entry(key).or_insert_with(|| {
                classes.push(partial);
                classes.len() - 1
            })
        };
        let of_row = of_row.into_iter().enumerate().map(&mut class).collect();
        Self { of_row, classes }
    }
}

/// The levels between which a zone's heat switches \[kW\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Levels {
    least: f64,
    largest: f64,
}

impl Levels {
    /// The levels of a zone; `None` if its heat is not held over rows, or lies hardly ever between two levels.
    pub fn new(zone: &MeasuredZone) -> Option<Self> {
        if zone.power_hold != Hold::ZeroOrder || !zone.supply_air.is_empty() {
            return None;
        }
        let finite = || zone.power_kw.iter().copied().filter(|power| power.is_finite());
        let levels = Self { least: finite().fold(f64::MAX, f64::min), largest: finite().fold(f64::MIN, f64::max) };
        let all = 0..zone.power_kw.len();
        let partial = all.clone().filter(|&row| levels.partial(&zone.power_kw, &all, row).is_some());
        (levels.largest > levels.least && partial.count() >= LEAST_PARTIAL_ROWS).then_some(levels)
    }

    /// Swing \[kW\] and share of the time that heat is on, by the mean of a row. With heating and cooling, off is zero.
    fn share(self, heat_kw: f64) -> (f64, f64) {
        let (off, on) = match (self.least < 0.0, self.largest > 0.0) {
            (true, true) => (0.0, if heat_kw < 0.0 { self.least } else { self.largest }),
            (true, false) => (self.largest, self.least),
            _ => (self.least, self.largest),
        };
        (on - off, (heat_kw - off) / (on - off))
    }

    /// The partial heat of a row, of which zone and column are still open; `None` for a row at a level.
    fn partial(self, heat_kw: &[f64], segment: &Range<usize>, row: usize) -> Option<PartialHeat> {
        let (swing_kw, share) = self.share(heat_kw[row]);
        let is_between = |share: f64| share > LEVEL_SHARE && share < 1.0 - LEVEL_SHARE;
        if !is_between(share) {
            return None;
        }
        let at = |other: Option<usize>| other.filter(|other| segment.contains(other)).map(|other| heat_kw[other]);
        let (before, after) = (at(row.checked_sub(1)), at(Some(row + 1)));
        let is_same = |other: f64| (other - heat_kw[row]).abs() <= SAME_SHARE * (self.largest - self.least);
        if [before, after].into_iter().flatten().any(is_same) {
            return None;
        }
        // 0 off, 1 on; another level or no row says nothing.
        let state = |other: Option<f64>| match self.share(other?).1 {
            share if share <= LEVEL_SHARE => Some(false),
            share if share >= 1.0 - LEVEL_SHARE => Some(true),
            _ => None,
        };
        // Between two rows of one state, two partial rows are one interval that goes over from the first into the second.
        let (long_before, long_after) = (state(at(row.checked_sub(2))), state(at(Some(row + 2))));
        let placement = match (state(before), state(after)) {
            (Some(false), Some(true)) => Placement::AtEnd,
            (Some(true), Some(false)) => Placement::AtStart,
            (Some(false), None) if long_after == Some(false) => Placement::AtEnd,
            (Some(true), None) if long_after == Some(true) => Placement::AtStart,
            (None, Some(false)) if long_before == Some(false) => Placement::AtStart,
            (None, Some(true)) if long_before == Some(true) => Placement::AtEnd,
            _ => Placement::Anywhere,
        };
        let steps = PARTS / PARTS_OF_ON_TIME;
        let on = (libm::round(share * steps as f64) as usize).clamp(1, steps - 1);
        Some(PartialHeat { zone: 0, column: 0, swing_kw, on_parts: PARTS_OF_ON_TIME * on, placement })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::synthetic_classroom::Classroom;

    /// Heat that switches between 0 and 2 kW inside rows, with a level that is held.
    fn telemetry() -> Telemetry {
        let mut telemetry = Classroom { days: 2, ..Classroom::default() }.simulate();
        let zone = &mut telemetry.zones[0];
        zone.supply_air.clear();
        zone.power_hold = Hold::ZeroOrder;
        let pattern = [0.0, 0.5, 2.0, 2.0, 1.5, 0.0, 0.0, 1.0, 0.0, 0.7, 0.7, 0.7, 2.0, 0.0, 0.3, 0.6, 0.0];
        (0..zone.power_kw.len()).for_each(|row| zone.power_kw[row] = pattern[row % pattern.len()]);
        telemetry
    }

    #[test]
    fn a_row_between_its_levels_has_its_place_from_the_rows_beside_it() {
        let telemetry = telemetry();
        let rows = HeatRows::new(&telemetry, &[Some(3)], std::slice::from_ref(&(0..telemetry.rows())), &[6]);
        let of = |row: usize| rows.classes[rows.of_row[row]].first().map(|it| (it.on_parts, it.placement));
        assert_eq!(of(1), Some((12, Placement::AtEnd)));
        assert_eq!(of(4), Some((36, Placement::AtStart)));
        assert_eq!(of(7), Some((24, Placement::Anywhere)));
        assert_eq!((of(14).map(|it| it.1), of(15).map(|it| it.1)), (Some(Placement::AtEnd), Some(Placement::AtStart)));
        assert_eq!([of(0), of(2), of(9), of(10), of(11)], [None; 5], "levels are held");
        assert_eq!((rows.of_row[5], rows.of_row[6]), (HELD, UNKNOWN));
        assert_eq!(rows.of_row[18], rows.of_row[1], "the same heat is one class");
        assert_eq!(rows.classes[rows.of_row[1]][0].swing_kw, 2.0);
    }

    #[test]
    fn heat_that_is_hardly_ever_between_two_levels_is_held() {
        let mut telemetry = telemetry();
        telemetry.zones[0].power_kw.iter_mut().for_each(|heat| *heat = if *heat > 1.0 { 2.0 } else { 0.0 });
        assert_eq!(Levels::new(&telemetry.zones[0]), None);
    }
}
