//! The camera, which follows the ego and the vehicles near enough to be in view with it, smoothly.

use interplay_scenarios::{Branch, Scenario};

use crate::rectangle::extent;
pub use crate::shown_extent::{CameraFrame, car_m, partners};
use crate::shown_extent::{Extent, LEAST_MARGIN_CARS, Largest, keeping_partners, shown_extent};

/// Standard deviations of the smoothing of the position and of the scale \[s\].
const SMOOTHING_S: [f64; 2] = [0.7, 0.8];
/// Standard deviation of the correction that brings the partners into view \[s\].
const CORRECTION_S: f64 = 0.3;
/// A vehicle is kept in view this long before and after it is mentioned \[s\], so that the smoothed camera arrives in time.
const KEPT_S: f64 = 2.0 * SMOOTHING_S[1];
/// If the largest scale is below this multiple of the smallest, the scale is constant.
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
    /// Least length of a car while a more distant vehicle is mentioned \[px\]: to see both matters more than to see large cars.
    pub least_car_px: f64,
    /// Time from one view to the next \[s\], at 1/10 scale.
    pub step_s: f64,
}

/// The visible part of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraView {
    /// The position in the middle of the view \[m\].
    pub centre_m: [f64; 2],
    pub px_per_m: f64,
    /// Width and height \[px\].
    pub size_px: [f64; 2],
}

impl CameraView {
    /// The pixel at which a position of the world is drawn \[px\].
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let right = (self.px_per_m * (x - self.centre_m[0])) + 0.5 * self.size_px[0];
        [right, 0.5 * self.size_px[1] - self.px_per_m * (y - self.centre_m[1])]
    }

    /// Least and greatest visible coordinates \[m\].
    pub fn bounds_m(&self) -> [[f64; 2]; 2] {
        let half = self.size_px.map(|part| 0.5 * part / self.px_per_m);
        [[0, 1].map(|axis| self.centre_m[axis] - half[axis]), [0, 1].map(|axis| self.centre_m[axis] + half[axis])]
    }

    /// The view moved to whole pixels, so that standing objects do not flicker.
    fn on_pixels(self) -> CameraView {
        CameraView { centre_m: self.centre_m.map(|part| (part * self.px_per_m).round() / self.px_per_m), ..self }
    }
}

/// One view per frame; all have the same height.
pub fn views(scenario: &Scenario, moments: &[CameraFrame], format: &ViewFormat) -> Vec<CameraView> {
    let car_m = car_m(scenario);
    let [least, greatest] = format.car_px.map(|length| length / car_m);
    if let Some(road_m) = straight_road_m(scenario) {
        return straight_views(scenario, moments, format, road_m);
    }
    let moments = &keeping_partners(moments, KEPT_S / format.step_s);
    let height_px = format.height_px[1];
    let largest = largest(format, car_m, height_px);
    let shown: Vec<Extent> = moments.iter().map(|moment| shown_extent(scenario, moment, &largest)).collect();
    let fit = |([low, high], moment): (&Extent, &CameraFrame)| {
        let needed = |axis: usize, pixels: f64| pixels / (high[axis] - low[axis]).max(1e-6);
        let least = if moment.partners.is_empty() { least } else { format.least_car_px / car_m };
        needed(0, format.width_px).min(needed(1, height_px)).clamp(least, greatest)
    };
    let scales: Vec<f64> = shown.iter().zip(moments).map(fit).collect();
    let closest = scales.iter().copied().fold(greatest, f64::min);
    let comes_close = moments.iter().any(|moment| moment.close_up.is_some());
    let size_px = [format.width_px, height_px];
    let still = still(&shown, [0.8 * greatest, 0.5 * (least + greatest)], size_px);
    if let Some(still) = still.filter(|_| !comes_close) {
        return vec![still; moments.len()];
    }
    let widest = scales.iter().copied().fold(closest, f64::max);
    let scales = if widest < STILL_SCALE_RATIO * closest && !comes_close {
        vec![closest; scales.len()]
    } else {
        let logarithms: Vec<f64> = scales.iter().map(|scale| libm::log(*scale)).collect();
        let lowest = lowest_near(&logarithms, SMOOTHING_S[1] / format.step_s);
        let is_close_up = |index: usize| moments[index].close_up.is_some();
        let logarithms: Vec<f64> = (0..moments.len())
            .map(|index| if is_close_up(index) { logarithms[index] } else { lowest[index] })
            .collect();
        smooth(&logarithms, SMOOTHING_S[1] / format.step_s).into_iter().map(libm::exp).collect()
    };
    let middles = [0, 1].map(|axis| smooth(&middles(&shown, axis), SMOOTHING_S[0] / format.step_s));
    // The picture is not higher than its tallest content.
    let tallest = shown.iter().zip(&scales).map(|([low, high], scale)| scale * (high[1] - low[1])).fold(0.0, f64::max);
    let height_px = 2.0 * (0.5 * tallest.clamp(format.height_px[0], height_px)).ceil();
    let view = |index: usize| CameraView {
        centre_m: [middles[0][index], middles[1][index]],
        px_per_m: scales[index],
        size_px: [format.width_px, height_px],
    };
    let views: Vec<CameraView> = (0..moments.len()).map(view).collect();
    with_partners(&views, scenario, moments, (format.least_car_px / car_m, CORRECTION_S / format.step_s))
}

/// The views of a straight road along x between two lateral coordinates \[m\], in one scale.
fn straight_views(
    scenario: &Scenario,
    moments: &[CameraFrame],
    format: &ViewFormat,
    [right_m, left_m]: [f64; 2],
) -> Vec<CameraView> {
    let car_m = car_m(scenario);
    let [least, greatest] = format.car_px.map(|length| length / car_m);
    let [lowest_px, highest_px] = format.straight_height_px;
    let moments = &keeping_partners(moments, KEPT_S / format.step_s);
    let largest = largest(format, car_m, highest_px);
    let shown: Vec<Extent> = moments.iter().map(|moment| shown_extent(scenario, moment, &largest)).collect();
    let fit = |([low, high], moment): (&Extent, &CameraFrame)| {
        let least = if moment.partners.is_empty() { least } else { format.least_car_px / car_m };
        (format.width_px / (high[0] - low[0]).max(1e-6)).clamp(least, greatest)
    };
    let closest = shown.iter().zip(moments).map(fit).fold(greatest, f64::min);
    let px_per_m = closest.min(highest_px / (left_m - right_m + 0.8 * car_m));
    let wanted = px_per_m * (left_m - right_m + 2.4 * car_m);
    let height_px = (2.0 * (0.5 * wanted.clamp(lowest_px, highest_px)).round()).round();
    let size_px = [format.width_px, height_px];
    let middle = smooth(&middles(&shown, 0), SMOOTHING_S[0] / format.step_s);
    let view = |x: &f64| CameraView { centre_m: [*x, 0.5 * (right_m + left_m)], px_per_m, size_px };
    let views: Vec<CameraView> = middle.iter().map(view).collect();
    let kept = with_partners(&views, scenario, moments, (px_per_m, CORRECTION_S / format.step_s));
    let along = |view: CameraView| CameraView { centre_m: [view.centre_m[0], 0.5 * (right_m + left_m)], ..view };
    kept.into_iter().map(|view| along(view).on_pixels()).collect()
}

/// The middles of the shown extents along one axis.
fn middles(shown: &[Extent], axis: usize) -> Vec<f64> {
    shown.iter().map(|[low, high]| 0.5 * (low[axis] + high[axis])).collect()
}

/// A constant view of everything that is shown, if its scale is at least the smaller of two scales.
fn still(shown: &[Extent], [greatest, least]: [f64; 2], size_px: [f64; 2]) -> Option<CameraView> {
    let [low, high] = extent(shown.iter().flatten().copied());
    let px_per_m = (size_px[0] / (high[0] - low[0])).min(size_px[1] / (high[1] - low[1])).min(greatest);
    let centre_m = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]));
    (px_per_m >= least).then(|| CameraView { centre_m, px_per_m, size_px }.on_pixels())
}

/// Lateral coordinates of the edges of a straight road along x; `None` for other roads.
fn straight_road_m(scenario: &Scenario) -> Option<[f64; 2]> {
    let corridor = scenario.road.corridor(Branch::Main)?;
    let is_alone = scenario.vehicles.iter().all(|vehicle| vehicle.road == Branch::Main);
    let is_straight = scenario.network.is_none() && corridor.heading_rad == 0.0;
    (is_alone && is_straight).then_some([corridor.right_m, corridor.left_m])
}

/// The largest extents in a view of a height \[px\], with cars of a length \[m\].
fn largest(format: &ViewFormat, car_m: f64, height_px: f64) -> Largest {
    let at = |car_px: f64| [format.width_px, height_px].map(|pixels| pixels * car_m / car_px);
    Largest { usual_m: at(format.car_px[0]), spoken_of_m: at(format.least_car_px) }
}

/// Moves the views, and widens them down to a least scale, so that they contain the ego and as many partners as fit. The changes
/// are smoothed with a standard deviation in numbers of views.
fn with_partners(
    views: &[CameraView],
    scenario: &Scenario,
    moments: &[CameraFrame],
    (least_px_per_m, deviation): (f64, f64),
) -> Vec<CameraView> {
    let wanted: Vec<CameraView> =
        views.iter().zip(moments).map(|(view, moment)| containing(*view, scenario, moment, least_px_per_m)).collect();
    let pairs = || views.iter().zip(&wanted);
    let change = |axis: usize| {
        let changes: Vec<f64> = pairs().map(|(view, wanted)| wanted.centre_m[axis] - view.centre_m[axis]).collect();
        smooth(&changes, deviation)
    };
    let (right_m, up_m) = (change(0), change(1));
    let scales: Vec<f64> = pairs().map(|(view, wanted)| libm::log(wanted.px_per_m / view.px_per_m)).collect();
    let scales = smooth(&lowest_near(&scales, deviation), deviation);
    let moved = |index: usize| {
        let (view, moment) = (views[index], &moments[index]);
        let centre_m = [view.centre_m[0] + right_m[index], view.centre_m[1] + up_m[index]];
        let px_per_m = (view.px_per_m * libm::exp(scales[index])).max(least_px_per_m.min(view.px_per_m));
        let alone = CameraFrame { partners: Vec::new(), ..moment.clone() };
        containing(CameraView { centre_m, px_per_m, ..view }, scenario, &alone, least_px_per_m).on_pixels()
    };
    (0..views.len()).map(moved).collect()
}

/// The view that contains the ego and as many partners as fit at a scale.
fn containing(view: CameraView, scenario: &Scenario, moment: &CameraFrame, least_px_per_m: f64) -> CameraView {
    if moment.close_up.is_some() {
        return view;
    }
    let margin_m = LEAST_MARGIN_CARS * car_m(scenario);
    let corners = |index: usize| scenario.vehicles[index].body.corners(&moment.states[index]);
    let (mut seen, mut px_per_m) = (extent(corners(scenario.ego_index())), view.px_per_m);
    for partner in &moment.partners {
        let both = extent(seen.into_iter().chain(corners(*partner)));
        let fit = |axis: usize| view.size_px[axis] / (both[1][axis] - both[0][axis] + 2.0 * margin_m);
        let needed = fit(0).min(fit(1));
        if needed >= least_px_per_m {
            (seen, px_per_m) = (both, px_per_m.min(needed));
        }
    }
    let half_m = view.size_px.map(|pixels| 0.5 * pixels / px_per_m - margin_m);
    let [low, high] = seen;
    let centre = |axis: usize| {
        let [first, last] = [high[axis] - half_m[axis], low[axis] + half_m[axis]];
        if first <= last { view.centre_m[axis].clamp(first, last) } else { 0.5 * (first + last) }
    };
    CameraView { centre_m: [centre(0), centre(1)], px_per_m, ..view }
}

/// For each index the lowest of the values at most `reach` indices away.
fn lowest_near(values: &[f64], reach: f64) -> Vec<f64> {
    let reach = reach as usize;
    let near = |index: usize| &values[index.saturating_sub(reach)..(index + reach + 1).min(values.len())];
    (0..values.len()).map(|index| near(index).iter().copied().fold(f64::INFINITY, f64::min)).collect()
}

/// Means of neighbouring values, weighted by a normal distribution with a standard deviation in numbers of values.
fn smooth(values: &[f64], deviation: f64) -> Vec<f64> {
    let reach = (3.0 * deviation) as isize;
    let weight = |offset: isize| libm::exp(-0.5 * (offset as f64 / deviation) * (offset as f64 / deviation));
    let weights: Vec<f64> = (-reach..=reach).map(weight).collect();
    let last = values.len() as isize - 1;
    // The values are extrapolated beyond their ends, so that the camera moves from the first picture on.
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
