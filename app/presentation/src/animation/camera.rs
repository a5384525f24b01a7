//! The sizes of animated pictures, and the camera view of each.

use super::flow;
use super::scene::DrivingRun;
use super::timing::{PICTURE_S, PictureTime};
use crate::camera::{self, CameraFrame, ViewFormat};
pub use crate::camera::{CameraView, car_m};

/// Width of every picture \[px\].
pub const WIDTH_PX: f64 = 720.0;
/// Least and greatest length of a car \[px\].
const CAR_PX: [f64; 2] = [38.0, 96.0];
/// Least length of a car while a more distant vehicle is mentioned \[px\].
const LEAST_CAR_PX: f64 = 22.0;
/// The format of animations. Pictures are lower where all vehicles drive along x.
const FORMAT: ViewFormat = ViewFormat {
    width_px: WIDTH_PX,
    height_px: [260.0, 420.0],
    straight_height_px: [170.0, 300.0],
    car_px: CAR_PX,
    least_car_px: LEAST_CAR_PX,
    step_s: PICTURE_S,
};

/// One view per picture; all have the same height.
pub fn views(run: &DrivingRun, moments: &[PictureTime]) -> Vec<CameraView> {
    if run.scenario.is_flow_alone() {
        return vec![flow::view(run.scenario, &run.frames, &FORMAT); moments.len()];
    }
    let moments: Vec<CameraFrame> = moments.iter().map(|moment| camera_frame(run, moment.time_s)).collect();
    camera::views(run.scenario, &moments, &FORMAT)
}

/// The input of the camera at a time.
fn camera_frame(run: &DrivingRun, time_s: f64) -> CameraFrame {
    let states = run.seen(time_s, 0.0).iter().map(|seen| seen.state).collect();
    CameraFrame { states, partners: run.partners(time_s), close_up: None }
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;
    use crate::animation::timing::moments;
    use crate::figures::RecordedRun;

    /// The ego is entirely in view in every picture, no car is too small, and the camera never jumps.
    #[test]
    fn the_camera_keeps_the_ego_in_view() {
        for name in
            ["lane-change/front-nice", "roundabout/nice", "intersection/nice", "on-ramp/five", "overtaking/oncoming"]
        {
            let recorded =
                RecordedRun::record(name, load(name, &[]).expect("embedded"), Vec::new(), "").expect("a run");
            let run = DrivingRun::from_run(&recorded).expect("vehicles");
            let ego = recorded.scenario.ego_index();
            let body = recorded.scenario.vehicles[ego].body;
            let moments = moments(&recorded.report, &run.times());
            let views = views(&run, &moments);
            assert_eq!(views.len(), moments.len());
            for (view, moment) in views.iter().zip(&moments) {
                let state = run.seen(moment.time_s, 0.0)[ego].state;
                for corner in body.corners(&state) {
                    let [x, y] = view.place(corner);
                    assert!((0.0..=WIDTH_PX).contains(&x) && (0.0..=view.size_px[1]).contains(&y), "{name}: {x} {y}");
                }
                let car_px = view.px_per_m * car_m(&recorded.scenario);
                // Cars are smaller than usual only while a more distant vehicle is mentioned.
                assert!(car_px > 0.99 * LEAST_CAR_PX && car_px < 1.01 * CAR_PX[1], "{name}: {car_px} px");
            }
            for pair in views.windows(2) {
                let [a, b] = [pair[0].place(pair[1].centre_m), pair[1].place(pair[1].centre_m)];
                assert!(libm::hypot(a[0] - b[0], a[1] - b[1]) < 60.0, "{name}: {a:?} {b:?}");
            }
        }
    }

    /// The share of pictures in which a vehicle is entirely in view.
    fn visible_share(name: &str, vehicle: &str) -> f64 {
        let recorded = RecordedRun::record(name, load(name, &[]).expect("embedded"), Vec::new(), "").expect("a run");
        let run = DrivingRun::from_run(&recorded).expect("vehicles");
        let index = recorded.scenario.index_of(vehicle).expect("there");
        let moments = moments(&recorded.report, &run.times());
        let views = views(&run, &moments);
        let is_seen = |(view, moment): &(&CameraView, &PictureTime)| {
            let corners = recorded.scenario.vehicles[index].body.corners(&run.seen(moment.time_s, 0.0)[index].state);
            let inside = |[x, y]: [f64; 2]| (0.0..WIDTH_PX).contains(&x) && (0.0..view.size_px[1]).contains(&y);
            corners.into_iter().all(|corner| inside(view.place(corner)))
        };
        views.iter().zip(&moments).filter(is_seen).count() as f64 / views.len() as f64
    }

    /// Vehicles that the ego negotiates or plays a game with are in view most of the time.
    #[test]
    fn partners_of_the_ego_are_in_view_most_of_the_time() {
        for (name, vehicle, least) in [
            // The animation lasts until the second vehicle has crossed, when the ego is far away.
            ("left-turn/nice", "oncoming", 0.85),
            ("roundabout/nice", "ring", 0.99),
            ("t-junction/bayesian-nice", "main", 0.99),
            ("narrow-passage/nice", "oncoming", 0.6),
            ("overtaking/oncoming", "lorry", 0.9),
            ("overtaking/oncoming", "oncoming", 0.1),
            ("on-ramp/five", "front", 0.9),
        ] {
            let share = visible_share(name, vehicle);
            assert!(share >= least, "{name}: {vehicle} in {share:.2} of the pictures");
        }
    }
}
