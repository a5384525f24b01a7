//! The zones with the worst figures of a day, by number.

use interplay_building::comfort::Targets;
use interplay_building::control::DayRecord;
use interplay_building::day::ZoneFigures;
use interplay_building::network::PowerLimits;

/// The zones with the largest share in each key figure of a day; none if the figure is 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WorstZones {
    /// The zone with the largest sum of squared errors over occupied steps.
    pub tracking: Option<usize>,
    /// The zone with the largest deviation beyond the comfort band, summed over occupied steps.
    pub discomfort: Option<usize>,
    /// The zone with the largest amount of heat, heating and cooling together.
    pub energy: Option<usize>,
    /// The zone with the largest consumption of electricity.
    pub electricity: Option<usize>,
    /// The zone with the highest cost of electricity.
    pub energy_cost: Option<usize>,
    /// The zone with the largest excess of a requested input over its limit.
    pub input_violation: Option<usize>,
}

impl WorstZones {
    /// Finds these zones in a day's record.
    pub fn find(record: &DayRecord, targets: &Targets, limits: &PowerLimits) -> Self {
        let zones = targets.zones;
        let largest = |share: &dyn Fn(usize) -> f64| {
            let shares = (0..zones).map(|zone| (zone, share(zone))).filter(|(_, share)| *share > 0.0);
            shares.max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0))).map(|(zone, _)| zone)
        };
        let entries = |zone: usize| (zone..record.temperatures_c.len()).step_by(zones);
        let errors_k = |zone: usize| {
            let occupied = entries(zone).filter(|&i| targets.occupied[i]);
            occupied.map(|i| targets.reference_c[i] - record.temperatures_c[i])
        };
        let beyond_k = |zone: usize| entries(zone).map(|i| targets.beyond_k(i, record.temperatures_c[i])).sum();
        let heat_kw = |zone: usize| record.heat_kw.iter().skip(zone).step_by(zones).map(|kw| kw.abs()).sum();
        let excess_kw = |zone: usize| {
            let requested_kw = record.requested_kw.iter().skip(zone).step_by(zones);
            requested_kw.map(|kw| limits.excess_kw(zone, *kw)).fold(0.0, f64::max)
        };
        // The step length is arbitrary here: it does not change which share is largest.
        let figures = ZoneFigures::of_all(record, targets, 3600.0);
        WorstZones {
            tracking: largest(&|zone| errors_k(zone).map(|error_k| error_k * error_k).sum()),
            discomfort: largest(&beyond_k),
            energy: largest(&heat_kw),
            electricity: largest(&|zone| figures[zone].electricity_kwh),
            energy_cost: largest(&|zone| figures[zone].energy_cost.unwrap_or(0.0)),
            input_violation: largest(&excess_kw),
        }
    }
}
