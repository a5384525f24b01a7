//! The wanted temperatures and the prices of heat on each day of a run.

use super::bounds::ComfortBounds;
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
    ///
    /// # Errors
    /// [`SetpointsError`].
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
