//! The strip of road that a vehicle may use, and the distances of its corners to the edges.
//!
//! Eq. 6.7 bounds the `y` of the four corners, which is valid only for a road along x. Here a [`Corridor`] has its own
//! heading `ψ`, and the bounded quantity is the lateral coordinate `n = −x sin ψ + y cos ψ` of a corner.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::centre_line::FrenetPoint;
use crate::vehicle::{Body, PoseExpansion, State, SteeringGeometry, slip_on_curve_rad};

/// A straight strip of road, bounded on both sides; with heading 0 it is eq. 6.7 as printed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corridor {
    /// Heading `ψ` of the road \[rad\].
    pub heading_rad: f64,
    /// Lateral coordinate of the right edge, `y_min` \[m\].
    pub right_m: f64,
    /// Lateral coordinate of the left edge, `y_max` \[m\].
    pub left_m: f64,
    /// The rightmost lane ends, if it does: the right edge moves to the left before the end.
    pub end: Option<LaneEnd>,
}

/// The end of the rightmost lane: the right edge rises as `h/2 · (1 + tanh((s − (s_end − 2w))/w))`, where `s` is the
/// longitudinal coordinate of the front bumper.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LaneEnd {
    /// Longitudinal coordinate at which the lane has ended, `s_end` \[m\].
    pub end_m: f64,
    /// How far the right edge moves, `h`: the width of the lane that ends \[m\].
    pub height_m: f64,
    /// Length scale of the taper, `w` \[m\].
    pub taper_m: f64,
}

impl LaneEnd {
    /// The right edge that lies at `edge_m` before the end, where the front bumper is at `front_m`, with its first and second
    /// derivative.
    pub(super) fn edge(&self, edge_m: f64, front_m: f64) -> [f64; 3] {
        let tanh = libm::tanh((front_m - (self.end_m - 2.0 * self.taper_m)) / self.taper_m);
        let slope = 0.5 * self.height_m * (1.0 - tanh * tanh) / self.taper_m;
        [edge_m + 0.5 * self.height_m * (1.0 + tanh), slope, -2.0 * tanh * slope / self.taper_m]
    }
}

impl Corridor {
    /// The longitudinal coordinate `s` of a position \[m\].
    pub fn along(&self, [x, y]: [f64; 2]) -> f64 {
        let (sin, cos) = libm::sincos(self.heading_rad);
        cos * x + sin * y
    }

    /// The lateral coordinate `n` of a position \[m\].
    pub fn across(&self, [x, y]: [f64; 2]) -> f64 {
        let (sin, cos) = libm::sincos(self.heading_rad);
        -sin * x + cos * y
    }

    /// Lateral coordinate of the right edge at a longitudinal coordinate \[m\].
    pub fn right_edge_m(&self, along_m: f64) -> f64 {
        self.right_edge(along_m)[0]
    }

    /// The right edge where the front bumper is at `front_m`, with its first and second derivative.
    fn right_edge(&self, front_m: f64) -> [f64; 3] {
        self.end.map_or([self.right_m, 0.0, 0.0], |end| end.edge(self.right_m, front_m))
    }

    /// The distance of each of the four corners to its edge \[m\], negative outside (eq. 6.7 in the frame of the road): of the two
    /// right corners to the right edge, and of the two left ones to the left edge, in the order of [`Body::local_corners`].
    pub fn clearances(&self, body: &Body, state: &State) -> [PoseExpansion; 4] {
        let mut clearances = [PoseExpansion::default(); 4];
        self.write_clearances(body, state, &mut clearances);
        clearances
    }

    /// Writes the same to `rows`.
    #[inline]
    pub(super) fn write_clearances(&self, body: &Body, state: &State, rows: &mut [PoseExpansion]) {
        let (sin_road, cos_road) = libm::sincos(self.heading_rad);
        let (sin, cos) = libm::sincos(state.heading_rad - self.heading_rad);
        let [x, y] = state.position();
        let (along, lateral) = (cos_road * x + sin_road * y, -sin_road * x + cos_road * y);
        let [edge, edge_slope, edge_bend] = self.right_edge(along + body.front_m);
        for (clearance, [ahead, left]) in rows.iter_mut().zip(body.local_corners()) {
            let corner = lateral + ahead * sin + left * cos;
            let turn = ahead * cos - left * sin;
            let bend = -(ahead * sin + left * cos);
            *clearance = if left < 0.0 {
                PoseExpansion {
                    value: corner - edge,
                    gradient: [-sin_road - edge_slope * cos_road, cos_road - edge_slope * sin_road, turn],
                    hessian: [
                        -edge_bend * cos_road * cos_road,
                        -edge_bend * cos_road * sin_road,
                        0.0,
                        -edge_bend * sin_road * sin_road,
                        0.0,
                        bend,
                    ],
                }
            } else {
                PoseExpansion {
                    value: self.left_m - corner,
                    gradient: [sin_road, -cos_road, -turn],
                    hessian: [0.0, 0.0, 0.0, 0.0, 0.0, -bend],
                }
            };
        }
    }

    /// Whether the whole footprint is on the road, to within `tolerance_m`.
    pub fn contains(&self, body: &Body, state: &State, tolerance_m: f64) -> bool {
        self.clearances(body, state).iter().all(|corner| corner.value >= -tolerance_m)
    }
}

impl FrenetPoint {
    /// The steering angle with which a vehicle that is here comes to a lateral position \[rad\]. In a curve it also turns at the
    /// rate of the road, and heads inward by the slip angle.
    pub(crate) fn steer(&self, geometry: &SteeringGeometry, state: &State, lateral_m: f64) -> f64 {
        let slip_rad = slip_on_curve_rad(geometry.rear_axle_m, self.curvature_1pm);
        let heading_error_rad = state.heading_rad - self.heading_rad + slip_rad;
        geometry.correct(self.across_m - lateral_m, heading_error_rad, state.speed_mps, self.curvature_1pm)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> Corridor {
        let end = LaneEnd { end_m: 3.5, height_m: 0.37, taper_m: 0.3 };
        Corridor { heading_rad: 0.3, right_m: -0.1, left_m: 0.9, end: Some(end) }
    }

    #[test]
    fn derivatives_agree_with_finite_differences() {
        let (corridor, body, step) = (ramp(), Body::default(), 1e-5);
        let at = [2.6, 1.1, 0.5, 1.0];
        let clear = |state: [f64; 4]| corridor.clearances(&body, &State::from_array(state));
        let here = clear(at);
        for axis in 0..3 {
            let (mut up, mut down) = (at, at);
            up[axis] += step;
            down[axis] -= step;
            for (corner, (above, below)) in clear(up).iter().zip(clear(down)).enumerate() {
                let slope = (above.value - below.value) / (2.0 * step);
                assert!((slope - here[corner].gradient[axis]).abs() < 1e-8, "corner {corner}, axis {axis}");
                let second = [[0, 1], [1, 3], [5, 5]][axis];
                let bend = |i: usize| (above.gradient[i] - below.gradient[i]) / (2.0 * step);
                let (first, other) = if axis == 2 { (bend(2), bend(2)) } else { (bend(0), bend(1)) };
                assert!((first - here[corner].hessian[second[0]]).abs() < 1e-7);
                assert!((other - here[corner].hessian[second[1]]).abs() < 1e-7);
            }
        }
    }

    #[test]
    fn along_x_the_printed_bounds_come_out() {
        let corridor = Corridor { heading_rad: 0.0, right_m: 0.0, left_m: 0.74, end: None };
        let (body, state) = (Body::default(), State { x_m: 1.0, y_m: 0.3, heading_rad: 0.2, speed_mps: 1.0 });
        let (sin, cos) = libm::sincos(0.2);
        let printed = [
            0.3 + 0.21 * sin - 0.095 * cos,
            0.74 - (0.3 + 0.21 * sin + 0.095 * cos),
            0.3 - 0.19 * sin - 0.095 * cos,
            0.74 - (0.3 - 0.19 * sin + 0.095 * cos),
        ];
        for (corner, expected) in corridor.clearances(&body, &state).iter().zip(printed) {
            assert!((corner.value - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn a_lane_has_no_room_past_its_end() {
        let corridor = Corridor { heading_rad: 0.0, ..ramp() };
        let (body, lane) = (Body::default(), State { x_m: 1.0, y_m: 0.085, heading_rad: 0.0, speed_mps: 1.0 });
        assert!(corridor.contains(&body, &lane, 0.0));
        assert!(!corridor.contains(&body, &State { x_m: 3.3, ..lane }, 0.01));
    }
}
