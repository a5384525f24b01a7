//! The lowest and the highest speed of a vehicle, and the share of its wanted speed that it drives.

use interplay_scenarios::MetricKind::Number;
use interplay_scenarios::{Better, MetricComparison, MetricDeclaration};

use crate::measure::metric::{Metric, VehicleMoment};
use crate::measure::vehicle_metric::{Fold, VehicleMetric, VehicleQuantity};
use crate::state::standing::wants_to_drive;

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
    &VehicleMetric {
        applies: wants_to_drive,
        ..VehicleMetric::new(
            MetricDeclaration::of_vehicle("wanted_speed_share", Number, SHARE_DOC)
                .compared(MetricComparison::Mean)
                .better(Better::Higher),
            Fold::Mean,
            VehicleQuantity::AtMoment(wanted_share),
        )
    },
];

/// Before the end of its route a vehicle slows down at this rate \[m/s²\].
const STOPPING_MPS2: f64 = 1.0;
/// Distance to the end of its route within which a real car may stand \[m\].
const NEAR_END_M: f64 = 15.0;

const SHARE_DOC: &str = "Mean share of the wanted speed, or of the limit of its lane if that is lower, that it drives; not counted before \
                         the end of its route, where it stops";

fn speed_mps(moment: &VehicleMoment<'_>) -> Option<f64> {
    Some(moment.state.speed_mps)
}

/// The speed as a share of the wanted one; none before the end of the route.
fn wanted_share(moment: &VehicleMoment<'_>) -> Option<f64> {
    let VehicleMoment { vehicle, state, along_m, .. } = moment;
    let goal_mps = vehicle.goal.speed_mps.unwrap_or(vehicle.start.speed_mps);
    let limit_mps = vehicle.route.leg(*along_m).and_then(|leg| leg.speed_limit_mps);
    let wanted_mps = limit_mps.map_or(goal_mps, |limit_mps| goal_mps.min(limit_mps));
    let stops_m = 0.5 * goal_mps * goal_mps / STOPPING_MPS2 + NEAR_END_M * vehicle.body.real_ratio();
    (along_m + stops_m < vehicle.route.end_m() && wanted_mps > 0.0).then(|| state.speed_mps / wanted_mps)
}
