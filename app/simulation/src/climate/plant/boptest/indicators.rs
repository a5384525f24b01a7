//! The indicators of a test: BOPTEST's own, and ours from what it measured.

use std::collections::BTreeMap;

use interplay_building::benchmark::{AirQuality, Carrier, Indicators, MeasuredRun, PowerSignal, ThermalZone};
use interplay_scenarios::{BoptestIndicators, BoptestPlantConfig, BoptestPrices};
use serde_json::json;

use super::api::{Test, series};
use crate::climate::plant::boptest_error::BoptestError;

/// Interval at which prices and limits are asked for \[s\]; those of BOPTEST's cases change at these times at the earliest.
const INTERVAL_S: f64 = 900.0;

/// Prices, emission factors and limits of a test, which its forecast knows without error. Each is held until the next time.
#[derive(Debug)]
pub struct Known {
    start_s: f64,
    end_s: f64,
    times_s: Vec<f64>,
    series: BTreeMap<String, Vec<f64>>,
    price_of_electricity: String,
}

impl Known {
    /// Asks for them at the beginning of a test: its first time and its length \[s\].
    ///
    /// # Errors
    /// [`BoptestError`].
    pub fn ask(
        listed: &BoptestIndicators,
        prices: BoptestPrices,
        test: &Test,
        (start_s, horizon_s): (f64, f64),
    ) -> Result<Self, BoptestError> {
        let price_of_electricity = format!("PriceElectricPower{}", prices.words().1);
        let mut names = Vec::new();
        for zone in &listed.zones {
            names.extend([format!("LowerSetp[{zone}]"), format!("UpperSetp[{zone}]")]);
        }
        names.extend(listed.zones.iter().take(listed.carbon_dioxide.len()).map(|zone| format!("UpperCO2[{zone}]")));
        for (signals, price, emission) in [
            (&listed.electricity, price_of_electricity.as_str(), "EmissionsElectricPower"),
            (&listed.gas, "PriceGasPower", "EmissionsGasPower"),
            (&listed.district_heat, "PriceDistrictHeatingPower", "EmissionsDistrictHeatingPower"),
        ] {
            if !signals.is_empty() {
                names.extend([price.to_owned(), emission.to_owned()]);
            }
        }
        let body = json!({ "point_names": names, "horizon": horizon_s, "interval": INTERVAL_S });
        let answer = test.ask("PUT", "forecast", Some(&body))?;
        let request = "PUT /forecast";
        let times_s = series(request, &answer, "time")?;
        let all = names.into_iter().map(|name| {
            let values = series(request, &answer, &name)?;
            if values.len() != times_s.len() || values.is_empty() {
                let reason = format!("`{name}` has {} values for {} times", values.len(), times_s.len());
                return Err(BoptestError::Invalid { request: request.to_owned(), reason });
            }
            Ok((name, values))
        });
        let series = all.collect::<Result<_, _>>()?;
        Ok(Self { start_s, end_s: start_s + horizon_s, times_s, series, price_of_electricity })
    }

    /// The indicators of the test, from its results.
    ///
    /// # Errors
    /// [`BoptestError`].
    pub fn compute(&self, config: &BoptestPlantConfig, test: &Test) -> Result<Indicators, BoptestError> {
        let Some(listed) = &config.indicators else { return Err(invalid("`building.plant.indicators` is missing")) };
        let temperatures = config.zones.iter().map(|zone| &zone.temperature);
        let powers = listed.electricity.iter().chain(&listed.gas).chain(&listed.district_heat);
        let names: Vec<&String> = temperatures.chain(&listed.carbon_dioxide).chain(powers).collect();
        let body = json!({ "point_names": names, "start_time": self.start_s, "final_time": self.end_s });
        let answer = test.ask("PUT", "results", Some(&body))?;
        let results = |name: &str| series("PUT /results", &answer, name);
        let times_s = results("time")?;
        let zones = config.zones.iter().zip(&listed.zones).map(|(zone, name)| {
            // Both the temperature and its limits are in kelvin; only differences count.
            Ok(ThermalZone {
                temperature_c: results(&zone.temperature)?,
                lower_c: self.held(&format!("LowerSetp[{name}]"), &times_s),
                upper_c: self.held(&format!("UpperSetp[{name}]"), &times_s),
            })
        });
        let air = listed.carbon_dioxide.iter().zip(&listed.zones).map(|(measurement, zone)| {
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

    /// A series at some times; before its first time and without any it is its first value, or zero.
    fn held(&self, name: &str, times_s: &[f64]) -> Vec<f64> {
        let Some(values) = self.series.get(name) else { return vec![0.0; times_s.len()] };
        let at = |time_s: &f64| {
            let after = self.times_s.partition_point(|known_s| *known_s <= *time_s + 1e-6);
            values.get(after.saturating_sub(1)).copied().unwrap_or_default()
        };
        times_s.iter().map(at).collect()
    }
}

fn invalid(reason: &str) -> BoptestError {
    BoptestError::Invalid { request: "PUT /results".to_owned(), reason: reason.to_owned() }
}
