//! Computes each indicator as a function of the measurements.

use serde::Serialize;

use super::measurements::{Carrier, MeasuredRun, MeasurementError, PowerSignal};

const SECONDS_PER_HOUR: f64 = 3600.0;
/// Kilowatt-hours of a joule, with the digits of BOPTEST's `kpi_calculator.py` (exactly 1/3.6e6).
const KWH_PER_J: f64 = 2.777_78e-7;
const W_PER_KW: f64 = 1000.0;
/// Length of the windows of a peak \[s\].
const PEAK_WINDOW_S: f64 = 900.0;

/// BOPTEST's key performance indicators of a test, without its computational time ratio (see
/// [`Indicators::computational_time_ratio`]).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Indicators {
    /// Thermal discomfort (`tdis_tot`) \[K·h per zone\].
    pub tdis_k_h: f64,
    /// Discomfort of the air (`idis_tot`) \[ppm·h per zone\].
    pub idis_ppm_h: f64,
    /// Energy (`ener_tot`) \[kWh/m²\].
    pub ener_kwh_per_m2: f64,
    /// Cost of operation (`cost_tot`) \[currency/m²\].
    pub cost_per_m2: f64,
    /// Emissions (`emis_tot`) \[kg/m²\], in carbon dioxide.
    pub emis_kg_per_m2: f64,
    /// Peak of electricity (`pele_tot`) \[kW/m²\]; none without such a signal.
    pub pele_kw_per_m2: Option<f64>,
    /// Peak of gas (`pgas_tot`) \[kW/m²\]; none without such a signal.
    pub pgas_kw_per_m2: Option<f64>,
    /// Peak of district heat (`pdih_tot`) \[kW/m²\]; none without such a signal.
    pub pdih_kw_per_m2: Option<f64>,
}

impl Indicators {
    /// The indicators of a test.
    ///
    /// # Errors
    /// [`MeasurementError`] if lists do not fit together or hold numbers that are not finite.
    pub fn compute(measured: &MeasuredRun) -> Result<Self, MeasurementError> {
        measured.check()?;
        Ok(Self {
            tdis_k_h: thermal_discomfort_k_h(measured),
            idis_ppm_h: air_discomfort_ppm_h(measured),
            ener_kwh_per_m2: energy_sum(measured, |_, _| 1.0),
            cost_per_m2: energy_sum(measured, |signal, i| signal.price_per_kwh[i]) + water_cost_per_m2(measured),
            emis_kg_per_m2: energy_sum(measured, |signal, i| signal.emission_kg_per_kwh[i]),
            pele_kw_per_m2: peak_kw_per_m2(measured, Carrier::Electricity),
            pgas_kw_per_m2: peak_kw_per_m2(measured, Carrier::Gas),
            pdih_kw_per_m2: peak_kw_per_m2(measured, Carrier::DistrictHeat),
        })
    }

    /// Mean share of a control step that the controller took (`time_rat`): the mean of `control_s` over `step_s`, both \[s\]; `None`
    /// before the first decision.
    pub fn computational_time_ratio(control_s: &[f64], step_s: f64) -> Option<f64> {
        (!control_s.is_empty()).then(|| control_s.iter().sum::<f64>() / control_s.len() as f64 / step_s)
    }
}

fn thermal_discomfort_k_h(measured: &MeasuredRun) -> f64 {
    let zone_k_s = measured.zones.iter().map(|zone| {
        trapezoid(&measured.times_s, |i| {
            (zone.lower_c[i] - zone.temperature_c[i]).max(0.0) + (zone.temperature_c[i] - zone.upper_c[i]).max(0.0)
        })
    });
    zone_k_s.sum::<f64>() / SECONDS_PER_HOUR / measured.zones.len().max(1) as f64
}

fn air_discomfort_ppm_h(measured: &MeasuredRun) -> f64 {
    let zone_ppm_s = measured
        .air
        .iter()
        .map(|air| trapezoid(&measured.times_s, |i| (air.concentration_ppm[i] - air.limit_ppm[i]).max(0.0)));
    zone_ppm_s.sum::<f64>() / SECONDS_PER_HOUR / measured.air.len().max(1) as f64
}

/// The energy of all signals, each instant with its weight, per floor area \[kWh/m² times the unit of the weight\].
fn energy_sum(measured: &MeasuredRun, weight: impl Fn(&PowerSignal, usize) -> f64) -> f64 {
    let energy_j =
        measured.powers.iter().map(|signal| trapezoid(&measured.times_s, |i| weight(signal, i) * signal.power_w[i]));
    energy_j.sum::<f64>() * KWH_PER_J / measured.area_m2
}

fn water_cost_per_m2(measured: &MeasuredRun) -> f64 {
    let cost = measured
        .water
        .iter()
        .map(|water| trapezoid(&measured.times_s, |i| water.price_per_m3[i] * water.flow_m3_per_s[i]));
    cost.sum::<f64>() / measured.area_m2
}

fn peak_kw_per_m2(measured: &MeasuredRun, carrier: Carrier) -> Option<f64> {
    let signals: Vec<&PowerSignal> = measured.powers.iter().filter(|signal| signal.carrier == carrier).collect();
    if signals.is_empty() {
        return None;
    }
    let total_w = |i: usize| signals.iter().map(|signal| signal.power_w[i]).sum::<f64>();
    Some(peak(&measured.times_s, total_w)? / W_PER_KW / measured.area_m2)
}

/// The integral of `values(index)` over the times by the trapezoidal rule \[unit of the values times seconds\].
fn trapezoid(times_s: &[f64], values: impl Fn(usize) -> f64) -> f64 {
    (1..times_s.len()).map(|i| 0.5 * (values(i - 1) + values(i)) * (times_s[i] - times_s[i - 1])).sum()
}

/// The largest mean of the samples within a quarter of an hour. Windows begin at the first time and include their first instant, as
/// those of pandas do; samples count alike, whatever the time between them. `None` without samples.
fn peak(times_s: &[f64], values: impl Fn(usize) -> f64) -> Option<f64> {
    let window = |i: usize| ((times_s[i] - times_s[0]) / PEAK_WINDOW_S).floor();
    let mut peak: Option<f64> = None;
    let mut from = 0;
    while from < times_s.len() {
        let mut to = from;
        while to < times_s.len() && window(to) == window(from) {
            to += 1;
        }
        let mean = (from..to).map(&values).sum::<f64>() / (to - from) as f64;
        peak = Some(peak.map_or(mean, |largest| largest.max(mean)));
        from = to;
    }
    peak
}
