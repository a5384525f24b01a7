//! Tables are read as the mapping says, and what cannot be read is located: file, line, column, what was wrong, what would work.

use interplay_building::identify::synthetic_classroom::Classroom;
use interplay_building::identify::{Mapping, Neighbour, Telemetry, TelemetryError};

const MAPPING: &str = r#"
walls = [["living", "outdoor"]]

[table]
separator = ";"

[time]
column = "t"
step_s = 900.0

[[boundary]]
name = "outdoor"
temperature = "Ta"

[[zone]]
name = "living"
temperature = "Ti"
heat = [{ kind = "power", column = "P", unit = "w" }]
solar = { column = "sun", unit = "w-per-m2" }
"#;

const TABLE: &str = "\
t;Ta;Ti;P;sun
2026-01-31 23:30:00;-1.5;20.0;1500;0
2026-01-31 23:45:00;-1.6;20.1;0;0
2026-02-01 00:00:00;-1.7;20.2;750;10
2026-02-01 00:15:00;-1.7;20.3;0;20
";

fn mapping() -> Mapping {
    Mapping::parse("home.toml", MAPPING).expect("the mapping is sound")
}

fn read(table: &str) -> Result<Telemetry, TelemetryError> {
    Telemetry::read("home.csv", table, &mapping())
}

/// The message of a table with one text replaced.
fn message(from: &str, to: &str) -> String {
    assert!(TABLE.contains(from), "`{from}` is not in the table");
    read(&TABLE.replacen(from, to, 1)).expect_err("the table is broken").to_string()
}

#[test]
fn columns_are_converted_to_the_units_of_the_crate() {
    let telemetry = read(TABLE).expect("the table is sound");
    assert_eq!(telemetry.step_s, 900.0);
    assert_eq!((telemetry.segments.len(), telemetry.segments[0].clone()), (1, 0..4));
    // From the midnight before the first row.
    assert_eq!(telemetry.time_s, [84_600.0, 85_500.0, 86_400.0, 87_300.0]);
    assert_eq!(telemetry.boundaries[0].temperature_c, [-1.5, -1.6, -1.7, -1.7]);
    let zone = &telemetry.zones[0];
    assert_eq!((zone.power_kw.as_slice(), zone.power_has_unit), ([1.5, 0.0, 0.75, 0.0].as_slice(), true));
    assert_eq!(zone.irradiance_kw_per_m2.as_deref(), Some([0.0, 0.0, 0.01, 0.02].as_slice()));
    assert_eq!(telemetry.neighbours(0), [Neighbour::Boundary(0)]);
}

#[test]
fn other_separators_units_and_time_formats_give_the_same_telemetry() {
    let text = MAPPING
        .replace(
            "separator = \";\"",
            "separator = \"\\t\"\ndecimal = \",\"\ntemperature_unit = \"fahrenheit\"\nmissing = [\"--\"]",
        )
        .replace("step_s = 900.0", "step_s = 900.0\nformat = \"%d.%m.%y %H:%M\"\ngaps = \"split\"");
    let mapping = Mapping::parse("home.toml", &text).expect("sound");
    let table = "t\tTa\tTi\tP\tsun\r\n31.01.26 23:30\t32,0\t68,0\t1500\t0\r\n31.01.26 23:45\t50,0\t68,9\t--\t0\r\n01.02.26 00:00\t50,0\t\"68,9\"\t0\t0\r\n";
    let telemetry = Telemetry::read("home.tsv", table, &mapping).expect("sound");
    assert_eq!(telemetry.boundaries[0].temperature_c, [0.0, 10.0]);
    assert!((telemetry.zones[0].temperature_c[1] - 20.5).abs() < 1e-12);
    assert_eq!((telemetry.left_out_rows, telemetry.segments.clone()), (1, vec![0..1, 1..2]));
}

#[test]
fn heat_flows_of_water_and_air_are_computed_from_flow_and_temperatures() {
    let text = MAPPING.replace(
        r#"{ kind = "power", column = "P", unit = "w" }"#,
        r#"{ kind = "water", flow = "P", flow_unit = "l-per-min", inlet = "Ta", outlet = "sun" },
           { kind = "supply-air", flow = "P", flow_unit = "kw-per-k", temperature = "Ta" }"#,
    );
    let mapping = Mapping::parse("home.toml", &text).expect("sound");
    let telemetry = Telemetry::read("home.csv", TABLE, &mapping).expect("sound");
    let zone = &telemetry.zones[0];
    // 1500 l/min from −1.5 to 0 °C, and 1500 kW/K of air at −1.5 °C into a zone at 21 °C.
    let (water, air) = (1500.0 / 60.0 * 4.18 * -1.5, 1500.0 * (-1.5 - 21.0));
    assert!((zone.heat_kw(0, 21.0) - (water + air)).abs() < 1e-9);
}

#[test]
fn telemetry_written_as_a_table_is_read_back_bit_for_bit() {
    let mut telemetry = Classroom { days: 1, ..Classroom::default() }.simulate();
    telemetry.segments = vec![0..40, 40..97];
    let mapping = toml::to_string(&telemetry.mapping()).expect("a mapping is TOML");
    let mapping = Mapping::parse("classroom.toml", &mapping).expect("as written");
    assert_eq!(Telemetry::read("classroom.csv", &telemetry.to_csv(), &mapping).expect("as written"), telemetry);
}

#[test]
fn zone_names_with_any_characters_are_read_back() {
    for name in ["a, b", "the \"blue\" room", " lobby ", "line\nbreak", "1.5", "Küche; Bad"] {
        let mut telemetry = Classroom { days: 1, ..Classroom::default() }.simulate();
        telemetry.zones[0].name = name.to_owned();
        telemetry.boundaries[1].name = format!("beside {name}");
        let table = telemetry.to_csv();
        let read = Telemetry::read("classroom.csv", &table, &telemetry.mapping());
        assert_eq!(read.as_ref(), Ok(&telemetry), "{name:?} in {:?}", table.lines().next());
    }
}

#[test]
fn an_empty_table_is_reported_by_name() {
    for empty in ["", "\n", "t;Ta;Ti;P;sun\n"] {
        let message = read(empty).expect_err("nothing to read").to_string();
        assert_eq!(message, "home.csv: the table is empty; it needs a header and at least two rows");
    }
}

#[test]
fn a_text_in_a_number_column_is_located() {
    assert_eq!(
        message("20.2", "warm"),
        "home.csv:4:26: `warm` in column `Ti` is not a number; write a number like 21.5 (`table.decimal` sets the decimal \
         sign), or list the text in `table.missing`"
    );
    // Whatever ends the lines, and after empty ones.
    let carriage_returns = TABLE.replace("20.2", "warm").replace('\n', "\r\n").replacen("2026", "\r\n2026", 1);
    let place = read(&carriage_returns).expect_err("the table is broken").place;
    assert_eq!(place, Some((5, 26)));
    // Rust parses these as numbers, but no building has such values.
    assert!(message("20.2", "NaN").starts_with("home.csv:4:26: `NaN` in column `Ti` is not a number"));
    assert!(message("20.2", "20,2").starts_with("home.csv:4:26: `20,2` in column `Ti` is not a number"));
}

#[test]
fn a_gap_in_time_is_located_and_may_be_split() {
    let expected = "home.csv:4:1: `2026-02-01 02:00:00` is 8100 s after the row before, and the sampling time is 900 s: there is \
                    a gap, or the sampling time is another; add the missing rows, correct `time.step_s`, or set `time.gaps = \
                    \"split\"` to start anew after each gap";
    assert_eq!(message("2026-02-01 00:00:00", "2026-02-01 02:00:00"), expected);
    assert!(message("2026-02-01 00:00:00", "2026-01-31 23:45:00").contains("one time stands twice"));
    assert!(message("2026-02-01 00:00:00", "2026-01-30 00:00:00").contains("time goes backwards"));

    let split = Mapping::parse("home.toml", &MAPPING.replace("step_s = 900.0", "step_s = 900.0\ngaps = \"split\""));
    let table = TABLE.replace("2026-02-01 00:15:00", "2026-02-01 03:15:00");
    let telemetry = Telemetry::read("home.csv", &table, &split.expect("sound")).expect("split");
    assert_eq!(telemetry.segments, [0..3, 3..4]);
}

#[test]
fn a_batch_ends_where_its_column_changes_even_without_a_gap() {
    let text = MAPPING.replace("step_s = 900.0", "step_s = 900.0\nbatch = \"sun\"");
    let mapping = Mapping::parse("home.toml", &text).expect("sound");
    let table = TABLE.replace("2026-02-01 00:15:00", "2026-07-01 00:15:00");
    let telemetry = Telemetry::read("home.csv", &table, &mapping).expect("batches may lie apart");
    assert_eq!(telemetry.segments, [0..2, 2..3, 3..4]);
}

#[test]
fn faults_of_values_rows_times_and_columns_are_located() {
    assert!(
        message("750", "").starts_with("home.csv:4:31: column `P` has no value here (``); fill the value in, or set")
    );
    assert!(
        message("-1.7;20.2;750;10", "-1.7;20.2;750")
            .starts_with("home.csv:4:1: the row cannot be read: it has 4 fields")
    );
    let time = message("2026-02-01 00:00:00", "yesterday");
    assert!(
        time.starts_with("home.csv:4:1: `yesterday` in column `t` is not a time of the form `%Y-%m-%d %H:%M:%S`"),
        "{time}"
    );
    let column = message("Ta;Ti", "Ta;Tx");
    assert!(
        column.contains("home.csv:1:1: column `Ti`, wanted as temperature of zone living, is not in the header"),
        "{column}"
    );
    assert!(column.contains("`t`, `Ta`, `Tx`, `P`, `sun`"), "{column}");
    assert!(message("P;sun", "P;Ti").contains("in the header twice"));
    let range = message("20.2", "293.35");
    assert!(
        range.starts_with("home.csv:4:26: 293.35 °C in column `Ti` is outside -60 to 90 °C; check the unit"),
        "{range}"
    );
}

#[test]
fn wrong_mappings_are_located_and_explained() {
    let table: toml::Table = include_str!("data/refused_mappings.toml").parse().expect("a table of mappings");
    for case in table["refusals"].as_array().expect("a list") {
        let texts: Vec<&str> = case.as_array().expect("a list").iter().filter_map(|text| text.as_str()).collect();
        let [from, to, pieces @ ..] = texts.as_slice() else { panic!("{texts:?}") };
        assert!(MAPPING.contains(from), "`{from}` is not in the mapping");
        let error = Mapping::parse("home.toml", &MAPPING.replacen(from, to, 1)).expect_err(to).to_string();
        assert!(pieces.iter().all(|piece| error.contains(piece)), "{pieces:?} in {error}");
    }
    let zones = MAPPING.find("[[zone]]").expect("a zone");
    let none = format!("zone = []\n{}", &MAPPING[..zones]);
    let none = Mapping::parse("home.toml", &none).expect_err("no zone").to_string();
    assert!(none.starts_with("home.toml:1:8: `zone` must be a list of at least 1 entry, not of 0; "), "{none}");
}

/// The check before reading and the reader itself accept the same documents.
#[test]
fn every_mapping_that_passes_the_check_is_read_without_error() {
    let values =
        ["3", "-3", "0.5", "1e300", "true", "\"a\"", "\";\"", "[]", "[[]]", "{}", "1979-05-27", "{ kind = \"water\" }"];
    let places = [
        "\";\"",
        "\"t\"",
        "900.0",
        "\"Ta\"",
        "\"living\"",
        "[[\"living\", \"outdoor\"]]",
        "\"power\"",
        "\"w\"",
        "\"sun\"",
    ];
    let mut refused = 0;
    for (place, value) in places.iter().flat_map(|place| values.map(|value| (place, value))) {
        let text = MAPPING.replacen(place, value, 1);
        if let Err(error) = Mapping::parse("home.toml", &text) {
            assert!(!error.problem.starts_with("not valid TOML"), "{value} for {place}: {error}");
            assert!(error.place.is_some(), "{value} for {place}: {error}");
            refused += 1;
        }
    }
    assert_eq!((refused, places.len() * values.len()), (97, 108), "refused, and tried");
}

#[test]
fn the_example_mappings_are_valid() {
    for (file, text) in [
        ("dutch3.toml", include_str!("../experiments/dutch3.toml")),
        ("riskbr.toml", include_str!("../experiments/riskbr.toml")),
    ] {
        Mapping::parse(file, text).expect("an example is sound");
    }
    assert_eq!(read("").expect_err("empty").problem, "the table is empty");
}

/// Every key of an object in a schema, and of those below it.
fn keys(schema: &serde_json::Value, found: &mut Vec<String>) {
    match schema {
        serde_json::Value::Object(fields) => {
            if let Some(serde_json::Value::Object(properties)) = fields.get("properties") {
                found.extend(properties.keys().cloned());
            }
            fields.values().for_each(|value| keys(value, found));
        }
        serde_json::Value::Array(items) => items.iter().for_each(|item| keys(item, found)),
        _ => {}
    }
}

#[test]
fn the_documentation_shows_a_valid_mapping_and_every_key() {
    let page = include_str!("../../docs/guide/identification.md");
    let example = page.split("```toml mapping\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a mapping");
    Mapping::parse("docs/guide/identification.md", example).expect("sound");
    let mut found = Vec::new();
    keys(schemars::schema_for!(Mapping).as_value(), &mut found);
    assert!(found.len() > 20);
    let missing: Vec<_> = found.iter().filter(|key| !page.contains(key.as_str())).collect();
    assert!(missing.is_empty(), "{missing:?}");
}
