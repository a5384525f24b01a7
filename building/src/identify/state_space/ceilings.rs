//! Physical limits that no building exceeds, or beyond which a record cannot tell, whatever the likelihood says.

use std::ops::Range;

use super::elements::{HiddenNode, Place};
use super::exponential::Number;
use super::likelihood::{Observations, numbers};
use super::quantities::QuantityKind;
use super::selection::Fit;
use crate::identify::telemetry::Telemetry;

/// The least that a façade loses for each square metre through which the sun comes in \[kW/(m² K)\]: the best windows have
/// 0.5 W/(m² K) and let half of the sun through.
const LEAST_LOSS_KW_PER_M2_K: f64 = 1e-3;
/// The same for each square metre of wall that absorbs the sun outside: the best walls have 0.1 W/(m² K).
const LEAST_LOSS_OF_WALL_KW_PER_M2_K: f64 = 1e-4;
/// Nodes that exchange their heat within this share of a row cannot be told apart by rows.
const FASTEST_SHARE_OF_ROW: f64 = 0.02;

/// The largest value of a quantity that a building can have and the record can show, and why.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ceiling {
    pub most: f64,
    pub reason: String,
}

/// The ceiling of a quantity of a zone; `None` if it has none.
pub(super) fn ceiling(
    telemetry: &Telemetry,
    observations: &Observations,
    fit: &Fit,
    (kind, zone): (QuantityKind, usize),
) -> Option<Ceiling> {
    let theta = numbers(&fit.maximum.theta);
    let of = |kind: QuantityKind, theta: &[Number]| kind.value(telemetry, &fit.structure, theta, zone).map(|it| it.re);
    let neighbours = telemetry.neighbours(zone);
    let losses_kw_per_k: f64 =
        neighbours.iter().filter_map(|&place| of(QuantityKind::Conductance(place), &theta)).sum();
    let rows: usize = observations.segments.iter().map(Range::len).sum();
    let record_s = rows as f64 * observations.step_s;
    let record_h = record_s / 3600.0;
    let slow = format!("a time constant beyond the {record_h:.0} h of the record cannot be seen in it");
    let minutes = observations.step_s / 60.0;
    let positive = |most: f64, reason: String| (most > 0.0).then_some(Ceiling { most, reason });
    match kind {
        QuantityKind::Capacity => positive(losses_kw_per_k * record_s, slow),
        QuantityKind::NodeCapacity(place) => {
            let exchange = match place {
                Place::Air => losses_kw_per_k,
                Place::Hidden(hidden) => {
                    of(QuantityKind::InnerConductance(hidden), &theta)?.max(0.0) + outer(telemetry, fit, zone, hidden)
                }
            };
            positive(losses_kw_per_k.min(exchange) * record_s, slow)
        }
        QuantityKind::TimeConstant => positive(record_h, slow),
        QuantityKind::Aperture | QuantityKind::NodeAperture(_) => {
            let per_m2 = match kind {
                QuantityKind::NodeAperture(Place::Hidden(HiddenNode::Wall(_))) => LEAST_LOSS_OF_WALL_KW_PER_M2_K,
                _ => LEAST_LOSS_KW_PER_M2_K,
            };
            let most = losses_kw_per_k / per_m2;
            positive(most, format!("a façade that loses so little takes in the sun of at most {most:.1} m²"))
        }
        QuantityKind::Conductance(_) => {
            let capacity = of(QuantityKind::Capacity, &theta)?;
            let reason =
                format!("a zone that follows its surroundings within a row of {minutes:.0} min has no capacity");
            positive(capacity / observations.step_s, reason)
        }
        QuantityKind::InnerConductance(hidden) => {
            let least_kj_per_k = [Place::Air, Place::Hidden(hidden)]
                .into_iter()
                .filter_map(|place| of(QuantityKind::NodeCapacity(place), &theta))
                .fold(f64::INFINITY, f64::min);
            let reason = format!("rows of {minutes:.0} min do not show masses that exchange their heat faster");
            let most = least_kj_per_k / (FASTEST_SHARE_OF_ROW * observations.step_s);
            most.is_finite().then_some(Ceiling { most, reason })
        }
        // The inverse of a conductance has that of the conductance, and a warming none.
        QuantityKind::Resistance(_) | QuantityKind::Warming => None,
    }
}

/// Conductance from a wall's mass outwards \[kW/K\]; 0 for other nodes.
fn outer(telemetry: &Telemetry, fit: &Fit, zone: usize, hidden: HiddenNode) -> f64 {
    let HiddenNode::Wall(boundary) = hidden else { return 0.0 };
    let theta = numbers(&fit.maximum.theta);
    let of = |kind: QuantityKind| kind.value(telemetry, &fit.structure, &theta, zone).map(|it| it.re);
    let whole = of(QuantityKind::Conductance(crate::identify::telemetry::Neighbour::Boundary(boundary)));
    // In series: 1/whole = 1/inner + 1/outer.
    whole.zip(of(QuantityKind::InnerConductance(hidden))).map_or(0.0, |(whole, inner)| {
        let outer = 1.0 / (1.0 / whole - 1.0 / inner);
        if outer.is_finite() { outer.max(0.0) } else { 0.0 }
    })
}
