//! The price of heat and the comfort band, stage by stage: the problem of the economic controller and of the optimum of a whole run.
//!
//! ```text
//! minimise    Σ h (price + emission price · emissions) (u⁺/COP_heating + u⁻/COP_cooling) + c h Σ s + ϖ p + terminal value
//! subject to  |r − T| ≤ band − margin + s  while occupied,   frost − s ≤ T ≤ heat + s  while empty
//!             0 ≤ u⁺ ≤ heating limit,   0 ≤ u⁻ ≤ cooling limit
//! ```
//!
//! If electricity has a negative price, simultaneous heating and cooling would pay in this problem but not in reality.
//! In such a stage, the mode that suits the weather keeps its price, and the other mode has the opposite price.

use crate::comfort::Targets;
use crate::discretise::Model;
use crate::energy::EnergySupply;
use crate::network::Network;
use crate::staged::{HeatInput, PlanStage, SoftBound};

use super::Disturbance;

/// Least and largest temperature of empty rooms \[°C\]: no pipe freezes, and no negative price heats a room without limit.
pub(crate) const EMPTY_ROOM_C: (f64, f64) = (5.0, 40.0);

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Prices<'a> {
    /// A kelvin beyond the band of a zone for an hour, of each zone.
    pub discomfort: &'a [f64],
    /// Least and largest temperature of empty rooms \[°C\].
    pub empty_c: (f64, f64),
    /// A kilogram of emissions.
    pub emissions_per_kg: f64,
    /// How far plans stay within the comfort band \[K\], of each zone.
    pub margin_k: &'a [f64],
    pub has_peak: bool,
}

/// The equipment of a network that can heat or cool.
pub(crate) fn inputs(network: &Network) -> Vec<HeatInput> {
    let limits = network.limits();
    let ways = |zone: usize| [(1.0, limits.heating_kw[zone]), (-1.0, limits.cooling_kw[zone])].map(|way| (zone, way));
    let all = (0..network.zone_count()).flat_map(ways);
    all.filter(|(_, (_, limit_kw))| *limit_kw > 0.0).map(|(zone, (sign, _))| HeatInput { zone, sign }).collect()
}

/// Steps that become a stage: their targets and disturbance are those from `first` on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub map: usize,
    pub first: usize,
    pub steps: usize,
}

/// The stage of a span of steps of `targets`, whose supply knows the outdoor temperature.
pub(crate) fn stage(
    model: &Model,
    inputs: &[HeatInput],
    (targets, disturbance): (&Targets, &Disturbance),
    prices: Prices<'_>,
    span: Span,
) -> PlanStage {
    let limits = model.network().limits();
    let steps = span.first..span.first + span.steps;
    let wanted_c = |step: usize, zone: usize| targets.reference_c[step * targets.zones + zone];
    let mut linear = vec![0.0; inputs.len()];
    let mut power = vec![0.0; if prices.has_peak { inputs.len() } else { 0 }];
    let hours = model.step_s() / 3600.0;
    for step in steps.clone() {
        let outdoor_c = disturbance.ambient_c[step];
        let supply = &targets.supply;
        let price = energy_price(supply, step, prices.emissions_per_kg);
        for (j, input) in inputs.iter().enumerate() {
            let heats = input.sign > 0.0;
            let cop = |heats: bool| supply.heat_pump.as_ref().map_or(1.0, |pump| pump.cop(heats, outdoor_c));
            let likely = heats == (outdoor_c < wanted_c(step, input.zone));
            linear[j] += hours * if price < 0.0 && !likely { -price / cop(!heats) } else { price / cop(heats) };
            if let Some(power) = power.get_mut(j) {
                *power += 1.0 / cop(heats) / span.steps as f64;
            }
        }
    }
    PlanStage {
        map: span.map,
        drift_k: drift_k(model, disturbance, steps),
        lower: vec![0.0; inputs.len()],
        upper: inputs
            .iter()
            .map(|input| if input.sign > 0.0 { limits.heating_kw[input.zone] } else { limits.cooling_kw[input.zone] })
            .collect(),
        linear,
        quadratic: vec![0.0; inputs.len()],
        nodes: Vec::new(),
        soft: band(targets, prices, span, hours),
        power,
    }
}

/// What a kelvin beyond the band of each zone costs for an hour, at a price of `per_kwh`: `factor` times that of what the zone
/// loses for a kelvin in an hour, or of a kilowatt-hour if that is less.
pub(crate) fn discomfort_prices(network: &Network, factor: f64, per_kwh: f64) -> Vec<f64> {
    let laplacian = network.laplacian();
    let loss = |zone: usize| laplacian[(zone, zone)].max(1.0);
    // If all electricity is free, any price of discomfort is right.
    let per_kwh = if per_kwh > 0.0 { per_kwh } else { 1.0 };
    (0..network.zone_count()).map(|zone| factor * per_kwh * loss(zone)).collect()
}

/// The price of electricity in a step, with that of its emissions \[currency/kWh\]; 1 without a tariff.
pub(crate) fn energy_price(supply: &EnergySupply, step: usize, emissions_per_kg: f64) -> f64 {
    let price = supply.price_per_kwh.as_ref().and_then(|prices| prices.get(step)).copied().unwrap_or(1.0);
    price + emissions_per_kg * supply.emissions_kg_per_kwh.as_ref().and_then(|all| all.get(step)).unwrap_or(&0.0)
}

/// The comfort band at the end of a span, and the limits of empty rooms.
fn band(targets: &Targets, prices: Prices<'_>, span: Span, hours: f64) -> Vec<SoftBound> {
    let last = span.first + span.steps - 1;
    let mut soft = Vec::new();
    for node in 0..targets.zones {
        let i = last * targets.zones + node;
        let (low, high) = if targets.occupied[i] {
            let band_k = targets.band_k[i] - prices.margin_k[node].min(0.5 * targets.band_k[i]);
            (targets.reference_c[i] - band_k, targets.reference_c[i] + band_k)
        } else {
            prices.empty_c
        };
        let linear = prices.discomfort[node] * hours * span.steps as f64;
        soft.push(SoftBound { node, sign: 1.0, bound: high, linear, quadratic: 0.0 });
        soft.push(SoftBound { node, sign: -1.0, bound: -low, linear, quadratic: 0.0 });
    }
    soft
}

/// What weather and gains of some steps add to the temperatures at their end \[K\].
pub(crate) fn drift_k(model: &Model, disturbance: &Disturbance, steps: std::ops::Range<usize>) -> Vec<f64> {
    let count = model.network().gain_count();
    let no_heat = vec![0.0; model.network().zone_count()];
    let mut drift_k = vec![0.0; model.network().node_count()];
    for step in steps {
        let gains_kw = &disturbance.gains_kw[step * count..(step + 1) * count];
        model.step(&mut drift_k, &no_heat, disturbance.ambient_c[step], gains_kw);
    }
    drift_k
}
