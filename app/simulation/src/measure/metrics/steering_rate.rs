//! Steering rate: `|δ_k − δ_{k−1}| / T` of the steering angles δ over a tick of length T.

use interplay_scenarios::MetricKind::Number;
use interplay_scenarios::{MetricComparison, MetricDeclaration};

use crate::measure::metric::{Metric, VehicleTick};
use crate::measure::vehicle_metric::{Fold, VehicleMetric, VehicleQuantity};

const DOC: &str = "Largest magnitude of the change of the steering angle from tick to tick, over a tick";

pub(super) const METRICS: &[&dyn Metric] = &[&VehicleMetric::new(
    MetricDeclaration::of_vehicle("peak_steering_rate_radps", Number, DOC).compared(MetricComparison::Mean),
    Fold::Peak,
    VehicleQuantity::OverTick(steering_rate_radps),
)];

/// Wheels point straight ahead before the first tick.
fn steering_rate_radps(tick: &VehicleTick<'_>) -> Option<f64> {
    Some((tick.frame.input.steering_rad - tick.previous_input.steering_rad).abs() / tick.step_s)
}
