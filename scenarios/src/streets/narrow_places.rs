//! Streets that parked vehicles make narrow.

use super::draft::{Draft, Draftee, Parked};

/// Width of a parked van, with mirrors \[m\].
const VAN_WIDTH_M: f64 = 2.1;

/// The ego on lane `east`, and up to four vehicles on lane `west`.
fn traffic(draft: &mut Draft, limit_mps: f64, oncoming: [usize; 2]) {
    let (along_m, speed_mps) = (draft.between(5.0, 30.0), draft.between(0.6, 0.9) * limit_mps);
    draft.ego("east", along_m, speed_mps, None, 0.95 * limit_mps);
    let mut along_m = draft.between(60.0, 85.0);
    let count = draft.count(oncoming[0], oncoming[1]);
    for name in ["west-a", "west-b", "west-c", "west-d"].iter().take(count) {
        let speed_mps = draft.between(0.7, 0.95) * limit_mps;
        draft.vehicle(Draftee {
            name,
            class: "car",
            lane: "west",
            along_m,
            speed_mps,
            to: None,
            wanted_mps: speed_mps,
            driver: None,
        });
        along_m -= draft.between(12.0, 18.0);
    }
}

/// A van at each edge of a street, beside each other or one after the other, and a gap between them that a car fits.
pub(super) fn gate(draft: &mut Draft) {
    let limit_mps = [8.3, 13.9][draft.count(0, 1)];
    let (length_m, lane_m) = (250.0, 4.0);
    draft.road(&format!(
        "kind = \"two-way\"\nlength_m = {length_m:.1}\nlane_width_m = {lane_m:.1}\nspeed_limit_mps = {limit_mps}"
    ));
    // Free between both vans; a car is 1.8 m wide and needs 0.3 m to each side.
    let free_m = draft.between(2.5, 3.8);
    let aside_m = 0.5 * (lane_m - VAN_WIDTH_M - free_m);
    let (right_m, apart_m) = (draft.between(95.0, 125.0), draft.between(0.0, 25.0));
    for (name, lane, along_m) in [("right", "east", right_m), ("left", "west", length_m - right_m - apart_m)] {
        draft.table(&format!(
            "[[obstacle]]\nname = \"{name}\"\nkind = \"parked-van\"\nlane = \"{lane}\"\nalong_m = {along_m:.1}\n\
             lateral_offset_m = {aside_m:.2}\nlength_m = 5.0\nwidth_m = {VAN_WIDTH_M}"
        ));
    }
    traffic(draft, limit_mps, [0, 2]);
    draft.expect("rules_kept = true");
}

/// Rows of parked cars on both sides, one after the other or partly beside each other, with traffic in both directions. Each
/// direction may use the lane of the other.
pub(super) fn rows(draft: &mut Draft) {
    let (limit_mps, length_m) = ([8.3, 13.9][draft.count(0, 1)], 300.0);
    draft.duration_s = 70.0;
    draft.road("kind = \"network\"");
    let more =
        |beside: &str| format!("left = {{ lane = \"{beside}\", oncoming = true }}\nspeed_limit_mps = {limit_mps}");
    draft.lane("east", [[0.0, -1.75], [length_m, -1.75]], 3.5, &more("west"));
    draft.lane("west", [[length_m, 1.75], [0.0, 1.75]], 3.5, &more("east"));
    for (lane, name) in [("east", "right"), ("west", "left")] {
        let mut along_m = draft.between(100.0, 190.0);
        for place in 0..draft.count(2, 6) {
            let aside_m = draft.between(-1.3, -0.9);
            let name = format!("{name}-{place}");
            draft.parked(Parked { name: &name, kind: "parked-car", lane, along_m, aside_m });
            along_m += draft.between(5.5, 9.0);
        }
    }
    traffic(draft, limit_mps, [1, 4]);
    draft.expect("rules_kept = true");
}
