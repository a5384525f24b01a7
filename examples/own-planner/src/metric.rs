//! A metric of one's own: how long a vehicle waits.

// shown from here
use interplay_scenarios::{Better, MetricComparison, MetricDeclaration, MetricKind};
use interplay_simulation::measure::{Fold, VehicleMetric, VehicleQuantity, VehicleTick};

/// A vehicle that is slower than this waits \[m/s\].
const WAITING_MPS: f64 = 0.2;

/// The share of the run in which a vehicle waits.
pub const WAITING_SHARE: VehicleMetric = VehicleMetric::new(
    MetricDeclaration::of_vehicle("waiting_share", MetricKind::Number, "Share of the run below 0.2 m/s")
        .compared(MetricComparison::Quantiles)
        .better(Better::Lower),
    Fold::Mean,
    VehicleQuantity::OverTick(waits),
);

fn waits(tick: &VehicleTick<'_>) -> Option<f64> {
    Some(f64::from(tick.frame.state.speed_mps < WAITING_MPS))
}
// shown until here
