//! Pairs of bodies that are near each other, found by sweeping along the axis of the largest spread.

/// All pairs (indices ascending, in lexicographic order) whose circles, with these centres and radii \[m\], are no further apart than
/// `window_m` along one axis. Circles with non-finite positions are near all others.
pub(crate) fn near_pairs(circles: &[Option<([f64; 2], f64)>], window_m: f64) -> Vec<[usize; 2]> {
    let axis = wider_axis(circles.iter().flatten().map(|(centre, _)| *centre));
    let mut spans: Vec<(f64, f64, usize)> = Vec::with_capacity(circles.len());
    for (index, circle) in circles.iter().enumerate() {
        if let Some((centre, radius_m)) = circle {
            let [low, high] = [centre[axis] - radius_m, centre[axis] + radius_m];
            let is_place = low.is_finite() && high.is_finite();
            spans.push(if is_place { (low, high, index) } else { (f64::NEG_INFINITY, f64::INFINITY, index) });
        }
    }
    spans.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut pairs = Vec::new();
    for (place, (_, high, index)) in spans.iter().enumerate() {
        for (low, _, other) in &spans[place + 1..] {
            if low - high > window_m {
                break;
            }
            pairs.push([*index.min(other), *index.max(other)]);
        }
    }
    pairs.sort_unstable();
    pairs
}

/// The smallest distance of the centres of neighbours along the axis: an upper bound of the smallest of all \[m\].
pub(crate) fn some_distance_m(circles: &[Option<([f64; 2], f64)>]) -> f64 {
    let axis = wider_axis(circles.iter().flatten().map(|(centre, _)| *centre));
    let mut centres: Vec<[f64; 2]> = circles.iter().flatten().map(|(centre, _)| *centre).collect();
    centres.sort_by(|one, other| one[axis].total_cmp(&other[axis]));
    let apart = centres.windows(2).map(|pair| libm::hypot(pair[0][0] - pair[1][0], pair[0][1] - pair[1][1]));
    apart.filter(|m| m.is_finite()).fold(f64::INFINITY, f64::min)
}

/// The axis along which positions are spread most.
fn wider_axis(places: impl Iterator<Item = [f64; 2]>) -> usize {
    let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for place in places {
        for (bound, m) in bounds.iter_mut().zip(place) {
            *bound = [bound[0].min(m), bound[1].max(m)];
        }
    }
    let [x_m, y_m] = bounds.map(|[low, high]| high - low);
    usize::from(y_m > x_m)
}

#[cfg(test)]
mod tests {
    use interplay_common::random::Random;

    use super::*;

    #[test]
    fn no_near_pair_is_missed() {
        let mut random = Random::new(1, 0);
        for round in 0..200 {
            let spread = if round % 2 == 0 { [300.0, 10.0] } else { [10.0, 300.0] };
            let mut circles: Vec<Option<([f64; 2], f64)>> = (0..40)
                .map(|_| {
                    let centre = spread.map(|m| random.uniform(-m, m));
                    random.chance(0.9).then(|| (centre, random.uniform(0.5, 4.0)))
                })
                .collect();
            if round % 10 == 0 {
                circles[3] = Some(([f64::NAN, 0.0], 1.0));
            }
            let window_m = random.uniform(0.0, 30.0);
            let found = near_pairs(&circles, window_m);
            assert!(found.is_sorted() && found.iter().all(|[one, other]| one < other));
            for one in 0..circles.len() {
                for other in one + 1..circles.len() {
                    let (Some((a, ar)), Some((b, br))) = (circles[one], circles[other]) else { continue };
                    let apart_m = libm::hypot(a[0] - b[0], a[1] - b[1]) - ar - br;
                    let is_near = apart_m.is_nan() || apart_m <= window_m;
                    assert!(!is_near || found.contains(&[one, other]), "{one} {other} within {window_m}");
                }
            }
            let least = some_distance_m(&circles);
            assert!(found.is_empty() || least > 0.0);
        }
    }
}
