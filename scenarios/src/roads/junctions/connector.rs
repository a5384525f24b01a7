//! Smooth curves from the end of one lane to the start of another one.

use interplay_planners::CentreLine;
use interplay_planners::road::centre_line::{CentreLineError, Piece};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LanePose {
    pub position: [f64; 2],
    pub heading_rad: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Connector {
    pub centre: CentreLine,
    /// Smallest radius of the curve; infinite on a straight line \[m\].
    pub radius_m: f64,
}

/// Length of the clothoid at either end of a turn, by its radius; together they turn by as many radians.
const CLOTHOID_RATIO: f64 = 0.5;

/// The largest share of a turn on its clothoids.
const MAX_CLOTHOID_SHARE: f64 = 0.6;

/// Directions that differ by less are equal \[rad\].
const SAME_DIRECTION_RAD: f64 = 1e-9;

/// Straight pieces that are shorter are left out \[m\].
const MIN_STRAIGHT_M: f64 = 1e-9;

/// The curve between two poses: straight where both lie on one line, otherwise a turn of clothoid, arc and clothoid whose
/// tangents meet where the lines of both poses do. It is as wide as the nearer pose allows.
///
/// # Errors
/// [`CentreLineError::NoLength`] if the second pose is not ahead of the first, or if the lines of both do not meet between
/// them.
pub(super) fn connector(from: LanePose, to: LanePose) -> Result<Connector, CentreLineError> {
    let apart = [to.position[0] - from.position[0], to.position[1] - from.position[1]];
    let [ahead, after] = [from.heading_rad, to.heading_rad].map(|heading_rad| {
        let (sin, cos) = libm::sincos(heading_rad);
        [cos, sin]
    });
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let turn_rad = libm::atan2(cross(ahead, after), ahead[0] * after[0] + ahead[1] * after[1]);
    if turn_rad.abs() < SAME_DIRECTION_RAD {
        let length_m = apart[0] * ahead[0] + apart[1] * ahead[1];
        let centre = super::straight(from.position, from.heading_rad, length_m)?;
        return Ok(Connector { centre, radius_m: f64::INFINITY });
    }
    let to_corner_m = cross(apart, after) / cross(ahead, after);
    let from_corner_m = cross(ahead, apart) / cross(ahead, after);
    let tangent_m = to_corner_m.min(from_corner_m);
    let radius_m = tangent_m / tangent_ratio(turn_rad)?;
    let rest = |length_m: f64| {
        (length_m - tangent_m > MIN_STRAIGHT_M).then_some(Piece::Straight { length_m: length_m - tangent_m })
    };
    let turn = turn(turn_rad, radius_m);
    let pieces: Vec<Piece> = rest(to_corner_m).into_iter().chain(turn).chain(rest(from_corner_m)).collect();
    let centre = CentreLine::from_pieces(from.position, from.heading_rad, &pieces)?;
    Ok(Connector { centre, radius_m })
}

/// A turn of clothoid, arc and clothoid, positive to the left \[rad\], with a smallest radius \[m\].
pub(super) fn turn(turn_rad: f64, radius_m: f64) -> [Piece; 3] {
    let ratio = CLOTHOID_RATIO.min(MAX_CLOTHOID_SHARE * turn_rad.abs());
    let (length_m, curvature_1pm) = (ratio * radius_m, turn_rad.signum() / radius_m);
    [
        Piece::Clothoid { length_m, from_1pm: 0.0, to_1pm: curvature_1pm },
        Piece::Arc { length_m: (turn_rad.abs() - ratio) * radius_m, curvature_1pm },
        Piece::Clothoid { length_m, from_1pm: curvature_1pm, to_1pm: 0.0 },
    ]
}

/// Distance of both ends of a [`turn`] from the corner of its tangents, by its radius.
///
/// # Errors
/// Those of [`CentreLine::from_pieces`], for an invalid angle.
pub(super) fn tangent_ratio(turn_rad: f64) -> Result<f64, CentreLineError> {
    let unit = CentreLine::from_pieces([0.0; 2], 0.0, &turn(turn_rad, 1.0))?;
    let [_, y] = unit.at(unit.length_m()).position;
    Ok(y / libm::sin(turn_rad))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// After any turn, the curve ends exactly where the second lane begins, without curvature.
    #[test]
    fn a_connector_joins_two_poses() {
        for (turn_deg, to_corner_m, from_corner_m) in
            [(90.0, 10.0, 12.0), (-90.0, 12.0, 8.0), (35.0, 20.0, 20.0), (-140.0, 30.0, 31.0), (3.0, 9.0, 9.0)]
        {
            let (heading_rad, turn_rad) = (0.4, f64::to_radians(turn_deg));
            let ((sin, cos), (end_sin, end_cos)) = (libm::sincos(heading_rad), libm::sincos(heading_rad + turn_rad));
            let end = [to_corner_m * cos + from_corner_m * end_cos, to_corner_m * sin + from_corner_m * end_sin];
            let from = LanePose { position: [0.0; 2], heading_rad };
            let to = LanePose { position: end, heading_rad: heading_rad + turn_rad };
            let Connector { centre, radius_m } = connector(from, to).expect("they meet");
            let last = centre.at(centre.length_m());
            assert!(libm::hypot(last.position[0] - end[0], last.position[1] - end[1]) < 1e-9, "{last:?} {end:?}");
            assert!((last.heading_rad - to.heading_rad).abs() < 1e-9 && last.curvature_1pm.abs() < 1e-9, "{last:?}");
            let tightest = (0..=500).map(|i| centre.at(centre.length_m() * f64::from(i) / 500.0).curvature_1pm.abs());
            assert!((tightest.fold(0.0, f64::max) * radius_m - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn lanes_that_face_away_from_each_other_have_no_connector() {
        let pose = |x: f64, y: f64, heading_rad: f64| LanePose { position: [x, y], heading_rad };
        assert!(connector(pose(0.0, 0.0, 0.0), pose(-5.0, 0.0, 0.0)).is_err(), "behind");
        assert!(connector(pose(0.0, 0.0, 0.0), pose(5.0, 5.0, -1.5)).is_err(), "the lines meet beyond");
    }
}
