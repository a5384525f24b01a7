//! Effects of a planner on a building: energy, electricity, its price, and discomfort.

use serde::Serialize;

use super::estimate::{Estimate, Split};
use super::records::RunRecord;

/// First random stream of the intervals of buildings, which have streams of their own.
const FIRST_STREAM: u64 = 1 << 48;
/// Number of intervals of a planner, its own and those versus the baseline.
const INTERVALS: u64 = 8;
/// Relative difference below which two bills, or two amounts of electricity, are equal.
const EQUAL_SHARE: f64 = 1e-9;

/// Results of the buildings of several runs: means over the runs of the totals over all days.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BuildingFigures {
    /// Heat brought in and taken out \[kWh\].
    pub energy_kwh: Estimate,
    /// Electricity of the equipment \[kWh\]; none if it equals the heat in all runs, without a heat pump.
    pub electricity_kwh: Option<Estimate>,
    /// What the electricity cost \[currency\]; none without a tariff.
    pub bill: Option<Estimate>,
    /// The currency of the bill; none without a tariff, or with several.
    pub currency: Option<String>,
    /// Deviation beyond the comfort band while occupied \[K·h per zone\].
    pub discomfort_k_h: Estimate,
}

/// Differences for a building between two planners under the same conditions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BuildingDifference {
    /// Pairs by the lower bill; without tariffs, by the lower consumption of electricity.
    pub cheaper: Split,
    /// Additional electricity of the first \[kWh\]: mean over the pairs.
    pub electricity_kwh: Option<Estimate>,
    /// Additional cost of the first \[currency\]: mean over the pairs with one currency.
    pub bill: Option<Estimate>,
    /// Additional discomfort of the first \[K·h per zone\]: mean over the pairs.
    pub discomfort_k_h: Option<Estimate>,
}

impl BuildingFigures {
    /// The figures of several runs; none without buildings.
    pub(super) fn of(records: &[&RunRecord], stream: u64) -> Option<BuildingFigures> {
        let buildings: Vec<&RunRecord> = records.iter().copied().filter(|record| has_building(record)).collect();
        let currency = buildings.first()?.text("currency");
        let estimate = |index: u64, column: &str| {
            let numbers: Vec<f64> = buildings.iter().filter_map(|one| one.number(column)).collect();
            Estimate::of(&numbers, FIRST_STREAM + INTERVALS * stream + index)
        };
        let has_heat_pump = |one: &&RunRecord| {
            let heat_and_electricity = one.number("energy_kwh").zip(one.number("electricity_kwh"));
            heat_and_electricity.is_some_and(|(heat_kwh, electricity_kwh)| !is_equal(heat_kwh, electricity_kwh))
        };
        let has_one_currency = buildings.iter().all(|one| one.text("currency") == currency);
        let electricity = buildings.iter().any(has_heat_pump);
        Some(BuildingFigures {
            energy_kwh: estimate(0, "energy_kwh")?,
            electricity_kwh: estimate(1, "electricity_kwh").filter(|_| electricity),
            bill: estimate(2, "bill").filter(|_| has_one_currency),
            currency: currency.filter(|_| has_one_currency).map(str::to_owned),
            discomfort_k_h: estimate(3, "discomfort_k_h")?,
        })
    }
}

impl BuildingDifference {
    /// Compares the first of each pair with the second; none without buildings.
    pub(super) fn of(pairs: &[&(&RunRecord, &RunRecord)], stream: u64) -> Option<BuildingDifference> {
        let both = |pair: &&&(&RunRecord, &RunRecord)| has_building(pair.0) && has_building(pair.1);
        let pairs: Vec<(&RunRecord, &RunRecord)> = pairs.iter().filter(both).map(|pair| **pair).collect();
        pairs.first()?;
        let has_one_currency = |one: &RunRecord, other: &RunRecord| one.text("currency") == other.text("currency");
        let more = |index: u64, column: &str, is_known: &dyn Fn(&RunRecord, &RunRecord) -> bool| {
            let known = pairs.iter().filter(|(one, other)| is_known(one, other));
            let differences = known.filter_map(|(one, other)| Some(one.number(column)? - other.number(column)?));
            Estimate::of(&differences.collect::<Vec<f64>>(), FIRST_STREAM + INTERVALS * stream + 4 + index)
        };
        let is_cheaper = |one: &RunRecord, other: &RunRecord| {
            let price = |of: &RunRecord| of.number("bill").or_else(|| of.number("electricity_kwh"));
            let prices = price(one).zip(price(other)).filter(|_| has_one_currency(one, other));
            prices.is_some_and(|(one, other)| one < other && !is_equal(one, other))
        };
        Some(BuildingDifference {
            cheaper: Split::between(pairs.iter().copied(), is_cheaper),
            electricity_kwh: more(0, "electricity_kwh", &|_, _| true),
            bill: more(1, "bill", &has_one_currency),
            discomfort_k_h: more(2, "discomfort_k_h", &|_, _| true),
        })
    }
}

fn has_building(record: &RunRecord) -> bool {
    record.number("energy_kwh").is_some() && record.number("discomfort_k_h").is_some()
}

/// Whether two sums are equal up to the order of their terms.
fn is_equal(one: f64, other: f64) -> bool {
    (one - other).abs() <= EQUAL_SHARE * (1.0 + one.abs().max(other.abs()))
}
