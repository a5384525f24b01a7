//! The measurements of a test case from which its indicators are computed.

use thiserror::Error;

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
