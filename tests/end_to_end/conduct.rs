//! Conduct in reports: which vehicles wait and why, which are stuck, and whether the rules were kept.

use std::fs;

use interplay_scenarios::{from_text, load};
use serde_json::{Value, json};

use crate::command::{interplay, scratch};
use crate::film::{Film, film};

/// A street with a stop sign, and a car whose driver does nothing at all although it wants to drive.
const STREET: &str = "title = 'A street'
shows = 'A stop sign'
duration_s = 14.0
conduct = 'people'

[road]
kind = 'network'

[[road.lane]]
name = 'in'
points = [[-150.0, 0.0], [0.0, 0.0]]
width_m = 3.5
successors = ['out']
right_of_way = 'stop'

[[road.lane]]
name = 'out'
points = [[0.0, 0.0], [300.0, 0.0]]
width_m = 3.5

[[vehicle]]
name = 'ego'
class = 'car'
start = { lane = 'in', along_m = EGO_M, speed_mps = 10.0 }
goal = { lane = 'out', speed_mps = 10.0 }
driver = { kind = 'human' }

[[vehicle]]
name = 'idle'
class = 'car'
start = { lane = 'out', along_m = 200.0, speed_mps = 0.0 }
goal = { speed_mps = 8.0 }
driver = { kind = 'scripted' }

[expect]
rules_kept = true
";

fn street(ego_m: &str) -> Film {
    let text = STREET.replace("EGO_M", ego_m);
    film("street", from_text("street.toml", &text, &[]).unwrap_or_else(|error| panic!("{:?}", error.faults())))
}

/// Neither a vehicle that stops at a sign nor one that stands because of its script is deadlocked.
#[test]
fn the_report_names_standing_vehicles_with_reasons() {
    let film = street("70.0");
    let standing = |name: &str| &film.report.vehicle(name).expect("a vehicle").standing;
    assert!(
        standing("ego").iter().any(|wait| wait.reason == "sign" && wait.waits_for.is_empty()),
        "{:?}",
        standing("ego")
    );
    let [idle] = standing("idle").as_slice() else { panic!("{:?}", standing("idle")) };
    assert_eq!(idle.reason, "as its script says");
    assert!((idle.waited_s - 14.0).abs() < 1e-6, "{idle:?}");
    assert!(film.report.deadlocks.is_empty(), "{:?}", film.report.deadlocks);
    let number = |metric: &str| film.report.vehicle("idle").expect("a vehicle").metrics.number(metric);
    assert_eq!([number("deadlocks"), number("unexplained_standing_s")], [Some(0.0); 2]);
}

#[test]
fn the_command_reports_conduct_in_words_and_as_json() {
    let folder = scratch("conduct");
    fs::write(folder.join("street.toml"), STREET.replace("EGO_M", "70.0")).expect("a scratch file can be written");
    let said = interplay(&folder, &["run", "street.toml", "--no-record"]);
    assert_eq!(said.code, Some(0), "{}", said.stdout);
    for piece in ["ego stood ", " s (sign)", "idle stood 14.0 s (as its script says)", "ok   rules_kept"] {
        assert!(said.stdout.contains(piece), "{piece:?} is not in\n{}", said.stdout);
    }
    let report = interplay(&folder, &["run", "street.toml", "--no-record", "--json"]).json();
    assert_eq!([&report["deadlocks"], &report["broken_rules"]], [&json!([]), &json!([])], "none, but stated");
    assert_eq!(report["vehicles"][1]["standing"][0]["reason"], "as its script says");
    // 8 m before the line no vehicle can stop from 10 m/s.
    fs::write(folder.join("street.toml"), STREET.replace("EGO_M", "140.0")).expect("a scratch file can be written");
    let broken = interplay(&folder, &["run", "street.toml", "--no-record", "--json"]);
    assert_eq!(broken.code, Some(1), "{}", broken.stdout);
    let rule = broken.json()["broken_rules"][0].clone();
    assert_eq!([&rule["vehicle"], &rule["rule"], &rule["lane"]], ["ego", "stop-sign", "in"], "{rule}");
    // Its middle, when its front has passed the line at 150 m.
    assert!((147.0..150.0).contains(&rule["along_m"].as_f64().expect("a number")), "{rule}");
    let said = interplay(&folder, &["run", "street.toml", "--no-record"]).stdout;
    assert!(said.contains(" s: ego passed the stop sign of lane in without standing\n"), "{said}");
    let expectations = broken.json()["expectations"].clone();
    let wanted: Value = json!([{
        "what": "rules_kept", "want": true, "got": { "rules_broken": { "ego": 1 } }, "passed": false
    }]);
    assert_eq!(expectations, wanted);
}

/// A bus at its stop and a car whose record pauses: neither is deadlocked, nor what waits behind them.
#[test]
fn vehicles_that_stand_as_their_script_or_record_says_are_not_deadlocked() {
    for (name, vehicle, reason) in
        [("bus-stop-no-deadlock", "bus", "as its script says"), ("pause", "front", "as its record says")]
    {
        let path = format!("{}/cases/streets2/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let film = film(name, load(&path, &[]).unwrap_or_else(|error| panic!("{:?}", error.faults())));
        assert!(film.report.deadlocks.is_empty(), "{name}: {:?}", film.report.deadlocks);
        let standing = &film.report.vehicle(vehicle).expect("a vehicle").standing;
        assert!(standing.iter().any(|wait| wait.reason == reason && wait.waited_s > 10.0), "{name}: {standing:?}");
    }
}

/// A driver that waits for an oncoming car before it passes a van names that car.
#[test]
fn a_waiting_vehicle_names_the_vehicle_that_it_waits_for() {
    let text = include_str!("../cases/streets/d-parked.toml").replace("negotiation", "human");
    let film = film("parked", from_text("parked.toml", &format!("conduct = 'people'\n{text}"), &[]).expect("sound"));
    let standing = &film.report.vehicle("ego").expect("an ego").standing;
    let for_oncoming = standing.iter().find(|wait| wait.waits_for == ["oncoming"]);
    let wait = for_oncoming.unwrap_or_else(|| panic!("{standing:?}"));
    assert_eq!(wait.reason, "before it passes parked");
    assert!(film.report.deadlocks.is_empty(), "{:?}", film.report.deadlocks);
}
