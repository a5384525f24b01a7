//! The wanted temperatures and the prices of heat on each day of a run.

use super::targets::{Setpoints, SetpointsError, Targets};
use crate::energy::{EnergySupply, HeatPump, Tariff};
use crate::schedule::{Timetable, ZoneSchedule};

/// The targets of every day.
#[derive(Clone, Debug)]
pub struct Agenda {
    /// The targets without schedules, at the mean price.
    common: Targets,
    setpoints: Setpoints,
    timetable: Timetable,
    bounds: Option<ComfortBounds>,
    tariff: Option<Tariff>,
    heat_pump: Option<HeatPump>,
    step_s: f64,
}

impl Agenda {
    /// The targets of days of `steps` steps, for zones without schedules, prices or heat pumps.
    pub fn new(setpoints: Setpoints, zones: usize, step_s: f64, steps: usize) -> Result<Self, SetpointsError> {
        let common = setpoints.targets(zones, step_s, steps)?;
        let timetable = Timetable::default();
        Ok(Self { common, setpoints, timetable, bounds: None, tariff: None, heat_pump: None, step_s })
    }

    /// Adds the schedules of a timetable.
    #[must_use]
    pub fn following(self, timetable: Timetable) -> Self {
        Self { timetable, ..self }
    }

    /// Adds a checked tariff and a checked heat pump.
    #[must_use]
    pub fn supplied(self, tariff: Option<Tariff>, heat_pump: Option<HeatPump>) -> Self {
        Self { tariff, heat_pump, ..self }
    }

    /// Adds comfort bounds of another program, which replace schedules.
    #[must_use]
    pub fn bounded(self, bounds: ComfortBounds) -> Self {
        Self { bounds: Some(bounds), ..self }
    }

    /// Replaces the tariff; the heat pump stays.
    #[must_use]
    pub fn priced(self, tariff: Tariff) -> Self {
        Self { tariff: Some(tariff), ..self }
    }

    /// The targets of day `day`, counted from zero. If days differ, they include the targets of the next day.
    pub fn of_day(&self, day: usize) -> Targets {
        let mut targets = self.alone(day);
        let bounded = self.bounds.is_some();
        if bounded || self.timetable.days_differ() || self.tariff.as_ref().is_some_and(Tariff::days_differ) {
            targets.tomorrow = Some(Box::new(self.alone(day + 1)));
        }
        targets
    }

    /// The currency of prices; `None` without a tariff.
    pub fn currency(&self) -> Option<&str> {
        self.tariff.as_ref().map(|tariff| tariff.currency.as_str())
    }

    fn alone(&self, day: usize) -> Targets {
        let mut targets = self.common.clone();
        for zone in 0..targets.zones {
            if let Some(schedule) = self.timetable.look_up(zone, day) {
                self.follow(&mut targets, zone, schedule);
            }
        }
        if let Some(bounds) = &self.bounds {
            bounds.write(&mut targets, day, self.step_s, &self.setpoints);
        }
        let price_per_kwh = self.tariff.as_ref().map(|tariff| tariff.day_per_kwh(day, self.step_s, targets.steps()));
        let weighs = self.setpoints.weigh_energy;
        if let (Some(tariff), Some(price_per_kwh), true) = (&self.tariff, &price_per_kwh, weighs) {
            let weights = tariff.day_weights(price_per_kwh);
            for (i, input_weight) in targets.input_weight.iter_mut().enumerate() {
                *input_weight *= weights[i / targets.zones];
            }
        }
        let heat_pump = self.heat_pump.clone();
        let price_weight = heat_pump.as_ref().filter(|_| weighs).map_or(Vec::new(), |_| targets.input_weight.clone());
        let tariff = self.tariff.as_ref();
        targets.supply = EnergySupply {
            price_per_kwh,
            emissions_kg_per_kwh: tariff.and_then(|tariff| tariff.day_emissions(day, self.step_s, targets.steps())),
            demand_per_kw: tariff.map_or(0.0, |tariff| tariff.demand_per_kw),
            heat_pump,
            outdoor_c: Vec::new(),
            price_weight,
        };
        targets
    }

    /// Writes the schedule of a zone into the targets; without one the zone is unoccupied.
    fn follow(&self, targets: &mut Targets, zone: usize, schedule: Option<&ZoneSchedule>) {
        let other_c = schedule.and_then(|schedule| schedule.other_c);
        for step in 0..targets.steps() {
            let i = step * targets.zones + zone;
            let hour = (step + 1) as f64 * self.step_s / 3600.0;
            let period = schedule.and_then(|schedule| schedule.period_at(hour));
            targets.occupied[i] = period.is_some();
            match (period, other_c) {
                (Some(period), _) => {
                    targets.reference_c[i] = period.wanted_c;
                    targets.error_weight[i] = self.setpoints.occupied_weight;
                    targets.band_k[i] = period.band_k.unwrap_or(self.setpoints.band_k);
                }
                (None, Some(other_c)) => {
                    targets.reference_c[i] = other_c;
                    targets.error_weight[i] = self.setpoints.other_weight;
                }
                (None, None) => targets.error_weight[i] = 0.0,
            }
        }
    }
}

/// A zone counts as occupied while its bounds are at most this much wider than the narrowest ones of the run \[K\].
const WIDTH_TOLERANCE_K: f64 = 0.05;
const DAY_S: f64 = 86_400.0;

/// The lowest and the highest comfortable temperature of each zone over a run.
///
/// A zone counts as occupied where its bounds are closest together: there it has a wanted temperature and a band that reaches down
/// to the lower bound. At other times its temperature is free, or the setting `other_c` of the setpoints states it.
#[derive(Clone, Debug, PartialEq)]
pub struct ComfortBounds {
    /// How long each value holds \[s\].
    pub interval_s: f64,
    /// The bounds of each zone; a zone without any is free at all times.
    pub zones: Vec<Option<ZoneBounds>>,
    /// The wanted temperature, above the lower bound \[K\]; none for the middle of the bounds.
    pub wanted_above_lower_k: Option<f64>,
}

/// The bounds of a zone from the first midnight on.
#[derive(Clone, Debug, PartialEq)]
pub struct ZoneBounds {
    /// Lowest temperatures \[°C\]; at least one. The last holds on.
    pub lower_c: Vec<f64>,
    /// Highest temperatures \[°C\]; at least one. The last holds on.
    pub upper_c: Vec<f64>,
}

impl ComfortBounds {
    /// Writes the bounds of a day into its targets, zone after zone; zones beyond those of the bounds keep what they have.
    pub(super) fn write(&self, targets: &mut Targets, day: usize, step_s: f64, setpoints: &Setpoints) {
        let count = targets.zones;
        for (zone, bounds) in self.zones.iter().enumerate().take(count) {
            let narrowest_k = bounds.as_ref().map_or(0.0, ZoneBounds::narrowest_k);
            for step in 0..targets.steps() {
                let i = step * count + zone;
                targets.occupied[i] = false;
                targets.error_weight[i] = 0.0;
                let Some(bounds) = bounds else { continue };
                let from_s = day as f64 * DAY_S + step as f64 * step_s;
                let (lower_c, upper_c) = bounds.at_end(from_s, from_s + step_s, self.interval_s);
                if upper_c - lower_c <= narrowest_k + WIDTH_TOLERANCE_K {
                    let half_k = 0.5 * (upper_c - lower_c);
                    let above_k = self.wanted_above_lower_k.unwrap_or(half_k).min(half_k);
                    targets.occupied[i] = true;
                    targets.error_weight[i] = setpoints.occupied_weight;
                    targets.reference_c[i] = lower_c + above_k;
                    targets.band_k[i] = above_k.max(0.0);
                } else if let Some(other_c) = setpoints.other_c {
                    targets.error_weight[i] = setpoints.other_weight;
                    targets.reference_c[i] = other_c;
                }
            }
        }
    }
}

impl ZoneBounds {
    fn narrowest_k(&self) -> f64 {
        self.upper_c.iter().zip(&self.lower_c).map(|(upper, lower)| upper - lower).fold(f64::INFINITY, f64::min)
    }

    /// The bounds at the end of a step: the narrower ones of those just before and at that time.
    fn at_end(&self, from_s: f64, to_s: f64, interval_s: f64) -> (f64, f64) {
        let value = |values: &[f64], time_s: f64| {
            let place = (time_s / interval_s + 1e-9).floor().max(0.0) as usize;
            values.get(place).or(values.last()).copied().unwrap_or_default()
        };
        // The last value that begins before the end of the step.
        let before_s = from_s.max(to_s - interval_s);
        let lower_c = value(&self.lower_c, before_s).max(value(&self.lower_c, to_s));
        let upper_c = value(&self.upper_c, before_s).min(value(&self.upper_c, to_s));
        (lower_c, upper_c)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zone_is_occupied_where_its_bounds_are_closest() {
        let setpoints = Setpoints { other_c: Some(19.0), other_weight: 0.5, ..Setpoints::default() };
        let mut targets = setpoints.targets(2, 3600.0, 24).expect("targets");
        let lower_c = (0..24).map(|hour| if (7..20).contains(&hour) { 15.0 } else { 21.0 }).collect();
        let upper_c = (0..24).map(|hour| if (7..20).contains(&hour) { 30.0 } else { 24.0 }).collect();
        let zones = vec![Some(ZoneBounds { lower_c, upper_c }), None];
        let mut bounds = ComfortBounds { interval_s: 3600.0, zones, wanted_above_lower_k: None };
        bounds.write(&mut targets, 0, 3600.0, &setpoints);
        let zone = |step: usize| (targets.occupied[2 * step], targets.reference_c[2 * step], targets.band_k[2 * step]);
        // The temperature at 7 o'clock ends the night, and that at 20 o'clock begins the evening.
        assert_eq!([zone(6), zone(19)], [(true, 22.5, 1.5); 2]);
        assert_eq!((zone(7).0, zone(7).1, targets.error_weight[14]), (false, 19.0, 0.5));
        assert!((0..24).all(|step| !targets.occupied[2 * step + 1] && targets.error_weight[2 * step + 1] == 0.0));
        bounds.wanted_above_lower_k = Some(0.6);
        bounds.write(&mut targets, 3, 3600.0, &setpoints);
        assert_eq!((targets.reference_c[0], targets.band_k[0]), (21.6, 0.6), "the last values hold on");
    }
}
