//! The indicators of a test: those of BOPTEST, and those that Interplay computes from the measurements.

use interplay_building::benchmark::{AirQuality, Carrier, Indicators, MeasuredRun, PowerSignal, ThermalZone};
use interplay_scenarios::{BoptestIndicators, BoptestPlantConfig, BoptestPrices};
use serde_json::json;

use super::api::{Bench, series};
use super::forecast::{KnownSeries, all_bounds};
use crate::plants::boptest::boptest_error::BoptestError;
use crate::state::day::Metered;

const RESULTS: &str = "PUT /results";

/// Prices, emission factors and limits of a test, from its error-free forecast. Each value holds until the next time.
#[derive(Debug)]
pub struct Known {
    start_s: f64,
    end_s: f64,
    series: KnownSeries,
    price_of_electricity: String,
}

impl Known {
    /// Requests these series at the beginning of a test, for its whole duration: first time and length \[s\].
    pub fn ask(
        listed: &BoptestIndicators,
        prices: BoptestPrices,
        test: &mut dyn Bench,
        start_s: f64,
        horizon_s: f64,
    ) -> Result<Self, BoptestError> {
        let price_of_electricity = format!("PriceElectricPower{}", prices.words().1);
        let mut names: Vec<String> = all_bounds(&listed.zones).collect();
        let aired = listed.zones.iter().take(listed.carbon_dioxide.len()).filter(|zone| !zone.is_empty());
        names.extend(aired.map(|zone| format!("UpperCO2[{zone}]")));
        for (signals, price, emission) in [
            (&listed.electricity, price_of_electricity.as_str(), "EmissionsElectricPower"),
            (&listed.gas, "PriceGasPower", "EmissionsGasPower"),
            (&listed.district_heat, "PriceDistrictHeatingPower", "EmissionsDistrictHeatingPower"),
        ] {
            if !signals.is_empty() {
                names.extend([price.to_owned(), emission.to_owned()]);
            }
        }
        let series = KnownSeries::ask(test, names, horizon_s)?;
        series.check_temperatures(all_bounds(&listed.zones))?;
        Ok(Self { start_s, end_s: start_s + horizon_s, series, price_of_electricity })
    }

    /// The reading of the electricity meter between two times \[s\]; `None` if no electricity is measured.
    pub fn metered(
        &self,
        config: &BoptestPlantConfig,
        test: &mut dyn Bench,
        from_s: f64,
        to_s: f64,
    ) -> Result<Option<Metered>, BoptestError> {
        let Some(listed) = config.indicators.as_ref().filter(|listed| !listed.electricity.is_empty()) else {
            return Ok(None);
        };
        let body = json!({ "point_names": listed.electricity, "start_time": from_s, "final_time": to_s });
        let answer = test.ask("PUT", "results", Some(&body))?;
        let times_s = series(RESULTS, &answer, "time")?;
        let price_per_kwh = self.held(&self.price_of_electricity, &times_s);
        let emission_kg_per_kwh = self.held("EmissionsElectricPower", &times_s);
        let power = |name: &String| {
            let (price_per_kwh, emission_kg_per_kwh) = (price_per_kwh.clone(), emission_kg_per_kwh.clone());
            let power_w = series(RESULTS, &answer, name)?;
            Ok(PowerSignal { carrier: Carrier::Electricity, power_w, price_per_kwh, emission_kg_per_kwh })
        };
        let powers = listed.electricity.iter().map(power).collect::<Result<_, BoptestError>>()?;
        // With an area of 1 m², figures per area equal those of the whole building.
        let measured = MeasuredRun { area_m2: 1.0, powers, times_s, ..MeasuredRun::default() };
        let figures = Indicators::compute(&measured).map_err(|error| invalid(&error.to_string()))?;
        Ok(Some(Metered {
            electric_kwh: figures.ener_kwh_per_m2,
            electric_peak_kw: figures.pele_kw_per_m2.unwrap_or_default(),
            electric_cost: figures.cost_per_m2,
        }))
    }

    /// The indicators of the test, from its results.
    pub fn compute(&self, config: &BoptestPlantConfig, test: &mut dyn Bench) -> Result<Indicators, BoptestError> {
        let Some(listed) = &config.indicators else { return Err(invalid("`building.plant.indicators` is missing")) };
        let temperatures = config.zones.iter().map(|zone| &zone.temperature);
        let powers = listed.electricity.iter().chain(&listed.gas).chain(&listed.district_heat);
        let names: Vec<&String> = temperatures.chain(&listed.carbon_dioxide).chain(powers).collect();
        let body = json!({ "point_names": names, "start_time": self.start_s, "final_time": self.end_s });
        let answer = test.ask("PUT", "results", Some(&body))?;
        let results = |name: &str| series(RESULTS, &answer, name);
        let times_s = results("time")?;
        let judged = config.zones.iter().zip(&listed.zones).filter(|(_, name)| !name.is_empty());
        let zones = judged.map(|(zone, name)| {
            // Both the temperature and its limits are in kelvin; only differences matter.
            Ok(ThermalZone {
                temperature_c: results(&zone.temperature)?,
                lower_c: self.held(&format!("LowerSetp[{name}]"), &times_s),
                upper_c: self.held(&format!("UpperSetp[{name}]"), &times_s),
            })
        });
        let aired = listed.carbon_dioxide.iter().zip(&listed.zones).filter(|(_, zone)| !zone.is_empty());
        let air = aired.map(|(measurement, zone)| {
            let limit_ppm = self.held(&format!("UpperCO2[{zone}]"), &times_s);
            Ok(AirQuality { concentration_ppm: results(measurement)?, limit_ppm })
        });
        let mut powers = Vec::new();
        for (carrier, names, price, emission) in [
            (Carrier::Electricity, &listed.electricity, self.price_of_electricity.as_str(), "EmissionsElectricPower"),
            (Carrier::Gas, &listed.gas, "PriceGasPower", "EmissionsGasPower"),
            (
                Carrier::DistrictHeat,
                &listed.district_heat,
                "PriceDistrictHeatingPower",
                "EmissionsDistrictHeatingPower",
            ),
        ] {
            for name in names {
                let price_per_kwh = self.held(price, &times_s);
                let emission_kg_per_kwh = self.held(emission, &times_s);
                powers.push(PowerSignal { carrier, power_w: results(name)?, price_per_kwh, emission_kg_per_kwh });
            }
        }
        let (zones, air) = (zones.collect::<Result<_, BoptestError>>()?, air.collect::<Result<_, BoptestError>>()?);
        let measured = MeasuredRun { area_m2: listed.area_m2, zones, air, powers, water: Vec::new(), times_s };
        Indicators::compute(&measured).map_err(|error| invalid(&error.to_string()))
    }

    /// A series at given times; before its first time it has its first value, and without values zero.
    fn held(&self, name: &str, times_s: &[f64]) -> Vec<f64> {
        let Some(values) = self.series.by_name.get(name) else { return vec![0.0; times_s.len()] };
        let at = |time_s: &f64| {
            let after = self.series.times_s.partition_point(|known_s| *known_s <= *time_s + 1e-6);
            values.get(after.saturating_sub(1)).copied().unwrap_or_default()
        };
        times_s.iter().map(at).collect()
    }
}

fn invalid(reason: &str) -> BoptestError {
    BoptestError::Invalid { request: RESULTS.to_owned(), reason: reason.to_owned() }
}
