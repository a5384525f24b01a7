//! Key figures of a day, as defined by BOPTEST.
//!
//! Discomfort is the time integral of the deviation beyond the comfort band, averaged over the zones \[K·h per zone\].
//! `energy_kwh` and `peak_kw` are thermal, of heat in and out; heating and cooling both count as positive. BOPTEST's energy and peak are
//! those of the meter, here `electricity_kwh` and `electric_peak_kw`. A peak is the highest power of the whole building averaged over a
//! quarter of an hour (or over a step, if that is longer). BOPTEST divides energy and peak by the floor area, which a thermal network
//! does not have.

use serde::Serialize;

use crate::comfort::Targets;
use crate::control::DayRecord;
use crate::network::PowerLimits;

/// Shortest time over which a peak is averaged \[s\].
const PEAK_WINDOW_S: f64 = 900.0;

/// The key figures of a building's day: cost, comfort and energy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct KeyFigures {
    /// Cost J (eq. 3.2).
    pub cost: f64,
    /// Root of the mean squared error over zones and occupied steps \[K\]; 0 if none is occupied.
    pub tracking_rmse_c: f64,
    /// Deviation beyond the comfort band while occupied, integrated over time \[K·h per zone\].
    pub discomfort_k_h: f64,
    /// Heat brought in and taken out by the equipment, thermal \[kWh\].
    pub energy_kwh: f64,
    /// Electricity that the equipment took for this heat \[kWh\]; without a heat pump as much as the heat.
    pub electricity_kwh: f64,
    /// What the electricity cost \[currency\]; none without a tariff.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_cost: Option<f64>,
    /// Heat brought in \[kWh\].
    pub heating_kwh: f64,
    /// Heat taken out \[kWh\].
    pub cooling_kwh: f64,
    /// Highest thermal power of all zones together, heat in and out \[kW\].
    pub peak_kw: f64,
    /// Highest electric power of all zones together \[kW\]; without a heat pump as much as the thermal one.
    pub electric_peak_kw: f64,
    /// Largest excess of a requested input over its limit \[kW\]; the equipment then did less than was requested.
    pub input_violation_kw: f64,
}

impl KeyFigures {
    /// The figures of a day. `targets` are those under the real outdoor temperature ([`Targets::under`]).
    ///
    /// # Panics
    /// When the record has not the shape of the targets.
    pub fn compute(record: &DayRecord, targets: &Targets, limits: &PowerLimits, step_s: f64) -> Self {
        let hours = step_s / 3600.0;
        let n = targets.zones;
        let energy = |part: fn(f64) -> f64| hours * record.heat_kw.iter().map(|&kw| part(kw)).sum::<f64>();
        let (heating_kwh, cooling_kwh) = (energy(|kw| kw.max(0.0)), energy(|kw| (-kw).max(0.0)));
        let errors_k = || {
            let entries = record.temperatures_c.iter().zip(&targets.reference_c).zip(&targets.occupied);
            entries.filter(|(_, occupied)| **occupied).map(|((actual_c, wanted_c), _)| wanted_c - actual_c)
        };
        let count = errors_k().count().max(1) as f64;
        let beyond_k: f64 = record.temperatures_c.iter().enumerate().map(|(i, t)| targets.beyond_k(i, *t)).sum();
        let electric_kw: Vec<f64> =
            record.heat_kw.iter().enumerate().map(|(i, kw)| targets.supply.electric_kw(i / n, *kw)).collect();
        let electric_kwh = |i: usize| hours * electric_kw[i];
        let money = |i: usize| targets.supply.money(i / n, electric_kwh(i));
        let excess = |(i, kw): (usize, &f64)| limits.excess_kw(i % n, *kw);
        Self {
            cost: targets.cost(&record.temperatures_c, &record.heat_kw),
            tracking_rmse_c: (errors_k().map(|error_k| error_k * error_k).sum::<f64>() / count).sqrt(),
            discomfort_k_h: hours * beyond_k / n as f64,
            energy_kwh: heating_kwh + cooling_kwh,
            electricity_kwh: (0..record.heat_kw.len()).map(electric_kwh).sum(),
            energy_cost: (0..record.heat_kw.len()).map(money).sum(),
            heating_kwh,
            cooling_kwh,
            peak_kw: peak_kw(&record.heat_kw, n, step_s),
            electric_peak_kw: peak_kw(&electric_kw, n, step_s),
            input_violation_kw: record.requested_kw.iter().enumerate().map(excess).fold(0.0, f64::max),
        }
    }
}

/// The highest mean power of all zones over consecutive windows.
fn peak_kw(heat_kw: &[f64], zones: usize, step_s: f64) -> f64 {
    let totals_kw: Vec<f64> = heat_kw.chunks_exact(zones).map(|step| step.iter().map(|kw| kw.abs()).sum()).collect();
    let window = ((PEAK_WINDOW_S / step_s).round() as usize).max(1);
    totals_kw.chunks(window).map(|window| window.iter().sum::<f64>() / window.len() as f64).fold(0.0, f64::max)
}

/// The key figures of a zone on a day.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ZoneFigures {
    /// The zone's part of J (eq. 3.2).
    pub cost: f64,
    /// Root of the mean squared error over occupied steps \[K\]; 0 if none is occupied.
    pub tracking_rmse_c: f64,
    /// Deviation beyond the comfort band while occupied, integrated over time \[K·h\].
    pub discomfort_k_h: f64,
    /// Heat brought in and taken out by the equipment \[kWh\].
    pub energy_kwh: f64,
    /// Electricity that this heat took \[kWh\].
    pub electricity_kwh: f64,
    /// What the electricity cost \[currency\]; none without a tariff.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_cost: Option<f64>,
}

impl ZoneFigures {
    /// The figures of every zone. `targets` are those under the real outdoor temperature.
    ///
    /// # Panics
    /// When the record has not the shape of the targets.
    pub fn of_all(record: &DayRecord, targets: &Targets, step_s: f64) -> Vec<Self> {
        (0..targets.zones).map(|zone| Self::compute(record, targets, step_s, zone)).collect()
    }

    fn compute(record: &DayRecord, targets: &Targets, step_s: f64, zone: usize) -> Self {
        let hours = step_s / 3600.0;
        let mut figures = Self { energy_cost: targets.supply.price_per_kwh.as_ref().map(|_| 0.0), ..Self::default() };
        let (mut squares_k2, mut occupied) = (0.0, 0_usize);
        for step in 0..targets.steps() {
            let i = step * targets.zones + zone;
            let (heat_kw, temperature_c) = (record.heat_kw[i], record.temperatures_c[i]);
            let error_k = targets.reference_c[i] - temperature_c;
            figures.cost += targets.error_weight[i] * error_k * error_k + targets.input_weight[i] * heat_kw * heat_kw;
            figures.discomfort_k_h += hours * targets.beyond_k(i, temperature_c);
            if targets.occupied[i] {
                squares_k2 += error_k * error_k;
                occupied += 1;
            }
            let electric_kwh = hours * targets.supply.electric_kw(step, heat_kw);
            figures.energy_kwh += hours * heat_kw.abs();
            figures.electricity_kwh += electric_kwh;
            if let (Some(energy_cost), Some(money)) =
                (&mut figures.energy_cost, targets.supply.money(step, electric_kwh))
            {
                *energy_cost += money;
            }
        }
        figures.tracking_rmse_c = (squares_k2 / occupied.max(1) as f64).sqrt();
        figures
    }
}
