//! The key figures of one zone on a day.

use serde::Serialize;

use crate::comfort::Targets;
use crate::control::DayRecord;

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
