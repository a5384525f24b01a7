//! The candidate drivers of a fit.

use interplay_planners::drivers::human::{Settings, Style};
use interplay_planners::motion_prediction::{LateralMotion, PredictedDriver};

/// Intervals of time gaps are widened by this ratio, since candidates are discrete. The ratio was chosen on the simulated
/// drivers of `coverage_of_the_intervals`, so that 95 % of their true values lie within.
pub(super) const RATIO_STEP: f64 = 1.02;
/// The same ratio for comforts, which is that of two neighbouring candidates.
pub(super) const COMFORT_STEP: f64 = 1.3;
/// Time gaps, as multiples of the usual one.
pub(super) const RATIOS: [f64; 13] = [0.4, 0.47, 0.55, 0.64, 0.74, 0.85, 0.97, 1.1, 1.25, 1.42, 1.62, 1.85, 2.1];
/// Weights of changes of the acceleration \[s⁴/m²\].
pub(super) const COMFORTS: [f64; 7] = [0.03, 0.06, 0.1, 0.17, 0.3, 0.5, 0.9];
/// Desired speeds, as multiples of the highest one in the record.
pub(super) const WANTED_RATIOS: [f64; 5] = [0.95, 1.0, 1.08, 1.2, 1.4];

pub(super) fn driver(time_gap_ratio: f64, acceleration_change: f64, wanted_mps: f64) -> PredictedDriver {
    PredictedDriver {
        settings: Settings { style: Some(Style::Normal), time_gap_ratio: Some(time_gap_ratio), ..Settings::default() },
        acceleration_change,
        wanted_mps: Some(wanted_mps),
        looks_beside: false,
        lateral: Some(LateralMotion::Kept),
        ..PredictedDriver::usual()
    }
}

/// The style with the nearest weight, on the scale on which weights change time gaps.
pub(super) fn style_of(weight: f64) -> &'static str {
    let away = |style: &Style| (libm::log1p(style.safety_weight()) - libm::log1p(weight)).abs();
    let nearest = Style::ALL.into_iter().min_by(|a, b| away(a).total_cmp(&away(b)));
    nearest.unwrap_or(Style::Normal).name()
}

/// The candidate with the least weighted sum of errors, refined between its neighbours by parabolas. `counts` are the weights.
pub(super) fn least(grid: &[[usize; 2]], errors: &[Vec<f64>], counts: &[u32]) -> [f64; 2] {
    let total =
        |errors: &Vec<f64>| -> f64 { errors.iter().zip(counts).map(|(error, count)| f64::from(*count) * error).sum() };
    let sums: Vec<f64> = errors.iter().map(total).collect();
    let best = (0..sums.len()).min_by(|a, b| sums[*a].total_cmp(&sums[*b])).unwrap_or(0);
    let at = |place: [usize; 2]| sums[place[0] * COMFORTS.len() + place[1]];
    let place = grid[best];
    std::array::from_fn(|axis| {
        let values: &[f64] = if axis == 0 { &RATIOS } else { &COMFORTS };
        let index = place[axis];
        if index == 0 || index + 1 == values.len() {
            return values[index];
        }
        let beside = |index: usize| {
            let mut moved = place;
            moved[axis] = index;
            at(moved)
        };
        let [below, here, above] = [beside(index - 1), beside(index), beside(index + 1)];
        let bend = below - 2.0 * here + above;
        let shift = if bend > 0.0 { (0.5 * (below - above) / bend).clamp(-0.5, 0.5) } else { 0.0 };
        let neighbour = if shift < 0.0 { values[index - 1] } else { values[index + 1] };
        values[index] * libm::pow(neighbour / values[index], shift.abs())
    })
}

#[cfg(test)]
mod tests {
    use interplay_planners::drivers::human::safety_weight_keeping;

    use super::*;

    #[test]
    fn safety_weights_convert_to_time_gaps_and_back() {
        for (ratio, weight) in [(0.6, 0.0), (1.4, 50.0), (0.3, 0.0), (2.0, 50.0)] {
            assert!((safety_weight_keeping(ratio) - weight).abs() < 1e-9, "{ratio}");
        }
        assert_eq!([0.0, 3.0, 9.0, 45.0].map(style_of), ["tough", "assertive", "normal", "nice"]);
    }

    #[test]
    fn the_fitted_minimum_is_interpolated_between_candidates() {
        let grid: Vec<[usize; 2]> =
            (0..RATIOS.len()).flat_map(|ratio| (0..COMFORTS.len()).map(move |comfort| [ratio, comfort])).collect();
        let bowl = |place: &[usize; 2]| {
            let [ratio, comfort] = [libm::log(RATIOS[place[0]] / 1.0), libm::log(COMFORTS[place[1]] / 0.2)];
            vec![ratio * ratio + 0.1 * comfort * comfort]
        };
        let errors: Vec<Vec<f64>> = grid.iter().map(bowl).collect();
        let [ratio, comfort] = least(&grid, &errors, &[1]);
        assert!((ratio - 1.0).abs() < 0.02 && (comfort - 0.2).abs() < 0.02, "{ratio}, {comfort}");
    }
}
