//! Forecasts of the case: series at equal intervals, and their use in a run.

use std::collections::BTreeMap;

use interplay_building::comfort::{ComfortBounds, ZoneBounds};
use interplay_building::energy::Tariff;
use interplay_building::occupancy::ZoneRecord;
use interplay_building::series::HeldSeries;
use interplay_building::weather::{TimeSeries, Weather};
use interplay_scenarios::{BoptestForecast, BoptestPrices};
use serde_json::json;

use super::api::{Bench, ZERO_CELSIUS_K, celsius, series};
use crate::plants::boptest::boptest_error::BoptestError;
use crate::plants::interface::Foreseen;

/// Interval of requested series \[s\]; those of BOPTEST's cases change at these times at the earliest.
pub const INTERVAL_S: f64 = 900.0;
const PER_HOUR: usize = 4;
const W_PER_KW: f64 = 1000.0;
const REQUEST: &str = "PUT /forecast";

/// Series of a test, from the present time on; each value holds until the next time.
#[derive(Debug)]
pub struct KnownSeries {
    /// The times \[s\].
    pub times_s: Vec<f64>,
    pub by_name: BTreeMap<String, Vec<f64>>,
}

impl KnownSeries {
    /// Requests the series of these names over `horizon_s` from now on.
    ///
    /// # Errors
    /// [`BoptestError`], also if a series does not have a value for each time.
    pub fn ask(test: &mut dyn Bench, names: Vec<String>, horizon_s: f64) -> Result<Self, BoptestError> {
        let body = json!({ "point_names": names, "horizon": horizon_s, "interval": INTERVAL_S });
        let answer = test.ask("PUT", "forecast", Some(&body))?;
        let times_s = series(REQUEST, &answer, "time")?;
        let all = names.into_iter().map(|name| {
            let values = series(REQUEST, &answer, &name)?;
            if values.len() != times_s.len() || values.is_empty() {
                let reason = format!("`{name}` has {} values for {} times", values.len(), times_s.len());
                return Err(BoptestError::Invalid { request: REQUEST.to_owned(), reason });
            }
            Ok((name, values))
        });
        let by_name = all.collect::<Result<_, _>>()?;
        Ok(Self { times_s, by_name })
    }

    /// Refuses series of implausible temperatures.
    ///
    /// # Errors
    /// [`BoptestError::Invalid`].
    pub fn check_temperatures(&self, names: impl IntoIterator<Item = String>) -> Result<(), BoptestError> {
        for name in names {
            self.values(&name).iter().try_for_each(|kelvin| celsius(REQUEST, &name, *kelvin).map(drop))?;
        }
        Ok(())
    }

    /// The values of a series; empty if it was not requested.
    fn values(&self, name: &str) -> &[f64] {
        self.by_name.get(name).map_or(&[], Vec::as_slice)
    }
}

/// The forecasts that the settings request, over `horizon_s` from the first midnight on, which is now.
pub fn foresee(
    settings: &BoptestForecast,
    prices: BoptestPrices,
    test: &mut dyn Bench,
    horizon_s: f64,
) -> Result<Foreseen, BoptestError> {
    let price = format!("PriceElectricPower{}", prices.words().1);
    let mut names = vec![settings.outdoor.clone(), settings.sun.clone()];
    for zone in settings.zones.iter().filter(|zone| !zone.is_empty()) {
        names.extend(bounds_of(zone));
        if settings.people {
            names.extend(gains_of(zone));
        }
    }
    if settings.tariff {
        names.extend([price.clone(), EMISSIONS.to_owned()]);
    }
    let known = KnownSeries::ask(test, names, horizon_s)?;
    let expected = (horizon_s / INTERVAL_S).round() as usize;
    if known.times_s.len() < expected {
        let reason = format!("it has {} times; wanted is one every {INTERVAL_S} s, {expected}", known.times_s.len());
        return Err(BoptestError::Invalid { request: REQUEST.to_owned(), reason });
    }
    known.check_temperatures(all_bounds(&settings.zones).chain([settings.outdoor.clone()]))?;
    let linear = |values: Vec<f64>| TimeSeries { first_s: 0.0, interval_s: INTERVAL_S, cyclic: false, values };
    let ambient_c = known.values(&settings.outdoor).iter().map(|kelvin| kelvin - ZERO_CELSIUS_K).collect();
    let sun_w_per_m2 = known.values(&settings.sun).iter().map(|sun| sun.max(0.0)).collect();
    Ok(Foreseen {
        weather: Weather { ambient_c: linear(ambient_c), sun_w_per_m2: linear(sun_w_per_m2), sky: None },
        people: if settings.people { people(settings, &known) } else { Vec::new() },
        bounds: (!settings.zones.is_empty()).then(|| bounds(settings, &known)),
        tariff: if settings.tariff { Some(tariff(&known, &price)?) } else { None },
    })
}

const EMISSIONS: &str = "EmissionsElectricPower";

/// The series of the bounds of all judged zones; other zones have no name.
pub fn all_bounds(zones: &[String]) -> impl Iterator<Item = String> {
    zones.iter().filter(|zone| !zone.is_empty()).flat_map(|zone| bounds_of(zone))
}

fn bounds_of(zone: &str) -> [String; 2] {
    [format!("LowerSetp[{zone}]"), format!("UpperSetp[{zone}]")]
}

fn gains_of(zone: &str) -> [String; 2] {
    [format!("InternalGainsCon[{zone}]"), format!("InternalGainsRad[{zone}]")]
}

fn people(settings: &BoptestForecast, known: &KnownSeries) -> Vec<ZoneRecord> {
    let judged = settings.zones.iter().enumerate().filter(|(_, zone)| !zone.is_empty());
    let records = judged.flat_map(|(index, zone)| {
        gains_of(zone).map(|name| {
            let values = known.values(&name).iter().map(|watts| watts / W_PER_KW).collect();
            let heat_kw = HeldSeries { first_s: 0.0, interval_s: INTERVAL_S, cyclic: false, values };
            ZoneRecord { zone: index, heat_kw, beside_people: false, is_forecast: true }
        })
    });
    records.collect()
}

fn bounds(settings: &BoptestForecast, known: &KnownSeries) -> ComfortBounds {
    let of_zone = |zone: &String| {
        let [lower_c, upper_c] =
            bounds_of(zone).map(|name| known.values(&name).iter().map(|kelvin| kelvin - ZERO_CELSIUS_K).collect());
        (!zone.is_empty()).then_some(ZoneBounds { lower_c, upper_c })
    };
    ComfortBounds {
        interval_s: INTERVAL_S,
        zones: settings.zones.iter().map(of_zone).collect(),
        wanted_above_lower_k: settings.wanted_above_lower_k,
    }
}

/// Prices at the interval of the series, and the mean emissions of each hour.
fn tariff(known: &KnownSeries, price: &str) -> Result<Tariff, BoptestError> {
    let emissions = known.values(EMISSIONS).chunks(PER_HOUR);
    let tariff = Tariff {
        prices_per_kwh: known.values(price).to_vec(),
        interval_s: INTERVAL_S,
        emissions_kg_per_kwh: emissions.map(|hour| hour.iter().sum::<f64>() / hour.len() as f64).collect(),
        ..Tariff::default()
    };
    let unusable = |error: &dyn ToString| BoptestError::Invalid {
        request: REQUEST.to_owned(),
        reason: format!("its prices serve no tariff: {}", error.to_string()),
    };
    tariff.check().map_err(|error| unusable(&error))?;
    Ok(tariff)
}
