//! Measures of a building agree with its frames.

use std::ops::Range;
use std::sync::{Arc, Mutex};

use interplay_scenarios::{Override, load};
use interplay_simulation::frame::Frame;
use interplay_simulation::report::BuildingReport;
use interplay_simulation::run::run;
use interplay_simulation::watch::{WatchError, Watcher};

struct Film(Arc<Mutex<Vec<Frame>>>);

impl Watcher for Film {
    fn tick(&mut self, frame: &Frame) -> Result<(), WatchError> {
        self.0.lock().expect("no thread panics").push(frame.clone());
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), WatchError> {
        Ok(())
    }
}

/// A run with changes, and all its frames.
fn filmed(name: &str, changes: &[&str]) -> (BuildingReport, Vec<Frame>) {
    let changes: Vec<Override> = changes.iter().map(|change| Override::Set((*change).to_owned())).collect();
    let scenario = load(name, &changes).expect("authored");
    let film = Arc::new(Mutex::new(Vec::new()));
    let report = run(name, &scenario, vec![Box::new(Film(Arc::clone(&film)))]).expect("it runs");
    let frames = std::mem::take(&mut *film.lock().expect("no thread panics"));
    (report.building.expect("a building"), frames)
}

/// Heat before the first occupied time, summed from the frames. A frame shows the occupation at the beginning of its step.
#[test]
fn early_heat_is_the_heat_before_the_first_occupied_time() {
    let (report, frames) = filmed("building/distributed", &["iterations=3"]);
    assert_eq!(report.iterations.len(), 3);
    let steps_per_day = frames.len() / 3;
    let step_h = 24.0 / steps_per_day as f64;
    for (day, figures) in report.iterations.iter().enumerate() {
        let steps = frames[day * steps_per_day..][..steps_per_day].iter().map(|frame| frame.building.as_ref());
        let steps: Vec<_> = steps.map(|step| step.expect("a step of the building")).collect();
        let occupied = steps.iter().skip(1).position(|step| step.zones.iter().any(|zone| zone.band_k.is_some()));
        let early = &steps[..=occupied.expect("an occupied time")];
        let kwh: f64 = early.iter().flat_map(|step| &step.zones).map(|zone| zone.heat_kw.abs() * step_h).sum();
        assert!(day == 0 || kwh > 0.5, "{kwh} on day {day}");
        assert!((figures.early_kwh - kwh).abs() <= 1e-9 * kwh, "{kwh} and {}", figures.early_kwh);
        assert!(steps.iter().enumerate().all(|(at, step)| step.figures.is_some() == (at + 1 == steps_per_day)));
    }
    let (free, _) = filmed("building/four-room-pid", &["iterations=1"]);
    assert!(free.iterations[0].early_kwh < 1e-9, "no heat is requested at night");
}

#[test]
fn perfect_foresight_has_no_regret() {
    let (report, _) = filmed("building/four-room-pid", &["iterations=1", "controller.kind=clairvoyant"]);
    let regret = report.iterations[0].regret.expect("a small building");
    assert!(regret.abs() < 1e-3, "{regret}");
    let (pid, _) = filmed("building/four-room-pid", &["iterations=1"]);
    let (cost, regret) = (pid.iterations[0].figures.cost, pid.iterations[0].regret.expect("a small building"));
    assert!((cost - regret - report.iterations[0].figures.cost).abs() < 1e-3, "{cost}, {regret}");
}

/// The digest of each part changes with its inputs, and with no later part.
#[test]
fn building_digests_identify_the_part_that_differs() {
    let digests = |changes: &[&str]| filmed("building/four-room-pid", changes).0.digests;
    let (one, two) = (digests(&["iterations=1"]), digests(&["iterations=2"]));
    assert_ne!(one.disturbance, one.control);
    assert_ne!(one.control, one.balance);
    assert!(one.disturbance != two.disturbance && one.control != two.control && one.balance != two.balance);
    let other = digests(&["iterations=1", "controller.kind=thermostat"]);
    assert_eq!(one.disturbance, other.disturbance, "the weather is the same");
    assert!(one.control != other.control && one.balance != other.balance);
}

/// The first step that concerns any zones, with these zones.
fn first(mut steps: Range<usize>, zones: impl Fn(usize) -> Vec<usize>) -> (usize, Vec<usize>) {
    let found = steps.find_map(|at| Some((at, zones(at))).filter(|(_, zones)| !zones.is_empty()));
    found.expect("it happens every day")
}

/// Events of each day in the log: the first time that heat is at its limit, and that an occupied zone is not comfortable, with
/// the time at the end of the step.
#[test]
fn the_log_names_the_events_that_begin_on_a_day() {
    let (report, frames) = filmed("building/four-room-pid", &["iterations=2", "controller.proportional_kw_per_k=9.0"]);
    let steps: Vec<_> = frames.iter().filter_map(|frame| frame.building.as_ref()).collect();
    let (steps_per_day, mut expected) = (steps.len() / 2, Vec::new());
    let most_kw = steps.iter().flat_map(|step| &step.zones).map(|zone| zone.heat_kw.abs()).fold(0.0, f64::max);
    for day in 0..2 {
        let at_limit = |at: usize| {
            let zones = steps[at].zones.iter().enumerate();
            zones.filter(|(_, zone)| zone.heat_kw.abs() == most_kw).map(|(index, _)| index).collect()
        };
        // A step has the targets of its beginning, so the next step has the targets of its end.
        let missed = |at: usize| {
            let wanted = steps.get(at + 1).map_or(&[][..], |next| &next.zones);
            let pairs = steps[at].zones.iter().zip(wanted).enumerate();
            let outside = pairs.filter(|(_, (zone, wanted))| {
                let (Some(wanted_c), Some(band_k)) = (wanted.reference_c, wanted.band_k) else { return false };
                (zone.next_c - wanted_c).abs() > band_k
            });
            outside.map(|(index, _)| index).collect()
        };
        let steps_of_day = day * steps_per_day..(day + 1) * steps_per_day;
        let begins = [
            ("heat at its limit in", first(steps_of_day.clone(), at_limit)),
            ("people there, and outside the comfort band", first(steps_of_day, missed)),
        ];
        for (text, (at, zones)) in begins {
            let minutes = (at % steps_per_day + 1) * 24 * 60 / steps_per_day;
            let names: Vec<&str> = zones.iter().take(3).map(|index| report.zone_names[*index].as_str()).collect();
            let more = if zones.len() > 3 { format!(" and {} more", zones.len() - 3) } else { String::new() };
            let when = format!("day {}, {}:{:02}", day + 1, minutes / 60, minutes % 60);
            expected.push((at, format!("{when}: {text} {}{more}", names.join(", "))));
        }
    }
    let said = frames.iter().enumerate().flat_map(|(at, frame)| frame.events.iter().map(move |event| (at, event)));
    let mut said: Vec<(usize, String)> = said.map(|(at, event)| (at, event.text.clone())).collect();
    said.retain(|(_, text)| text.contains("limit in") || text.contains("people there"));
    said.sort();
    expected.sort();
    assert_eq!(said, expected);
}
