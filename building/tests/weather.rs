//! The synthetic climate, forecasts and occupancy: in range, repeatable, and wrong as they should be.

use interplay_building::calendar::{Calendar, RunDays};
use interplay_building::comfort::{Agenda, Setpoints};
use interplay_building::identify::{Mapping, Telemetry, TelemetryError};
use interplay_building::occupancy::{Deviation, Occupancy};
use interplay_building::schedule::{DayChoice, Period, Timetable, ZoneSchedule};
use interplay_building::weather::{Climate, ErrorLevel, Forecast};

const DAY_S: f64 = 86_400.0;
const STEP_S: f64 = 1800.0;
const STEPS: usize = 48;

fn mean(x: &[f64]) -> f64 {
    x.iter().sum::<f64>() / x.len() as f64
}

fn rms(x: impl Iterator<Item = f64>) -> f64 {
    let squares: Vec<f64> = x.map(|x| x * x).collect();
    mean(&squares).sqrt()
}

#[test]
fn the_synthetic_climate_resembles_singapore() {
    let weather = Climate::default().weather(7, 60);
    let days: Vec<Vec<f64>> = (0..60).map(|day| weather.ambient_steps_c(day as f64 * DAY_S, STEP_S, STEPS)).collect();
    let all: Vec<f64> = days.concat();
    assert!((28.0..29.0).contains(&mean(&all)), "{}", mean(&all));
    let (low, high) = all.iter().fold((f64::MAX, f64::MIN), |(l, h), &t| (l.min(t), h.max(t)));
    assert!(low > 23.0 && low < 26.0 && high > 31.5 && high < 34.0, "{low} {high}");
    // Afternoons are warmer than mornings before dawn, and days differ.
    let at = |hour: f64| mean(&days.iter().map(|day| day[(2.0 * hour) as usize]).collect::<Vec<f64>>());
    assert!(at(13.5) - at(5.5) > 4.0);
    assert!(rms(days[3].iter().zip(&days[4]).map(|(a, b)| a - b)) > 0.2);
    // The sun shines by day.
    let sun = weather.sun_steps_w_per_m2(0.0, 3600.0, 24);
    assert!(sun[2] == 0.0 && sun[12] > 300.0 && sun[22] == 0.0);
}

#[test]
fn days_depend_on_the_seed_alone() {
    let climate = Climate::default();
    let (short, long) = (climate.weather(3, 2), climate.weather(3, 9));
    assert_eq!(short.ambient_steps_c(0.0, STEP_S, 2 * STEPS - 2), long.ambient_steps_c(0.0, STEP_S, 2 * STEPS - 2));
    assert_ne!(climate.weather(4, 2), short);
}

#[test]
fn exact_and_persistence_forecasts_match_their_definitions() {
    let weather = Climate::default().weather(1, 5);
    let actual = |day: f64| weather.ambient_steps_c(day * DAY_S, STEP_S, STEPS);
    assert_eq!(Forecast::Exact.ambient_steps_c(&weather, 9, 2, STEP_S, STEPS), actual(2.0));
    assert_eq!(Forecast::Persistence.ambient_steps_c(&weather, 9, 2, STEP_S, STEPS), actual(1.0));
    assert_eq!(Forecast::Persistence.ambient_steps_c(&weather, 9, 0, STEP_S, STEPS), actual(-1.0));
}

#[test]
fn forecast_errors_have_boptest_s_moments() {
    const DAYS: usize = 4000;
    for level in [ErrorLevel::Low, ErrorLevel::Medium, ErrorLevel::High] {
        let model = level.model();
        let errors: Vec<Vec<f64>> = (0..DAYS).map(|day| model.errors_k(5, day, 24)).collect();
        let at = |hour: usize| errors.iter().map(|day| day[hour]).collect::<Vec<f64>>();
        let (mut expected_mean, mut expected_variance) = (model.first_mean_k, model.first_deviation_k.powi(2));
        for hour in 0..=24 {
            let values = at(hour);
            let standard_error = (expected_variance / DAYS as f64).sqrt();
            assert!((mean(&values) - expected_mean).abs() < 4.0 * standard_error, "{level:?} {hour}");
            let variance = mean(&values.iter().map(|e| (e - mean(&values)).powi(2)).collect::<Vec<f64>>());
            assert!((variance / expected_variance - 1.0).abs() < 4.0 * (2.0 / DAYS as f64).sqrt(), "{level:?} {hour}");
            expected_mean = model.correlation * expected_mean + model.drift_k;
            expected_variance = model.correlation.powi(2) * expected_variance + model.deviation_k.powi(2);
        }
    }
}

#[test]
fn an_uncertain_forecast_is_the_truth_plus_an_error() {
    let weather = Climate::default().weather(1, 3);
    let forecast = Forecast::Uncertain { level: ErrorLevel::Medium };
    let errors = ErrorLevel::Medium.model().errors_k(9, 1, 24);
    let forecast_c = forecast.ambient_steps_c(&weather, 9, 1, 3600.0, 24);
    for (hour, (forecast_c, actual_c)) in forecast_c.iter().zip(weather.ambient_steps_c(DAY_S, 3600.0, 24)).enumerate()
    {
        assert!((forecast_c - actual_c - 0.5 * (errors[hour] + errors[hour + 1])).abs() < 1e-12);
    }
    assert_eq!(forecast_c, forecast.ambient_steps_c(&weather, 9, 1, 3600.0, 24), "repeatable");
    assert_ne!(errors, ErrorLevel::Medium.model().errors_k(9, 2, 24), "each day has its own");
}

#[test]
fn occupancy_is_scheduled_in_working_hours() {
    let people = Occupancy::default().people(4, 1);
    let scheduled_kw = people.scheduled_kw(0, STEP_S, STEPS);
    let zone = |t: usize, i: usize| scheduled_kw[4 * t + i];
    for i in 0..4 {
        assert!((0.3..0.45).contains(&people.peaks_kw[i]));
        assert_eq!((zone(0, i), zone(47, i)), (0.02, 0.02), "only the base at night");
        assert!((zone(20, i) - 0.02 - people.peaks_kw[i]).abs() < 1e-3, "full at ten");
        assert!(zone(24, i) < 0.75 * zone(20, i), "lunch");
        assert!(
            (zone(15, i) - 0.02 - 0.25 * people.peaks_kw[i]).abs() < 0.01,
            "people are coming at a quarter to eight"
        );
    }
}

#[test]
fn real_occupancy_deviates_by_the_stated_amounts() {
    let mut deviations_kw = Vec::new();
    for seed in 0..20 {
        let people = Occupancy::default().people(4, seed);
        for bias in &people.biases {
            assert!((0.1..0.25).contains(&(bias - 1.0).abs()), "{bias}");
        }
        let scheduled_kw = people.scheduled_kw(0, STEP_S, STEPS);
        let actual_kw: Vec<Vec<f64>> = (0..5).map(|day| people.actual_kw(day, STEP_S, STEPS)).collect();
        assert_ne!(actual_kw[0], actual_kw[1]);
        assert!(actual_kw.concat().iter().all(|&kw| kw >= 0.02));
        // Steps 16 to 37 are working hours.
        deviations_kw.push(rms(actual_kw.iter().flat_map(|day| {
            day.iter().zip(&scheduled_kw).map(|(a, s)| a - s).skip(16 * 4).take(22 * 4).collect::<Vec<f64>>()
        })));
    }
    assert!(deviations_kw.iter().all(|rms| (0.05..0.15).contains(rms)), "{deviations_kw:?}");
    assert!((0.06..0.11).contains(&mean(&deviations_kw)), "{deviations_kw:?}");
}

#[test]
fn without_deviation_occupancy_equals_the_schedule() {
    let people = Occupancy { deviation: Deviation::NONE, ..Occupancy::default() }.people(3, 1);
    assert_eq!(people.actual_kw(4, STEP_S, STEPS), people.scheduled_kw(0, STEP_S, STEPS));
}

fn names() -> Vec<String> {
    ["office", "flat", "store"].map(str::to_owned).to_vec()
}

fn period(from_h: f64, to_h: f64) -> Period {
    Period { from_h, to_h, wanted_c: 20.0 + from_h / 10.0, band_k: None, people_kw: 0.5 }
}

fn schedule(zone: &str, days: &[DayChoice], periods: &[Period]) -> ZoneSchedule {
    let (days, periods) = (days.to_vec(), periods.to_vec());
    ZoneSchedule { zones: vec![zone.to_owned()], days, other_c: None, base_kw: 0.1, periods }
}

/// A week from Monday, 2026-07-06, with a holiday on Wednesday.
fn week() -> RunDays {
    let holidays = vec!["2026-07-08".to_owned()];
    let calendar = Calendar { first_day: Some("2026-07-06".to_owned()), first_weekday: None, holidays };
    calendar.days(None).expect("dates")
}

#[test]
fn zones_follow_their_own_schedules_by_weekday() {
    let schedules = [
        schedule(
            "office",
            &[DayChoice::Workday],
            &[Period { band_k: Some(1.5), ..period(8.0, 12.0) }, period(13.0, 17.0)],
        ),
        schedule("flat", &[DayChoice::Everyday], &[period(0.0, 7.0), period(18.0, 24.0)]),
    ];
    let timetable = Timetable::new(&schedules, &names(), week()).expect("hours");
    let setpoints = Setpoints { occupied_c: vec![23.0], ..Setpoints::default() };
    let agenda = Agenda::new(setpoints.clone(), 3, STEP_S, STEPS).expect("setpoints").following(timetable.clone());
    let monday = agenda.of_day(0);
    let at = |hour: f64, zone: usize| ((2.0 * hour) as usize - 1) * 3 + zone;
    let occupied: Vec<bool> = [8.0, 12.0, 12.5, 13.0, 17.0, 17.5].map(|hour| monday.occupied[at(hour, 0)]).to_vec();
    assert_eq!(occupied, [true, true, false, true, true, false], "both ends belong to a period");
    assert_eq!([monday.reference_c[at(10.0, 0)], monday.reference_c[at(15.0, 0)]], [20.8, 21.3]);
    assert_eq!([monday.band_k[at(10.0, 0)], monday.band_k[at(15.0, 0)]], [1.5, 0.5], "the common band by default");
    assert_eq!([monday.error_weight[at(10.0, 0)], monday.error_weight[at(12.5, 0)]], [1.0, 0.0], "free at noon");
    assert_eq!(monday.reference_c[at(10.0, 2)], 23.0, "the store follows the setpoints");
    assert!(monday.occupied[at(10.0, 2)] && !monday.occupied[at(10.0, 1)]);
    for (day, at_work) in [(0, true), (1, true), (2, false), (3, true), (4, true), (5, false), (6, false), (7, true)] {
        let targets = agenda.of_day(day);
        assert_eq!(targets.occupied[at(10.0, 0)], at_work, "day {day}");
        assert!(targets.occupied[at(6.0, 1)], "the flat is lived in on day {day}");
    }
    let people = Occupancy { deviation: Deviation::NONE, ..Occupancy::default() }.people(3, 1).following(timetable);
    let common = Occupancy { deviation: Deviation::NONE, ..Occupancy::default() }.people(3, 1);
    let (monday_kw, holiday_kw) = (people.scheduled_kw(0, STEP_S, STEPS), people.scheduled_kw(2, STEP_S, STEPS));
    // In the step from 10:00 to 10:30, and from 12:00 to 12:30.
    assert_eq!(
        [monday_kw[60], monday_kw[72], holiday_kw[60]],
        [0.6, 0.1, 0.0],
        "0.1 kW of machines on days with a schedule"
    );
    assert_eq!(people.actual_kw(0, STEP_S, STEPS), monday_kw, "people who keep to their schedule");
    let store = |kw: &[f64]| -> Vec<f64> { kw.iter().skip(2).step_by(3).copied().collect() };
    assert_eq!(store(&monday_kw), store(&common.scheduled_kw(0, STEP_S, STEPS)), "the store is like before");
}

/// Actual occupancy deviates from schedules, but an unoccupied zone stays unoccupied.
#[test]
fn people_deviate_from_their_schedules() {
    let schedules = [schedule("office", &[DayChoice::Workday], &[period(8.0, 17.0)])];
    let timetable = Timetable::new(&schedules, &names(), week()).expect("hours");
    let people = Occupancy::default().people(3, 5).following(timetable);
    let office = |day: usize| -> Vec<f64> { people.actual_kw(day, STEP_S, STEPS).iter().step_by(3).copied().collect() };
    let (monday, tuesday, holiday) = (office(0), office(1), office(2));
    assert_ne!(monday, tuesday);
    assert!(holiday.iter().all(|kw| *kw == 0.0), "{holiday:?}");
    assert!(monday[4] == 0.1 && monday[46] == 0.1, "only machines at night");
    let noon_kw = monday[24..30].iter().sum::<f64>() / 6.0;
    assert!((0.2..1.2).contains(&noon_kw) && (noon_kw - 0.6).abs() > 1e-3, "{noon_kw}");
}

#[test]
fn contradictory_schedules_are_refused() {
    let refused = |schedules: &[ZoneSchedule], key: &str, words: &str| {
        let error = Timetable::new(schedules, &names(), RunDays::default()).expect_err(words);
        assert!(error.key.as_str() == key && error.to_string().contains(words), "{}: {error}", error.key);
    };
    let day = [period(8.0, 12.0)];
    refused(&[schedule("ofice", &[DayChoice::Everyday], &day)], "zones.0", "did you mean `office`");
    let twice = [schedule("flat", &[DayChoice::Workday], &day), schedule("flat", &[DayChoice::Friday], &day)];
    refused(&twice, "zones.0", "two schedules for Fridays");
    let doubled = ZoneSchedule { zones: vec!["flat".to_owned(); 2], ..schedule("flat", &[DayChoice::Everyday], &day) };
    refused(&[doubled], "zones.1", "named twice");
    let holidays = [schedule("flat", &[DayChoice::Everyday], &day), schedule("flat", &[DayChoice::Holiday], &day)];
    refused(&holidays, "zones.0", "two schedules for");
    refused(
        &[schedule("flat", &[DayChoice::Everyday], &[period(22.0, 7.0)])],
        "period.0.to_h",
        "from 22 to 24 and from 0 to 7",
    );
    let overlapping = [period(8.0, 12.0), period(11.0, 13.0)];
    refused(&[schedule("flat", &[DayChoice::Everyday], &overlapping)], "period.1.from_h", "overlaps");
    refused(&[schedule("flat", &[DayChoice::Everyday], &[period(8.0, 25.0)])], "period.0.to_h", "at most 24");
    let fine = [
        schedule("flat", &[DayChoice::Workday], &day),
        schedule("flat", &[DayChoice::Weekend, DayChoice::Holiday], &day),
    ];
    assert!(Timetable::new(&fine, &names(), RunDays::default()).is_ok_and(|timetable| timetable.days_differ()));
    let same = [schedule("flat", &[DayChoice::Everyday], &day)];
    assert!(Timetable::new(&same, &names(), RunDays::default()).is_ok_and(|timetable| !timetable.days_differ()));
}

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
