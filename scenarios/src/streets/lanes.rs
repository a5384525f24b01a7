//! Streets with lanes side by side, or one that ends.

use super::draft::{Draft, Draftee};

fn car<'a>(name: &'a str, lane: &'a str, along_m: f64, speed_mps: f64) -> Draftee<'a> {
    Draftee { name, class: "car", lane, along_m, speed_mps, to: None, wanted_mps: speed_mps, driver: None }
}

/// The names of vehicles that follow each other.
const NAMES: [&str; 11] = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k"];

/// A slow truck ahead on a road with two directions, on which overtaking is allowed.
pub(super) fn slow_truck(draft: &mut Draft) {
    draft.road("kind = \"two-way\"\nlength_m = 800.0\nspeed_limit_mps = 22.2\novertaking = true");
    draft.duration_s = 50.0;
    let (along_m, speed_mps) = (draft.between(20.0, 60.0), draft.between(14.0, 21.0));
    draft.ego("east", along_m, speed_mps, None, 21.0);
    let (lead_m, slow_mps) = (draft.between(45.0, 90.0), draft.between(6.0, 11.0));
    draft.vehicle(Draftee { class: "truck", ..car("truck", "east", along_m + lead_m, slow_mps) });
    let mut along_m = draft.between(50.0, 300.0);
    for name in NAMES.iter().take(draft.count(0, 3)) {
        let speed_mps = draft.between(15.0, 21.0);
        draft.vehicle(car(name, "west", along_m, speed_mps));
        along_m += draft.between(60.0, 200.0);
    }
}

/// Three lanes of a motorway as a network, with vehicles in all of them; the ego wants another lane.
pub(super) fn dense(draft: &mut Draft) {
    let limit_mps = [25.0, 33.3][draft.count(0, 1)];
    let lane = |index: usize, beside: &str| {
        let y_m = 1.75 + 3.5 * index as f64;
        format!(
            "\n[[road.lane]]\nname = \"lane-{index}\"\npoints = [[0.0, {y_m}], [600.0, {y_m}], [1500.0, {y_m}]]\n\
             width_m = 3.5\nspeed_limit_mps = {limit_mps}\n{beside}"
        )
    };
    let left = |index: usize| format!("left = {{ lane = \"lane-{index}\" }}\n");
    let right = |index: usize| format!("right = {{ lane = \"lane-{index}\" }}\n");
    let lanes = [lane(0, &left(1)), lane(1, &(left(2) + &right(0))), lane(2, &right(1))];
    draft.road(&format!("kind = \"network\"\n{}", lanes.concat()));
    let from = draft.count(0, 2);
    let to = if from == 1 { [0, 2][draft.count(0, 1)] } else { 1 };
    let (lane_from, lane_to) = (format!("lane-{from}"), format!("lane-{to}"));
    let flow_mps = draft.between(0.7, 0.9) * limit_mps;
    let speed_mps = flow_mps + draft.between(-2.0, 2.0);
    draft.ego(&lane_from, 150.0, speed_mps, Some(&lane_to), 0.95 * limit_mps);
    let mut names = NAMES.iter();
    for index in 0..3 {
        let lane = format!("lane-{index}");
        let mut along_m = draft.between(10.0, 50.0);
        while along_m < 330.0 {
            let is_free = index != from || (along_m - 150.0_f64).abs() > 25.0;
            if let Some(name) = names.next().filter(|_| is_free) {
                let speed_mps = flow_mps + 1.5 * (index as f64 - 1.0) + draft.between(-1.0, 1.0);
                draft.vehicle(car(name, &lane, along_m, speed_mps));
            }
            along_m += draft.between(28.0, 75.0) + if names.len() < 4 { 60.0 } else { 0.0 };
        }
    }
}

/// Two lanes of a network, of which the ego's ends.
pub(super) fn lane_drop(draft: &mut Draft) {
    let limit_mps = draft.between(12.0, 22.0);
    let end_m = draft.between(160.0, 260.0);
    draft.road(&format!(
        "kind = \"network\"\n\n[[road.lane]]\nname = \"ending\"\npoints = [[0.0, 0.0], [{end_m:.1}, 0.0]]\nwidth_m = 3.5\n\
         speed_limit_mps = {limit_mps:.1}\nleft = {{ lane = \"through\" }}\n\n\
         [[road.lane]]\nname = \"through\"\npoints = [[0.0, 3.5], [600.0, 3.5]]\nwidth_m = 3.5\n\
         speed_limit_mps = {limit_mps:.1}\nright = {{ lane = \"ending\" }}"
    ));
    let (ego_m, flow_mps) = (draft.between(50.0, 80.0), draft.between(0.7, 0.95) * limit_mps);
    draft.ego("ending", ego_m, flow_mps, Some("through"), 0.95 * limit_mps);
    let mut along_m = draft.between(5.0, 40.0);
    for name in NAMES.iter().take(draft.count(2, 6)) {
        let speed_mps = flow_mps + draft.between(-1.0, 1.0);
        draft.vehicle(car(name, "through", along_m, speed_mps));
        along_m += draft.between(16.0, 45.0);
    }
}

/// The ego merges from a ramp between vehicles on the right lane of a motorway.
pub(super) fn on_ramp(draft: &mut Draft) {
    draft.road("kind = \"on-ramp\"");
    let (ego_m, ego_mps) = (draft.between(50.0, 90.0), draft.between(15.0, 21.0));
    let flow_mps = draft.between(19.0, 26.0);
    draft.ego("ramp", ego_m, ego_mps, Some("main-0"), flow_mps);
    let mut along_m = draft.between(5.0, 40.0);
    for name in NAMES.iter().take(draft.count(2, 4)) {
        let speed_mps = flow_mps + draft.between(-1.5, 1.5);
        draft.vehicle(car(name, "main-0", along_m, speed_mps));
        along_m += draft.between(26.0, 60.0);
    }
    let mut along_m = draft.between(10.0, 80.0);
    for name in NAMES[5..].iter().take(draft.count(0, 2)) {
        let speed_mps = flow_mps + draft.between(1.0, 4.0);
        draft.vehicle(car(name, "main-1", along_m, speed_mps));
        along_m += draft.between(40.0, 90.0);
    }
}
