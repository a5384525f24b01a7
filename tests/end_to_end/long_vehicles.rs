//! Lorries and buses in turns, vehicles on ramps, scripts that lead through obstacles.

use interplay_scenarios::{Override, Scenario, from_text};
use rayon::prelude::*;

use crate::film::{Film, film};

/// A vehicle is off the road from 3 % of its width on: 8 cm of a lorry.
const OFF_ROAD_M: f64 = 0.08;

fn scenario(text: &str) -> Scenario {
    from_text("long.toml", text, &[]).unwrap_or_else(|error| panic!("{error}: {:?}", error.faults()))
}

/// A vehicle that turns alone: road, lane of the start, lane of the goal, class and driver.
fn turning(road: &str, [from, to]: [&str; 2], class: &str, driver: &str) -> String {
    format!(
        "title = \"A turn\"\nshows = \"A long vehicle turns\"\nduration_s = 30.0\nroad = {road}\n[[vehicle]]\nname = \"ego\"\nclass = \
         \"{class}\"\nstart = {{ lane = \"{from}\", along_m = 45.0, speed_mps = 8.0 }}\ngoal = {{ lane = \"{to}\", speed_mps = 10.0 }}\n\
         driver = {{ kind = \"{driver}\" }}\n"
    )
}

/// By how much a vehicle left the road at most \[m\].
fn off_road_m(film: &Film, name: &str) -> f64 {
    let vehicle = film.report.vehicles.iter().find(|vehicle| vehicle.name == name);
    vehicle.and_then(|vehicle| vehicle.metrics.number("off_road_m")).expect("it was measured")
}

fn remarks(scenario: &Scenario) -> String {
    scenario.remarks.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

/// Alone, at both radii, they come round within the road.
#[test]
fn lorries_and_buses_come_round_junctions_and_rings() {
    let turns = [["west-in", "south-out"], ["east-in", "south-out"], ["south-in", "west-out"]];
    let roads = ["t-junction", "crossing", "all-way-stop"].iter().flat_map(|kind| {
        let at = |radius: &&str| format!("{{ kind = \"{kind}\", turn_radius_m = {radius} }}");
        ["9.0", "12.0"].iter().map(at).collect::<Vec<_>>()
    });
    let mut cases: Vec<(String, [&str; 2], &str, &str)> = Vec::new();
    for (number, road) in roads.enumerate() {
        for (place, turn) in turns.into_iter().enumerate() {
            let class = ["truck", "bus"][(number + place) % 2];
            // Of people, every third.
            let drivers: &[&str] = if (number + place) % 3 == 0 { &["idm", "human"] } else { &["idm"] };
            cases.extend(drivers.iter().map(|driver| (road.clone(), turn, class, *driver)));
        }
    }
    for (class, driver) in [("truck", "idm"), ("bus", "human")] {
        let ring = "{ kind = \"roundabout\", radius_m = 20.0, lane_count = 2 }".to_owned();
        cases.push((ring, ["west-in-0", "east-out-0"], class, driver));
    }
    let wrong: Vec<String> = cases
        .par_iter()
        .filter_map(|(road, turn, class, driver)| {
            let film = film("turn", scenario(&turning(road, *turn, class, driver)));
            let (off_m, speed_mps) = (off_road_m(&film, "ego"), film.report.vehicles[0].last.speed_mps);
            let is_round = film.report.vehicles[0].completed_s.is_some();
            (!is_round || off_m > OFF_ROAD_M).then(|| {
                format!("{road} {turn:?} {class} {driver}: {off_m} m off the road, round: {is_round}, {speed_mps} m/s")
            })
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// `check` names a radius with which the remark goes, and with a smaller one it stays.
#[test]
fn the_smallest_radius_that_is_named_works() {
    let road = |radius_m: f64| format!("{{ kind = \"t-junction\", turn_radius_m = {radius_m:.1} }}");
    let said = |radius_m: f64| remarks(&scenario(&turning(&road(radius_m), ["east-in", "south-out"], "bus", "human")));
    let tight = said(7.0);
    assert!(tight.contains("is too tight for the 12.1 m of vehicle `ego`"), "{tight}");
    let named = tight.split("road.turn_radius_m = ").nth(1).and_then(|rest| rest.split('`').next());
    let named_m: f64 = named.and_then(|radius_m| radius_m.parse().ok()).unwrap_or_else(|| panic!("{tight}"));
    assert!(!said(named_m).contains("too tight"), "{named_m} m: {}", said(named_m));
    assert!(said(named_m - 0.3).contains("too tight"), "{named_m} m is not the smallest");
}

/// A lorry that swings over the lane of a car waits until it is gone, and comes round.
#[test]
fn a_lorry_swings_over_the_oncoming_lane_while_it_is_free() {
    let road = "{ kind = \"t-junction\", turn_radius_m = 9.0 }";
    let car = "[[vehicle]]\nname = \"car\"\nclass = \"car\"\nstart = { lane = \"south-in\", along_m = 55.0, speed_mps = 8.0 }\ngoal = { \
               lane = \"west-out\", speed_mps = 10.0 }\n";
    let text = turning(road, ["west-in", "south-out"], "truck", "human") + car;
    let film = film("swing", scenario(&text));
    assert!(film.report.collisions.is_empty(), "{:?}", film.report.collisions);
    assert!(film.report.vehicles.iter().all(|vehicle| vehicle.completed_s.is_some()), "both get on");
}

/// Cars from a ramp fall in between those on the main road without standing, and without contact: they come with 15 m/s, as the curve of the
/// ramp permits, and want 25 m/s.
#[test]
fn no_vehicle_stands_at_the_end_of_a_ramp() {
    let mix = |_: f64| "{ share = 1.0, vehicle = { driver = { kind = \"idm\" } } }".to_owned();
    let text = two_flows(60.0, [1500, 700], &mix);
    assert_merges(&text, 7.0);
}

/// Two and a half minutes of people of five styles, a tenth of them with lorries, with 2,000 and 700 vehicles an hour. Who becomes slow for a
/// gap needs a longer one, so that those behind would queue: in runs of ten minutes, 77 of 111 stood.
#[test]
fn people_from_a_dense_ramp_keep_up_their_speed() {
    let person = |style: &str| format!("driver = {{ kind = \"human\", style = \"{style}\" }}");
    let mix = |speed_mps: f64| {
        let truck = format!("class = \"truck\", goal = {{ speed_mps = 21.0 }}, {}", person("normal"));
        let mut sorts =
            vec![format!("{{ share = 0.1, speed_mps = {:?}, vehicle = {{ {truck} }} }}", speed_mps.min(21.0))];
        let people = [("nice", 0.3), ("considerate", 0.2), ("normal", 0.2), ("assertive", 0.1), ("tough", 0.1)];
        sorts
            .extend(people.map(|(style, share)| format!("{{ share = {share:?}, vehicle = {{ {} }} }}", person(style))));
        sorts.join(", ")
    };
    assert_merges(&two_flows(150.0, [2000, 700], &mix), 5.0);
}

/// No vehicle touches another or becomes slower than a speed \[m/s\].
fn assert_merges(text: &str, least_mps: f64) {
    let changes = [Override::Set("budget.plans=1000000".to_owned())];
    let film = film("ramp", from_text("ramp.toml", text, &changes).unwrap_or_else(|error| panic!("{error}")));
    assert!(film.report.collisions.is_empty(), "{:?}", film.report.collisions);
    for vehicle in &film.report.vehicles {
        let slowest_mps = vehicle.metrics.number("min_speed_mps").unwrap_or(25.0);
        assert!(slowest_mps > least_mps, "{}: {slowest_mps} m/s", vehicle.name);
    }
}

/// An on-ramp and what comes on it and on the main road an hour; `mix` says of which sorts, at a speed \[m/s\].
fn two_flows(seconds: f64, [main_per_h, ramp_per_h]: [u32; 2], mix: &dyn Fn(f64) -> String) -> String {
    let flow = |name: &str, per_h: u32, from: &str, speed_mps: f64| {
        format!(
            "[[flow]]\nname = \"{name}\"\nvehicles_per_h = {per_h}\nfrom = {from}\nalong_m = 5.0\nspeed_mps = {speed_mps:?}\n\
             vehicle = {{ goal = {{ speed_mps = 25.0 }} }}\nmix = [{}]\n",
            mix(speed_mps)
        )
    };
    format!(
        "title = \"A ramp\"\nshows = \"Two flows merge\"\nduration_s = {seconds:?}\nroad = {{ kind = \"on-ramp\" }}\ndefaults = {{ class = \
         \"car\" }}\n{}{}to = [{{ lane = \"main-0\", share = 1.0 }}]\n",
        flow("main", main_per_h, "[\"main-0\", \"main-1\"]", 25.0),
        flow("ramp", ramp_per_h, "[\"ramp\"]", 15.0),
    )
}

/// The lanes of a crossing with lanes for turning leave a hole in its middle at this radius, which no kerb surrounds.
#[test]
fn holes_between_the_lanes_of_a_junction_are_paved() {
    let road = "{ kind = \"crossing\", turning_lanes = true, turn_radius_m = 8.0 }";
    let said = remarks(&scenario(&turning(road, ["south-in", "west-out"], "truck", "human")));
    assert!(!said.contains("too tight"), "{said}");
}

/// A curve of one lane with a radius in metres and a width.
fn curve(radius_m: f64, width_m: f64, driver: &str) -> String {
    let road = format!(
        "{{ kind = \"curve\", lane_count = 1, lane_width_m = {width_m:?}, pieces = [{{ straight_m = 80.0 }}, {{ turn_deg = 90.0, \
         radius_m = {radius_m:?} }}, {{ straight_m = 80.0 }}] }}"
    );
    let text = turning(&road, ["0", "0"], "truck", driver);
    text.replace("\"0\"", "0")
}

/// The mass centre of a lorry is beside the middle of the lane where the strip that it covers is in that middle.
#[test]
fn a_lorry_stays_on_the_road_in_a_curve() {
    for driver in ["idm", "human"] {
        let film = film("curve", scenario(&curve(15.0, 5.8, driver)));
        assert!(off_road_m(&film, "ego") <= OFF_ROAD_M, "{driver}: {} m", off_road_m(&film, "ego"));
    }
    let said = remarks(&scenario(&curve(100.0, 3.5, "human")));
    assert!(!said.contains("covers a width"), "{said}");
}

#[test]
fn a_script_that_leads_through_an_obstacle_is_remarked() {
    let street = |script: &str| {
        scenario(&format!(
            "title = \"A street\"\nshows = \"A script\"\nduration_s = 20.0\ndefaults = {{ class = \"car\" }}\nroad = {{ kind = \
             \"two-way\", length_m = 200.0 }}\n[[vehicle]]\nname = \"van\"\nstart = {{ lane = \"east\", along_m = 10.0, speed_mps = 8.0 \
             }}\ndriver = {{ kind = \"scripted\", script = [{script}] }}\n[[obstacle]]\nname = \"parked\"\nkind = \"parked-car\"\nlane = \
             \"east\"\nalong_m = 80.0\n"
        ))
    };
    let through = remarks(&street("{ from_s = 1.0, speed_mps = 8.0 }"));
    assert!(through.contains("the script of `van` leads through `parked`"), "{through}");
    for script in ["{ from_s = 2.0, lateral_m = 3.5 }", "{ from_s = 3.0, speed_mps = 0.0 }"] {
        assert!(!remarks(&street(script)).contains("leads through"), "{script}");
    }
}
