//! The method `state-space` recovers hidden walls, copes with gaps, and refuses what the data do not say.

mod common;

use common::house::{House, WALL_HOUSE};
use interplay_building::discretise::Model;
use interplay_building::identify::{
    Confidence, Gaps, IdentificationReport, IdentifyError, IdentifySettings, Mapping, Quantity, Telemetry,
    expected_processor_s, identify,
};
use interplay_building::network::{AMBIENT, Network};

fn quantity<'a>(report: &'a IdentificationReport, name: &str) -> &'a Quantity {
    let mut all = report.zones[0].physical.iter();
    all.find(|quantity| quantity.name == name).unwrap_or_else(|| panic!("no quantity `{name}`"))
}

fn assert_covers(report: &IdentificationReport, name: &str, truth: f64) {
    let found = quantity(report, name);
    let (low, high) = (found.interval.0.expect("bounded"), found.interval.1.expect("bounded"));
    assert!(low <= truth && truth <= high, "{name}: {truth} not in {low} to {high}");
    assert_eq!(found.verdict.confidence, Confidence::Identified, "{name}: {}", found.verdict.words);
}

/// The network is simulated by the crate's own exact discretisation, which shares no code with the filter.
#[test]
fn a_hidden_wall_state_is_identified_where_one_state_errs_threefold() {
    let house = WALL_HOUSE;
    let telemetry = house.simulate(900.0, 14, 1);
    let report = identify(&telemetry, &IdentifySettings::default()).expect("rich data").report;
    let chosen = report.models.iter().find(|model| model.chosen).expect("one is chosen");
    assert_eq!(chosen.model, "air, wall to outdoor", "{:?}", report.models);
    assert_covers(&report, "heat capacity", house.air_kj_per_k + house.wall_kj_per_k);
    assert_covers(&report, "heat capacity of the wall to outdoor", house.wall_kj_per_k);
    assert_covers(&report, "conductance to outdoor", house.conductance_kw_per_k);
    assert_covers(&report, "resistance to outdoor", 1.0 / house.conductance_kw_per_k);
    let free = &report.zones[0].train.free_run;
    assert!(free.errors_k[0].1.expect("runs") < 0.3 * free.mean_of_data_k.expect("runs"));

    let one_state = IdentifySettings { most_states: 1, ..IdentifySettings::default() };
    let alone = identify(&telemetry, &one_state).expect("rich data").report;
    let physical = &alone.zones[0].physical;
    assert!(physical.iter().all(|quantity| quantity.verdict.confidence != Confidence::Identified), "{physical:?}");
}

#[test]
fn gaps_and_missing_temperatures_are_bridged() {
    let house = WALL_HOUSE;
    let mut telemetry = house.simulate(900.0, 14, 2);
    for row in 0..telemetry.rows() {
        // Every ninth value, and six hours a day.
        if row % 9 == 4 || (row / 24) % 4 == 3 {
            telemetry.zones[0].temperature_c[row] = f64::NAN;
        }
    }
    let mapping = telemetry.mapping();
    assert_eq!(mapping.time.gaps, Gaps::Bridge);
    let again = Telemetry::read("house.csv", &telemetry.to_csv(), &mapping).expect("its own table");
    assert_eq!(again.rows(), telemetry.rows());
    let report = identify(&again, &mapping.identify).expect("rich data").report;
    assert_covers(&report, "conductance to outdoor", house.conductance_kw_per_k);
    assert_covers(&report, "heat capacity", house.air_kj_per_k + house.wall_kj_per_k);
    let mut regression = mapping.identify.clone();
    regression.method = interplay_building::identify::Estimator::PredictionError;
    let error = identify(&again, &regression).expect_err("a regression needs every value");
    assert!(matches!(error, IdentifyError::MissingTemperature { .. }), "{error}");
}

/// Without any change of heat or weather nothing can be said of a capacity.
#[test]
fn no_parameter_is_identified_from_data_without_information() {
    let mut house = WALL_HOUSE;
    house.is_steady = true;
    let report = identify(&house.simulate(900.0, 14, 3), &IdentifySettings::default()).expect("enough rows").report;
    for name in ["heat capacity", "time constant through the walls"] {
        let found = quantity(&report, name);
        assert_ne!(found.verdict.confidence, Confidence::Identified, "{found:?}");
    }
}

#[test]
fn without_a_unit_of_heat_only_scale_free_quantities_are_identified() {
    let house = WALL_HOUSE;
    let mut telemetry = house.simulate(900.0, 14, 4);
    let with_unit = identify(&telemetry, &IdentifySettings::default()).expect("rich data");
    telemetry.zones[0].power_has_unit = false;
    telemetry.zones[0].power_kw.iter_mut().for_each(|power| *power *= 40.0);
    let without = identify(&telemetry, &IdentifySettings::default()).expect("rich data");
    for name in ["heat capacity", "conductance to outdoor", "resistance to outdoor"] {
        let found = quantity(&without.report, name);
        assert_eq!((found.value, found.verdict.confidence), (None, Confidence::NotIdentifiable));
    }
    let tau = |report| quantity(report, "time constant through the walls").value.expect("needs no unit");
    assert!((tau(&without.report) / tau(&with_unit.report) - 1.0).abs() < 1e-2);
    assert!(without.network.expect_err("no scale").contains("unit"));
}

/// The network that is found, simulated by the crate, warms as the house does.
#[test]
fn an_identified_network_is_exported_as_zones_and_walls() {
    let house = WALL_HOUSE;
    let found = identify(&house.simulate(900.0, 14, 5), &IdentifySettings::default()).expect("rich data");
    let exported = found.network.expect("everything is determined");
    assert_eq!(exported.walls[0].between, ["house".to_owned(), AMBIENT.to_owned()]);
    let network = Network::new(&exported.zones, &exported.walls).expect("sound");
    assert_eq!(network.node_count(), 2);
    let model = Model::exact(&network, 900.0).expect("sound");
    let mut state = vec![15.0; 2];
    for _ in 0..5000 {
        model.step(&mut state, &[1.0], 10.0, &[0.0]);
    }
    let steady = 10.0 + 1.0 / house.conductance_kw_per_k;
    assert!((state[0] - steady).abs() < 0.03 * (steady - 10.0), "{state:?}, in truth {steady}");
    let (low, high) = exported.uncertainty.capacity;
    assert!(low < 1.0 && 1.0 < high && high < 1.25, "{:?}", exported.uncertainty);
}

#[test]
fn too_few_rows_are_an_error() {
    let house: House = WALL_HOUSE;
    let mut telemetry = house.simulate(900.0, 1, 6);
    telemetry.segments = std::iter::once(0..20).collect();
    let error = identify(&telemetry, &IdentifySettings::default()).expect_err("20 rows are too few");
    assert!(matches!(error, IdentifyError::TooFewRows { .. }), "{error}");
}

#[test]
fn an_identification_beyond_its_time_limit_is_refused_beforehand() {
    let house: House = WALL_HOUSE;
    let telemetry = house.simulate(900.0, 4, 6);
    let settings = IdentifySettings { processor_s: 0.5, ..IdentifySettings::default() };
    let expected_s = expected_processor_s(&telemetry, &settings);
    assert!((0.5..5.0).contains(&expected_s), "{expected_s}");
    let error = identify(&telemetry, &settings).expect_err("half a second is little");
    assert!(matches!(error, IdentifyError::TooMuchWork { .. }), "{error}");
    let fewer = IdentifySettings { most_states: 1, ..settings };
    assert!(expected_processor_s(&telemetry, &fewer) < 0.5 * expected_s);
}

const MEASURED: &str = "\
time,north,south,out,heat
2024-03-30 22:00+01:00,20.0,21.0,5.0,1000
2024-03-30 23:00+01:00,20.2,21.2,4.0,0
2024-03-31 00:00+01:00,20.4,,3.0,500
2024-03-31 01:00+01:00,20.6,21.6,2.0,500
2024-03-31 03:00+02:00,20.8,21.8,1.0,500
";

/// Means of columns, factors, and times with offsets; the clock was put forward between the last two rows.
#[test]
fn columns_are_averaged_and_scaled_and_utc_offsets_are_read() {
    let text = "walls = [['house', 'outdoor']]\n\
        [time]\ncolumn = 'time'\nformat = '%Y-%m-%d %H:%M%z'\nstep_s = 3600.0\ngaps = 'bridge'\n\
        [[column]]\nname = 'inside'\nmean_of = ['north', 'south']\n\
        [[column]]\nname = 'shaded'\nmean_of = ['heat']\nfactor = 0.5\n\
        [[boundary]]\nname = 'outdoor'\ntemperature = 'out'\nhold = 'zero-order'\n\
        [[zone]]\nname = 'house'\ntemperature = 'inside'\n\
        heat = [{ kind = 'power', column = 'heat', unit = 'w' }]\nheat_hold = 'first-order'\n\
        solar = { column = 'shaded', unit = 'w-per-m2', factor = 0.1 }\n";
    let mapping = Mapping::parse("house.toml", text).expect("sound");
    let telemetry = Telemetry::read("house.csv", MEASURED, &mapping).expect("it fits");
    assert_eq!(
        (telemetry.segments.len(), telemetry.segments[0].clone()),
        (1, 0..5),
        "one recording: the clock changed, not the time"
    );
    assert_eq!(telemetry.time_s[0], 22.0 * 3600.0, "since midnight at the place");
    let temperature = &telemetry.zones[0].temperature_c;
    assert!((temperature[1] - 20.7).abs() < 1e-12 && temperature[2].is_nan(), "{temperature:?}");
    assert!((telemetry.zones[0].irradiance_kw_per_m2.as_ref().expect("mapped")[0] - 0.05).abs() < 1e-12);
    let refused = |from: &str, to: &str| {
        let read = Mapping::parse("house.toml", &text.replace(from, to))
            .and_then(|mapping| Telemetry::read("house.csv", MEASURED, &mapping));
        read.expect_err("refused").to_string()
    };
    assert!(refused("['north', 'south']", "['north', 'west']").contains("`west`"));
    assert!(refused("['north', 'south']", "[]").contains("column"));
    assert!(refused("name = 'inside'", "name = 'north'").contains("north"));
    let strict = refused("gaps = 'bridge'", "gaps = 'refuse'");
    assert!(strict.starts_with("house.csv:4:"), "{strict}");
}
