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
fn the_hour_that_comes_twice_is_no_gap() {
    let telemetry = read(MAPPING, TABLE).expect("regular in time");
    assert_eq!(telemetry.segments, [0..8]);
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
fn what_is_wrong_with_clocks_and_meters_is_located() {
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
fn whole_days_are_weather_for_a_scenario() {
    let rows = (10..80).map(|hour| format!("{}.06.2026 {:02}:00;20;{};{hour}\n", 1 + hour / 24, hour % 24, hour % 24));
    let table = format!("\n\nt;in;out;E\n{}", rows.collect::<String>());
    let recorded = read(MAPPING, &table).expect("a table").recorded_days().expect("whole days");
    assert_eq!((recorded.skip_days, recorded.days, recorded.step_s), (1, 2, Some(3600.0)));
    assert!(recorded.csv.starts_with("time_s,outdoor_c\n36000,10\n39600,11\n"), "{}", &recorded.csv[..40]);
    assert!(!recorded.are_means && !recorded.has_other_sun);
}
