//! Streets on which another road user does what no driver can foresee.

use super::draft::{Draft, Draftee};

fn car<'a>(name: &'a str, lane: &'a str, along_m: f64, speed_mps: f64) -> Draftee<'a> {
    Draftee { name, class: "car", lane, along_m, speed_mps, to: None, wanted_mps: speed_mps, driver: None }
}

fn script(orders: &str) -> Option<String> {
    Some(format!("{{ kind = \"scripted\", script = [{orders}] }}"))
}

/// A network of two lanes, each of which may use the other, from 0 to `length_m` along x.
fn street(draft: &mut Draft, length_m: f64, limit_mps: f64) {
    draft.road("kind = \"network\"");
    let more =
        |beside: &str| format!("left = {{ lane = \"{beside}\", oncoming = true }}\nspeed_limit_mps = {limit_mps:.1}");
    draft.lane("east", [[0.0, -1.75], [length_m, -1.75]], 3.5, &more("west"));
    draft.lane("west", [[length_m, 1.75], [0.0, 1.75]], 3.5, &more("east"));
}

/// What a street expects on which a contact may be unavoidable: none is the ego's fault.
fn expect_blameless(draft: &mut Draft) {
    draft.is_untouched = false;
    draft.expect("rules_kept = true");
    draft.expect_at_most("contacts_at_fault", Some("ego"), 0.0);
}

/// An oncoming vehicle drives in the ego's lane: it overtakes and returns late, or it does not return and leaves room at the edge.
pub(super) fn head_on(draft: &mut Draft) {
    let limit_mps = draft.between(13.9, 25.0);
    street(draft, 800.0, limit_mps);
    draft.duration_s = 30.0;
    let (along_m, speed_mps) = (draft.between(20.0, 60.0), draft.between(0.7, 0.9) * limit_mps);
    draft.ego("east", along_m, speed_mps, None, 0.9 * limit_mps);
    let (along_m, their_mps) = (draft.between(350.0, 520.0), draft.between(0.6, 0.9) * limit_mps);
    let from_s = draft.between(0.0, 4.0);
    let orders = if draft.chance(0.5) {
        let until_s = from_s + draft.between(4.0, 9.0);
        // It is still ahead when the other one begins to overtake.
        let slow_m = along_m + draft.between(25.0, 40.0) + 0.4 * their_mps * from_s;
        draft.vehicle(Draftee { class: "truck", ..car("slow", "west", slow_m, 0.6 * their_mps) });
        format!("{{ from_s = {from_s:.1}, lateral_m = 3.5 }}, {{ from_s = {until_s:.1}, lateral_m = 0.0 }}")
    } else {
        let aside_m = draft.between(1.6, 2.3);
        format!("{{ from_s = {from_s:.1}, lateral_m = {aside_m:.1} }}")
    };
    let driver = script(&format!("{{ speed_mps = {their_mps:.1} }}, {orders}"));
    draft.vehicle(Draftee { driver, ..car("wrong-way", "west", along_m, their_mps) });
    expect_blameless(draft);
}

/// The leader brakes to a stop for no visible reason.
pub(super) fn sudden_stop(draft: &mut Draft) {
    let limit_mps = draft.between(12.0, 25.0);
    street(draft, 600.0, limit_mps);
    draft.duration_s = 30.0;
    let (along_m, speed_mps) = (draft.between(80.0, 110.0), draft.between(0.75, 0.95) * limit_mps);
    draft.ego("east", along_m, speed_mps, None, speed_mps);
    let gap_m = 4.6 + draft.between(1.2, 3.0) * speed_mps;
    let (from_s, braking_mps2) = (draft.between(2.0, 5.0), draft.between(4.0, 7.0));
    let driver = script(&format!(
        "{{ speed_mps = {speed_mps:.1} }}, {{ from_s = {from_s:.1}, speed_mps = 0.0, acceleration_mps2 = {braking_mps2:.1} }}"
    ));
    draft.vehicle(Draftee { driver, ..car("lead", "east", along_m + gap_m, speed_mps) });
    if draft.chance(0.6) {
        let gap_m = 4.6 + draft.between(1.2, 2.5) * speed_mps;
        draft.vehicle(car("rear", "east", along_m - gap_m, speed_mps));
    }
    let mut along_m = draft.between(150.0, 400.0);
    for name in ["west-a", "west-b"].iter().take(draft.count(0, 2)) {
        let speed_mps = draft.between(0.7, 0.95) * limit_mps;
        draft.vehicle(car(name, "west", along_m, speed_mps));
        along_m -= draft.between(30.0, 100.0);
    }
    expect_blameless(draft);
}

/// A vehicle on the lane beside changes into the ego's lane with a short gap, and is slower.
pub(super) fn cut_in(draft: &mut Draft) {
    let limit_mps = draft.between(16.0, 33.0);
    draft.road("kind = \"network\"");
    let more = |beside: &str| format!("{beside}\nspeed_limit_mps = {limit_mps:.1}");
    draft.lane("right", [[0.0, 0.0], [1200.0, 0.0]], 3.5, &more("left = { lane = \"left\" }"));
    draft.lane("left", [[0.0, 3.5], [1200.0, 3.5]], 3.5, &more("right = { lane = \"right\" }"));
    draft.duration_s = 25.0;
    let (along_m, speed_mps) = (draft.between(100.0, 130.0), draft.between(0.75, 0.95) * limit_mps);
    let (own, other, aside_m) = if draft.chance(0.5) { ("right", "left", -3.5) } else { ("left", "right", 3.5) };
    draft.ego(own, along_m, speed_mps, None, speed_mps);
    let (from_s, slower_mps) = (draft.between(1.0, 4.0), draft.between(0.0, 6.0));
    let gap_m = 4.6 + draft.between(0.5, 1.5) * speed_mps + slower_mps * from_s;
    let driver = script(&format!(
        "{{ speed_mps = {:.1} }}, {{ from_s = {from_s:.1}, lateral_m = {aside_m:.1} }}",
        speed_mps - slower_mps
    ));
    draft.vehicle(Draftee { driver, ..car("cutter", other, along_m + gap_m, speed_mps - slower_mps) });
    if draft.chance(0.5) {
        let gap_m = 4.6 + draft.between(1.0, 2.5) * speed_mps;
        draft.vehicle(car("rear", own, along_m - gap_m, speed_mps));
    }
    expect_blameless(draft);
}

/// A child runs out between parked cars.
pub(super) fn child(draft: &mut Draft) {
    let limit_mps = draft.between(8.0, 13.9);
    street(draft, 300.0, limit_mps);
    draft.duration_s = 30.0;
    let (x_m, speed_mps) = (draft.between(120.0, 170.0), draft.between(0.75, 0.95) * limit_mps);
    draft.lane("path", [[x_m, -7.0], [x_m, 9.0]], 1.5, "users = [\"pedestrian\"]");
    let along_m = x_m - draft.between(60.0, 90.0);
    draft.ego("east", along_m, speed_mps, None, speed_mps);
    // From the trigger on, a driver that keeps its speed is at the path after this time.
    let ahead_m = draft.between(2.0, 3.4) * speed_mps;
    let run_mps = draft.between(2.0, 3.5);
    let driver = script(&format!(
        "{{ speed_mps = 0.0 }}, {{ when = {{ vehicle = \"ego\", reaches = {{ lane = \"east\", along_m = {:.1} }} }}, \
         speed_mps = {run_mps:.1}, acceleration_mps2 = 3.0 }}",
        x_m - ahead_m
    ));
    let beside_m = draft.between(0.8, 2.2);
    draft.vehicle(Draftee { class: "pedestrian", wanted_mps: run_mps, driver, ..car("child", "path", beside_m, 0.0) });
    for (name, along_m) in [("parked-a", x_m - 4.5), ("parked-b", x_m + 4.5)] {
        draft.table(&format!(
            "[[obstacle]]\nname = \"{name}\"\nkind = \"parked-car\"\nlane = \"east\"\nalong_m = {along_m:.1}\n\
             lateral_offset_m = -2.80"
        ));
    }
    if draft.chance(0.5) {
        let speed_mps = draft.between(0.7, 0.95) * limit_mps;
        let along_m = 300.0 - x_m - draft.between(30.0, 100.0);
        draft.vehicle(car("oncoming", "west", along_m, speed_mps));
    }
    expect_blameless(draft);
}

/// A car backs out of a drive, stands across the ego's lane for a while, and returns.
pub(super) fn backing_out(draft: &mut Draft) {
    let limit_mps = draft.between(8.0, 13.9);
    street(draft, 400.0, limit_mps);
    let (along_m, speed_mps) = (draft.between(15.0, 40.0), draft.between(0.75, 0.95) * limit_mps);
    draft.ego("east", along_m, speed_mps, None, speed_mps);
    // The car begins when the ego is this time away, and takes some seconds until it stands across.
    let (begins_s, takes_s, stands_s) = (draft.between(1.0, 4.0), draft.between(3.0, 5.0), draft.between(5.0, 12.0));
    let x_m = along_m + speed_mps * (begins_s + draft.between(4.0, 7.0));
    let (far_y_m, near_y_m) = (-8.0, draft.between(-3.4, -2.2));
    let times_s =
        [0.0, begins_s, begins_s + takes_s, begins_s + takes_s + stands_s, begins_s + 2.0 * takes_s + stands_s];
    let rows = times_s.iter().zip([far_y_m, far_y_m, near_y_m, near_y_m, far_y_m]);
    let rows: Vec<String> = rows.map(|(time_s, y_m)| format!("[{time_s:.1}, {x_m:.1}, {y_m:.1}, -1.5708]")).collect();
    draft.table(&format!("[[obstacle]]\nname = \"backer\"\ntimetable = [{}]", rows.join(", ")));
    let mut along_m = draft.between(100.0, 300.0);
    for name in ["west-a", "west-b"].iter().take(draft.count(0, 2)) {
        let speed_mps = draft.between(0.7, 0.95) * limit_mps;
        draft.vehicle(car(name, "west", along_m, speed_mps));
        along_m -= draft.between(30.0, 80.0);
    }
    expect_blameless(draft);
}
