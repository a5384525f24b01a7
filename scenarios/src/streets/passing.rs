//! Streets on which vehicles overtake or change lanes.

use super::draft::{Draft, Draftee};

fn car<'a>(name: &'a str, lane: &'a str, along_m: f64, speed_mps: f64) -> Draftee<'a> {
    Draftee { name, class: "car", lane, along_m, speed_mps, to: None, wanted_mps: speed_mps, driver: None }
}

/// The names of the other vehicles.
const NAMES: [&str; 16] = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l", "m", "n", "o", "p"];

/// A slow vehicle on a country road, with none, one or two vehicles between it and the ego, and gaps in the oncoming traffic. Each
/// direction may use the lane of the other.
pub(super) fn overtake(draft: &mut Draft) {
    let (limit_mps, length_m) = (draft.between(20.0, 27.8), 1800.0);
    draft.duration_s = 60.0;
    draft.road("kind = \"network\"");
    let more =
        |beside: &str| format!("left = {{ lane = \"{beside}\", oncoming = true }}\nspeed_limit_mps = {limit_mps:.1}");
    draft.lane("east", [[0.0, -1.75], [length_m, -1.75]], 3.5, &more("west"));
    draft.lane("west", [[length_m, 1.75], [0.0, 1.75]], 3.5, &more("east"));
    let (own, theirs) = if draft.chance(0.5) { ("east", "west") } else { ("west", "east") };
    let slow_mps = draft.between(5.0, 13.0);
    let (mut along_m, between) = (draft.between(120.0, 160.0), draft.count(0, 2));
    let class = draft.one_of(&["truck", "van", "car", "bicycle"]);
    let slow_mps = if class == "bicycle" { slow_mps.min(7.0) } else { slow_mps };
    let driver = Some(format!("{{ kind = \"scripted\", script = [{{ speed_mps = {slow_mps:.1} }}] }}"));
    draft.vehicle(Draftee { class, driver, ..car("slow", own, along_m, slow_mps) });
    for name in &NAMES[..between] {
        along_m -= draft.between(20.0, 35.0);
        let wanted_mps = draft.between(1.1, 2.0) * slow_mps;
        draft.vehicle(Draftee { wanted_mps, ..car(name, own, along_m, slow_mps) });
    }
    along_m -= draft.between(25.0, 60.0);
    let speed_mps = draft.between(0.6, 0.9) * limit_mps;
    draft.ego(own, along_m, speed_mps, None, 0.95 * limit_mps);
    let mut along_m = draft.between(800.0, 1400.0);
    let count = draft.count(0, 5);
    for name in &NAMES[4..4 + count] {
        let speed_mps = draft.between(0.7, 0.95) * limit_mps;
        draft.vehicle(car(name, theirs, along_m, speed_mps));
        along_m -= draft.between(40.0, 300.0);
    }
    draft.expect("rules_kept = true");
}

/// Parallel lanes with vehicles that keep to different speeds, each in its own lane; the ego wants to stay in its lane, or another one.
pub(super) fn parallel(draft: &mut Draft) {
    let lanes = draft.count(2, 3);
    draft.road(&format!("kind = \"lanes\"\nlane_count = {lanes}\nlane_width_m = 3.5"));
    draft.duration_s = 30.0;
    let flow_mps = draft.between(8.0, 28.0);
    let (from, to) = (draft.count(0, lanes - 1), draft.count(0, lanes - 1));
    let (lane, goal) = (from.to_string(), to.to_string());
    let (speed_mps, wanted_mps) = (flow_mps + draft.between(-1.0, 1.0), draft.between(1.0, 1.2) * flow_mps);
    draft.ego(&lane, 100.0, speed_mps, Some(&goal), wanted_mps);
    let mut names = NAMES.iter();
    for index in 0..lanes {
        let (lane, gap_s) = (index.to_string(), draft.between(0.9, 2.2));
        let lane_mps = flow_mps + 1.0 * index as f64 + draft.between(-1.5, 1.5);
        let mut along_m = draft.between(10.0, 35.0);
        while along_m < 230.0 {
            let is_free = index != from || (along_m - 100.0_f64).abs() > 8.0 + gap_s * flow_mps;
            if let Some(name) = names.next().filter(|_| is_free) {
                let speed_mps = lane_mps + draft.between(-0.5, 0.5);
                draft.vehicle(car(name, &lane, along_m, speed_mps));
            }
            along_m += 6.0 + gap_s * flow_mps + draft.between(0.0, 40.0);
        }
    }
}

/// Three lanes of a motorway; the ego wants to be two lanes further.
pub(super) fn two_lanes(draft: &mut Draft) {
    let limit_mps = draft.between(22.0, 33.3);
    draft.duration_s = 45.0;
    draft.road("kind = \"network\"");
    let beside = [
        "left = { lane = \"middle\" }",
        "left = { lane = \"left\" }\nright = { lane = \"right\" }",
        "right = { lane = \"middle\" }",
    ];
    for (index, beside) in beside.iter().enumerate() {
        let y_m = 3.5 * index as f64;
        let more = format!("{beside}\nspeed_limit_mps = {limit_mps:.1}");
        draft.lane(["right", "middle", "left"][index], [[0.0, y_m], [2500.0, y_m]], 3.5, &more);
    }
    let flow_mps = draft.between(0.75, 0.95) * limit_mps;
    let (from, to) = if draft.chance(0.5) { ("right", "left") } else { ("left", "right") };
    let speed_mps = flow_mps + draft.between(-2.0, 2.0);
    draft.ego(from, 200.0, speed_mps, Some(to), 0.95 * limit_mps);
    let mut names = NAMES.iter();
    for (index, lane) in ["right", "middle", "left"].iter().enumerate() {
        let lane_mps = flow_mps + 2.0 * (index as f64 - 1.0);
        let mut along_m = draft.between(60.0, 110.0);
        while along_m < 380.0 {
            let is_free = *lane != from || (along_m - 200.0_f64).abs() > 35.0;
            if let Some(name) = names.next().filter(|_| is_free) {
                let speed_mps = lane_mps + draft.between(-1.0, 1.0);
                draft.vehicle(car(name, lane, along_m, speed_mps));
            }
            along_m += draft.between(30.0, 85.0);
        }
    }
    draft.expect("rules_kept = true");
    draft.expect("\n[[expect.completes]]\nvehicle = \"ego\"\nbefore_s = 40.0");
}
