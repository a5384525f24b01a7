//! What a planner means for a building: energy, electricity, its price, and discomfort.

use serde::Serialize;

use super::estimate::Estimate;
use super::records::{BuildingRecord, RunRecord};
use super::split::Split;

/// The intervals of buildings have streams of their own, from here on.
const FIRST_STREAM: u64 = 1 << 48;
/// How many intervals a planner has of its own, and versus the baseline.
const INTERVALS: u64 = 8;
/// Two bills, or two amounts of electricity, that differ by a smaller share are equal.
const EQUAL_SHARE: f64 = 1e-9;

/// What became of the buildings of some runs: means over the runs of what all days of a run amount to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BuildingFigures {
    /// Heat brought in and taken out \[kWh\].
    pub energy_kwh: Estimate,
    /// Electricity that the equipment took for it \[kWh\]; none where it is the heat itself in all runs, without a heat pump.
    pub electricity_kwh: Option<Estimate>,
    /// What the electricity cost \[currency\]; none without a tariff.
    pub bill: Option<Estimate>,
    /// The currency of the bill; none without a tariff, or with several.
    pub currency: Option<String>,
    /// Deviation beyond the comfort band while occupied \[K·h per zone\].
    pub discomfort_k_h: Estimate,
}

/// What is different for a building with one of two, under the same conditions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BuildingDifference {
    /// Whose bill is lower; without tariffs, who takes less electricity.
    pub cheaper: Split,
    /// How much more electricity the first takes \[kWh\]: mean over the pairs.
    pub electricity_kwh: Option<Estimate>,
    /// How much more it costs \[currency\]: mean over the pairs with one currency.
    pub bill: Option<Estimate>,
    /// How much more discomfort there is \[K·h per zone\]: mean over the pairs.
    pub discomfort_k_h: Option<Estimate>,
}

impl BuildingFigures {
    /// The figures of some runs; none without buildings.
    pub(super) fn of(records: &[&RunRecord], stream: u64) -> Option<BuildingFigures> {
        let buildings: Vec<&BuildingRecord> = records.iter().filter_map(|record| record.building.as_ref()).collect();
        let first = buildings.first()?;
        let estimate = |index: u64, of: fn(&BuildingRecord) -> Option<f64>| {
            let numbers: Vec<f64> = buildings.iter().filter_map(|one| of(one)).collect();
            Estimate::of(&numbers, FIRST_STREAM + INTERVALS * stream + index)
        };
        let has_heat_pump =
            |one: &&BuildingRecord| one.electricity_kwh.is_some_and(|kwh| !is_equal(kwh, one.energy_kwh));
        let has_one_currency = buildings.iter().all(|one| one.currency == first.currency);
        let electricity = buildings.iter().any(has_heat_pump);
        Some(BuildingFigures {
            energy_kwh: estimate(0, |one| Some(one.energy_kwh))?,
            electricity_kwh: estimate(1, |one| one.electricity_kwh).filter(|_| electricity),
            bill: estimate(2, |one| one.bill).filter(|_| has_one_currency),
            currency: first.currency.as_deref().filter(|_| has_one_currency).map(str::to_owned),
            discomfort_k_h: estimate(3, |one| Some(one.discomfort_k_h))?,
        })
    }
}

impl BuildingDifference {
    /// Compares the first of each pair with the second; none without buildings.
    pub(super) fn of(pairs: &[&(&RunRecord, &RunRecord)], stream: u64) -> Option<BuildingDifference> {
        let pairs: Vec<(&BuildingRecord, &BuildingRecord)> =
            pairs.iter().filter_map(|(one, other)| Some((one.building.as_ref()?, other.building.as_ref()?))).collect();
        pairs.first()?;
        let more = |index: u64, of: fn(&BuildingRecord, &BuildingRecord) -> Option<f64>| {
            let numbers: Vec<f64> = pairs.iter().filter_map(|(one, other)| of(one, other)).collect();
            Estimate::of(&numbers, FIRST_STREAM + INTERVALS * stream + 4 + index)
        };
        let is_cheaper = |one: &BuildingRecord, other: &BuildingRecord| {
            let price = |of: &BuildingRecord| of.bill.or(of.electricity_kwh);
            let prices = price(one).zip(price(other)).filter(|_| one.currency == other.currency);
            prices.is_some_and(|(one, other)| one < other && !is_equal(one, other))
        };
        Some(BuildingDifference {
            cheaper: Split::between(pairs.iter().copied(), is_cheaper),
            electricity_kwh: more(0, |one, other| Some(one.electricity_kwh? - other.electricity_kwh?)),
            bill: more(1, |one, other| {
                one.bill.zip(other.bill).filter(|_| one.currency == other.currency).map(|(one, other)| one - other)
            }),
            discomfort_k_h: more(2, |one, other| Some(one.discomfort_k_h - other.discomfort_k_h)),
        })
    }
}

/// Whether two sums are equal but for the order in which they were added.
fn is_equal(one: f64, other: f64) -> bool {
    (one - other).abs() <= EQUAL_SHARE * (1.0 + one.abs().max(other.abs()))
}
