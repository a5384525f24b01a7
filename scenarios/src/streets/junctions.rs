//! Streets with junctions.

use super::draft::{Draft, Draftee};

/// The arms of a junction with four of them, counter-clockwise.
const ARMS: [&str; 4] = ["south", "east", "north", "west"];

/// The names of the other vehicles.
const NAMES: [&str; 5] = ["a", "b", "c", "d", "e"];

/// Adds the ego on one arm and other vehicles on free arms, each to an arm that it can reach; `suffix` follows the words
/// for lanes that lead in and out.
fn approach(draft: &mut Draft, arms: &[&str], others: usize, suffix: &str, limit_mps: f64) {
    let mut free: Vec<&str> = arms.to_vec();
    for name in ["ego"].iter().chain(&NAMES).take(1 + others.min(arms.len() - 1)) {
        let from = free.remove(draft.count(0, free.len() - 1));
        let reachable: Vec<&str> = arms.iter().copied().filter(|arm| *arm != from).collect();
        let to = draft.one_of(&reachable);
        let (lane, goal) = (format!("{from}-in{suffix}"), format!("{to}-out{suffix}"));
        let speed_mps = draft.between(0.55, 0.95) * limit_mps;
        let along_m = draft.between(12.0, 48.0);
        drive_through(draft, name, [&lane, &goal], along_m, speed_mps, 0.9 * limit_mps);
    }
}

pub(super) fn ring(draft: &mut Draft) {
    let radius_m = draft.between(14.0, 26.0);
    draft.road(&format!("kind = \"roundabout\"\nlane_count = 1\nradius_m = {radius_m:.1}"));
    let others = draft.count(1, 3);
    approach(draft, &ARMS, others, "", 11.0);
}

/// A roundabout with two lanes; each vehicle stays in the outer one or the inner one.
pub(super) fn wide_ring(draft: &mut Draft) {
    let radius_m = draft.between(18.0, 28.0);
    draft.road(&format!("kind = \"roundabout\"\nlane_count = 2\nradius_m = {radius_m:.1}"));
    let others = draft.count(1, 3);
    approach(draft, &ARMS, others, "-0", 11.0);
}

/// A minor road that joins a main one.
pub(super) fn tee(draft: &mut Draft) {
    let rule = draft.one_of(&["yield", "stop"]);
    draft.road(&format!("kind = \"t-junction\"\nturning_lanes = false\nright_of_way = \"{rule}\""));
    let others = draft.count(1, 2);
    approach(draft, &["south", "east", "west"], others, "", 11.0);
}

/// A minor road that crosses a main one.
pub(super) fn crossing(draft: &mut Draft) {
    let rule = draft.one_of(&["yield", "stop"]);
    draft.road(&format!("kind = \"crossing\"\nminor = \"{rule}\""));
    let others = draft.count(1, 3);
    approach(draft, &ARMS, others, "", 11.0);
}

pub(super) fn all_way_stop(draft: &mut Draft) {
    draft.road("kind = \"all-way-stop\"");
    let others = draft.count(1, 3);
    approach(draft, &ARMS, others, "", 11.0);
}

/// A road whose two directions share one lane for a stretch.
pub(super) fn narrow_passage(draft: &mut Draft) {
    let direction = draft.one_of(&["east", "west"]);
    draft.road(&format!("kind = \"narrow-passage\"\npriority_to = \"{direction}\""));
    let limit_mps = 10.0;
    let (along_m, speed_mps) = (draft.between(10.0, 40.0), draft.between(0.6, 0.95) * limit_mps);
    draft.ego("east-in", along_m, speed_mps, Some("east-out"), 0.95 * limit_mps);
    let mut along_m = draft.between(20.0, 40.0);
    for name in NAMES.iter().take(draft.count(1, 2)) {
        let speed_mps = draft.between(0.6, 0.95) * limit_mps;
        draft.vehicle(Draftee {
            name,
            class: "car",
            lane: "west-in",
            along_m,
            speed_mps,
            to: Some("west-out"),
            wanted_mps: speed_mps,
            driver: None,
        });
        along_m -= 18.0;
    }
}

/// Four roads that meet without signs, all vehicles straight on: a vehicle from the right goes first.
pub(super) fn equal(draft: &mut Draft) {
    let limit_mps = [8.3, 13.9][draft.count(0, 1)];
    draft.road(&equal_roads(limit_mps, 100.0));
    let mut free = vec!["west", "east", "south", "north"];
    for name in ["ego"].iter().chain(&NAMES).take(draft.count(2, 4)) {
        let side = free.remove(draft.count(0, free.len() - 1));
        let (lane, goal) = (format!("{side}-in"), format!("{side}-out"));
        let (along_m, speed_mps) = (draft.between(40.0, 75.0), draft.between(0.5, 0.9) * limit_mps);
        drive_through(draft, name, [&lane, &goal], along_m, speed_mps, 0.9 * limit_mps);
    }
}

/// The lanes of four roads that meet without signs, straight on from each side; they reach this far from the middle \[m\].
pub(crate) fn equal_roads(limit_mps: f64, arm_m: f64) -> String {
    let lane = |name: &str, ends: [[f64; 2]; 2], more: &str| {
        let [[ax, ay], [bx, by]] = ends;
        let (mx, my) = (0.5 * (ax + bx), 0.5 * (ay + by));
        format!(
            "\n[[road.lane]]\nname = \"{name}\"\npoints = [[{ax:.2}, {ay:.2}], [{mx:.2}, {my:.2}], [{bx:.2}, {by:.2}]]\n\
             width_m = 3.5\nspeed_limit_mps = {limit_mps}\n{more}"
        )
    };
    // A lane from each side: its direction, and the side to its right on which it runs.
    let directions = [("west", [1.0, 0.0]), ("east", [-1.0, 0.0]), ("south", [0.0, 1.0]), ("north", [0.0, -1.0])];
    let mut lanes = String::from("kind = \"network\"\n");
    for (side, [dx, dy]) in directions {
        let place = |along_m: f64| [along_m * dx + 1.75 * dy, along_m * dy - 1.75 * dx];
        let next = |name: &str| format!("successors = [\"{side}-{name}\"]\n");
        let sign = "right_of_way = \"yield\"\n";
        lanes += &lane(&format!("{side}-in"), [place(-arm_m), place(-10.0)], &(next("over") + sign));
        lanes += &lane(&format!("{side}-over"), [place(-10.0), place(10.0)], &next("out"));
        lanes += &lane(&format!("{side}-out"), [place(10.0), place(arm_m)], "");
    }
    lanes
}

/// Adds a vehicle that drives from one lane to another: the ego, or one of the others.
fn drive_through(
    draft: &mut Draft,
    name: &str,
    [lane, goal]: [&str; 2],
    along_m: f64,
    speed_mps: f64,
    wanted_mps: f64,
) {
    if name == "ego" {
        draft.ego(lane, along_m, speed_mps, Some(goal), wanted_mps);
    } else {
        let (class, to, driver) = ("car", Some(goal), None);
        draft.vehicle(Draftee { name, class, lane, along_m, speed_mps, to, wanted_mps, driver });
    }
}
