//! Whatever numbers a record holds, an identification ends in findings or in an error.

use interplay_building::identify::{
    Boundary, Estimator, Hold, IdentifyError, IdentifySettings, MeasuredWall, MeasuredZone, Neighbour, Telemetry,
    identify,
};
use proptest::prelude::*;

/// Enough for the smallest model of each estimator, few enough for many fits.
const ROWS: usize = 72;

/// Every kind of series meets every other in one place at least.
const CASES: u32 = 48;

/// A series as sensors, switches and mistakes make them; `low` and `high` span what the quantity can be.
fn series(low: f64, high: f64) -> impl Strategy<Value = Vec<f64>> {
    let value = low..high;
    let each = |values| Just(values).boxed();
    let constant = value.clone().prop_map(|value| vec![value; ROWS]);
    let alternating = (value.clone(), value.clone())
        .prop_map(|(one, other)| (0..ROWS).map(|row| if row % 2 == 0 { one } else { other }).collect());
    let two_valued = (value.clone(), value.clone(), prop::collection::vec(any::<bool>(), ROWS))
        .prop_map(|(one, other, is_one)| is_one.iter().map(|&is_one| if is_one { one } else { other }).collect());
    let one_row = (value.clone(), value.clone(), 0..ROWS)
        .prop_map(|(one, other, at)| (0..ROWS).map(|row| if row == at { other } else { one }).collect());
    let around = |middle: f64, width: f64| {
        prop::collection::vec(-width..width, ROWS).prop_map(move |each| each.iter().map(|one| middle + one).collect())
    };
    prop_oneof![
        each(vec![0.0; ROWS]),
        constant,
        alternating,
        two_valued,
        one_row,
        around(0.5 * (low + high), 1e-13),
        around(0.5 * (low + high), 1e-6),
        around(0.0, 1e-300),
        prop::collection::vec(value, ROWS),
    ]
}

/// A zone beside the outdoors, of which two series may be one.
fn telemetry() -> impl Strategy<Value = Telemetry> {
    let temperature = || series(-60.0, 90.0);
    let heat = prop_oneof![series(-3.0, 5.0), series(-1e12, 1e12)];
    let sun = prop::option::of(series(0.0, 1.2));
    (temperature(), temperature(), heat, sun, 0..3_u8).prop_map(|(zone, outdoor, heat, sun, equal)| {
        let outdoor = if equal == 1 { zone.clone() } else { outdoor };
        let heat = if equal == 2 { zone.clone() } else { heat };
        record(zone, outdoor, heat, sun)
    })
}

fn record(temperature_c: Vec<f64>, outdoor_c: Vec<f64>, power_kw: Vec<f64>, sun: Option<Vec<f64>>) -> Telemetry {
    Telemetry {
        step_s: 900.0,
        time_s: (0..ROWS).map(|row| 900.0 * row as f64).collect(),
        segments: std::iter::once(0..ROWS).collect(),
        left_out_rows: 0,
        zones: vec![MeasuredZone {
            name: "room".into(),
            temperature_c,
            power_kw,
            power_has_unit: true,
            power_hold: Hold::ZeroOrder,
            supply_air: Vec::new(),
            irradiance_kw_per_m2: sun,
            irradiance_hold: Hold::FirstOrder,
        }],
        boundaries: vec![Boundary { name: "out".into(), temperature_c: outdoor_c, hold: Hold::FirstOrder }],
        walls: vec![MeasuredWall { zone: 0, other: Neighbour::Boundary(0) }],
    }
}

fn settings(method: Estimator) -> IdentifySettings {
    IdentifySettings { method, most_states: 2, horizon_h: 6.0, harmonics: 1, ..IdentifySettings::default() }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(CASES))]

    /// Returning is the claim: a panic fails the test.
    #[test]
    fn a_regression_of_any_table_ends_in_findings_or_an_error(telemetry in telemetry()) {
        for method in [Estimator::Semiparametric, Estimator::PredictionError] {
            let _ = identify(&telemetry, &settings(method));
        }
    }

    #[test]
    fn a_likelihood_of_any_table_ends_in_findings_or_an_error(telemetry in telemetry()) {
        let _ = identify(&telemetry, &settings(Estimator::StateSpace));
    }
}

#[test]
fn a_zone_whose_temperature_never_changes_is_refused_by_name() {
    for value_c in [5.0, 1.0, 0.0] {
        let telemetry = telemetry_of(vec![value_c; ROWS]);
        for method in [Estimator::Semiparametric, Estimator::PredictionError, Estimator::StateSpace] {
            let error = identify(&telemetry, &settings(method)).expect_err("the sensor is stuck");
            let expected = IdentifyError::ConstantTemperature { zone: "room".into(), value_c, rows: ROWS };
            assert_eq!(error, expected);
            assert!(error.to_string().starts_with("the temperature of zone `room` never changes"), "{error}");
        }
    }
}

#[test]
fn a_temperature_that_changes_only_after_the_trained_days_is_refused() {
    let mut temperature_c = vec![20.0; ROWS];
    temperature_c[ROWS - 1] = 21.0;
    let telemetry = telemetry_of(temperature_c);
    let settings = IdentifySettings { train_days: Some(0.5), ..settings(Estimator::StateSpace) };
    let error = identify(&telemetry, &settings).expect_err("nothing changes in the trained rows");
    assert!(matches!(error, IdentifyError::ConstantTemperature { rows: 48, .. }), "{error:?}");
}

/// A zone with this temperature, beside outdoors that change evenly.
fn telemetry_of(temperature_c: Vec<f64>) -> Telemetry {
    let ramp = |slope: f64, rows: usize| (0..ROWS).map(|row| slope * (row % rows) as f64).collect();
    record(temperature_c, ramp(0.1, ROWS), ramp(1.0, 5), None)
}
