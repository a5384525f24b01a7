//! Physical limits that no building exceeds, whatever the likelihood says.

use std::ops::Range;

use crate::identify::state_space::exponential::Number;
use crate::identify::state_space::likelihood::{Observations, numbers};
use crate::identify::state_space::quantities::QuantityKind;
use crate::identify::state_space::selection::Fit;
use crate::identify::telemetry::Telemetry;

/// The least that a façade loses for each square metre through which the sun comes in \[kW/(m² K)\]: the best windows have
/// 0.5 W/(m² K) and let half of the sun through.
const LEAST_LOSS_KW_PER_M2_K: f64 = 1e-3;

/// Why a value is none that these data can show or a building can have; `None` if it may be right.
pub(in crate::identify::state_space) fn exceeded(
    telemetry: &Telemetry,
    observations: &Observations,
    fit: &Fit,
    (kind, zone): (QuantityKind, usize),
) -> Option<String> {
    let theta = numbers(&fit.maximum.theta);
    let of = |kind: QuantityKind, theta: &[Number]| kind.value(telemetry, &fit.structure, theta, zone).map(|it| it.re);
    match kind {
        QuantityKind::Capacity | QuantityKind::TimeConstant => {
            let rows: usize = observations.segments.iter().map(Range::len).sum();
            let record_h = rows as f64 * observations.step_s / 3600.0;
            let time_constant_h = of(QuantityKind::TimeConstant, &theta)?;
            (!telemetry.neighbours(zone).is_empty() && time_constant_h > record_h).then(|| {
                format!("a time constant of {time_constant_h:.0} h cannot be seen in a record of {record_h:.0} h")
            })
        }
        QuantityKind::Aperture => {
            let losses =
                telemetry.neighbours(zone).into_iter().filter_map(|place| of(QuantityKind::Conductance(place), &theta));
            let most = losses.sum::<f64>() / LEAST_LOSS_KW_PER_M2_K;
            let aperture = of(QuantityKind::Aperture, &theta)?;
            (most > 0.0 && aperture > most)
                .then(|| format!("no façade that loses so little lets in so much sun (at most {most:.1} m²)"))
        }
        _ => None,
    }
}
