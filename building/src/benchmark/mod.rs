//! The key performance indicators of BOPTEST, from the measurements of one of its test cases.
//!
//! ```text
//! tdis  ∫ max(T_lower − T, 0) + max(T − T_upper, 0) dt    summed over zone signals, divided by the number of zones  [K·h/zone]
//! idis  ∫ max(C − C_upper, 0) dt                           likewise                                                  [ppm·h/zone]
//! ener  ∫ P dt / A        cost  ∫ p P dt / A + ∫ p_w V dt / A        emis  ∫ e P dt / A        [kWh/m², currency/m², kg/m²]
//! pele, pgas, pdih        largest mean of all power of a carrier in a quarter of an hour / A   [kW/m²]
//! ```
//!
//! `A` is the floor area. Integrals use the trapezoidal rule over the times of the measurements, as BOPTEST's
//! `kpis/kpi_calculator.py` does; prices and emission factors are those at the same times.
//!
//! Source: Blum et al., "Building optimization testing framework (BOPTEST) for simulation-based benchmarking of control strategies in
//! buildings", Journal of Building Performance Simulation 14(5), 2021.

use serde::Serialize;
use thiserror::Error;

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

/// The carrier of the energy of a power signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carrier {
    /// Electricity (`ElectricPower`).
    Electricity,
    /// Gas (`GasPower`).
    Gas,
    /// Heat of a district (`DistrictHeatingPower`).
    DistrictHeat,
    /// Biomass, solar heat and whatever else BOPTEST measures as a power.
    Other,
}

/// A power, with what each kilowatt-hour of it costs and emits.
#[derive(Clone, Debug, PartialEq)]
pub struct PowerSignal {
    /// What carries the energy.
    pub carrier: Carrier,
    /// The power at each time \[W\].
    pub power_w: Vec<f64>,
    /// The price at each time \[currency/kWh\].
    pub price_per_kwh: Vec<f64>,
    /// The emission factor at each time \[kg/kWh\], in carbon dioxide.
    pub emission_kg_per_kwh: Vec<f64>,
}

/// The temperature of a zone and its comfort band at each time, all in °C or all in K.
#[derive(Clone, Debug, PartialEq)]
pub struct ThermalZone {
    /// Operative or air temperature.
    pub temperature_c: Vec<f64>,
    /// Lower end of the band.
    pub lower_c: Vec<f64>,
    /// Upper end of the band.
    pub upper_c: Vec<f64>,
}

/// The concentration of carbon dioxide in a zone and its limit, at each time \[ppm\].
#[derive(Clone, Debug, PartialEq)]
pub struct AirQuality {
    /// The concentration.
    pub concentration_ppm: Vec<f64>,
    /// The limit.
    pub limit_ppm: Vec<f64>,
}

/// A flow of fresh water and its price.
#[derive(Clone, Debug, PartialEq)]
pub struct Water {
    /// The flow at each time \[m³/s\].
    pub flow_m3_per_s: Vec<f64>,
    /// The price at each time \[currency/m³\].
    pub price_per_m3: Vec<f64>,
}

/// The signals of a test from its first instant to its last. Each list has a value for each time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasuredRun {
    /// Times \[s\], rising; intervals may differ.
    pub times_s: Vec<f64>,
    /// Floor area of the building \[m²\].
    pub area_m2: f64,
    /// Zones whose temperature is judged.
    pub zones: Vec<ThermalZone>,
    /// Zones whose air is judged.
    pub air: Vec<AirQuality>,
    /// Powers.
    pub powers: Vec<PowerSignal>,
    /// Flows of fresh water.
    pub water: Vec<Water>,
}

/// Why indicators cannot be computed from measurements.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MeasurementError {
    /// There are fewer than two times, so an integral is not defined.
    #[error("there are {count} times; an integral takes at least 2")]
    TooFewTimes {
        /// How many there are.
        count: usize,
    },
    /// A time is not later than the one before, or is not finite.
    #[error("time {index} is {time_s} s, which is not after the one before")]
    TimesDoNotRise {
        /// Which time, from 0.
        index: usize,
        /// The time \[s\].
        time_s: f64,
    },
    /// The floor area is not a positive number.
    #[error("the floor area is {area_m2} m²; it must be above 0")]
    Area {
        /// The area \[m²\].
        area_m2: f64,
    },
    /// A list has not one value for each time.
    #[error("{signal} has {count} values for {times} times")]
    Length {
        /// The signal, in words.
        signal: &'static str,
        /// How many values it has.
        count: usize,
        /// How many times there are.
        times: usize,
    },
    /// A value is not finite.
    #[error("{signal} is not a finite number at time {index}")]
    NotFinite {
        /// The signal, in words.
        signal: &'static str,
        /// Which time, from 0.
        index: usize,
    },
}

impl MeasuredRun {
    /// Refuses measurements from which indicators cannot be computed.
    ///
    /// # Errors
    /// [`MeasurementError`], of the first fault.
    pub fn check(&self) -> Result<(), MeasurementError> {
        let times = self.times_s.len();
        if times < 2 {
            return Err(MeasurementError::TooFewTimes { count: times });
        }
        if !self.times_s[0].is_finite() {
            return Err(MeasurementError::TimesDoNotRise { index: 0, time_s: self.times_s[0] });
        }
        let falls = |pair: &[f64]| !(pair[1] > pair[0] && pair[1].is_finite());
        if let Some(index) = self.times_s.windows(2).position(falls) {
            return Err(MeasurementError::TimesDoNotRise { index: index + 1, time_s: self.times_s[index + 1] });
        }
        if !(self.area_m2 > 0.0 && self.area_m2.is_finite()) {
            return Err(MeasurementError::Area { area_m2: self.area_m2 });
        }
        for (signal, values) in self.signals() {
            if values.len() != times {
                return Err(MeasurementError::Length { signal, count: values.len(), times });
            }
            if let Some(index) = values.iter().position(|value| !value.is_finite()) {
                return Err(MeasurementError::NotFinite { signal, index });
            }
        }
        Ok(())
    }

    fn signals(&self) -> impl Iterator<Item = (&'static str, &Vec<f64>)> {
        let zones = self.zones.iter().flat_map(|zone| {
            [
                ("a temperature", &zone.temperature_c),
                ("the lower end of a band", &zone.lower_c),
                ("the upper end of a band", &zone.upper_c),
            ]
        });
        let air = self
            .air
            .iter()
            .flat_map(|air| [("a concentration", &air.concentration_ppm), ("its limit", &air.limit_ppm)]);
        let powers = self.powers.iter().flat_map(|signal| {
            [
                ("a power", &signal.power_w),
                ("a price of energy", &signal.price_per_kwh),
                ("an emission factor", &signal.emission_kg_per_kwh),
            ]
        });
        let water = self
            .water
            .iter()
            .flat_map(|water| [("a flow of water", &water.flow_m3_per_s), ("a price of water", &water.price_per_m3)]);
        zones.chain(air).chain(powers).chain(water)
    }
}
