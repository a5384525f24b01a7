//! Where the camera is: it follows the ego and whoever is near enough to be seen with it, without jerks.

use interplay_planners::State;
use interplay_scenarios::{Branch, Scenario};

use super::scene::DrivingRun;
use super::timing::{Moment, PICTURE_S};

/// Width of every picture \[px\].
pub const WIDTH_PX: f64 = 720.0;
/// Height of the view of roads that cross or turn \[px\].
const HIGH_VIEW_PX: f64 = 420.0;
/// Least height of such a view where everybody drives about along x \[px\].
const LOW_VIEW_PX: f64 = 260.0;
/// Least and greatest height of the view of a straight road \[px\].
const STRAIGHT_VIEW_PX: [f64; 2] = [170.0, 300.0];
/// Least and greatest length of a car \[px\].
const CAR_PX: [f64; 2] = [38.0, 96.0];
/// Length of a car of 1/10 scale \[m\].
const CAR_M: f64 = 0.4;
/// Space between the vehicles and the edge of the view, in lengths of a car.
const MARGIN_CARS: f64 = 1.3;
/// How far ahead of each vehicle the view reaches, in its motion at 1/10 scale \[s\].
const LOOK_AHEAD_S: f64 = 0.35;
/// A vehicle that is further away than this many widths of the largest view does not draw the camera.
const NEAR_WIDTHS: f64 = 2.5;
/// Around an ego that is alone, this share of the largest view is shown.
const ALONE_RATIO: f64 = 0.7;
/// How long the camera takes to follow a change of place, and of scale \[s\]: standard deviations.
const SMOOTHING_S: [f64; 2] = [0.7, 1.1];
/// A camera whose scale changes by less than this share stands still in scale.
const STILL_SCALE_RATIO: f64 = 1.3;

/// A part of the world that is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraView {
    /// What is in the middle \[m\].
    pub centre_m: [f64; 2],
    /// Scale.
    pub px_per_m: f64,
    /// Height \[px\]; the width is [`WIDTH_PX`].
    pub height_px: f64,
}

impl CameraView {
    /// The place of a position \[px\].
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let right = (self.px_per_m * (x - self.centre_m[0])) + 0.5 * WIDTH_PX;
        [right, 0.5 * self.height_px - self.px_per_m * (y - self.centre_m[1])]
    }

    /// Least and greatest coordinates that are seen \[m\].
    pub fn bounds_m(&self) -> [[f64; 2]; 2] {
        let half = [0.5 * WIDTH_PX / self.px_per_m, 0.5 * self.height_px / self.px_per_m];
        [[0, 1].map(|axis| self.centre_m[axis] - half[axis]), [0, 1].map(|axis| self.centre_m[axis] + half[axis])]
    }

    /// The same view moved by less than a pixel, so that what stands still does not flicker.
    fn on_pixels(self) -> CameraView {
        CameraView { centre_m: self.centre_m.map(|part| (part * self.px_per_m).round() / self.px_per_m), ..self }
    }
}

/// Length of a car of the scenario's scale \[m\].
pub fn car_m(scenario: &Scenario) -> f64 {
    CAR_M * scenario.ego().map_or(1.0, |ego| ego.body.scale)
}

/// The view at every moment; all have one height.
pub fn views(run: &DrivingRun, moments: &[Moment]) -> Vec<CameraView> {
    let car_m = car_m(run.scenario);
    let [least, greatest] = CAR_PX.map(|length| length / car_m);
    let road_m = straight_road_m(run.scenario);
    let height_px = road_m.map_or(HIGH_VIEW_PX, |_| STRAIGHT_VIEW_PX[1]);
    let largest_m = [WIDTH_PX / least, height_px / least];
    let shown: Vec<[[f64; 2]; 2]> = moments.iter().map(|moment| around(run, moment.time_s, largest_m)).collect();
    let fit = |[low, high]: &[[f64; 2]; 2]| {
        let needed = |axis: usize, pixels: f64| pixels / (high[axis] - low[axis]).max(1e-6);
        let across = if road_m.is_some() { greatest } else { needed(1, height_px) };
        needed(0, WIDTH_PX).min(across).clamp(least, greatest)
    };
    let scales: Vec<f64> = shown.iter().map(fit).collect();
    let closest = scales.iter().copied().fold(greatest, f64::min);
    if let Some([right_m, left_m]) = road_m {
        let px_per_m = closest.min(STRAIGHT_VIEW_PX[1] / (left_m - right_m + 0.8 * car_m));
        let wanted = px_per_m * (left_m - right_m + 2.4 * car_m);
        let height_px = (2.0 * (0.5 * wanted.clamp(STRAIGHT_VIEW_PX[0], STRAIGHT_VIEW_PX[1])).round()).round();
        let middle =
            smooth(&shown.iter().map(|[low, high]| 0.5 * (low[0] + high[0])).collect::<Vec<_>>(), SMOOTHING_S[0]);
        let view = |x: &f64| CameraView { centre_m: [*x, 0.5 * (right_m + left_m)], px_per_m, height_px }.on_pixels();
        return middle.iter().map(view).collect();
    }
    if let Some(still) = still(&shown, [0.8 * greatest, 0.5 * (least + greatest)], height_px) {
        return vec![still; moments.len()];
    }
    let widest = scales.iter().copied().fold(least, f64::max);
    let scales = if widest < STILL_SCALE_RATIO * closest {
        vec![closest; scales.len()]
    } else {
        smooth(&scales.iter().map(|scale| libm::log(*scale)).collect::<Vec<_>>(), SMOOTHING_S[1])
            .into_iter()
            .map(libm::exp)
            .collect()
    };
    let middles = [0, 1].map(|axis| {
        smooth(&shown.iter().map(|[low, high]| 0.5 * (low[axis] + high[axis])).collect::<Vec<_>>(), SMOOTHING_S[0])
    });
    // No higher than what is ever shown.
    let tallest = shown.iter().zip(&scales).map(|([low, high], scale)| scale * (high[1] - low[1])).fold(0.0, f64::max);
    let height_px = 2.0 * (0.5 * tallest.clamp(LOW_VIEW_PX, height_px)).ceil();
    let view = |index: usize| CameraView {
        centre_m: [middles[0][index], middles[1][index]],
        px_per_m: scales[index],
        height_px,
    };
    (0..moments.len()).map(|index| view(index).on_pixels()).collect()
}

/// A view that contains everything that is ever shown, if its cars are as long as cars of the smaller of two scales.
fn still(shown: &[[[f64; 2]; 2]], [greatest, least]: [f64; 2], height_px: f64) -> Option<CameraView> {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for [l, h] in shown {
        for axis in 0..2 {
            (low[axis], high[axis]) = (low[axis].min(l[axis]), high[axis].max(h[axis]));
        }
    }
    let px_per_m = (WIDTH_PX / (high[0] - low[0])).min(height_px / (high[1] - low[1])).min(greatest);
    let centre_m = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]));
    (px_per_m >= least).then(|| CameraView { centre_m, px_per_m, height_px }.on_pixels())
}

/// Lateral coordinates of the edges of a straight road along x; none of any other.
fn straight_road_m(scenario: &Scenario) -> Option<[f64; 2]> {
    let corridor = scenario.road.corridor(Branch::Main)?;
    let is_alone = scenario.vehicles.iter().all(|vehicle| vehicle.road == Branch::Main);
    let is_straight = scenario.network.is_none() && corridor.heading_rad == 0.0;
    (is_alone && is_straight).then_some([corridor.right_m, corridor.left_m])
}

/// Whom the ego asks for something.
fn partner(run: &DrivingRun, time_s: f64) -> Option<usize> {
    let proposal = run.frame(time_s).vehicles[run.scenario.ego_index()].plan.proposal.as_ref()?;
    run.scenario.vehicles.iter().position(|vehicle| vehicle.name == proposal.to)
}

/// Least and greatest coordinates of the ego and of those near it, with a margin, within the largest extent \[m\].
fn around(run: &DrivingRun, time_s: f64, largest_m: [f64; 2]) -> [[f64; 2]; 2] {
    let states: Vec<State> = run.seen(time_s, 0.0).iter().map(|seen| seen.state).collect();
    let states = states.as_slice();
    let partner = partner(run, time_s);
    let ego = run.scenario.ego_index();
    let margin_m = MARGIN_CARS * car_m(run.scenario);
    let of = |index: usize| {
        let vehicle = &run.scenario.vehicles[index];
        let ahead_m = LOOK_AHEAD_S * vehicle.body.time_ratio() * states[index].speed_mps;
        let (sin, cos) = libm::sincos(states[index].heading_rad);
        let [x, y] = states[index].position();
        let soon = [x + ahead_m * cos, y + ahead_m * sin];
        vehicle.body.corners(&states[index]).into_iter().chain([soon])
    };
    let extent = |indices: &[usize]| {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in indices.iter().flat_map(|index| of(*index)) {
            for axis in 0..2 {
                (low[axis], high[axis]) =
                    (low[axis].min(point[axis] - margin_m), high[axis].max(point[axis] + margin_m));
            }
        }
        [low, high]
    };
    let away = |index: &usize| {
        let [dx, dy] = [states[*index].x_m - states[ego].x_m, states[*index].y_m - states[ego].y_m];
        libm::hypot(dx, dy)
    };
    let mut others: Vec<usize> = (0..states.len()).filter(|index| *index != ego).collect();
    others.sort_by(|a, b| (Some(*a) != partner).cmp(&(Some(*b) != partner)).then(away(a).total_cmp(&away(b))));
    let (mut kept, next) = (vec![ego], others.first().copied());
    for other in others {
        kept.push(other);
        let [low, high] = extent(&kept);
        if (0..2).any(|axis| high[axis] - low[axis] > largest_m[axis]) {
            kept.pop();
        }
    }
    let [mut low, mut high] = extent(&kept);
    // Nobody fits: as much as there is space for of the way to the one who comes next.
    let is_near = |next: &usize| away(next) < NEAR_WIDTHS * largest_m[0] && are_closing([&states[ego], &states[*next]]);
    if let Some(next) = next.filter(|next| kept.len() == 1 && is_near(next)) {
        let other = states[next].position();
        for axis in 0..2 {
            if other[axis] < low[axis] {
                low[axis] = other[axis].max(high[axis] - largest_m[axis]);
            } else {
                high[axis] = high[axis].max(other[axis].min(low[axis] + largest_m[axis]));
            }
        }
    }
    if kept.len() == 1 {
        for axis in 0..2 {
            let missing = (ALONE_RATIO * largest_m[axis] - (high[axis] - low[axis])).max(0.0);
            (low[axis], high[axis]) = (low[axis] - 0.5 * missing, high[axis] + 0.5 * missing);
        }
    }
    [low, high]
}

/// Whether two vehicles come closer to each other.
fn are_closing([one, other]: [&State; 2]) -> bool {
    let velocity = |state: &State| {
        let (sin, cos) = libm::sincos(state.heading_rad);
        [state.speed_mps * cos, state.speed_mps * sin]
    };
    let (one_mps, other_mps) = (velocity(one), velocity(other));
    let [x, y] = [other.x_m - one.x_m, other.y_m - one.y_m];
    x * (other_mps[0] - one_mps[0]) + y * (other_mps[1] - one_mps[1]) < 0.0
}

/// Means of neighbouring values, weighted by a normal distribution over the time of the pictures.
fn smooth(values: &[f64], deviation_s: f64) -> Vec<f64> {
    let deviation = deviation_s / PICTURE_S;
    let reach = (3.0 * deviation) as isize;
    let weight = |offset: isize| libm::exp(-0.5 * (offset as f64 / deviation) * (offset as f64 / deviation));
    let weights: Vec<f64> = (-reach..=reach).map(weight).collect();
    let last = values.len() as isize - 1;
    // Beyond its ends a line goes on as it ended, so that the camera moves from the first picture on.
    let value = |index: isize| {
        let inside = index.clamp(0, last);
        let mirrored = (2 * inside - index).clamp(0, last);
        2.0 * values[inside as usize] - values[mirrored as usize]
    };
    let at = |index: isize| {
        let value = |offset: isize| {
            if (0..=last).contains(&(index + offset)) {
                values[(index + offset) as usize]
            } else {
                value(index + offset)
            }
        };
        let sum: f64 = (-reach..=reach).zip(&weights).map(|(offset, weight)| weight * value(offset)).sum();
        sum / weights.iter().sum::<f64>()
    };
    (0..=last).map(at).collect()
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;
    use crate::animation::timing::moments;
    use crate::figures::RecordedRun;

    #[test]
    fn smoothing_keeps_straight_lines_and_flattens_steps() {
        let line: Vec<f64> = (0..80).map(f64::from).collect();
        let smoothed = smooth(&line, 0.7);
        assert!(smoothed.iter().zip(&line).all(|(a, b)| (a - b).abs() < 1e-6), "{smoothed:?}");
        let step: Vec<f64> = (0..80).map(|index| f64::from(u8::from(index >= 40))).collect();
        let largest = smooth(&step, 0.7).windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        assert!(largest < 0.06, "{largest}");
    }

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
                    assert!((0.0..=WIDTH_PX).contains(&x) && (0.0..=view.height_px).contains(&y), "{name}: {x} {y}");
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
