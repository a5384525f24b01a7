//! Tables of any content, and real buildings. Data of the latter may not be part of this repository, so their tests are ignored by
//! default. To run them, let the environment variable `INTERPLAY_THERMAL_DATA` name a folder with `dutch3/blg_1.csv` to `blg_3.csv`,
//! `flexhouse/inputPRBS1.csv` and `riskbr/riskbr_data.csv` (sources: `docs/guide/identification.md`), and pass `--ignored`:
//!
//! ```sh
//! INTERPLAY_THERMAL_DATA=FOLDER cargo test --release -p interplay-building --test identify_measured -- --ignored
//! ```

use std::path::PathBuf;

use interplay_building::identify::{
    Boundary, Confidence, Estimator, Gaps, Hold, IdentificationReport, IdentifyError, IdentifySettings, Mapping,
    MeasuredWall, MeasuredZone, Neighbour, Quantity, ResidualForecast, Telemetry, identify,
};
use proptest::prelude::*;

const DUTCH: &str = include_str!("../experiments/dutch3.toml");
const FLEXHOUSE: &str = include_str!("../experiments/flexhouse.toml");
const RISKBR: &str = include_str!("../experiments/riskbr.toml");

/// Reads a file of the data.
fn table(path: &str) -> String {
    let folder = std::env::var_os("INTERPLAY_THERMAL_DATA").expect("INTERPLAY_THERMAL_DATA names a folder");
    let path = PathBuf::from(folder).join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn report(mapping: &Mapping, file: &str, table: &str) -> IdentificationReport {
    let telemetry = Telemetry::read(file, table, mapping).expect("the mapping fits the table");
    identify(&telemetry, &mapping.identify).expect("thousands of rows").report
}

fn quantity<'a>(report: &'a IdentificationReport, zone: usize, name: &str) -> &'a Quantity {
    let zone = &report.zones[zone];
    zone.coefficients.iter().chain(&zone.physical).find(|quantity| quantity.name == name).expect("listed")
}

/// The published fits (CTSM-R; Leprince et al., Energy and Buildings 253, 2021) have two to four states, chosen home by home.
#[test]
#[ignore = "needs the data of measured buildings in INTERPLAY_THERMAL_DATA"]
fn dutch_homes_are_predicted_as_well_as_by_the_published_models() {
    // Standard deviation of the residuals of the published final models [K].
    for (home, published_k) in [(1, 0.3366), (2, 0.0966), (3, 0.1099)] {
        let file = format!("dutch3/blg_{home}.csv");
        let table = table(&file);
        let mapping = Mapping::parse("dutch3.toml", DUTCH).expect("sound");
        let zone = &report(&mapping, &file, &table).zones[0];
        let ours_k = zone.train.one_step_k;
        assert!(ours_k < 1.02 * published_k, "home {home}: {ours_k} K against {published_k} K");
        let free = &zone.train.free_run;
        let (network_k, mean_k) = (free.errors_k[0].1.expect("runs"), free.mean_of_data_k.expect("runs"));
        assert!(network_k < 0.8 * mean_k, "home {home}: {network_k} K against {mean_k} K by the mean of the data");
    }
}

/// The heated house of BSSPy: by its heat balance 0.18 kW/K, and 14 MJ/K.
#[test]
#[ignore = "needs the data of measured buildings in INTERPLAY_THERMAL_DATA"]
fn the_known_conductance_and_capacity_of_the_heated_house_are_identified() {
    let table = table("flexhouse/inputPRBS1.csv");
    let mapping = Mapping::parse("flexhouse.toml", FLEXHOUSE).expect("sound");
    let report = report(&mapping, "inputPRBS1.csv", &table);
    let conductance = quantity(&report, 0, "conductance to outdoor").value.expect("determined");
    assert!((conductance - 0.18).abs() < 0.02, "{conductance}");
    // Six days do not say how much of the sun falls on the inner mass, nor therefore how heavy that is.
    let (low, high) = quantity(&report, 0, "heat capacity").interval;
    assert!(low.is_some_and(|low| low < 14_000.0) && high.is_some_and(|high| high > 14_000.0), "{low:?} {high:?}");
    let free_run_k = report.zones[0].train.free_run.errors_k[0].1.expect("runs");
    assert!(free_run_k < 0.8, "{free_run_k}");
    // With a wall in place of the inner mass, which is a little less likely.
    let with_wall = format!("{}\n[identify]\nhidden = [\"wall\", \"heater\"]\n", FLEXHOUSE);
    let mapping = Mapping::parse("flexhouse.toml", &with_wall).expect("sound");
    let report = self::report(&mapping, "inputPRBS1.csv", &table);
    let capacity = quantity(&report, 0, "heat capacity").value.expect("determined");
    assert!((capacity / 14_000.0 - 1.0).abs() < 0.15, "{capacity}");
}

/// Multiplying capacities, conductances, aperture and the heater's gain by one number changes nothing that is measured here, so
/// no fit can know them, published or not.
#[test]
#[ignore = "needs the data of measured buildings in INTERPLAY_THERMAL_DATA"]
fn without_a_unit_of_heat_parameters_of_dutch_homes_have_no_absolute_scale() {
    let file = "dutch3/blg_2.csv";
    let table = table(file);
    let mut mapping = Mapping::parse("dutch3.toml", DUTCH).expect("sound");
    mapping.identify.method = Estimator::PredictionError;
    let report = report(&mapping, file, &table);
    for name in ["heat capacity", "conductance to outdoor", "resistance to outdoor", "aperture to the sun"] {
        let quantity = quantity(&report, 0, name);
        assert_eq!((quantity.value, quantity.verdict.confidence), (None, Confidence::NotIdentifiable), "{name}");
    }
    // What has no scale agrees with the published model (1/25.746 kW/K; 6.057 + 19.936 kWh/K; heater 0.039618 kW).
    for (name, published) in [
        ("time constant through the walls", (6.057 + 19.936) * 25.746),
        ("warming by a steady heat signal", 0.039_618 * 25.746),
    ] {
        let (low, high) = quantity(&report, 0, name).interval;
        assert!(low.expect("bounded") < published && published < high.expect("bounded"), "{name}");
    }
}

#[test]
#[ignore = "needs the data of measured buildings in INTERPLAY_THERMAL_DATA"]
fn the_hospital_record_is_split_into_its_batches() {
    let table = table("riskbr/riskbr_data.csv");
    let mut mapping = Mapping::parse("riskbr.toml", RISKBR).expect("sound");
    mapping.identify.method = Estimator::PredictionError;
    let mut strict = mapping.clone();
    strict.time.gaps = Gaps::Refuse;
    let error =
        Telemetry::read("riskbr_data.csv", &table, &strict).expect_err("batch 22 holds two recordings").to_string();
    assert!(error.starts_with("riskbr_data.csv:6032:1: `28.10.21 06:52` is -506160 s after the row before"), "{error}");

    let report = report(&mapping, "riskbr_data.csv", &table);
    assert_eq!((report.rows, report.segments, report.zones.len(), report.walls.len()), (7026, 27, 3, 2));
    for zone in &report.zones {
        assert!(zone.train.one_step_with_residual_model_k.expect("a regression") < 0.14);
        let error = |wanted| zone.train.free_run.errors_k.iter().find(|(how, _)| *how == wanted).expect("listed").1;
        assert!(
            error(ResidualForecast::ProfileArma).expect("runs") < 0.85 * error(ResidualForecast::None).expect("runs")
        );
    }
    // The heat of room 2 does not show against that of its neighbours; doors stand open.
    let capacity = quantity(&report, 1, "heat capacity");
    assert_eq!((capacity.value, capacity.interval.1), (None, None), "{capacity:?}");
    assert!(report.warnings.iter().any(|warning| warning.contains("standard errors away")), "{:?}", report.warnings);
}

/// Minutes: three rooms with nine temperatures are one model.
#[test]
#[ignore = "needs the data of measured buildings in INTERPLAY_THERMAL_DATA"]
fn the_hospital_in_state_space_predicts_a_day_better_than_regressions_do() {
    let table = table("riskbr/riskbr_data.csv");
    let mapping = Mapping::parse("riskbr.toml", RISKBR).expect("sound");
    assert_eq!(mapping.identify.method, Estimator::StateSpace);
    let report = report(&mapping, "riskbr_data.csv", &table);
    let chosen = report.models.iter().find(|model| model.chosen).expect("one is chosen");
    assert_eq!(chosen.states, 3, "{}", chosen.model);
    for zone in &report.zones {
        // The mean of the data leaves 2.7 to 2.9 K, the regressions 0.9 to 1.1 K.
        let errors = &zone.train.free_run.errors_k;
        let alone = errors.iter().find(|(how, _)| *how == ResidualForecast::None).expect("listed").1;
        assert!(alone.is_some_and(|error_k| error_k < 0.75), "{}: {alone:?}", zone.name);
    }
}

#[test]
#[ignore = "needs the data of measured buildings in INTERPLAY_THERMAL_DATA"]
fn the_semiparametric_method_runs_on_every_measured_building() {
    for (text, file) in [(DUTCH, "dutch3/blg_1.csv"), (DUTCH, "dutch3/blg_3.csv"), (RISKBR, "riskbr/riskbr_data.csv")] {
        let table = table(file);
        let mut mapping = Mapping::parse("mapping.toml", text).expect("sound");
        mapping.identify.method = Estimator::Semiparametric;
        mapping.identify.train_days = Some(30.0);
        let report = report(&mapping, file, &table);
        assert!(!report.zones.is_empty(), "{file}");
        for zone in &report.zones {
            assert!(!zone.coefficients.is_empty());
            assert!(
                zone.test.as_ref().expect("more than 30 days").one_step_with_residual_model_k.expect("a regression")
                    < 0.5
            );
            assert!(zone.coefficients.iter().all(|quantity| quantity.value.is_none_or(|value| value >= 0.0)));
        }
    }
}

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
