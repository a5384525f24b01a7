//! The views of cameras in authored scenarios.

use interplay_scenarios::load;

use super::super::palette::vehicle_colours;
use super::*;
use crate::figures::RecordedRun;
use crate::network_lines::expected_bounds_m;

/// The cameras of an authored scenario after its run, and their views.
fn filmed(name: &str) -> (Scenario, Cameras, Vec<CameraView>) {
    let recorded = RecordedRun::record(name, load(name, &[]).expect("embedded"), Vec::new(), "").expect("a run");
    let scenario = recorded.scenario;
    let shape = (false, expected_bounds_m(&scenario));
    let stream = RecordingStream::disabled();
    let mut cameras = Cameras::begin(&stream, &scenario, &vehicle_colours(&scenario), shape).expect("begun");
    recorded.frames.iter().for_each(|frame| cameras.store(&scenario, frame));
    for index in 0..cameras.ticks.len() {
        cameras.ticks[index].frame.close_up = cameras.close_up(cameras.ticks[index].time_s);
    }
    let moments: Vec<CameraFrame> = cameras.ticks.iter().map(|tick| tick.frame.clone()).collect();
    let views = camera::views(&scenario, &moments, &cameras.format);
    (scenario, cameras, views)
}

/// At every tick the ego is in view, cars have an allowed length, and labels cover neither vehicles nor each other.
#[test]
fn the_ego_is_in_view_and_labels_cover_no_vehicle() {
    let overlap = |a: &Rectangle, b: &Rectangle| a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
    for name in ["lane-change/front-nice", "intersection/tough", "roundabout/nice", "full-size/ramp-merge"] {
        let (scenario, mut cameras, views) = filmed(name);
        let mut shown = 0;
        for (tick, view) in std::mem::take(&mut cameras.ticks).iter().zip(&views) {
            let vehicles = scenario.vehicles.iter().zip(&tick.frame.states);
            let place = |corner: [f64; 2]| view.place(corner);
            let boxes: Vec<Rectangle> =
                vehicles.map(|(one, state)| rectangle_around(one.body.corners(state).map(place))).collect();
            let [left, top, right, bottom] = boxes[scenario.ego_index()];
            let [width, height] = view.size_px;
            assert!(left > 0.0 && top > 0.0 && right < width && bottom < height, "{name}: {:?}", boxes[0]);
            let car_px = camera::car_m(&scenario) * view.px_per_m;
            assert!(car_px > 0.99 * LEAST_CAR_PX && car_px < 1.01 * CAR_PX[1], "{name}: {car_px}");
            let words: Vec<String> = scenario.vehicles.iter().map(|one| format!("{} 1.0 m/s", one.name)).collect();
            let labels = labels::place_labels(&boxes, &words, view.size_px, &mut cameras.sides);
            let labels: Vec<Rectangle> = labels.into_iter().flatten().collect();
            for (index, label) in labels.iter().enumerate() {
                assert!(!boxes.iter().chain(&labels[..index]).any(|other| overlap(label, other)), "{name}");
            }
            shown += labels.len();
        }
        assert!(shown >= views.len(), "{name}: {shown} labels in {} views", views.len());
    }
}

/// Partners of the ego are in view or, beyond the widest view, marked at the edge.
#[test]
fn partners_are_in_view_with_the_ego_or_marked() {
    for name in
        ["roundabout/nice", "t-junction/bayesian-nice", "all-way-stop/four", "left-turn/nice", "narrow-passage/nice"]
    {
        let (scenario, cameras, views) = filmed(name);
        let ego = scenario.ego_index();
        let (mut seen, mut near, mut marked) = (0, 0, 0);
        for (tick, view) in cameras.ticks.iter().zip(&views) {
            let CameraFrame { states, partners, .. } = &tick.frame;
            let Some(partner) = partners.first() else { continue };
            let apart = [0, 1].map(|axis| (states[*partner].position()[axis] - states[ego].position()[axis]).abs());
            let most_m = view.size_px.map(|pixels| (pixels / LEAST_CAR_PX - 2.0) * camera::car_m(&scenario));
            if (0..2).all(|axis| apart[axis] < most_m[axis]) {
                let [x, y] = view.place(states[*partner].position());
                let inside = (0.0..view.size_px[0]).contains(&x) && (0.0..view.size_px[1]).contains(&y);
                (seen, near) = (seen + usize::from(inside), near + 1);
            } else {
                marked += edge_marks(&scenario, view, states, partners).len();
            }
        }
        assert!(near > 5 && seen as f64 >= 0.9 * near as f64, "{name}: {seen} of {near}");
        assert_eq!(marked > 0, name == "narrow-passage/nice", "{name}: {marked}");
    }
}

#[test]
fn a_collision_is_marked_and_has_a_close_view() {
    let (scenario, cameras, views) = filmed("crash/side-impact");
    let hit = cameras.contacts.first().expect("they collide");
    let at = |time_s: f64| {
        let tick = cameras.ticks.iter().position(|tick| tick.time_s >= time_s - 1e-9).expect("a tick");
        views[tick].px_per_m
    };
    let greatest = CAR_PX[1] / camera::car_m(&scenario);
    assert!(at(hit.time_s + 0.5) > 0.85 * greatest, "{} of {greatest}", at(hit.time_s + 0.5));
    assert!(cameras.marked_contact(&scenario, hit.time_s + 0.2).is_some());
    assert!(cameras.marked_contact(&scenario, hit.time_s - 0.5).is_none());
    assert!(cameras.marked_contact(&scenario, hit.time_s + 60.0).is_none());
    let apart = |index: usize| {
        let [x, y] = cameras.ticks.iter().rfind(|tick| tick.time_s <= hit.time_s).expect("a tick").frame.states[index]
            .position();
        libm::hypot(x - hit.place_m[0], y - hit.place_m[1])
    };
    assert!(hit.between.iter().all(|index| apart(*index) < 0.4), "the mark lies between the two");
}
