//! Heat from people and their appliances, as scheduled and as it actually occurs.
//!
//! A zone follows a schedule that rises around the start of work, dips at lunch and falls around its end, times the zone's
//! peak. Reality deviates from it. One deviation can be learned: the schedule is wrong by the same share every day (bias).
//! The others cannot: people come earlier or later and are more or fewer (shift, scatter), and meetings take place
//! unannounced, or are cancelled. In these buildings the error of occupancy dominates that of the weather forecast.

use interplay_common::random::Random;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::schedule::Timetable;
use crate::series::HeldSeries;
use crate::weather::TimeSeries;

/// How zones are occupied on a working day, and how far from it reality strays.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Occupancy {
    /// Hour of the day at which work begins \[h\].
    #[schemars(range(min = 0, max = 24))]
    pub from_h: f64,
    /// Hour of the day at which work ends \[h\].
    #[schemars(range(min = 0, max = 24))]
    pub to_h: f64,
    /// How long it takes until all have come, or gone \[h\].
    #[schemars(range(min = 0.0))]
    pub ramp_h: f64,
    /// Hour of the day at which most are at lunch \[h\].
    #[schemars(range(min = 0, max = 24))]
    pub lunch_h: f64,
    /// Share of the heat that is missing at lunch.
    #[schemars(range(min = 0, max = 1), extend("x-unit" = "dimensionless"))]
    pub lunch_dip: f64,
    /// Least peak of a zone's heat \[kW\]; each zone's is drawn between the least and the greatest.
    #[schemars(range(min = 0.0))]
    pub least_peak_kw: f64,
    /// Greatest peak of a zone's heat \[kW\].
    #[schemars(range(min = 0.0))]
    pub greatest_peak_kw: f64,
    /// Heat at all times \[kW\].
    #[schemars(range(min = 0.0))]
    pub base_kw: f64,
    /// How real occupancy deviates from the schedule.
    pub deviation: Deviation,
}

/// How real occupancy deviates from the schedule. All zero: not at all.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Deviation {
    /// Least share by which a zone's schedule is wrong every day, up or down.
    #[schemars(range(min = 0.0), extend("x-unit" = "dimensionless"))]
    pub least_bias: f64,
    /// Greatest share by which a zone's schedule is wrong every day, up or down.
    #[schemars(range(min = 0.0), extend("x-unit" = "dimensionless"))]
    pub greatest_bias: f64,
    /// Standard deviation of the share by which a day differs from the others.
    #[schemars(range(min = 0.0), extend("x-unit" = "dimensionless"))]
    pub scatter: f64,
    /// Standard deviation of when people come and go \[h\].
    #[schemars(range(min = 0.0))]
    pub shift_h: f64,
    /// Probability that a zone has an extra meeting, or a cancelled one, on a day.
    #[schemars(range(min = 0, max = 1), extend("x-unit" = "dimensionless"))]
    pub meeting_probability: f64,
    /// Standard deviation of what switches on and off by itself, during work \[kW\].
    #[schemars(range(min = 0.0))]
    pub noise_kw: f64,
}

impl Default for Occupancy {
    fn default() -> Self {
        Self {
            from_h: 8.0,
            to_h: 19.0,
            ramp_h: 1.0,
            lunch_h: 12.5,
            lunch_dip: 0.45,
            least_peak_kw: 0.3,
            greatest_peak_kw: 0.45,
            base_kw: 0.02,
            deviation: Deviation::default(),
        }
    }
}

impl Default for Deviation {
    fn default() -> Self {
        Self {
            least_bias: 0.1,
            greatest_bias: 0.25,
            scatter: 0.08,
            shift_h: 0.3,
            meeting_probability: 0.4,
            noise_kw: 0.02,
        }
    }
}

impl Deviation {
    /// No deviation: real occupancy is as scheduled.
    pub const NONE: Self = Self {
        least_bias: 0.0,
        greatest_bias: 0.0,
        scatter: 0.0,
        shift_h: 0.0,
        meeting_probability: 0.0,
        noise_kw: 0.0,
    };
}

/// The people of a building: an [`Occupancy`] with the peaks and biases of each zone.
#[derive(Clone, Debug, PartialEq)]
pub struct People {
    occupancy: Occupancy,
    seed: u64,
    /// Schedules of zones that have their own.
    timetable: Timetable,
    /// Peak of each zone's schedule \[kW\].
    pub peaks_kw: Vec<f64>,
    /// Real over scheduled heat of each zone, on an average day.
    pub biases: Vec<f64>,
}

#[derive(Clone, Debug)]
struct Day {
    peak_kw: f64,
    from_h: f64,
    to_h: f64,
    meeting: Option<Meeting>,
    noise_kw: TimeSeries,
}

#[derive(Clone, Copy, Debug)]
struct Meeting {
    from_h: f64,
    /// Heat over that without the meeting: below 1 when it was cancelled.
    factor: f64,
}

impl Occupancy {
    /// Whether people depend on the seed.
    pub fn depends_on_seed(&self) -> bool {
        self.least_peak_kw != self.greatest_peak_kw || self.deviation != Deviation::NONE
    }

    /// Returns the people of `zones` zones.
    pub fn people(&self, zones: usize, seed: u64) -> People {
        let mut random = Random::new(seed, 0);
        let Deviation { least_bias, greatest_bias, .. } = self.deviation;
        let peaks_kw = (0..zones).map(|_| random.uniform(self.least_peak_kw, self.greatest_peak_kw)).collect();
        let biases = (0..zones)
            .map(|_| {
                let bias = random.uniform(least_bias, greatest_bias);
                1.0 + if random.chance(0.75) { bias } else { -bias }
            })
            .collect();
        People { occupancy: *self, seed, timetable: Timetable::default(), peaks_kw, biases }
    }

    /// Share of the peak at an hour of the day, for work from one hour to another.
    fn share(&self, hour: f64, from_h: f64, to_h: f64) -> f64 {
        const LUNCH_WIDTH_H: f64 = 0.6;
        let ramp = |since_h: f64| (0.5 + since_h / self.ramp_h.max(1e-3)).clamp(0.0, 1.0);
        let lunch = (hour - self.lunch_h) / LUNCH_WIDTH_H;
        ramp(hour - from_h).min(ramp(to_h - hour)) * (1.0 - self.lunch_dip * libm::exp(-lunch * lunch))
    }
}

impl People {
    /// The same people, except that those of zones with their own schedules come and go by these. Their deviations are
    /// as before, except for the peak, which the schedule states.
    #[must_use]
    pub fn following(self, timetable: Timetable) -> Self {
        Self { timetable, ..self }
    }

    /// Scheduled heat of a day's steps from midnight \[kW\], stacked time-major (entry t·n + i is zone i in step t),
    /// taken at the middle of each step. Only zones with schedules differ from day to day.
    pub fn scheduled_kw(&self, day: usize, step_s: f64, steps: usize) -> Vec<f64> {
        let Occupancy { from_h, to_h, base_kw, .. } = self.occupancy;
        let mut stacked = Vec::with_capacity(steps * self.peaks_kw.len());
        for hour in hours(step_s, steps) {
            let share = self.occupancy.share(hour, from_h, to_h);
            stacked.extend(self.peaks_kw.iter().enumerate().map(|(zone, peak_kw)| {
                match self.timetable.look_up(zone, day) {
                    None => base_kw + peak_kw * share,
                    Some(None) => 0.0,
                    Some(Some(schedule)) => schedule.base_kw + schedule.people_kw(hour, 0.0, 0.0),
                }
            }));
        }
        stacked
    }

    /// Real heat of a day's steps from midnight \[kW\], stacked in the same way. Days are independent of one another
    /// and of the length of a step.
    pub fn actual_kw(&self, day: usize, step_s: f64, steps: usize) -> Vec<f64> {
        let days: Vec<Day> = (0..self.peaks_kw.len()).map(|zone| self.day(zone, day)).collect();
        let mut stacked = Vec::with_capacity(steps * days.len());
        for hour in hours(step_s, steps) {
            stacked.extend(days.iter().enumerate().map(|(zone, today)| match self.timetable.look_up(zone, day) {
                None => self.occupancy.base_kw + today.heat_kw(&self.occupancy, hour),
                Some(None) => 0.0,
                Some(Some(schedule)) => {
                    let Occupancy { from_h, to_h, .. } = self.occupancy;
                    let people_kw = schedule.people_kw(hour, today.from_h - from_h, today.to_h - to_h);
                    let share = if people_kw > 0.0 { self.deviates(zone, today) } else { 0.0 };
                    schedule.base_kw + today.disturbed_kw(people_kw, share, hour)
                }
            }));
        }
        stacked
    }

    /// Real over scheduled heat of a zone on a day.
    fn deviates(&self, zone: usize, today: &Day) -> f64 {
        let peak_kw = self.peaks_kw[zone];
        if peak_kw > 0.0 { today.peak_kw / peak_kw } else { self.biases[zone] }
    }

    fn day(&self, zone: usize, day: usize) -> Day {
        let Occupancy { from_h, to_h, deviation, .. } = self.occupancy;
        let label = 1 + (day * self.peaks_kw.len() + zone) as u64;
        let mut random = Random::new(self.seed, label);
        let peak_kw = self.peaks_kw[zone] * self.biases[zone] * random.normal(1.0, deviation.scatter).max(0.0);
        let from_h = from_h + random.normal(0.0, deviation.shift_h);
        let to_h = to_h + random.normal(0.0, deviation.shift_h);
        let takes_place = random.chance(deviation.meeting_probability);
        let meeting = Meeting { from_h: random.uniform(9.0, 16.0), factor: if random.chance(0.5) { 0.4 } else { 1.5 } };
        Day {
            peak_kw,
            from_h,
            to_h,
            meeting: takes_place.then_some(meeting),
            noise_kw: noise(deviation.noise_kw, &mut random),
        }
    }
}

impl Day {
    fn heat_kw(&self, occupancy: &Occupancy, hour: f64) -> f64 {
        let share = occupancy.share(hour, self.from_h, self.to_h);
        self.disturbed_kw(self.peak_kw, share, hour)
    }

    /// `heat_kw` times a share, with the meeting of the day and with noise while the share is not 0.
    fn disturbed_kw(&self, heat_kw: f64, share: f64, hour: f64) -> f64 {
        const MEETING_H: f64 = 1.5;
        let running = |meeting: &Meeting| (meeting.from_h..meeting.from_h + MEETING_H).contains(&hour);
        let factor = self.meeting.filter(running).map_or(1.0, |meeting| meeting.factor);
        let noise_kw = if share > 0.0 { self.noise_kw.at(3600.0 * hour).abs() } else { 0.0 };
        heat_kw * share * factor + noise_kw
    }
}

/// A day of AR(1) noise by the half hour.
fn noise(deviation_kw: f64, random: &mut Random) -> TimeSeries {
    const CORRELATION: f64 = 0.6;
    let fresh = libm::sqrt(1.0 - CORRELATION * CORRELATION);
    let mut value_kw = random.normal(0.0, deviation_kw);
    let values = (0..=48)
        .map(|_| {
            value_kw = CORRELATION * value_kw + fresh * random.normal(0.0, deviation_kw);
            value_kw
        })
        .collect();
    TimeSeries { first_s: 0.0, interval_s: 1800.0, cyclic: false, values }
}

/// Hour of the day in the middle of each step.
fn hours(step_s: f64, steps: usize) -> impl Iterator<Item = f64> {
    (0..steps).map(move |step| (step as f64 + 0.5) * step_s / 3600.0)
}

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
