//! The curves of a route, and the highest speeds in them.

use crate::road::centre_line::CentreLine;

/// A part of a route, between two knots of its centre line, with its largest curvature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bend {
    /// Where it begins \[m\].
    from_m: f64,
    /// Where it ends \[m\].
    to_m: f64,
    /// Largest curvature in it, without sign \[1/m\].
    pub curvature_1pm: f64,
}

/// How many places are checked between two knots of a centre line.
pub(super) const CHECKS_PER_KNOT: usize = 8;

/// A curvature below this is that of a straight road \[1/m\].
const STRAIGHT_CURVATURE_1PM: f64 = 1e-6;

/// The parts of a centre line between its knots, in order.
pub(super) fn bends(centre: &CentreLine) -> Vec<Bend> {
    let knots_m = centre.knots_m();
    let parts = knots_m.windows(2).map(|pair| {
        let places = (0..=CHECKS_PER_KNOT).map(|part| part as f64 / CHECKS_PER_KNOT as f64);
        let curvatures = places.map(|share| centre.at(pair[0] + share * (pair[1] - pair[0])).curvature_1pm.abs());
        Bend { from_m: pair[0], to_m: pair[1], curvature_1pm: curvatures.fold(0.0, f64::max) }
    });
    parts.collect()
}

/// The speed at an arc length from which every curve ahead is taken with at most a lateral acceleration, braking at `braking_mps2`:
/// the least of `√(a/κ + 2 b d)` over the curves, `d` ahead; none without curves ahead \[m/s\].
pub(super) fn highest_speed_mps(bends: &[Bend], along_m: f64, lateral_mps2: f64, braking_mps2: f64) -> Option<f64> {
    let speeds =
        bends.iter().filter(|bend| bend.to_m > along_m && bend.curvature_1pm > STRAIGHT_CURVATURE_1PM).map(|bend| {
            let room_m = (bend.from_m - along_m).max(0.0);
            (lateral_mps2 / bend.curvature_1pm + 2.0 * braking_mps2 * room_m).sqrt()
        });
    speeds.min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use crate::road::centre_line::{CentreLine, Piece, smooth};

    /// Straight for 50 m, a quarter of a circle of 20 m, straight again: 2 m/s² allow `√(2·20)` m/s on the circle, and before it
    /// what braking at 3 m/s² takes off.
    #[test]
    fn a_curve_ahead_limits_the_speed_by_the_braking_distance() {
        let pieces = [
            Piece::Straight { length_m: 50.0 },
            Piece::Arc { length_m: 10.0 * std::f64::consts::PI, curvature_1pm: 0.05 },
            Piece::Straight { length_m: 50.0 },
        ];
        let centre = CentreLine::from_pieces([0.0; 2], 0.0, &smooth(&pieces, 4.0).expect("room")).expect("a line");
        let bends = super::bends(&centre);
        let speed_mps = |along_m| super::highest_speed_mps(&bends, along_m, 2.0, 3.0);
        let on_circle_mps = speed_mps(65.0).expect("on the circle");
        assert!((on_circle_mps - 40.0_f64.sqrt()).abs() < 0.02 * on_circle_mps, "{on_circle_mps}");
        // The curvature of the circle is reached within the transition from 48 to 52 m.
        let before_mps = speed_mps(20.0).expect("before the circle");
        let by_braking_mps = |room_m: f64| (40.0 + 2.0 * 3.0 * room_m).sqrt();
        assert!((by_braking_mps(28.0)..=by_braking_mps(32.0)).contains(&before_mps), "{before_mps}");
        assert_eq!(speed_mps(105.0), None);
    }
}
