//! Scenarios of CommonRoad: carried-over parts, places of errors, and no panics of the importer.

use std::fs;
use std::path::{Path, PathBuf};

use interplay_common::random::SplitMix64;
use interplay_planners::drivers::recorded::Record;
use interplay_planners::road::network::RightOfWay;
use interplay_scenarios::{
    ImportOptions, Imported, LoadError, Registry, Replacement, Scenario, files_below, import_commonroad, is_commonroad,
    load,
};
use miette::{GraphicalReportHandler, GraphicalTheme};

fn folder() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/cases/commonroad"))
}

fn text(file: &str) -> String {
    fs::read_to_string(folder().join(file)).expect("a case of this repository")
}

fn imported(file: &str) -> Imported {
    import_commonroad(file, &text(file), &ImportOptions::default()).expect("a sound scenario")
}

fn resolved(imported: &Imported) -> Scenario {
    imported.resolve(Registry::standard()).unwrap_or_else(|error| panic!("{error}: {:?}", error.faults()))
}

/// The error as the command shows it.
fn shown(error: &LoadError) -> String {
    let mut text = String::new();
    let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor()).with_width(160);
    handler.render_report(&mut text, error).expect("every error can be shown");
    text
}

#[test]
fn lanes_signs_vehicles_and_the_planning_problem_are_imported() {
    let imported = imported("motorway.xml");
    let scenario = resolved(&imported);
    let network = scenario.network.as_ref().expect("a network");
    let lane = |name: &str| network.lane(name).unwrap_or_else(|| panic!("no lane {name}"));
    assert_eq!(network.lanes().len(), 4);
    assert_eq!(lane("l1").successors, ["l3"]);
    assert_eq!(lane("l2").successors, ["l4"], "stated by its successor only");
    assert_eq!(lane("l1").speed_limit_mps, Some(27.78));
    assert!(lane("l1").left.as_ref().is_some_and(|left| left.lane == "l2" && left.may_change));
    assert!((lane("l1").half_width_m(50.0) - 1.75).abs() < 1e-9 && lane("l1").right.is_none());
    let names: Vec<&str> = scenario.vehicles.iter().map(|vehicle| vehicle.name.as_str()).collect();
    assert_eq!(names, ["ego", "car-21", "truck-22", "car-23", "parked-24"]);
    let later = scenario.vehicle("car-23").expect("a car that appears later");
    assert!(later.stay.enters_s.is_some_and(|enters_s| enters_s > 0.0));
    assert!(scenario.vehicle("parked-24").is_some_and(|parked| parked.obstacle.is_some()));
    let ego = scenario.ego().expect("an ego");
    assert_eq!((ego.start.x_m, ego.start.y_m, ego.start.speed_mps), (20.0, 1.75, 22.0));
    assert_eq!(ego.route.legs.last().map(|leg| leg.lane.as_str()), Some("l4"), "the lane of its goal");
    assert_eq!(ego.goal.speed_mps, Some(22.0), "its own, which the goal allows");
    assert_eq!((scenario.step_s, scenario.planning_period_s(), scenario.duration_s), (0.1, 0.2, 6.0));
    assert!(scenario.planning_period_s() * scenario.horizon_steps as f64 >= 8.0);
    let truck = scenario.vehicle("truck-22").expect("a truck");
    assert_eq!((truck.body.front_m + truck.body.rear_m, truck.body.width_m), (12.0, 2.5));
    for line in [
        "1 sign `277`: not carried over yet",
        "1 traffic light: left out",
        "1 obstacle that is not a rectangle: carried over as the box around it",
    ] {
        assert!(imported.notes.iter().any(|note| note.starts_with(line)), "no {line:?} in {:#?}", imported.notes);
    }
}

#[test]
fn the_ego_of_a_map_without_a_problem_starts_on_a_lane_for_vehicles() {
    let scenario = resolved(&imported("crosswalk-is-longest.xml"));
    let ego = scenario.ego().expect("an ego");
    assert_eq!(ego.route.legs.iter().map(|leg| leg.lane.as_str()).collect::<Vec<_>>(), ["l1"]);
}

/// The only successor begins at an angle of 45°, so that no route leads into it.
#[test]
fn the_ego_stops_where_its_route_ends_although_the_map_goes_on() {
    let bound = |side: &str, [from, to]: [[f64; 2]; 2]| {
        let points = [from, to].map(|[x, y]| format!("<point><x>{x}</x><y>{y}</y></point>"));
        format!("<{side}Bound>{}</{side}Bound>", points.concat())
    };
    let first = bound("left", [[0.0, 3.5], [60.0, 3.5]]) + &bound("right", [[0.0, 0.0], [60.0, 0.0]]);
    let next = bound("left", [[58.7, 3.0], [78.7, 23.0]]) + &bound("right", [[61.3, 0.5], [81.3, 20.5]]);
    let goes_on = |next: &str| {
        format!(
            "<commonRoad timeStepSize=\"0.1\" commonRoadVersion=\"2020a\" benchmarkID=\"ZAM_Own-3_1_T-1\">\
             <lanelet id=\"1\">{first}{next}</lanelet></commonRoad>"
        )
    };
    let stops = |text: &str| {
        let imported = import_commonroad("own", text, &ImportOptions::default()).expect("a sound scenario");
        let is_noted = imported.notes.iter().any(|note| note.contains("the ego stops there"));
        let stops = resolved(&imported).ego().expect("an ego").stay.stops_at_end;
        assert_eq!(stops, is_noted, "{:?}", imported.notes);
        stops
    };
    let turns = format!("<successor ref=\"2\"/></lanelet><lanelet id=\"2\">{next}");
    assert!(stops(&goes_on(&turns)) && !stops(&goes_on("")));
}

/// Without a planning problem, `--planner` drives the first vehicle, which needs the lanes of its record.
#[test]
fn the_first_record_of_a_map_without_an_ego_has_a_route() {
    let (text, [begin, end]) = (text("motorway.xml"), ["<planningProblem", "</planningProblem>"]);
    let [from, to] = [text.find(begin), text.find(end).map(|at| at + end.len())].map(|at| at.expect("a problem"));
    let text = format!("{}{}", &text[..from], &text[to..]);
    let imported = import_commonroad("own", &text, &ImportOptions::default()).expect("a sound scenario");
    assert_eq!(imported.file.vehicles[0].route, ["l1", "l3"]);
    assert_eq!(resolved(&imported).vehicles[0].name, "car-21");
}

#[test]
fn the_plaque_of_an_all_way_stop_is_read() {
    let imported = imported("all-way-stop.xml");
    assert!(!imported.notes.iter().any(|note| note.contains("R1-3")), "{:?}", imported.notes);
    let scenario = resolved(&imported);
    let network = scenario.network.as_ref().expect("a network");
    assert_eq!(network.lane("l1").map(|lane| lane.right_of_way), Some(RightOfWay::AllWayStop));
}

/// Coordinates of UTM are moved; the records are those of the file, to the rounding of a table.
#[test]
fn distant_maps_are_moved_near_the_origin_with_all_their_objects() {
    let imported = imported("tee-in-utm.xml");
    let scenario = resolved(&imported);
    let car = scenario.vehicle("car-7").expect("a car");
    assert_eq!((car.start.x_m, car.start.y_m), (-60.0, -1.75));
    let record = car.driver.record().expect("a record");
    let [x_m, y_m] = record.state_at(1.1).expect("within the record").position();
    assert!((x_m - (2.4 * 5.5 - 60.0)).abs() < 1e-4 && (y_m + 1.75).abs() < 1e-4, "between two steps: {x_m}, {y_m}");
    assert!(imported.notes.iter().any(|note| note.contains("(-691000, -5336000) m")), "{:?}", imported.notes);
    assert!(imported.notes.iter().any(|note| note.starts_with("1 stop line without a sign")));
    let parked = scenario.vehicle("parked-8").expect("a parked car");
    assert!((parked.start.y_m + 39.8).abs() < 1e-3, "its box is 0.2 m ahead of its position: {:?}", parked.start);
    assert_eq!(scenario.ego().and_then(|ego| ego.route.legs.last()).map(|leg| leg.lane.as_str()), Some("l103"));
}

/// A scenario with its records in a table beside it equals the scenario with the records in it.
#[test]
fn a_scenario_written_to_files_is_the_same_scenario() {
    for file in ["motorway.xml", "tee-in-utm.xml"] {
        let imported = imported(file);
        let place = tempfile::tempdir().expect("a folder");
        let (scenario, rows) = imported.with_records_in("records.csv");
        fs::write(place.path().join("records.csv"), rows.expect("records")).expect("written");
        let path = place.path().join("scenario.toml");
        fs::write(&path, scenario.to_toml()).expect("written");
        let read = load(&path.to_string_lossy(), &[]).unwrap_or_else(|error| panic!("{}", shown(&error)));
        assert_eq!(read, resolved(&imported), "{file}");
        assert_eq!(read, load(&folder().join(file).to_string_lossy(), &[]).expect("XML as it is"), "{file}");
        // And its whole statement reads back, too.
        assert_eq!(read.to_file().resolve().expect("stated"), read, "{file}");
    }
}

#[test]
fn drivers_of_interplay_can_replace_records() {
    let replace = |vehicle: Option<&str>, kind: &str, style: Option<&str>| {
        let [vehicle, style] = [vehicle, style].map(|word| word.map(str::to_owned));
        Replacement { vehicle, kind: kind.to_owned(), style }
    };
    let options = ImportOptions {
        ego: Some("negotiation".to_owned()),
        replace: vec![replace(None, "human", Some("tough")), replace(Some("22"), "idm", None)],
    };
    let imported = import_commonroad("motorway.xml", &text("motorway.xml"), &options).expect("a sound scenario");
    let scenario = resolved(&imported);
    let kinds: Vec<&str> = scenario.vehicles.iter().map(|vehicle| vehicle.driver.kind()).collect();
    assert_eq!(kinds, ["negotiation", "human", "idm", "human", "recorded"], "what stands goes on standing");
    let unknown = ImportOptions { replace: vec![replace(Some("99"), "idm", None)], ..ImportOptions::default() };
    let error = import_commonroad("motorway.xml", &text("motorway.xml"), &unknown).expect_err("no such vehicle");
    assert!(shown(&error).contains("no obstacle `99`"));
}

/// Errors that the importer finds, and those that the scenario has later, are at elements of the XML.
#[test]
fn errors_are_located_in_the_imported_file() {
    let motorway = text("motorway.xml");
    let cases = [
        ("commonRoadVersion=\"2020a\"", "commonRoadVersion=\"2017a\"", "version `2017a`"),
        ("timeStepSize=\"0.1\"", "timeStepSize=\"0\"", "`timeStepSize` is 0"),
        ("</commonRoad>", "", "not valid XML"),
        ("<x>25.0000</x>", "<x>25 m</x>", "`x` is `25 m`"),
        ("<lanelet id=\"2\">", "<lanelet id=\"1\">", "two lanelets"),
        ("<rightBound>", "<middle>", "not valid XML"),
        ("<length>4.6</length>", "<length>-4.6</length>", "`length` is -4.6"),
        ("<dynamicObstacle id=\"21\">", "<obstacle id=\"21\">", "not valid XML"),
    ];
    for (stated, instead, fragment) in cases {
        let wrong = motorway.replacen(stated, instead, 1);
        assert_ne!(wrong, motorway, "{stated}");
        let error = import_commonroad("motorway.xml", &wrong, &ImportOptions::default()).expect_err(instead);
        let text = shown(&error);
        assert!(text.contains(fragment) && text.contains("motorway.xml:"), "{instead}: {text}");
    }
    // An unknown driver is reported at the planning problem.
    let options = ImportOptions { ego: Some("humane".to_owned()), ..ImportOptions::default() };
    let imported = import_commonroad("motorway.xml", &motorway, &options).expect("as far as the importer sees");
    let error = imported.resolve(Registry::standard()).expect_err("no such driver");
    let line = motorway.lines().position(|line| line.contains("<planningProblem")).map(|line| line + 1);
    assert_eq!(error.faults()[0].line_and_column().map(|(line, _)| line), line, "{}", shown(&error));
}

#[test]
fn a_folder_lists_scenarios_of_commonroad_and_no_other_xml() {
    let place = tempfile::tempdir().expect("a folder");
    let [scenario, report] = ["a.xml", "b.xml"].map(|name| place.path().join(name));
    fs::write(&scenario, text("motorway.xml")).expect("written");
    fs::write(&report, "<testsuites/>").expect("written");
    assert!(is_commonroad(&scenario) && !is_commonroad(&report));
    assert_eq!(scenarios_of(place.path()), [(scenario, false)]);
}

/// The scenarios of a folder, and whether others extend them.
fn scenarios_of(folder: &Path) -> Vec<(PathBuf, bool)> {
    let found = files_below(folder).expect("readable").scenarios;
    found.into_iter().map(|scenario| (scenario.path, scenario.is_extended)).collect()
}

#[test]
fn a_folder_tells_plans_and_extended_files_from_scenarios_and_leaves_out_sweeps() {
    let place = tempfile::tempdir().expect("a folder");
    let file = |name: &str, text: &str| {
        let path = place.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).and_then(|()| fs::write(&path, text)).expect("written");
        path
    };
    let base = file("base.toml", "title = 'a street'\n[road]\nkind = 'two-way'\n");
    let mine = file("sub/mine.toml", "extends = '../base.toml'\n[[vehicle]]\nname = 'ego'\n");
    let plan = file("plan.toml", "scenario = ['mine.toml']\nplanner = ['idm']\n");
    for inside in ["sweeps/quick/plan.toml", "sub/sweeps/copy.toml", ".venv/x.toml"] {
        file(inside, "scenario = ['mine.toml']\n");
    }
    assert_eq!(scenarios_of(place.path()), [(base, true), (mine, false)]);
    assert_eq!(files_below(place.path()).expect("readable").plans, [plan]);
}

/// Fragments that get further through the parser than random letters.
const PIECES: [&str; 20] = [
    "<",
    ">",
    "</x>",
    "-1",
    "0",
    "1e308",
    "NaN",
    "",
    "2020a",
    "<exact>",
    "ref=\"1\"",
    "id=\"1\"",
    "opposite",
    "\u{0}",
    "é",
    "<point><x>0</x><y>0</y></point>",
    "<rectangle/>",
    "<time><exact>-5</exact></time>",
    "99999999999",
    "<lanelet ref=\"4\"/>",
];

/// A text with a few mistakes. Some leave it well-formed: another value of an element or attribute, or an element that is left out or
/// doubled. Others leave out, double, reverse or replace any letters.
fn mutated(text: &str, random: &mut SplitMix64) -> String {
    let mut text = text.to_owned();
    let mut below = |most: usize| (random.uniform(0.0, 1.0) * most as f64) as usize % most.max(1);
    let breaks_form = below(3) == 0;
    for _ in 0..=below(3) {
        let starts: Vec<usize> = text.match_indices(['>', '"']).map(|(at, _)| at + 1).collect();
        let from = starts.get(below(starts.len())).copied().unwrap_or_default();
        let (to, instead) = if breaks_form {
            let to = text.ceil_char_boundary((from + [1, 4, 12, 60, 400][below(5)]).min(text.len()));
            let part = &text[from..to];
            let instead = match below(4) {
                0 => String::new(),
                1 => part.repeat(2),
                2 => part.chars().rev().collect(),
                _ => PIECES[below(PIECES.len())].to_owned(),
            };
            (to, instead)
        } else if below(2) == 0 {
            let to = text[from..].find(['<', '"']).map_or(from, |length| from + length);
            (to, VALUES[below(VALUES.len())].to_owned())
        } else {
            let Some((from, to)) = element_from(&text, from) else { continue };
            let instead = if below(3) > 0 { String::new() } else { text[from..to].repeat(2) };
            text.replace_range(from..to, &instead);
            continue;
        };
        text.replace_range(from..to, &instead);
    }
    text
}

const VALUES: [&str; 14] =
    ["-1", "0", "1", "2", "3", "103", "7.5", "1e9", "-200", "0.0001", "dynamic", "opposite", "solid", "pedestrian"];

/// The first element that begins after a place.
fn element_from(text: &str, from: usize) -> Option<(usize, usize)> {
    let begin = from
        + text[from..]
            .match_indices('<')
            .map(|(at, _)| at)
            .find(|at| text[from + at + 1..].starts_with(char::is_alphabetic))?;
    let name: String = text[begin + 1..].chars().take_while(|c| c.is_alphanumeric()).collect();
    let close = format!("</{name}>");
    let end = begin + text[begin..].find(&close)? + close.len();
    Some((begin, end))
}

#[test]
fn mutated_files_are_refused_with_a_place_or_are_scenarios() {
    let mut random = SplitMix64::new(46);
    let sound = ["motorway.xml", "tee-in-utm.xml"].map(text);
    let (mut refused, mut accepted) = (0, 0);
    for number in 0..300 {
        let text = mutated(&sound[number % 2], &mut random);
        let imported = import_commonroad("mutated.xml", &text, &ImportOptions::default());
        match imported.and_then(|imported| imported.resolve(Registry::standard())) {
            Ok(scenario) => {
                accepted += 1;
                assert!(!scenario.vehicles.is_empty());
                assert!(scenario.vehicles.iter().all(|vehicle| vehicle.start.position().iter().all(|x| x.is_finite())));
            }
            Err(error) => {
                refused += 1;
                let places = error.faults().iter().map(interplay_scenarios::Fault::line_and_column);
                assert!(places.into_iter().all(|place| place.is_some()), "{number}: {}", shown(&error));
            }
        }
    }
    assert!(refused > 60 && accepted > 60, "{refused} refused, {accepted} accepted");
}

/// A table of records is the record, to a tenth of a millimetre.
#[test]
fn a_table_of_records_equals_the_records_in_the_file() {
    let scenario = resolved(&imported("motorway.xml"));
    let record: Record = scenario.vehicle("truck-22").and_then(|truck| truck.driver.record()).expect("a record");
    for step in 0..=20 {
        let state = record.state_at(0.1 * f64::from(step)).expect("within the record");
        assert!((state.x_m - (10.0 + 1.8 * f64::from(step))).abs() < 1e-4 && state.speed_mps == 18.0);
    }
}
