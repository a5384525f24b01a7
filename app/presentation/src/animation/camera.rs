//! The sizes of the pictures, and the views of a run at its moments.

use super::scene::DrivingRun;
use super::timing::{Moment, PICTURE_S};
use crate::camera::{self, CameraMoment, ViewFormat};
pub use crate::camera::{CameraView, car_m};

/// Width of every picture \[px\].
pub const WIDTH_PX: f64 = 720.0;
/// Least and greatest length of a car \[px\].
const CAR_PX: [f64; 2] = [38.0, 96.0];
/// The views of animations. A road that crosses or turns is seen lower where everybody drives about along x.
const FORMAT: ViewFormat = ViewFormat {
    width_px: WIDTH_PX,
    height_px: [260.0, 420.0],
    straight_height_px: [170.0, 300.0],
    car_px: CAR_PX,
    step_s: PICTURE_S,
};

/// The view at every moment; all have one height.
pub fn views(run: &DrivingRun, moments: &[Moment]) -> Vec<CameraView> {
    let moments: Vec<CameraMoment> = moments.iter().map(|moment| camera_moment(run, moment.time_s)).collect();
    camera::views(run.scenario, &moments, &FORMAT)
}

/// What the camera must know of a time.
fn camera_moment(run: &DrivingRun, time_s: f64) -> CameraMoment {
    let states = run.seen(time_s, 0.0).iter().map(|seen| seen.state).collect();
    let ego = &run.frame(time_s).vehicles[run.scenario.ego_index()];
    CameraMoment { states, partner: camera::partner(run.scenario, ego), close_up: None }
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;
    use crate::animation::timing::moments;
    use crate::figures::RecordedRun;

    /// The whole ego is seen at every moment, no car is too small, and the camera never jumps.
    #[test]
    fn the_camera_keeps_the_ego_in_view() {
        for name in
            ["lane-change/front-nice", "roundabout/nice", "intersection/nice", "on-ramp/five", "curve/lane-drop"]
        {
            let recorded = RecordedRun::of(name, load(name, &[]).expect("embedded"), Vec::new(), "").expect("a run");
            let run = DrivingRun::of(&recorded).expect("vehicles");
            let ego = recorded.scenario.ego_index();
            let body = recorded.scenario.vehicles[ego].body;
            let moments = moments(&recorded.report, ego, run.end_s(), body.time_ratio());
            let views = views(&run, &moments);
            assert_eq!(views.len(), moments.len());
            for (view, moment) in views.iter().zip(&moments) {
                let state = run.seen(moment.time_s, 0.0)[ego].state;
                for corner in body.corners(&state) {
                    let [x, y] = view.place(corner);
                    assert!((0.0..=WIDTH_PX).contains(&x) && (0.0..=view.size_px[1]).contains(&y), "{name}: {x} {y}");
                }
                let car_px = view.px_per_m * car_m(&recorded.scenario);
                assert!(car_px > 0.7 * CAR_PX[0] && car_px < 1.01 * CAR_PX[1], "{name}: {car_px} px");
            }
            for pair in views.windows(2) {
                let [a, b] = [pair[0].place(pair[1].centre_m), pair[1].place(pair[1].centre_m)];
                assert!(libm::hypot(a[0] - b[0], a[1] - b[1]) < 60.0, "{name}: {a:?} {b:?}");
            }
        }
    }
}
