//! Where the camera is: it follows the ego and whoever is near enough to be seen with it, without jerks.

use interplay_planners::State;
use interplay_scenarios::{Branch, Scenario};
use interplay_simulation::frame::VehicleFrame;

use crate::body_style::scale;
use crate::extent::extent;

/// Length of a car of 1/10 scale \[m\].
const CAR_M: f64 = 0.4;
/// Space between the vehicles and the edge of the view, in lengths of a car.
const MARGIN_CARS: f64 = 1.3;
/// The same where two are shown close.
const CLOSE_MARGIN_CARS: f64 = 0.4;
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

/// Sizes of the views of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewFormat {
    /// Width of every view \[px\].
    pub width_px: f64,
    /// Least and greatest height of the view of roads that cross or turn \[px\].
    pub height_px: [f64; 2],
    /// Least and greatest height of the view of a straight road \[px\].
    pub straight_height_px: [f64; 2],
    /// Least and greatest length of a car \[px\].
    pub car_px: [f64; 2],
    /// Time from one view to the next \[s\], at 1/10 scale.
    pub step_s: f64,
}

/// What the camera must know of a moment.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraMoment {
    /// Every vehicle, in the scenario's order.
    pub states: Vec<State>,
    /// Whom the ego asks for something.
    pub partner: Option<usize>,
    /// Two vehicles that the camera shows alone, as large as it can.
    pub close_up: Option<[usize; 2]>,
}

/// A part of the world that is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraView {
    /// What is in the middle \[m\].
    pub centre_m: [f64; 2],
    /// Scale.
    pub px_per_m: f64,
    /// Width and height \[px\].
    pub size_px: [f64; 2],
}

impl CameraView {
    /// The place of a position \[px\].
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let right = (self.px_per_m * (x - self.centre_m[0])) + 0.5 * self.size_px[0];
        [right, 0.5 * self.size_px[1] - self.px_per_m * (y - self.centre_m[1])]
    }

    /// Least and greatest coordinates that are seen \[m\].
    pub fn bounds_m(&self) -> [[f64; 2]; 2] {
        let half = self.size_px.map(|part| 0.5 * part / self.px_per_m);
        [[0, 1].map(|axis| self.centre_m[axis] - half[axis]), [0, 1].map(|axis| self.centre_m[axis] + half[axis])]
    }

    /// The same view moved by less than a pixel, so that what stands still does not flicker.
    fn on_pixels(self) -> CameraView {
        CameraView { centre_m: self.centre_m.map(|part| (part * self.px_per_m).round() / self.px_per_m), ..self }
    }
}

/// Least and greatest coordinates \[m\].
type Extent = [[f64; 2]; 2];

/// Length of a car of the scenario's scale \[m\].
pub fn car_m(scenario: &Scenario) -> f64 {
    CAR_M * scenario.ego().map_or(1.0, |ego| scale(&ego.body))
}

/// The view at every moment; all have one height.
pub fn views(scenario: &Scenario, moments: &[CameraMoment], format: &ViewFormat) -> Vec<CameraView> {
    let car_m = car_m(scenario);
    let [least, greatest] = format.car_px.map(|length| length / car_m);
    if let Some(road_m) = straight_road_m(scenario) {
        return straight_views(scenario, moments, format, road_m);
    }
    let height_px = format.height_px[1];
    let largest_m = [format.width_px / least, height_px / least];
    let shown: Vec<Extent> = moments.iter().map(|moment| around(scenario, moment, largest_m)).collect();
    let fit = |[low, high]: &Extent| {
        let needed = |axis: usize, pixels: f64| pixels / (high[axis] - low[axis]).max(1e-6);
        needed(0, format.width_px).min(needed(1, height_px)).clamp(least, greatest)
    };
    let scales: Vec<f64> = shown.iter().map(fit).collect();
    let closest = scales.iter().copied().fold(greatest, f64::min);
    let comes_close = moments.iter().any(|moment| moment.close_up.is_some());
    let size_px = [format.width_px, height_px];
    let still = still(&shown, [0.8 * greatest, 0.5 * (least + greatest)], size_px);
    if let Some(still) = still.filter(|_| !comes_close) {
        return vec![still; moments.len()];
    }
    let widest = scales.iter().copied().fold(least, f64::max);
    let scales = if widest < STILL_SCALE_RATIO * closest && !comes_close {
        vec![closest; scales.len()]
    } else {
        let logarithms: Vec<f64> = scales.iter().map(|scale| libm::log(*scale)).collect();
        smooth(&logarithms, SMOOTHING_S[1] / format.step_s).into_iter().map(libm::exp).collect()
    };
    let middles = [0, 1].map(|axis| smooth(&middles(&shown, axis), SMOOTHING_S[0] / format.step_s));
    // No higher than what is ever shown.
    let tallest = shown.iter().zip(&scales).map(|([low, high], scale)| scale * (high[1] - low[1])).fold(0.0, f64::max);
    let height_px = 2.0 * (0.5 * tallest.clamp(format.height_px[0], height_px)).ceil();
    let view = |index: usize| CameraView {
        centre_m: [middles[0][index], middles[1][index]],
        px_per_m: scales[index],
        size_px: [format.width_px, height_px],
    };
    (0..moments.len()).map(|index| view(index).on_pixels()).collect()
}

/// The views of a straight road along x between two lateral coordinates \[m\], in one scale.
fn straight_views(
    scenario: &Scenario,
    moments: &[CameraMoment],
    format: &ViewFormat,
    [right_m, left_m]: [f64; 2],
) -> Vec<CameraView> {
    let car_m = car_m(scenario);
    let [least, greatest] = format.car_px.map(|length| length / car_m);
    let [lowest_px, highest_px] = format.straight_height_px;
    let largest_m = [format.width_px / least, highest_px / least];
    let shown: Vec<Extent> = moments.iter().map(|moment| around(scenario, moment, largest_m)).collect();
    let fit = |[low, high]: &Extent| (format.width_px / (high[0] - low[0]).max(1e-6)).clamp(least, greatest);
    let closest = shown.iter().map(fit).fold(greatest, f64::min);
    let px_per_m = closest.min(highest_px / (left_m - right_m + 0.8 * car_m));
    let wanted = px_per_m * (left_m - right_m + 2.4 * car_m);
    let height_px = (2.0 * (0.5 * wanted.clamp(lowest_px, highest_px)).round()).round();
    let size_px = [format.width_px, height_px];
    let middle = smooth(&middles(&shown, 0), SMOOTHING_S[0] / format.step_s);
    let view = |x: &f64| CameraView { centre_m: [*x, 0.5 * (right_m + left_m)], px_per_m, size_px }.on_pixels();
    middle.iter().map(view).collect()
}

/// The middles of what is shown, along one axis.
fn middles(shown: &[Extent], axis: usize) -> Vec<f64> {
    shown.iter().map(|[low, high]| 0.5 * (low[axis] + high[axis])).collect()
}

/// A view that contains everything that is ever shown, if its cars are as long as cars of the smaller of two scales.
fn still(shown: &[Extent], [greatest, least]: [f64; 2], size_px: [f64; 2]) -> Option<CameraView> {
    let [low, high] = extent(shown.iter().flatten().copied());
    let px_per_m = (size_px[0] / (high[0] - low[0])).min(size_px[1] / (high[1] - low[1])).min(greatest);
    let centre_m = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]));
    (px_per_m >= least).then(|| CameraView { centre_m, px_per_m, size_px }.on_pixels())
}

/// Lateral coordinates of the edges of a straight road along x; none of any other.
fn straight_road_m(scenario: &Scenario) -> Option<[f64; 2]> {
    let corridor = scenario.road.corridor(Branch::Main)?;
    let is_alone = scenario.vehicles.iter().all(|vehicle| vehicle.road == Branch::Main);
    let is_straight = scenario.network.is_none() && corridor.heading_rad == 0.0;
    (is_alone && is_straight).then_some([corridor.right_m, corridor.left_m])
}

/// Whom a vehicle asks for something.
pub fn partner(scenario: &Scenario, vehicle: &VehicleFrame) -> Option<usize> {
    let proposal = vehicle.plan.proposal.as_ref()?;
    scenario.index_of(&proposal.to)
}

/// Least and greatest coordinates of the ego and of those near it, with a margin, within the largest extent \[m\].
fn around(scenario: &Scenario, moment: &CameraMoment, largest_m: [f64; 2]) -> Extent {
    let CameraMoment { states, partner, close_up } = moment;
    let ego = scenario.ego_index();
    let margin_m = if close_up.is_some() { CLOSE_MARGIN_CARS } else { MARGIN_CARS } * car_m(scenario);
    let of = |index: usize| {
        let vehicle = &scenario.vehicles[index];
        let ahead_m = LOOK_AHEAD_S * vehicle.body.time_ratio() * states[index].speed_mps;
        let (sin, cos) = libm::sincos(states[index].heading_rad);
        let [x, y] = states[index].position();
        let soon = [x + ahead_m * cos, y + ahead_m * sin];
        vehicle.body.corners(&states[index]).into_iter().chain([soon])
    };
    let around = |indices: &[usize]| {
        let [low, high] = extent(indices.iter().flat_map(|index| of(*index)));
        [low.map(|part| part - margin_m), high.map(|part| part + margin_m)]
    };
    if let Some(pair) = close_up {
        return around(pair);
    }
    let away = |index: &usize| {
        let [dx, dy] = [states[*index].x_m - states[ego].x_m, states[*index].y_m - states[ego].y_m];
        libm::hypot(dx, dy)
    };
    let mut others: Vec<usize> = (0..states.len()).filter(|index| *index != ego).collect();
    others.sort_by(|a, b| (Some(*a) != *partner).cmp(&(Some(*b) != *partner)).then(away(a).total_cmp(&away(b))));
    let (mut kept, next) = (vec![ego], others.first().copied());
    for other in others {
        kept.push(other);
        let [low, high] = around(&kept);
        if (0..2).any(|axis| high[axis] - low[axis] > largest_m[axis]) {
            kept.pop();
        }
    }
    let [mut low, mut high] = around(&kept);
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

/// Means of neighbouring values, weighted by a normal distribution with a standard deviation in numbers of values.
fn smooth(values: &[f64], deviation: f64) -> Vec<f64> {
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
    use super::*;

    #[test]
    fn smoothing_keeps_straight_lines_and_flattens_steps() {
        let line: Vec<f64> = (0..80).map(f64::from).collect();
        let smoothed = smooth(&line, 7.0);
        assert!(smoothed.iter().zip(&line).all(|(a, b)| (a - b).abs() < 1e-6), "{smoothed:?}");
        let step: Vec<f64> = (0..80).map(|index| f64::from(u8::from(index >= 40))).collect();
        let largest = smooth(&step, 7.0).windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        assert!(largest < 0.06, "{largest}");
    }
}
