//! A metric of one's own: declared once, it is in reports, rows of sweeps and comparisons, and scenario files may bound it.
//! `cargo run --release -p interplay-examples --example own_metric`

#![allow(clippy::print_stdout, reason = "an example prints what it found")]

use interplay_scenarios::{Better, MetricComparison, MetricDeclaration, MetricKind, Override, Registry};
use interplay_simulation::measure::{Fold, RegisterMetrics, VehicleMetric, VehicleQuantity, VehicleTick};
use interplay_simulation::run::run;

/// How fast a vehicle turns, at the rear axle of the bicycle: `v tan(δ) / L`.
fn yaw_rate_radps(tick: &VehicleTick<'_>) -> Option<f64> {
    let body = &tick.end.vehicle.body;
    let wheelbase_m = body.front_axle_m + body.rear_axle_m;
    Some((tick.frame.state.speed_mps * tick.frame.input.steering_rad.tan() / wheelbase_m).abs())
}

/// A number at each tick, and the fold that makes one of all. What looks at several vehicles implements `Metric` itself.
const PEAK_YAW_RATE: VehicleMetric = VehicleMetric::new(
    MetricDeclaration::of_vehicle("peak_yaw_rate_radps", MetricKind::Number, "Largest magnitude of the yaw rate")
        .compared(MetricComparison::Mean)
        .better(Better::Lower),
    Fold::Peak,
    VehicleQuantity::OverTick(yaw_rate_radps),
);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let registry = Registry::default().with_metric(PEAK_YAW_RATE)?;
    // As a file would state it: `[[expect.metric]]`.
    let bound = "expect.metric=[{ name = \"peak_yaw_rate_radps\", vehicle = \"ego\", at_most = 0.8 }]".to_owned();
    for planner in ["conservative", "negotiation", "idm"] {
        let changes = [Override::Set(bound.clone()), Override::Planner(planner.to_owned())];
        let scenario = registry.load("lane-change/front-nice", &changes)?;
        let report = run(planner, &scenario, Vec::new())?;
        let values = report.vehicles.iter().map(|vehicle| {
            let value = vehicle.metrics.number("peak_yaw_rate_radps");
            format!("{} {:.2} rad/s", vehicle.name, value.unwrap_or(f64::NAN))
        });
        println!("{planner:12} {}", values.collect::<Vec<_>>().join(", "));
        let judged = report.expectations.iter().filter(|expectation| expectation.what.contains("peak_yaw_rate"));
        judged.for_each(|expectation| println!("{:12} bound kept: {}", "", expectation.passed));
    }
    Ok(())
}
