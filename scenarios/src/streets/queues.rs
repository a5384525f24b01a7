//! Streets on which vehicles wait in a queue: at a light, at a zebra crossing, behind a turning vehicle, behind a junction.

use super::draft::{Draft, Draftee};

/// The names of the vehicles ahead of the ego, from the front of the queue.
const AHEAD: [&str; 3] = ["first", "second", "third"];

/// The names of oncoming vehicles.
const ONCOMING: [&str; 4] = ["west-a", "west-b", "west-c", "west-d"];

/// The beginning and the end of a straight street of two lanes along x \[m\].
pub(crate) const STREET_M: f64 = 200.0;
/// The front of a column is at least this far before the end of its lane \[m\].
const LINE_M: f64 = 5.0;

fn car<'a>(name: &'a str, lane: &'a str, along_m: f64, speed_mps: f64, to: Option<&'a str>) -> Draftee<'a> {
    Draftee { name, class: "car", lane, along_m, speed_mps, to, wanted_mps: speed_mps, driver: None }
}

/// A street with a lane in each direction, each of which may use the other; all lanes end at the middle and go on behind it.
pub(crate) fn street(draft: &mut Draft, limit_mps: f64) {
    let lane = |draft: &mut Draft, name: &str, from_m: f64, to_m: f64, next: Option<&str>, beside: &str| {
        let y_m = if to_m > from_m { -1.75 } else { 1.75 };
        let next = next.map(|name| format!("successors = [\"{name}\"]\n")).unwrap_or_default();
        let more = format!("{next}left = {{ lane = \"{beside}\", oncoming = true }}\nspeed_limit_mps = {limit_mps:.1}");
        draft.lane(name, [[from_m, y_m], [to_m, y_m]], 3.5, &more);
    };
    draft.road("kind = \"network\"");
    lane(draft, "east-in", -STREET_M, 0.0, Some("east-out"), "west-out");
    lane(draft, "east-out", 0.0, STREET_M, None, "west-in");
    lane(draft, "west-in", STREET_M, 0.0, Some("west-out"), "east-out");
    lane(draft, "west-out", 0.0, -STREET_M, None, "east-in");
}

/// Adds the ego and one to three vehicles ahead of it on lane `east-in`; the first is `front_m` along it.
fn column(draft: &mut Draft, front_m: f64, limit_mps: f64) {
    let mut along_m = front_m;
    let count = draft.count(1, 3);
    for name in AHEAD.iter().take(count) {
        let speed_mps = draft.between(0.7, 0.9) * limit_mps;
        draft.vehicle(car(name, "east-in", along_m, speed_mps, Some("east-out")));
        along_m -= draft.between(16.0, 30.0);
    }
    let speed_mps = draft.between(0.7, 0.95) * limit_mps;
    draft.ego("east-in", along_m, speed_mps, Some("east-out"), 0.95 * limit_mps);
}

/// Adds up to four oncoming vehicles.
fn oncoming(draft: &mut Draft, lane: &str, to: &str, limit_mps: f64) {
    let mut along_m = draft.between(5.0, 60.0);
    let count = draft.count(0, 4);
    for name in ONCOMING.iter().take(count) {
        let speed_mps = draft.between(0.7, 0.95) * limit_mps;
        draft.vehicle(car(name, lane, along_m, speed_mps, Some(to)));
        along_m += draft.between(20.0, 60.0);
    }
}

/// What a street with a queue expects: no vehicle passes it by leaving its lane.
fn expect_queue(draft: &mut Draft) {
    draft.expect("rules_kept = true");
    draft.expect_at_most("oncoming_past_queue_s", None, 0.0);
}

/// Vehicles ahead of the ego wait at a red light; the oncoming lane may be free.
pub(super) fn light(draft: &mut Draft) {
    let limit_mps = [8.3, 13.9][draft.count(0, 1)];
    draft.duration_s = 60.0;
    street(draft, limit_mps);
    let (red_s, green_s) = (draft.between(14.0, 30.0), draft.between(20.0, 40.0));
    draft.table(&format!(
        "[[light]]\nname = \"light\"\nlanes = [\"east-in\", \"west-in\"]\nphases = [{{ colour = \"red\", duration_s = {red_s:.1} }}, \
         {{ colour = \"green\", duration_s = {green_s:.1} }}, {{ colour = \"amber\", duration_s = 3.0 }}]"
    ));
    let front_m = draft.between(100.0, 180.0);
    column(draft, front_m, limit_mps);
    oncoming(draft, "west-in", "west-out", limit_mps);
    expect_queue(draft);
}

/// Vehicles ahead of the ego let pedestrians cross.
pub(super) fn zebra(draft: &mut Draft) {
    let limit_mps = [8.3, 13.9][draft.count(0, 1)];
    draft.duration_s = 50.0;
    street(draft, limit_mps);
    let x_m = draft.between(-40.0, 40.0);
    let path = "users = [\"pedestrian\"]\n";
    draft.lane("pavement", [[x_m, 14.0], [x_m, 5.0]], 2.5, &format!("{path}successors = [\"zebra\"]"));
    draft.lane("zebra", [[x_m, 5.0], [x_m, -5.0]], 2.5, &format!("{path}zebra = true\nsuccessors = [\"opposite\"]"));
    draft.lane("opposite", [[x_m, -5.0], [x_m, -14.0]], 2.5, path);
    let front_m = (STREET_M + x_m - draft.between(30.0, 60.0)).min(STREET_M - LINE_M);
    column(draft, front_m, limit_mps);
    let mut along_m = draft.between(4.5, 8.0);
    let count = draft.count(1, 3);
    for name in ["walker", "second-walker", "third-walker"].iter().take(count) {
        let speed_mps = draft.between(0.8, 1.5);
        let style = draft.one_of(&["careful", "normal", "bold"]);
        draft.vehicle(Draftee {
            class: "pedestrian",
            driver: Some(format!("{{ kind = \"walker\", style = \"{style}\" }}")),
            ..car(name, "pavement", along_m, speed_mps, Some("opposite"))
        });
        along_m -= draft.between(1.2, 2.0);
    }
    if draft.chance(0.5) {
        oncoming(draft, "west-in", "west-out", limit_mps);
    }
    expect_queue(draft);
}

/// Vehicles ahead of the ego wait for oncoming traffic before one of them turns left.
pub(super) fn turn(draft: &mut Draft) {
    let limit_mps = draft.between(9.0, 13.9);
    draft.duration_s = 60.0;
    let radius_m = 9.75;
    draft.road("kind = \"network\"");
    let limit = format!("speed_limit_mps = {limit_mps:.1}\n");
    let next = |names: &str| format!("successors = [{names}]\n{limit}");
    let beside = |name: &str| format!("left = {{ lane = \"{name}\", oncoming = true }}\n");
    let on = |ax: f64, bx: f64| if bx > ax { [[ax, -1.75], [bx, -1.75]] } else { [[ax, 1.75], [bx, 1.75]] };
    draft.lane("east-in", on(-150.0, -8.0), 3.5, &(next("\"left\", \"east\"") + &beside("west-out")));
    draft.lane("east", on(-8.0, 8.0), 3.5, &next("\"east-out\""));
    draft.lane("east-out", on(8.0, 150.0), 3.5, &(limit.clone() + &beside("west-in")));
    draft.lane("west-in", on(150.0, 8.0), 3.5, &(next("\"west\"") + &beside("east-out")));
    draft.lane("west", on(8.0, -8.0), 3.5, &next("\"west-out\""));
    draft.lane("west-out", on(-8.0, -150.0), 3.5, &(limit.clone() + &beside("east-in")));
    draft.road(&format!(
        "\n[[road.lane]]\nname = \"left\"\nstart = {{ x_m = -8.0, y_m = -1.75, heading_deg = 0.0 }}\n\
         pieces = [{{ turn_deg = 90.0, radius_m = {radius_m} }}]\nwidth_m = 3.5\nspeed_limit_mps = 5.5\nsuccessors = [\"north-out\"]"
    ));
    draft.lane("north-out", [[radius_m - 8.0, radius_m - 1.75], [radius_m - 8.0, 100.0]], 3.5, &limit);
    let (mut along_m, count) = (draft.between(90.0, 125.0), draft.count(1, 3));
    for (place, name) in AHEAD.iter().take(count).enumerate() {
        let to = if place == 0 { "north-out" } else { "east-out" };
        let speed_mps = draft.between(0.5, 0.8) * limit_mps;
        draft.vehicle(Draftee { wanted_mps: 0.9 * limit_mps, ..car(name, "east-in", along_m, speed_mps, Some(to)) });
        along_m -= draft.between(16.0, 26.0);
    }
    let speed_mps = draft.between(0.6, 0.9) * limit_mps;
    draft.ego("east-in", along_m, speed_mps, Some("east-out"), 0.95 * limit_mps);
    let mut along_m = draft.between(95.0, 125.0);
    let count = draft.count(2, 4);
    for name in ONCOMING.iter().take(count) {
        let speed_mps = draft.between(0.7, 0.9) * limit_mps;
        draft.vehicle(car(name, "west-in", along_m, speed_mps, Some("west-out")));
        along_m -= draft.between(18.0, 28.0);
    }
    expect_queue(draft);
}

/// The light is green, but the queue behind the junction stands; the side street has green later.
pub(super) fn keep_clear(draft: &mut Draft) {
    let limit_mps = draft.between(10.0, 13.9);
    draft.duration_s = 60.0;
    draft.road("kind = \"network\"");
    let limit = format!("speed_limit_mps = {limit_mps:.1}\n");
    let next = |name: &str| format!("successors = [\"{name}\"]\n{limit}");
    draft.lane("main-in", [[-130.0, 0.0], [-8.0, 0.0]], 3.5, &next("main"));
    draft.lane("main", [[-8.0, 0.0], [8.0, 0.0]], 3.5, &next("main-out"));
    draft.lane("main-out", [[8.0, 0.0], [200.0, 0.0]], 3.5, &limit);
    draft.lane("side-in", [[0.0, -90.0], [0.0, -8.0]], 3.5, &(next("side") + "right_of_way = \"yield\""));
    draft.lane("side", [[0.0, -8.0], [0.0, 8.0]], 3.5, &next("side-out"));
    draft.lane("side-out", [[0.0, 8.0], [0.0, 90.0]], 3.5, &limit);
    let green_s = draft.between(8.0, 14.0);
    draft.table(&format!(
        "[[light]]\nname = \"main\"\nlanes = [\"main-in\"]\nphases = [{{ colour = \"green\", duration_s = {green_s:.1} }}, \
         {{ colour = \"amber\", duration_s = 3.0 }}, {{ colour = \"red\", duration_s = 100.0 }}]\n\n\
         [[light]]\nname = \"side\"\nlanes = [\"side-in\"]\nphases = [{{ colour = \"red\", duration_s = {:.1} }}, \
         {{ colour = \"green\", duration_s = 100.0 }}]",
        green_s + 5.0
    ));
    // The last vehicle of the queue stands with less than a car's length behind it, or with room for one or two.
    let (mut along_m, from_s) = (draft.between(3.0, 16.0), draft.between(25.0, 40.0));
    for name in ["queue-a", "queue-b"].iter().take(draft.count(1, 2)) {
        let script = format!(
            "{{ kind = \"scripted\", script = [{{ speed_mps = 0.0 }}, {{ from_s = {from_s:.1}, speed_mps = 9.0, acceleration_mps2 = 1.2 }}] }}"
        );
        draft.vehicle(Draftee { wanted_mps: 9.0, driver: Some(script), ..car(name, "main-out", along_m, 0.0, None) });
        along_m += draft.between(7.0, 9.0);
    }
    let (along_m, speed_mps) = (draft.between(70.0, 95.0), draft.between(0.7, 0.9) * limit_mps);
    draft.vehicle(car("ahead", "main-in", along_m, speed_mps, Some("main-out")));
    let (behind_m, speed_mps) = (draft.between(18.0, 40.0), draft.between(0.7, 0.95) * limit_mps);
    draft.ego("main-in", along_m - behind_m, speed_mps, Some("main-out"), 0.95 * limit_mps);
    let mut along_m = draft.between(25.0, 60.0);
    for name in ["side-a", "side-b"].iter().take(draft.count(1, 2)) {
        let speed_mps = draft.between(0.5, 0.8) * limit_mps;
        draft.vehicle(car(name, "side-in", along_m, speed_mps, Some("side-out")));
        along_m -= draft.between(12.0, 20.0);
    }
    draft.expect("rules_kept = true");
    draft.expect_at_most("blocks_junction_s", None, 0.0);
}

/// The ego turns right; a cyclist beside it rides straight on.
pub(super) fn beside(draft: &mut Draft) {
    let limit_mps = draft.between(9.0, 13.9);
    let radius_m = draft.between(8.0, 12.0);
    draft.road("kind = \"network\"");
    let next = |name: &str| format!("successors = [\"{name}\"]\nspeed_limit_mps = {limit_mps:.1}");
    draft.lane("east-in", [[-140.0, -1.75], [-10.0, -1.75]], 3.5, &next("right"));
    draft.road(&format!(
        "\n[[road.lane]]\nname = \"right\"\nstart = {{ x_m = -10.0, y_m = -1.75, heading_deg = 0.0 }}\n\
         pieces = [{{ turn_deg = -90.0, radius_m = {radius_m:.1} }}]\nwidth_m = 3.5\nspeed_limit_mps = 5.5\n\
         successors = [\"south-out\"]"
    ));
    let (x_m, y_m) = (radius_m - 10.0, -1.75 - radius_m);
    draft.lane("south-out", [[x_m, y_m], [x_m, -100.0]], 3.5, &format!("speed_limit_mps = {limit_mps:.1}"));
    draft.lane("track", [[-140.0, -4.6], [80.0, -4.6]], 1.8, "users = [\"bicycle\"]");
    let (along_m, speed_mps) = (draft.between(30.0, 80.0), draft.between(0.6, 0.9) * limit_mps);
    draft.ego("east-in", along_m, speed_mps, Some("south-out"), 0.95 * limit_mps);
    // Of the ego, which slows down to turn, the cyclist is somewhat ahead, beside or somewhat behind when both are at the corner.
    let mut ahead_m = draft.between(-10.0, 25.0);
    for name in ["cyclist", "second-cyclist"].iter().take(draft.count(1, 2)) {
        let speed_mps = draft.between(3.5, 7.0);
        let style = draft.one_of(&["nice", "normal", "tough"]);
        let driver = Some(format!("{{ kind = \"human\", style = \"{style}\" }}"));
        draft.vehicle(Draftee { class: "bicycle", driver, ..car(name, "track", along_m + ahead_m, speed_mps, None) });
        ahead_m -= draft.between(6.0, 15.0);
    }
    draft.expect("rules_kept = true");
}
