//! The lowest and the highest speed of a vehicle.

use interplay_scenarios::MetricDeclaration;
use interplay_scenarios::MetricKind::Number;

use crate::measure::metric::{Metric, VehicleMoment};
use crate::measure::vehicle_metric::{Fold, VehicleMetric, VehicleQuantity};

pub(super) const METRICS: &[&dyn Metric] = &[
    &VehicleMetric::new(
        MetricDeclaration::of_vehicle("min_speed_mps", Number, "Lowest speed"),
        Fold::Least,
        VehicleQuantity::AtMoment(speed_mps),
    ),
    &VehicleMetric::new(
        MetricDeclaration::of_vehicle("max_speed_mps", Number, "Highest speed"),
        Fold::Largest,
        VehicleQuantity::AtMoment(speed_mps),
    ),
];

fn speed_mps(moment: &VehicleMoment<'_>) -> Option<f64> {
    Some(moment.state.speed_mps)
}
