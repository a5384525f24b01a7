//! EPW files: no hour is off by one, gaps are bridged, and what is wrong is located.
//!
//! The files are made here. `INTERPLAY_EPW_DIR` may name a folder with real ones: `SGP_Singapore.486980_IWEC.epw` and
//! `USA_CA_San.Francisco.Intl.AP.724940_TMY3.epw`.

use interplay_building::weather::epw::{Epw, EpwError, EpwProblem, EpwUse, Field};

const HOUR_S: f64 = 3600.0;
const DAYS: [u32; 12] = [31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];

/// A file under construction: rows for all hours from the first to the last day of its period.
struct File {
    leap: bool,
    intervals_per_hour: usize,
    first: (u32, u32),
    last: (u32, u32),
    rows: Vec<String>,
}

/// The temperature that the made files state at the end of interval `row` (from zero).
fn temperature_c(row: usize) -> f64 {
    (200 + (row * 37) % 101) as f64 / 10.0
}

fn row(month: u32, day: u32, hour: u32, minute: usize, index: usize) -> String {
    let temperature_c = temperature_c(index);
    let sun = if (8..18).contains(&hour) { 500 } else { 0 };
    format!(
        "1989,{month},{day},{hour},{minute},C9C9,{temperature_c:.1},23.6,94,100900,0,1415,387,{sun},0,0,0,0,0,0,180,3.2,9,1,\
         16.0,77777,9,999999999,0,0.1600,0,88,0.000,0.0,0.0"
    )
}

impl File {
    fn new(leap: bool, intervals_per_hour: usize, first: (u32, u32), last: (u32, u32)) -> Self {
        let mut rows = Vec::new();
        for month in 1..=12_u32 {
            let days = DAYS[month as usize - 1] + u32::from(leap && month == 2);
            for day in (1..=days).filter(|&day| (first..=last).contains(&(month, day))) {
                for hour in 1..=24 {
                    for interval in 1..=intervals_per_hour {
                        let minute = interval * 60 / intervals_per_hour;
                        rows.push(row(month, day, hour, minute, rows.len()));
                    }
                }
            }
        }
        Self { leap, intervals_per_hour, first, last, rows }
    }

    fn year() -> Self {
        Self::new(false, 1, (1, 1), (12, 31))
    }

    fn days(last: (u32, u32)) -> Self {
        Self::new(false, 1, (1, 1), last)
    }

    /// Replaces one column of one row.
    fn with(mut self, index: usize, column: usize, text: &str) -> Self {
        let mut cells: Vec<&str> = self.rows[index].split(',').collect();
        cells[column] = text;
        self.rows[index] = cells.join(",");
        self
    }

    fn text(&self) -> String {
        let ((m1, d1), (m2, d2)) = (self.first, self.last);
        let leap = if self.leap { "Yes" } else { "No" };
        let mut lines = vec![
            "LOCATION,NOWHERE,-,NWH,Made up,000000,1.37,103.98,8.0,16.0".to_owned(),
            "DESIGN CONDITIONS,0".to_owned(),
            "TYPICAL/EXTREME PERIODS,0".to_owned(),
            "GROUND TEMPERATURES,0".to_owned(),
            format!("HOLIDAYS/DAYLIGHT SAVINGS,{leap},0,0,0"),
            "COMMENTS 1,\"made, for tests\"".to_owned(),
            "COMMENTS 2,".to_owned(),
            format!("DATA PERIODS,1,{},Data,Sunday,{m1:2}/{d1:2},{m2:2}/{d2:2}", self.intervals_per_hour),
        ];
        lines.extend(self.rows.iter().cloned());
        lines.join("\r\n") + "\r\n"
    }

    fn parse(&self) -> Result<Epw, EpwError> {
        Epw::parse(&self.text())
    }
}

/// Lines before the first row.
const HEADER: usize = 8;

/// Three days of some fields, with gaps of at most 6 h.
fn all_days(fields: &[Field]) -> EpwUse<'_> {
    EpwUse { fields, from_s: 0.0, to_s: 72.0 * HOUR_S, bridge_gaps_h: 6.0 }
}

/// 120 cells of −999 in October are nothing to a run in February, whatever the field, and its first line is told.
#[test]
fn faulty_cells_that_a_run_does_not_use_give_remarks() {
    let october = 24 * 280;
    let file = (october..october + 120).fold(File::year(), |file, index| file.with(index, 6, "-999"));
    let file = (0..8760).fold(file, |file, index| file.with(index, 14, "-1"));
    let epw = file.with(10, 15, "dim").parse().expect("rows follow each other");
    let february = EpwUse { from_s: 31.0 * 24.0 * HOUR_S, to_s: 59.0 * 24.0 * HOUR_S, ..all_days(&[Field::DryBulb]) };
    let remarks = epw.check_use(&february).expect("February is right");
    let found: Vec<(usize, bool)> =
        remarks.iter().map(|remark| (remark.line - HEADER, remark.text.contains("does not use this cell"))).collect();
    assert_eq!(found, [(october + 1, false), (1, false), (11, true)], "{remarks:?}");
    assert!(remarks[0].text.contains("is -999") && remarks[0].text.contains("120 such cells"), "{}", remarks[0].text);
    assert!(
        remarks[1].text.contains("direct normal radiation") && remarks[1].text.contains("8760 such cells"),
        "{remarks:?}"
    );
    for (from_day, to_day) in [(270.0, 290.0), (0.0, 365.0), (360.0, 650.0)] {
        let usage = EpwUse { from_s: from_day * 24.0 * HOUR_S, to_s: to_day * 24.0 * HOUR_S, ..february };
        let error = epw.check_use(&usage).expect_err("October is used");
        assert_eq!(error.line, HEADER + october + 1, "{from_day}");
    }
    let after = EpwUse { from_s: 300.0 * 24.0 * HOUR_S, to_s: 390.0 * 24.0 * HOUR_S, ..february };
    assert!(epw.check_use(&after).is_ok(), "from November into the next January");
}

#[test]
fn short_gaps_are_bridged_with_a_remark_and_long_gaps_are_refused() {
    let missing = |rows: std::ops::Range<usize>| {
        rows.fold(File::days((1, 3)), |file, index| file.with(index, 6, "99.9")).parse().expect("rows")
    };
    let remarks = missing(30..36).check_use(&all_days(&[Field::DryBulb])).expect("six hours");
    assert_eq!(remarks.len(), 1);
    assert!(remarks[0].line == HEADER + 31 && remarks[0].text.contains("6 rows"), "{remarks:?}");
    let error = missing(30..37).check_use(&all_days(&[Field::DryBulb])).expect_err("seven hours");
    assert_eq!(
        (error.line, error.to_string().contains("is missing for 7 h from here on")),
        (HEADER + 31, true),
        "{error}"
    );
    let longer = EpwUse { bridge_gaps_h: 7.0, ..all_days(&[Field::DryBulb]) };
    assert!(missing(30..37).check_use(&longer).is_ok());
}

#[test]
fn a_file_without_sun_is_refused_where_the_sun_is_used() {
    let without = |columns: &[usize]| {
        let cells = (0..72).flat_map(|row| columns.iter().map(move |column| (row, *column)));
        let file = cells.fold(File::days((1, 3)), |file, (row, column)| file.with(row, column, "9999"));
        file.parse().expect("the temperatures are there")
    };
    assert_eq!(without(&[13, 14, 15]).check_use(&all_days(&[Field::DryBulb])), Ok(Vec::new()));
    let used = [Field::DryBulb, Field::GlobalHorizontal];
    let error = without(&[13, 14, 15]).check_use(&all_days(&used)).expect_err("no sun");
    let words = "every global horizontal radiation is marked as missing, and the run uses it";
    assert_eq!(error.problem, EpwProblem::NoValues(words.into()));
    // Direct and diffuse radiation make up the global one.
    let diffuse = (0..72).fold(File::days((1, 3)), |file, row| file.with(row, 13, "9999").with(row, 15, "200"));
    let epw = diffuse.parse().expect("rows");
    assert_eq!(epw.check_use(&all_days(&used)), Ok(Vec::new()));
    assert_eq!(epw.weather().sun_w_per_m2.at(12.0 * HOUR_S), 200.0);
}

#[test]
fn the_hour_of_a_row_ends_at_its_time_stamp() {
    let weather = File::year().parse().expect("a whole year").weather();
    let at = |hours: f64| weather.ambient_c.at(hours * HOUR_S);
    // Row 0 is stamped hour 1: its temperature is that of 01:00, not that of 00:00.
    assert_eq!(at(1.0), temperature_c(0));
    assert_eq!(at(13.0), temperature_c(12));
    assert_eq!(at(8760.0), temperature_c(8759));
    // Linear in between, and from the last hour of the year into the first.
    assert!((at(13.25) - (0.75 * temperature_c(12) + 0.25 * temperature_c(13))).abs() < 1e-12);
    assert_eq!(at(0.0), temperature_c(8759));
    assert!((at(0.5) - 0.5 * (temperature_c(8759) + temperature_c(0))).abs() < 1e-12);
    assert_eq!(at(8761.0), at(1.0));
    assert_eq!(at(-8759.0), at(1.0));
    assert!((weather.ambient_c.mean() - (0..8760).map(temperature_c).sum::<f64>() / 8760.0).abs() < 1e-9);
}

#[test]
fn dates_of_the_data_period_may_begin_or_end_with_the_year() {
    let text = File::year().text();
    let stated = "Sunday, 1/ 1,12/31";
    assert!(text.contains(stated));
    let usual = Epw::parse(&text).expect("a whole year");
    for other in ["Sunday,2015/1/1,2015/12/31", "Sunday,1/1/2015,12/31/2015", "Sunday,2015/01/01,12/31"] {
        assert_eq!(Epw::parse(&text.replace(stated, other)), Ok(usual.clone()), "{other}");
    }
    // As spreadsheets save it.
    for other in ["Sunday,1-Jan,31-Dec", "Sunday,Jan 1,Dec 31", "Sunday,2015-01-01,2015-12-31"] {
        assert_eq!(Epw::parse(&text.replace(stated, other)), Ok(usual.clone()), "{other}");
    }
    for wrong in ["Sunday,2015/13/1,2015/12/31", "Sunday,2015/1,12/31", "Sunday,0/1/1,12/31", "Sunday,1-Jen,31-Dec"] {
        assert!(Epw::parse(&text.replace(stated, wrong)).is_err(), "{wrong}");
    }
}

#[test]
fn radiation_of_a_row_belongs_to_the_hour_before_its_stamp() {
    let weather = File::year().parse().expect("a whole year").weather();
    let sun = |hours: f64| weather.sun_w_per_m2.at(hours * HOUR_S);
    // Hours 8 to 17 have 500 Wh/m²: the sun shines from 07:00 to 17:00.
    assert_eq!((sun(7.5), sun(12.0), sun(16.5)), (500.0, 500.0, 500.0));
    assert_eq!((sun(6.5), sun(17.5)), (0.0, 0.0));
    let day_wh: f64 = weather.sun_steps_w_per_m2(0.0, 0.1 * HOUR_S, 240).iter().sum::<f64>() / 10.0;
    assert!((day_wh - 5000.0).abs() < 1e-6, "{day_wh}");
}

#[test]
fn weather_of_a_step_is_the_mean_over_the_step() {
    let weather = File::year().parse().expect("a whole year").weather();
    let steps = weather.ambient_steps_c(24.0 * HOUR_S, 0.5 * HOUR_S, 4);
    let fine = weather.ambient_steps_c(24.0 * HOUR_S, 0.001 * HOUR_S, 2000);
    for (step, fine) in steps.iter().zip(fine.chunks_exact(500)) {
        assert!((step - fine.iter().sum::<f64>() / 500.0).abs() < 1e-9);
    }
}

#[test]
fn leap_years_are_recognised_by_their_rows() {
    let leap = File::new(true, 1, (1, 1), (12, 31)).parse().expect("8784 rows");
    assert!(leap.is_leap() && leap.is_whole_year());
    assert_eq!(leap.rows(), 8784);
    assert_eq!(leap.midnight_s(3, 1), Some(60.0 * 24.0 * HOUR_S));
    let common = File::year().parse().expect("8760 rows");
    assert!(!common.is_leap() && common.is_whole_year());
    assert_eq!(common.midnight_s(3, 1), Some(59.0 * 24.0 * HOUR_S));
    assert_eq!(common.midnight_s(2, 29), None);
    assert_eq!(common.midnight_s(2, 30), None);
    assert_eq!(common.midnight_s(12, 31), Some(364.0 * 24.0 * HOUR_S));
}

#[test]
fn short_data_periods_and_sub_hourly_intervals_are_read() {
    let epw = File::new(false, 4, (2, 27), (3, 2)).parse().expect("four days");
    assert_eq!((epw.rows(), epw.interval_s, epw.is_whole_year()), (4 * 96, 900.0, false));
    assert_eq!(epw.midnight_s(3, 1), Some(2.0 * 24.0 * HOUR_S));
    assert_eq!(epw.midnight_s(3, 3), None);
    let weather = epw.weather();
    assert_eq!(weather.ambient_c.at(900.0), temperature_c(0));
    assert_eq!(weather.ambient_c.at(0.0), temperature_c(0), "the nearest value outside of the period");
    // 500 Wh/m² in a quarter of an hour are 2000 W/m².
    assert_eq!(weather.sun_w_per_m2.at(12.0 * HOUR_S), 2000.0);
}

#[test]
fn missing_values_are_bridged_and_counted() {
    let file = File::days((1, 2)).with(10, 6, "99.9").with(11, 6, "99.9").with(20, 14, "9999").with(21, 15, "");
    let epw = file.parse().expect("two days");
    assert_eq!(epw.filled, [(Field::DryBulb, 2), (Field::DirectNormal, 1), (Field::DiffuseHorizontal, 1)]);
    let temperatures_c = epw.column(Field::DryBulb).expect("most are there");
    let (before, after) = (temperature_c(9), temperature_c(12));
    assert!((temperatures_c[10] - (before + (after - before) / 3.0)).abs() < 1e-12);
    assert!((temperatures_c[11] - (before + (after - before) / 1.5)).abs() < 1e-12);

    let no_sun = (0..48).fold(File::days((1, 2)), |file, index| file.with(index, 13, "9999"));
    let epw = no_sun.parse().expect("the temperatures are there");
    assert_eq!(epw.column(Field::GlobalHorizontal), None);
    assert_eq!(epw.weather().sun_w_per_m2.at(12.0 * HOUR_S), 0.0);

    let nothing = (0..48).fold(File::days((1, 2)), |file, index| file.with(index, 6, "99.9"));
    let error = nothing.parse().expect_err("useless").to_string();
    assert_eq!(error, "line 9: every dry-bulb temperature is marked as missing");
}

#[test]
fn a_cut_off_file_is_located() {
    let whole = File::year().text();
    let lines: Vec<&str> = whole.lines().collect();
    let cut = lines[..HEADER + 5000].join("\n");
    let error = Epw::parse(&cut).expect_err("cut off");
    assert_eq!(error.line, HEADER + 5000);
    assert_eq!(
        error.to_string(),
        "line 5008: the file ends here, with 5000 rows; its header promises data up to 12/31 hour 24"
    );
    // Cut off within a row, or within the header.
    let error = Epw::parse(&whole[..whole.len() / 2]).expect_err("cut off");
    assert!(error.to_string().contains("cut off") || error.to_string().contains("ends here"), "{error}");
    let error = Epw::parse(&lines[..4].join("\n")).expect_err("cut off");
    assert_eq!(error.to_string(), "line 5: the file ends before its `DATA PERIODS` line");
    let error = Epw::parse("").expect_err("empty");
    assert_eq!(error.to_string(), "line 1: an EPW file begins with `LOCATION,`, and this does not");
}

#[test]
fn every_fault_of_an_epw_file_is_located() {
    let problem = |file: File| {
        let error = file.parse().expect_err("must be refused");
        (error.line - HEADER, error.to_string())
    };
    let days = || File::days((1, 3));
    let used = |file: File| {
        let epw = file.parse().expect("rows follow each other");
        let error = epw.check_use(&all_days(&[Field::DryBulb])).expect_err("must be refused");
        (error.line - HEADER, error.to_string())
    };
    let (row, text) = used(days().with(30, 6, "warm"));
    assert_eq!((row, text.contains("column 7, dry-bulb temperature, is `warm`, not a number")), (31, true), "{text}");
    let (row, text) = used(days().with(3, 6, "-99.0"));
    assert_eq!((row, text.contains("is -99; possible are -70 to 70, and missing is 99.9")), (4, true), "{text}");
    let (row, text) = used(days().with(3, 6, "NaN"));
    assert_eq!((row, text.contains("is NaN")), (4, true), "{text}");
    let (row, text) = problem(days().with(0, 2, "32"));
    assert_eq!((row, text.contains("day of the month")), (1, true), "{text}");

    let mut skipped = days();
    skipped.rows.remove(20);
    let (row, text) = problem(skipped);
    assert_eq!((row, text.contains("this is 1/1 hour 22, but 1/1 hour 21 comes next")), (21, true), "{text}");
    let mut repeated = days();
    repeated.rows.insert(5, repeated.rows[4].clone());
    assert_eq!(problem(repeated).0, 6);
    let mut short = days();
    short.rows[7].truncate(40);
    assert!(problem(short).1.contains("columns"));
    let longer = File { last: (1, 2), ..days() };
    assert!(problem(longer).1.contains("a row after 1/2 hour 24"));
}

#[test]
fn a_wrong_header_is_located() {
    let text = File::days((1, 1)).text();
    let refused = |from: &str, to: &str| Epw::parse(&text.replace(from, to)).expect_err("must be refused").to_string();
    assert!(refused("LOCATION", "<html>").starts_with("line 1: an EPW file begins with `LOCATION,`"));
    assert!(refused(",1.37,", ",north,").starts_with("line 1: the latitude is `north`"));
    assert!(refused("PERIODS,1,1", "PERIODS,2,1").starts_with("line 8: the number of data periods is `2`"));
    assert!(refused("PERIODS,1,1", "PERIODS,1,7").starts_with("line 8: the number of intervals an hour is `7`"));
    assert!(refused("Sunday, 1/ 1", "Sunday,13/ 1").starts_with("line 8: the first day of the data period is `13/ 1`"));
}

/// `INTERPLAY_EPW_DIR=FOLDER cargo test --release -p interplay-building --test epw -- --ignored`
#[test]
#[ignore = "needs two real EPW files in the folder INTERPLAY_EPW_DIR"]
fn real_epw_files_load_correctly() {
    let folder = std::env::var_os("INTERPLAY_EPW_DIR").expect("INTERPLAY_EPW_DIR names a folder");
    for (name, mean_c, first_c, last_c) in [
        ("SGP_Singapore.486980_IWEC.epw", Some(27.464), 24.7, 25.1),
        ("USA_CA_San.Francisco.Intl.AP.724940_TMY3.epw", None, 7.2, 11.1),
    ] {
        let bytes = std::fs::read(std::path::Path::new(&folder).join(name)).expect("the file is there");
        let text = String::from_utf8_lossy(&bytes);
        let epw = Epw::parse(&text).expect("a whole file");
        assert_eq!((epw.rows(), epw.is_leap()), (8760, false));
        let ambient_c = epw.weather().ambient_c;
        assert_eq!((ambient_c.at(HOUR_S), ambient_c.at(8760.0 * HOUR_S)), (first_c, last_c));
        if let Some(mean_c) = mean_c {
            assert!((ambient_c.mean() - mean_c).abs() < 5e-4, "{}", ambient_c.mean());
        }
    }
}
