//! Hours of zones by weekday: people and wanted temperatures.

use interplay_building::calendar::{Calendar, RunDays};
use interplay_building::comfort::{Agenda, Setpoints};
use interplay_building::occupancy::{Deviation, Occupancy};
use interplay_building::schedule::{DayChoice, Period, Timetable, ZoneSchedule};

const STEPS: usize = 48;
const STEP_S: f64 = 1800.0;

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
