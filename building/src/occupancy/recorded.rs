//! Recorded heat of people and machines, which replaces the heat of schedules or adds to it.

use crate::series::HeldSeries;

/// The recorded heat of each zone that has any.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordedGains {
    /// Each zone with a record, by its index; a zone may have several, which add up.
    pub zones: Vec<ZoneRecord>,
}

/// The recorded heat of a zone.
#[derive(Clone, Debug, PartialEq)]
pub struct ZoneRecord {
    /// Index of the zone.
    pub zone: usize,
    /// Its heat since the first midnight \[kW\].
    pub heat_kw: HeldSeries,
    /// Whether it comes beside the heat of people by schedule, and not in its place.
    pub beside_people: bool,
    /// Whether controllers are told of it beforehand. Otherwise they expect what the schedule says.
    pub is_forecast: bool,
}

impl RecordedGains {
    /// The forecast heat of a day's steps, stacked, from that of people by schedule \[kW\].
    pub(crate) fn forecast_kw(&self, people_kw: Vec<f64>, day: usize, zones: usize, step_s: f64) -> Vec<f64> {
        self.laid_over(people_kw, day, zones, step_s, |record| record.is_forecast)
    }

    /// The real heat of a day's steps, stacked, from that of people \[kW\].
    pub(crate) fn actual_kw(&self, people_kw: Vec<f64>, day: usize, zones: usize, step_s: f64) -> Vec<f64> {
        self.laid_over(people_kw, day, zones, step_s, |_| true)
    }

    fn laid_over(
        &self,
        mut heat_kw: Vec<f64>,
        day: usize,
        zones: usize,
        step_s: f64,
        counts: fn(&ZoneRecord) -> bool,
    ) -> Vec<f64> {
        let records = || self.zones.iter().filter(|record| counts(record));
        for record in records().filter(|record| !record.beside_people) {
            heat_kw.iter_mut().skip(record.zone).step_by(zones).for_each(|heat_kw| *heat_kw = 0.0);
        }
        for record in records() {
            for (step, heat_kw) in heat_kw.iter_mut().skip(record.zone).step_by(zones).enumerate() {
                let from_s = day as f64 * 86_400.0 + step as f64 * step_s;
                *heat_kw += record.heat_kw.mean(from_s, from_s + step_s);
            }
        }
        heat_kw
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recorded_heat_replaces_scheduled_people_or_adds_to_them() {
        let heat_kw = HeldSeries { first_s: 0.0, interval_s: 3600.0, cyclic: true, values: vec![3.0, 5.0] };
        let record =
            |beside_people| ZoneRecord { zone: 1, heat_kw: heat_kw.clone(), beside_people, is_forecast: false };
        let people_kw = vec![0.1, 0.2, 0.1, 0.2];
        let gains = |beside| RecordedGains { zones: vec![record(beside)] };
        assert_eq!(gains(false).actual_kw(people_kw.clone(), 0, 2, 3600.0), [0.1, 3.0, 0.1, 5.0]);
        assert_eq!(gains(true).actual_kw(people_kw.clone(), 3, 2, 3600.0), [0.1, 3.2, 0.1, 5.2]);
        assert_eq!(gains(false).forecast_kw(people_kw.clone(), 0, 2, 3600.0), people_kw);
    }
}
