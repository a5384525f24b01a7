//! What the data cannot tell, the report does not pretend to know.

use interplay_building::discretise::{self, Model};
use interplay_building::identify::synthetic_classroom::Classroom;
use interplay_building::identify::{
    Boundary, Confidence, Estimator, Hold, IdentificationReport, IdentifyError, IdentifySettings, MeasuredWall,
    MeasuredZone, Neighbour, Quantity, Telemetry, identify,
};
use interplay_building::network::Network;

fn settings(method: Estimator) -> IdentifySettings {
    IdentifySettings { method, ..IdentifySettings::default() }
}

fn quantity<'a>(report: &'a IdentificationReport, zone: usize, name: &str) -> &'a Quantity {
    let zone = &report.zones[zone];
    let mut all = zone.coefficients.iter().chain(&zone.physical);
    all.find(|quantity| quantity.name == name).unwrap_or_else(|| panic!("no quantity `{name}`"))
}

/// The four rooms of Table 2.1, exact over a step, heated by independent on-off switching, with slow and fast weather. All pairs
/// of rooms are candidates for a wall, also the two across, which have none.
fn testbed(days: usize, step_s: f64) -> Telemetry {
    let network = Network::testbed();
    let model = Model::exact(&network, step_s).expect("a sound network");
    let rows = days * (86_400.0 / step_s) as usize;
    let mut state = vec![25.0, 24.0, 26.0, 25.0];
    let mut temperatures = vec![Vec::new(); 4];
    let mut heats = vec![Vec::new(); 4];
    let mut outdoor = Vec::new();
    // A multiplicative congruential generator is chance enough here.
    let mut seed = 20_261_u64;
    let mut chance = move || {
        seed = seed * 48_271 % 2_147_483_647;
        seed as f64 / 2_147_483_647.0
    };
    for row in 0..rows {
        let hour = row as f64 * step_s / 3600.0;
        let ambient = 28.0 + 4.0 * (hour * std::f64::consts::TAU / 24.0).sin() + 2.0 * (hour * 0.61).sin();
        let heat: Vec<f64> = (0..4).map(|_| if chance() < 0.4 { -1.6 * chance() } else { 0.4 * chance() }).collect();
        for zone in 0..4 {
            // Sensors with a noise of some hundredths of a kelvin.
            temperatures[zone].push(state[zone] + 0.02 * (chance() - 0.5));
            heats[zone].push(heat[zone]);
        }
        outdoor.push(ambient);
        let gains: Vec<f64> = (0..4).map(|_| 0.02 * (chance() - 0.5)).collect();
        model.step(&mut state, &heat, ambient, &gains);
    }
    let zone = |(index, (temperature_c, power_kw))| MeasuredZone {
        name: format!("room {}", index + 1),
        temperature_c,
        power_kw,
        power_has_unit: true,
        power_hold: Hold::ZeroOrder,
        supply_air: Vec::new(),
        irradiance_kw_per_m2: None,
        irradiance_hold: Hold::FirstOrder,
    };
    let pairs =
        (0..4).flat_map(|one| (one + 1..4).map(move |other| MeasuredWall { zone: one, other: Neighbour::Zone(other) }));
    let outward = (0..4).map(|zone| MeasuredWall { zone, other: Neighbour::Boundary(0) });
    Telemetry {
        step_s,
        time_s: (0..rows).map(|row| row as f64 * step_s).collect(),
        segments: std::iter::once(0..rows).collect(),
        left_out_rows: 0,
        zones: temperatures.into_iter().zip(heats).enumerate().map(zone).collect(),
        boundaries: vec![Boundary { name: "outdoor".into(), temperature_c: outdoor, hold: Hold::ZeroOrder }],
        walls: pairs.chain(outward).collect(),
    }
}

/// A network that lives in continuous time: capacities need the exact discretisation, conductances do not care.
#[test]
fn regression_recovers_the_capacities_and_resistances_of_the_testbed() {
    let telemetry = testbed(20, 900.0);
    let report = identify(&telemetry, &settings(Estimator::PredictionError)).expect("rich data").report;
    let euler =
        IdentifySettings { discretisation: discretise::Discretisation::Euler, ..settings(Estimator::PredictionError) };
    let by_euler = identify(&telemetry, &euler).expect("rich data").report;
    for zone in 0..4 {
        let value = |report: &IdentificationReport, name| quantity(report, zone, name).value.expect("identified");
        assert!((value(&report, "heat capacity") / 1000.0 - 1.0).abs() < 0.01);
        // The part of a difference that decays in 15 minutes is 5.6 %, and forward Euler errs by half of it.
        assert!((value(&by_euler, "heat capacity") / 1000.0 - 1.029).abs() < 0.01);
        assert!((value(&report, "resistance to outdoor") / 31.25 - 1.0).abs() < 0.1);
        assert!((value(&report, "time constant through the walls") / 4.34 - 1.0).abs() < 0.1);
    }
    for (zone, neighbour) in [(0, "room 2"), (1, "room 1"), (2, "room 4"), (3, "room 3")] {
        let wall = quantity(&report, zone, &format!("conductance to {neighbour}"));
        let (conductance, error) = (wall.value.expect("identified"), wall.standard_error.expect("identified"));
        assert!((conductance - 0.016).abs() < 3.0 * error && error < 0.002, "{neighbour}: {conductance} ± {error}");
    }
}

#[test]
fn a_missing_wall_has_a_conductance_of_about_zero_and_no_resistance() {
    let report = identify(&testbed(20, 900.0), &settings(Estimator::PredictionError)).expect("rich data").report;
    let rate = quantity(&report, 0, "rate towards room 4");
    assert_eq!(rate.verdict.confidence, Confidence::NotDistinguishableFromZero, "{rate:?}");
    let resistance = quantity(&report, 0, "resistance to room 4");
    assert_eq!((resistance.value, resistance.interval.1), (None, None), "{resistance:?}");
    // What is known is that it insulates better than the walls that are there.
    assert!(resistance.interval.0.expect("a lower bound") > 62.5);
    assert!(
        report.warnings.iter().any(|warning| warning.contains("rate towards room 4 cannot be told apart from zero"))
    );
}

#[test]
fn heat_that_never_changes_identifies_no_capacity() {
    for method in [Estimator::Semiparametric, Estimator::PredictionError] {
        let mut telemetry = Classroom { days: 9, ..Classroom::default() }.simulate();
        telemetry.zones[0].power_kw.fill(0.5);
        let report = identify(&telemetry, &settings(method)).expect("no error: the report says so").report;
        for name in ["effect of heat", "heat capacity", "conductance to outdoor", "resistance to outdoor"] {
            let quantity = quantity(&report, 0, name);
            assert_eq!(quantity.value, None, "{method:?}: {quantity:?}");
            assert_eq!(quantity.verdict.confidence, Confidence::NotIdentifiable, "{method:?}: {quantity:?}");
        }
    }
}

#[test]
fn identical_neighbours_are_not_identifiable_but_other_walls_are() {
    for method in [Estimator::Semiparametric, Estimator::PredictionError] {
        let mut telemetry = Classroom { days: 9, ..Classroom::default() }.simulate();
        telemetry.boundaries[2].temperature_c = telemetry.boundaries[1].temperature_c.clone();
        let report = identify(&telemetry, &settings(method)).expect("no error: the report says so").report;
        for name in ["rate towards room-b", "rate towards room-c"] {
            let quantity = quantity(&report, 0, name);
            assert_eq!(
                (quantity.value, quantity.verdict.confidence),
                (None, Confidence::NotIdentifiable),
                "{method:?}"
            );
        }
        let heat = quantity(&report, 0, "effect of heat");
        assert_eq!(heat.verdict.confidence, Confidence::Identified, "{method:?}: {heat:?}");
    }
}

#[test]
fn without_a_unit_of_heat_only_scale_free_quantities_are_identified() {
    let mut telemetry = Classroom { days: 9, ..Classroom::default() }.simulate();
    let with_unit = identify(&telemetry, &settings(Estimator::PredictionError)).expect("identifiable").report;
    telemetry.zones[0].power_has_unit = false;
    telemetry.zones[0].power_kw.iter_mut().for_each(|power| *power *= 40.0);
    let without = identify(&telemetry, &settings(Estimator::PredictionError)).expect("identifiable").report;
    for name in ["heat capacity", "conductance to outdoor", "resistance to outdoor"] {
        assert!(quantity(&with_unit, 0, name).value.is_some());
        let quantity = quantity(&without, 0, name);
        assert_eq!((quantity.value, quantity.verdict.confidence), (None, Confidence::NotIdentifiable));
        assert!(quantity.verdict.words.contains("no unit"), "{}", quantity.verdict.words);
    }
    let tau = |report| quantity(report, 0, "time constant through the walls").value.expect("needs no unit");
    assert!((tau(&without) / tau(&with_unit) - 1.0).abs() < 1e-6);
}

#[test]
fn too_few_rows_or_missing_causes_are_reported_with_a_remedy() {
    let mut telemetry = Classroom { days: 1, ..Classroom::default() }.simulate();
    telemetry.segments = std::iter::once(0..20).collect();
    let error = identify(&telemetry, &settings(Estimator::PredictionError)).expect_err("20 rows are too few");
    assert!(matches!(error, IdentifyError::TooFewRows { rows: 17, parameters: 14, wanted: 42 }), "{error:?}");
    let mut telemetry = Classroom { days: 1, ..Classroom::default() }.simulate();
    telemetry.walls.clear();
    telemetry.zones[0].power_kw.fill(0.0);
    let error = identify(&telemetry, &settings(Estimator::PredictionError)).expect_err("nothing acts on the zone");
    assert!(matches!(&error, IdentifyError::NothingToIdentify { zone } if zone == "classroom"), "{error:?}");
    let settings = IdentifySettings { autoregressive_order: 0, ..settings(Estimator::PredictionError) };
    let error = identify(&telemetry, &settings).expect_err("no such order").to_string();
    assert_eq!(error, "setting `autoregressive_order` is 0; it must be at least 1");
}
