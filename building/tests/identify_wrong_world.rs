//! Data that contradict what every model takes for granted are not trusted: a clock that is off, windows, people, gaps.

mod common;

use common::house::WALL_HOUSE;
use interplay_building::identify::{
    Confidence, Gaps, IdentificationReport, IdentifySettings, Mapping, Quantity, SuspectedCause, Telemetry, identify,
};

fn quantity<'a>(report: &'a IdentificationReport, name: &str) -> &'a Quantity {
    let mut all = report.zones[0].physical.iter();
    all.find(|quantity| quantity.name == name).unwrap_or_else(|| panic!("no quantity `{name}`"))
}

fn report(telemetry: &Telemetry) -> IdentificationReport {
    identify(telemetry, &IdentifySettings::default()).expect("rich data").report
}

fn causes(report: &IdentificationReport) -> Vec<SuspectedCause> {
    report.suspicions.iter().map(|it| it.cause).collect()
}

/// The house with its weather, and a sunny one with the weather of an hour before.
#[test]
fn a_clock_error_of_an_hour_prevents_identification() {
    let telemetry = WALL_HOUSE.simulate(900.0, 14, 21);
    let right = report(&telemetry);
    assert!(right.suspicions.is_empty(), "{:?}", right.suspicions);
    assert_eq!(quantity(&right, "conductance to outdoor").verdict.confidence, Confidence::Identified);
    let sun: Vec<f64> = (0..telemetry.rows())
        .map(|row| {
            let hour = (row as f64 / 4.0) % 24.0;
            if (7.0..17.0).contains(&hour) { 0.4 * ((hour - 7.0) / 10.0 * std::f64::consts::PI).sin() } else { 0.0 }
        })
        .collect();
    // The sun's heat is known to the house as if it had been heated by it: 2 m².
    let mut sunny = WALL_HOUSE.simulate(900.0, 14, 22);
    sunny.zones[0].power_kw.iter_mut().zip(&sun).for_each(|(power, sun)| *power -= 2.0 * sun);
    let late: Vec<f64> = (0..sun.len()).map(|row| sun[row.saturating_sub(4)]).collect();
    sunny.zones[0].irradiance_kw_per_m2 = Some(late);
    let outdoor = telemetry.boundaries[0].temperature_c.clone();
    let late_c = |row: usize| outdoor[row.saturating_sub(4)];
    sunny.boundaries[0].temperature_c = (0..outdoor.len()).map(late_c).collect();
    let wrong = report(&sunny);
    // Where the fit has given up the sun, the clock test cannot name the clock; what is named is the heat that the model lacks.
    assert!(!wrong.suspicions.is_empty());
    assert!(wrong.zones[0].physical.iter().all(|it| it.verdict.confidence != Confidence::Identified));
    assert!(wrong.warnings[0].contains(&wrong.suspicions[0].words), "{:?}", wrong.warnings);
}

#[test]
fn unmeasured_heat_at_the_same_hours_is_attributed_to_people() {
    let mut telemetry = WALL_HOUSE.simulate(900.0, 14, 23);
    for row in 0..telemetry.rows() {
        let hour = (row as f64 / 4.0) % 24.0;
        // The heat acted on the house; it is taken out of the column.
        telemetry.zones[0].power_kw[row] -= if (17.0..23.0).contains(&hour) { 0.3 } else { 0.0 };
    }
    let found = report(&telemetry);
    assert!(causes(&found).contains(&SuspectedCause::People), "{:?}", found.suspicions);
    assert_ne!(quantity(&found, "heat capacity").verdict.confidence, Confidence::Identified);
}

/// A record without a few of its rows says the same as with them.
#[test]
fn a_missing_row_loses_only_the_information_of_that_row() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/telemetry/cabin");
    let read = |ending: &str| std::fs::read_to_string(format!("{path}{ending}")).expect("part of the repository");
    let mut mapping = Mapping::parse("cabin.toml", &read(".toml")).expect("sound");
    mapping.time.gaps = Gaps::Split;
    let table = read(".csv");
    let whole = report(&Telemetry::read("cabin.csv", &table, &mapping).expect("sound"));
    for missing in [1, 501, 900] {
        let kept = table.lines().enumerate().filter(|(line, _)| *line != missing).map(|(_, text)| text);
        let less: String = kept.flat_map(|text| [text, "\n"]).collect();
        let less = report(&Telemetry::read("cabin.csv", &less, &mapping).expect("sound"));
        for name in ["heat capacity", "conductance to outdoor", "time constant through the walls"] {
            let (one, other) = (quantity(&whole, name), quantity(&less, name));
            let distance = (one.value.expect("known") - other.value.expect("known")).abs();
            assert!(distance < 0.2 * one.standard_error.expect("known"), "{missing}, {name}: {one:?} {other:?}");
            assert_eq!(one.verdict.confidence, other.verdict.confidence, "{missing}, {name}");
        }
    }
}

/// Two weeks of a house cannot show a time constant of months.
#[test]
fn a_time_constant_beyond_the_record_is_not_identified() {
    let mut house = WALL_HOUSE;
    house.conductance_kw_per_k = 0.004;
    house.wall_kj_per_k = 20_000.0;
    let found = report(&house.simulate(900.0, 14, 24));
    for name in ["heat capacity", "time constant through the walls"] {
        let found = quantity(&found, name);
        assert_ne!(found.verdict.confidence, Confidence::Identified, "{found:?}");
    }
}

/// Six weeks of minutes are fitted in longer steps, and say what the house is.
#[test]
fn a_long_record_is_fitted_in_longer_steps_without_loss() {
    let telemetry = WALL_HOUSE.simulate(60.0, 42, 25);
    let settings = IdentifySettings {
        most_states: 2,
        hidden: vec![interplay_building::identify::HiddenTemperature::Wall],
        ..IdentifySettings::default()
    };
    let found = identify(&telemetry, &settings).expect("rich data").report;
    assert_eq!(found.rows, 42 * 1440);
    assert!(found.warnings[0].contains("in steps of"), "{:?}", found.warnings);
    for (name, truth) in [
        ("heat capacity", WALL_HOUSE.air_kj_per_k + WALL_HOUSE.wall_kj_per_k),
        ("conductance to outdoor", WALL_HOUSE.conductance_kw_per_k),
    ] {
        let value = quantity(&found, name).value.expect("known");
        assert!((value / truth - 1.0).abs() < 0.02, "{name}: {value} for {truth}");
    }
}
