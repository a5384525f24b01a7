//! Tables of loggers and meters: lines before the header, clocks that are put forward and back, and counts of energy.

use interplay_building::identify::{Mapping, Telemetry, TelemetryError};

const MAPPING: &str = r#"
walls = [["home", "outdoor"]]
table = { separator = ";", skip_rows = 2 }
boundary = [{ name = "outdoor", temperature = "out" }]

[time]
column = "t"
format = "%d.%m.%Y %H:%M"
zone = "Europe/Zurich"
step_s = 3600.0

[[zone]]
name = "home"
temperature = "in"
heat = [{ kind = "meter", column = "E", unit = "kwh" }]
"#;

/// Eight hours with the end of summer time in them, and a meter that counts 1, 2, 3, … kWh an hour.
const TABLE: &str = "Logger 17;;;\nBasel, living room\nt;in;out;E\n\
    24.10.2026 23:00;20;5;100\n25.10.2026 00:00;20;5;101\n25.10.2026 01:00;20;5;103\n25.10.2026 02:00;20;5;106\n\
    25.10.2026 02:00;20;5;110\n25.10.2026 03:00;20;5;115\n25.10.2026 04:00;20;5;121\n25.10.2026 05:00;20;5;128\n";

fn read(mapping: &str, table: &str) -> Result<Telemetry, TelemetryError> {
    Telemetry::read("home.csv", table, &Mapping::parse("home.toml", mapping).expect("a mapping"))
}

#[test]
fn the_repeated_hour_of_a_clock_change_is_not_a_gap() {
    let telemetry = read(MAPPING, TABLE).expect("regular in time");
    assert_eq!(telemetry.segments, std::slice::from_ref(&(0..8)));
    let hours: Vec<f64> = telemetry.time_s.iter().map(|time_s| time_s / 3600.0).collect();
    assert_eq!(hours, [23.0, 24.0, 25.0, 26.0, 27.0, 28.0, 29.0, 30.0]);
    let even = MAPPING.replace("zone = \"Europe/Zurich\"\n", "");
    let error = read(&even, TABLE).expect_err("one time stands twice");
    assert!(error.to_string().starts_with("home.csv:8:1: "), "{error}");
}

#[test]
fn a_meter_gives_the_mean_power_until_the_next_row() {
    let powers = |reading: &str| {
        let mapping = MAPPING.replace("unit = \"kwh\"", &format!("unit = \"kwh\", reading = \"{reading}\""));
        read(&mapping, TABLE).expect("a table").zones[0].power_kw.clone()
    };
    assert_eq!(powers("counter"), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 7.0]);
    assert_eq!(powers("until-row"), [101.0, 103.0, 106.0, 110.0, 115.0, 121.0, 128.0, 128.0]);
    assert_eq!(powers("from-row"), [100.0, 101.0, 103.0, 106.0, 110.0, 115.0, 121.0, 128.0]);
    let joules = MAPPING.replace("unit = \"kwh\"", "unit = \"mj\", factor = -1.8");
    assert!((read(&joules, TABLE).expect("a table").zones[0].power_kw[0] + 0.5).abs() < 1e-12);
}

#[test]
fn faults_of_clocks_and_meters_are_located() {
    let refused = |mapping: &str, table: &str| read(mapping, table).expect_err("must be refused").to_string();
    let error = refused(MAPPING, &TABLE.replace("5;115", "5;99"));
    assert!(error.starts_with("home.csv:9:") && error.contains("falls from 110 to 99"), "{error}");
    assert!(error.contains("time.batch"), "{error}");
    let spring = "\n\nt;in;out;E\n29.03.2026 01:00;20;5;1\n29.03.2026 02:00;20;5;2\n";
    let error = refused(MAPPING, spring);
    assert!(error.starts_with("home.csv:5:1: clocks of Europe/Zurich never showed"), "{error}");
    let error = refused(&MAPPING.replace("\"out\"", "\"outside\""), TABLE);
    assert!(error.starts_with("home.csv:3:1: column `outside`"), "{error}");
    let unreadable = |mapping: &str| Mapping::parse("home.toml", mapping).expect_err("must be refused").to_string();
    let error = unreadable(&MAPPING.replace("Europe/Zurich", "Europe/Zurch"));
    assert!(error.starts_with("home.toml:9:8: ") && error.contains("`Europe/Zurich`"), "{error}");
    let error = unreadable(&MAPPING.replace("%H:%M", "%H:%M %z"));
    assert!(error.contains("without an offset"), "{error}");
    let error = unreadable(&format!("{MAPPING}heat_hold = \"first-order\"\n"));
    assert!(error.contains("`zero-order`"), "{error}");
}

#[test]
fn whole_days_of_telemetry_become_weather_for_a_scenario() {
    let rows = (10..80).map(|hour| format!("{}.06.2026 {:02}:00;20;{};{hour}\n", 1 + hour / 24, hour % 24, hour % 24));
    let table = format!("\n\nt;in;out;E\n{}", rows.collect::<String>());
    let recorded = read(MAPPING, &table).expect("a table").recorded_days().expect("whole days");
    assert_eq!((recorded.skip_days, recorded.days, recorded.step_s), (1, 2, Some(3600.0)));
    assert!(recorded.csv.starts_with("time_s,outdoor_c\n36000,10\n39600,11\n"), "{}", &recorded.csv[..40]);
    assert!(!recorded.are_means && !recorded.has_other_sun);
}

const DATED: &str =
    "\n\nt;in;out;E\n2026-07-06T00:00:00Z;20;5;1\n2026-07-06T03:00:00+02:00;21;5;2\n2026-07-06T02:00:00Z;20;5;3\n";

#[test]
fn the_suffix_z_means_utc() {
    let mapping = MAPPING.replace("zone = \"Europe/Zurich\"\n", "").replace("%d.%m.%Y %H:%M", "%Y-%m-%dT%H:%M:%S%z");
    let telemetry = read(&mapping, DATED).expect("three hours");
    assert_eq!(telemetry.time_s, [0.0, 3600.0, 7200.0]);
}

#[test]
fn a_missing_offset_in_the_time_format_is_reported() {
    let mapping = MAPPING.replace("zone = \"Europe/Zurich\"\n", "").replace("%d.%m.%Y %H:%M", "%Y-%m-%dT%H:%M:%S");
    let error = read(&mapping, DATED).expect_err("the format has no offset").to_string();
    assert!(error.contains("it has an offset from UTC: set `time.format` to `%Y-%m-%dT%H:%M:%S%z`"), "{error}");
}

#[test]
fn a_gap_of_an_hour_is_attributed_to_a_clock_change() {
    let even = MAPPING.replace("zone = \"Europe/Zurich\"\n", "");
    let spring = "\n\nt;in;out;E\n29.03.2026 01:00;20;5;1\n29.03.2026 03:00;21;5;2\n";
    for table in [TABLE, spring] {
        let error = read(&even, table).expect_err("an hour too much or too little").to_string();
        assert!(error.contains("`time.zone`") && error.contains("`%z`"), "{error}");
    }
    let error = read(&even, &spring.replace("03:00", "05:00")).expect_err("three hours are missing").to_string();
    assert!(error.contains("add the missing rows") && !error.contains("time.zone"), "{error}");
}

#[test]
fn all_faults_of_a_mapping_are_reported_together() {
    let spoilt = MAPPING
        .replace("step_s = 3600.0", "step_s = -1.0")
        .replace("skip_rows = 2", "skip_rows = \"two\"")
        .replace("temperature = \"in\"", "temprature = \"in\"")
        .replace("unit = \"kwh\"", "unit = \"kw\"");
    let error = Mapping::parse("home.toml", &spoilt).expect_err("four faults");
    let shown = error.to_string();
    let lines: Vec<&str> = shown.lines().collect();
    assert_eq!((lines.len(), error.others.len()), (4, 3), "{shown}");
    let words = ["home.toml:3:", "home.toml:10:", "home.toml:14:", "home.toml:15:"];
    assert!(lines.iter().zip(words).all(|(line, word)| line.starts_with(word)), "{shown}");
    assert!(lines[2].contains("`temprature`") && !shown.contains("is missing"), "{shown}");
}
