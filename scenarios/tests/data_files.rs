//! Data files that a scenario names: weather, prices and gains from tables, solar radiation on windows, and their errors.

mod common;

use std::fs;
use std::path::PathBuf;

use interplay_scenarios::{LoadError, Scenario, WeatherSource, load};

const HOUSE: &str = "title = 'house'\nshows = 'data'\niterations = 2\n[building]\nstep_s = 1800.0\n\
    [[building.zone]]\nname = 'living'\n[[building.zone]]\nname = 'bed'\n\
    [[building.wall]]\nbetween = ['living', 'bed']\nresistance_k_per_kw = 30.0\n\
    [[building.wall]]\nbetween = ['living', 'ambient']\nresistance_k_per_kw = 30.0\n";
const WINDOW: &str = "[[building.zone.window]]\narea_m2 = 4.0\nfacing_deg = 180.0\n";

/// A folder with a scenario and the files that it names.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.0.path().join(name);
        fs::write(&path, text).expect("a writable folder");
        path
    }

    fn load(&self, scenario: &str) -> Result<Scenario, LoadError> {
        let path = self.write("house.toml", scenario);
        load(path.to_str().expect("a plain path"), &[])
    }

    fn refused(&self, scenario: &str, words: &[&str]) {
        common::refused(self.load(scenario), words);
    }
}

fn remarks(scenario: &Scenario) -> String {
    scenario.remarks.iter().map(|remark| format!("{remark}\n")).collect()
}

/// A year of rows by the hour from the first of January on; `cell` changes a cell of a row, counted from zero.
fn epw(cell: impl Fn(usize, usize) -> Option<&'static str>) -> String {
    const DAYS: [usize; 12] = [31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let mut text = String::from(
        "LOCATION,NOWHERE,-,NWH,Made up,000000,47.4,8.5,1.0,400\nDESIGN CONDITIONS,0\nTYPICAL/EXTREME PERIODS,0\n\
         GROUND TEMPERATURES,0\nHOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0\nCOMMENTS 1,made\nCOMMENTS 2,\n\
         DATA PERIODS,1,1,Data,Sunday,1-Jan,31-Dec\n",
    );
    let days = DAYS.iter().enumerate().flat_map(|(month, days)| (1..=*days).map(move |day| (month + 1, day)));
    for (index, (month, day, hour)) in days.flat_map(|(m, d)| (1..=24).map(move |h| (m, d, h))).enumerate() {
        let sun = if (9..=16).contains(&hour) { ["300", "400", "100"] } else { ["0", "0", "0"] };
        let row = format!(
            "2009,{month},{day},{hour},60,?,4.5,1.0,80,960,0,0,300,{},{},{},0,0,0,0,180,2.0,5,5",
            sun[0], sun[1], sun[2]
        );
        let cells: Vec<&str> =
            row.split(',').enumerate().map(|(place, text)| cell(index, place).unwrap_or(text)).collect();
        text.extend([cells.join(",").as_str(), "\n"]);
    }
    text
}

#[test]
fn gaps_outside_the_days_of_the_run_are_accepted() {
    let folder = Folder::new();
    let weather = "[weather]\nkind = 'epw'\nfile = 'year.epw'\n";
    let october = 24 * 280..24 * 285;
    folder.write("year.epw", &epw(|row, column| (column == 6 && october.contains(&row)).then_some("-999")));
    let scenario = folder.load(&format!("{HOUSE}{weather}month = 2\n")).expect("February is right");
    let said = remarks(&scenario);
    assert!(said.contains("line 6729: column 7, dry-bulb temperature, is -999"), "{said}");
    assert!(said.contains("120 such cells"), "{said}");
    folder
        .refused(&format!("{HOUSE}{weather}month = 10\nday = 8\n"), &["year.epw:6729:1", "is -999", "take other days"]);
    // Missing radiation is accepted without windows, and refused with them.
    folder.write("year.epw", &epw(|_, column| (13..16).contains(&column).then_some("9999")));
    assert!(folder.load(&format!("{HOUSE}{weather}")).is_ok());
    let sunny = HOUSE.replace("name = 'bed'\n", "name = 'bed'\nsolar_aperture_m2 = 1.0\n");
    folder
        .refused(&format!("{sunny}{weather}"), &["every global horizontal radiation is marked as missing", "`window`"]);
    // A gap of 480 temperatures is too long to bridge.
    folder.write("year.epw", &epw(|row, column| (column == 6 && (10..490).contains(&row)).then_some("99.9")));
    folder.refused(&format!("{HOUSE}{weather}"), &["year.epw:19:1", "missing for 480 h", "weather.bridge_gaps_h"]);
    let bridged = folder.load(&format!("{HOUSE}{weather}bridge_gaps_h = 480.0\n")).expect("as stated");
    assert!(remarks(&bridged).contains("480 rows that the run uses"), "{}", remarks(&bridged));
}

#[test]
fn quarter_hourly_and_quoted_prices_are_read() {
    let folder = Folder::new();
    let tariff = |text: &str| {
        folder.write("prices.csv", text);
        folder
            .load(&format!("{HOUSE}[tariff]\nfile = 'prices.csv'\n"))
            .map(|scenario| scenario.tariff.expect("a tariff"))
    };
    let quarters: String = (0..192)
        .map(|quarter| format!("{},{}\n", f64::from(quarter) / 4.0, 0.1 + 0.001 * f64::from(quarter)))
        .collect();
    let read = tariff(&format!("\"hour\",\"price_per_kwh\"\n{quarters}")).expect("two days");
    assert_eq!((read.interval_s, read.prices_per_kwh.len()), (900.0, 192));
    let step = read.day_per_kwh(1, 1800.0, 48)[0];
    assert!((step - (0.1 + 0.001 * 96.5)).abs() < 1e-12, "the mean of two quarters: {step}");
    let dated = |from: &str| format!("time;price_per_kwh\n{from} 00:00;0,3\n{from} 12:00;0,5\n");
    folder.write("prices.csv", &dated("2026-07-06"));
    let calendar = "calendar = { first_day = '2026-07-06' }\n";
    let scenario = folder.load(&format!("{calendar}{HOUSE}[tariff]\nfile = 'prices.csv'\n")).expect("half days");
    assert_eq!(scenario.tariff.expect("a tariff").prices_per_kwh, [0.3, 0.5]);
    folder.write("prices.csv", &dated("2026-07-09"));
    folder.refused(
        &format!("{calendar}{HOUSE}[tariff]\nfile = 'prices.csv'\n"),
        &["prices.csv:2:1", "calendar.first_day"],
    );
}

#[test]
fn prices_repeat_after_whole_days_only() {
    let folder = Folder::new();
    let list = |count: usize| format!("{HOUSE}[tariff]\nprices_per_kwh = [{}]\n", "0.3,".repeat(count));
    for count in [1, 2, 24, 48, 49, 100] {
        assert!(folder.load(&list(count)).is_ok(), "{count} prices for 48 hours");
    }
    folder.refused(&list(47), &["house.toml:17:18", "there are 47 prices", "the run takes 48", "24 or 48 prices"]);
    let rows: String = (0..47).map(|hour| format!("{hour},0.3\n")).collect();
    folder.write("prices.csv", &format!("hour,price_per_kwh\n{rows}"));
    folder.refused(&format!("{HOUSE}[tariff]\nfile = 'prices.csv'\n"), &["house.toml:17:8", "47 prices"]);
}

#[test]
fn weather_is_read_from_a_table() {
    let folder = Folder::new();
    let rows: String = (0..=72)
        .map(|hour| {
            format!("2026-07-{:02} {:02}:00,{},{}\n", 6 + hour / 24, hour % 24, 15 + hour % 7, 100 * (hour % 4))
        })
        .collect();
    folder.write("weather.csv", &format!("# station 7\ntime,temp,ghi\n{rows}"));
    let weather = "[weather]\nkind = 'csv'\nfile = 'weather.csv'\ntemperature = 'temp'\nsun = 'ghi'\n";
    let scenario = folder.load(&format!("{HOUSE}{weather}skip_days = 1\n")).expect("a scenario");
    let WeatherSource::Csv(read) = &scenario.weather else { panic!("a table") };
    assert_eq!(read.weather.ambient_c.at(0.0), 18.0, "the 7th of July at midnight");
    let again = scenario.to_file().resolve().expect("what it is written as");
    assert_eq!(again.weather.days(2, 1), scenario.weather.days(2, 1));
    folder.refused(&format!("{HOUSE}{weather}skip_days = 2\n"), &["weather.csv:75:1", "skip_days"]);
    folder.refused(&format!("{HOUSE}{}", weather.replace("'temp'", "'tmp'")), &["weather.csv:2:1", "temp"]);
    let sunny = HOUSE.replace("name = 'bed'\n", &format!("name = 'bed'\n{WINDOW}"));
    folder.refused(&format!("{sunny}{weather}"), &["where the sun stands", "latitude_deg"]);
    let placed = "latitude_deg = 47.4\nlongitude_deg = 8.5\ntime_zone_h = 2.0\n";
    assert!(folder.load(&format!("{sunny}{weather}{placed}")).is_ok());
}

#[test]
fn gains_are_read_from_a_table() {
    let folder = Folder::new();
    let rows: String = (0..48).map(|hour| format!("{hour},{},1\n", hour % 24)).collect();
    folder.write("gains.csv", &format!("hour,living,Kitchen\n{rows}"));
    let gains = "[[gains]]\nfile = 'gains.csv'\nunit_kw = 0.08\n";
    let scenario = folder.load(&format!("{HOUSE}{gains}")).expect("a scenario");
    assert!(remarks(&scenario).contains("`Kitchen`"), "{}", remarks(&scenario));
    let [zone] = scenario.gains[0].zones.as_slice() else { panic!("one zone") };
    assert!((zone.zone, zone.beside_people) == (0, false) && (zone.heat_kw.mean(7200.0, 9000.0) - 0.16).abs() < 1e-12);
    // A file that is written elsewhere names its table by its whole path.
    assert_eq!(scenario.to_file().resolve().expect("what it is written as").gains[0].zones, scenario.gains[0].zones);
    folder.refused(
        &format!("{}{gains}", HOUSE.replace("iterations = 2", "iterations = 3")),
        &["gains.csv:49:1", "repeats = true"],
    );
    folder.write("gains.csv", "hour,lving\n0,1\n1,2\n");
    folder.refused(&format!("{HOUSE}{gains}"), &["gains.csv:1:1", "living"]);
}

#[test]
fn windows_are_checked_like_other_settings() {
    let folder = Folder::new();
    let with = |window: &str| HOUSE.replace("name = 'bed'\n", &format!("name = 'bed'\n{window}"));
    assert!(folder.load(&with(WINDOW)).is_ok(), "synthetic weather has a sky");
    folder.refused(&with(&WINDOW.replace("180.0", "-90.0")), &["house.toml:12:14", "facing_deg"]);
    folder.refused(&with(&WINDOW.replace("facing_deg = 180.0\n", "")), &["facing_deg"]);
    let thin = HOUSE.replace(
        "between = ['living', 'ambient']\n",
        "between = ['living', 'ambient']\nwindow = [{ area_m2 = 1.0, facing_deg = 0.0 }]\n",
    );
    folder.refused(&thin, &["stores no heat", "capacity_kj_per_k"]);
}

#[test]
fn prices_per_megawatt_hour_cause_a_remark() {
    let folder = Folder::new();
    let remarks_of = |price: &str| {
        folder.write(
            "prices.csv",
            &format!("hour,price_per_kwh\n{}", (0..48).map(|hour| format!("{hour},{price}\n")).collect::<String>()),
        );
        remarks(&folder.load(&format!("{HOUSE}[tariff]\nfile = 'prices.csv'\n")).expect("prices"))
    };
    let said = remarks_of("380");
    assert!(said.contains("line 2: the price is 380 per kWh: is it per MWh?"), "{said}");
    assert!(!remarks_of("0.38").contains("MWh"));
}

#[test]
fn hourly_prices_are_read_and_their_errors_are_located() {
    let folder = Folder::new();
    let scenario = format!("{HOUSE}[tariff]\nfile = 'prices.csv'\n");
    folder.write("prices.csv", "hour,price_per_kwh\n0,0.25\n1,0.5\n");
    let read = folder.load(&scenario).expect("two prices");
    assert_eq!(read.tariff.expect("a tariff").prices_per_kwh, [0.25, 0.5]);
    folder.write("prices.csv", "hour,price_per_kwh\n0,0.25\n1,cheap\n");
    folder.refused(&scenario, &["prices.csv:3:1", "`cheap`"]);
    folder.write("prices.csv", "hour,price_per_kwh\n0,-0.25\n");
    let read = folder.load(&scenario).expect("a negative price");
    assert_eq!(read.tariff.expect("a tariff").prices_per_kwh, [-0.25]);
}
