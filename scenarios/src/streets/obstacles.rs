//! Streets with standing, stopping or crossing road users.

use super::draft::{Draft, Draftee, SCRIPTED};

/// A street with a lane in each direction.
fn two_way(draft: &mut Draft, length_m: f64) -> f64 {
    let limit_mps = [8.3, 13.9][draft.count(0, 1)];
    draft.road(&format!("kind = \"two-way\"\nlength_m = {length_m:.1}\nspeed_limit_mps = {limit_mps}"));
    limit_mps
}

/// A vehicle that stands in a lane.
fn standing<'a>(name: &'a str, lane: &'a str, along_m: f64) -> Draftee<'a> {
    Draftee {
        name,
        class: "van",
        lane,
        along_m,
        speed_mps: 0.0,
        to: None,
        wanted_mps: 0.0,
        driver: Some(SCRIPTED.to_owned()),
    }
}

/// Adds a vehicle that comes the other way.
fn oncoming(draft: &mut Draft, name: &str, along_m: f64, limit_mps: f64) {
    let speed_mps = draft.between(0.6, 0.95) * limit_mps;
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
}

/// A van stands in the ego's lane; in half of the draws a vehicle comes the other way.
pub(super) fn standing_van(draft: &mut Draft) {
    let limit_mps = two_way(draft, 300.0);
    let (along_m, van_m) = (draft.between(15.0, 40.0), draft.between(100.0, 150.0));
    let speed_mps = draft.between(0.5, 0.9) * limit_mps;
    draft.ego("east", along_m, speed_mps, None, draft_wanted(limit_mps));
    draft.vehicle(standing("van", "east", van_m));
    if draft.chance(0.5) {
        let along_m = draft.between(10.0, 140.0);
        oncoming(draft, "oncoming", along_m, limit_mps);
    }
}

/// Some vans are parked in the ego's lane, with traffic the other way.
pub(super) fn parked_vans(draft: &mut Draft) {
    let limit_mps = two_way(draft, 400.0);
    draft.duration_s = 60.0;
    let (along_m, speed_mps) = (draft.between(15.0, 40.0), draft.between(0.5, 0.9) * limit_mps);
    draft.ego("east", along_m, speed_mps, None, draft_wanted(limit_mps));
    let mut place_m = draft.between(90.0, 130.0);
    for name in ["van-a", "van-b", "van-c"].iter().take(draft.count(2, 3)) {
        draft.vehicle(standing(name, "east", place_m));
        place_m += draft.between(35.0, 80.0);
    }
    let mut along_m = draft.between(20.0, 120.0);
    for name in ["west-a", "west-b", "west-c"].iter().take(draft.count(1, 3)) {
        oncoming(draft, name, along_m, limit_mps);
        along_m += draft.between(30.0, 90.0);
    }
}

/// A bus ahead stops for some seconds and goes on; a vehicle comes the other way.
pub(super) fn bus(draft: &mut Draft) {
    let limit_mps = two_way(draft, 400.0);
    draft.duration_s = 60.0;
    let along_m = draft.between(10.0, 30.0);
    let (lead_m, speed_mps) = (draft.between(35.0, 60.0), 0.8 * limit_mps);
    draft.ego("east", along_m, speed_mps, None, draft_wanted(limit_mps));
    let (stops_s, stands_s) = (draft.between(2.0, 6.0), draft.between(8.0, 20.0));
    let script = format!(
        "{{ kind = \"scripted\", script = [{{ from_s = {stops_s:.1}, speed_mps = 0.0, acceleration_mps2 = 1.5 }}, \
         {{ from_s = {:.1}, speed_mps = {speed_mps:.1}, acceleration_mps2 = 0.8 }}] }}",
        stops_s + stands_s
    );
    draft.vehicle(Draftee {
        name: "bus",
        class: "truck",
        lane: "east",
        along_m: along_m + lead_m,
        speed_mps,
        to: None,
        wanted_mps: speed_mps,
        driver: Some(script),
    });
    for (name, from_m) in [("west-a", 40.0), ("west-b", 160.0)].iter().take(draft.count(0, 2)) {
        let along_m = from_m + draft.between(0.0, 80.0);
        oncoming(draft, name, along_m, limit_mps);
    }
}

/// A slow road user with priority on a crossing path; the path is a lane of its own.
pub(super) fn crosser(draft: &mut Draft) {
    let limit_mps = draft.between(8.0, 13.9);
    draft.duration_s = 30.0;
    draft.road(&format!(
        "kind = \"network\"\n\n[[road.lane]]\nname = \"street-in\"\npoints = [[-150.0, 0.0], [-4.0, 0.0]]\nwidth_m = 3.5\n\
         successors = [\"street-out\"]\nright_of_way = \"yield\"\nspeed_limit_mps = {limit_mps:.1}\n\n\
         [[road.lane]]\nname = \"street-out\"\npoints = [[-4.0, 0.0], [150.0, 0.0]]\nwidth_m = 3.5\n\
         speed_limit_mps = {limit_mps:.1}\n\n\
         [[road.lane]]\nname = \"path\"\npoints = [[0.0, -25.0], [0.0, 25.0]]\nwidth_m = 2.0"
    ));
    let (along_m, speed_mps) = (draft.between(50.0, 100.0), draft.between(0.6, 1.0) * limit_mps);
    draft.ego("street-in", along_m, speed_mps, Some("street-out"), limit_mps);
    let speed_mps = draft.between(1.0, 3.5);
    for (name, from_m) in [("walker", 8.0), ("second", 1.0)].iter().take(draft.count(1, 2)) {
        let along_m = from_m + draft.between(0.0, 4.5);
        draft.vehicle(Draftee {
            name,
            class: "bicycle",
            lane: "path",
            along_m,
            speed_mps,
            to: None,
            wanted_mps: speed_mps,
            driver: Some(SCRIPTED.to_owned()),
        });
    }
}

/// The desired speed of people on a street with a limit: slightly below it.
fn draft_wanted(limit_mps: f64) -> f64 {
    0.95 * limit_mps
}
