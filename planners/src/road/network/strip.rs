//! The strip of a route in road coordinates: where a position is, and how far a body is inside the edges.

use super::super::centre_line::RoadPoint;
use super::super::corridor::LaneEnd;
use super::route::Route;
use crate::vehicle::{Body, PoseExpansion, State};

impl Route {
    /// Road coordinates of a position, searched from an arc length on where one is known.
    pub fn locate(&self, position: [f64; 2], near_m: Option<f64>) -> RoadPoint {
        self.centre.project(position, near_m)
    }

    /// The longitudinal coordinate `s` of a position \[m\].
    pub fn along(&self, position: [f64; 2]) -> f64 {
        self.locate(position, None).along_m
    }

    /// The lateral coordinate `n` of a position, positive to the left \[m\].
    pub fn across(&self, position: [f64; 2]) -> f64 {
        self.locate(position, None).across_m
    }

    /// Direction of the road beside a position \[rad\].
    pub fn heading_at(&self, position: [f64; 2]) -> f64 {
        self.locate(position, None).heading_rad
    }

    /// The position with these road coordinates \[m\].
    pub fn position(&self, along_m: f64, across_m: f64) -> [f64; 2] {
        self.centre.position(along_m, across_m)
    }

    /// Lateral coordinates of both edges as if no lane ended \[m\].
    pub fn edges_before_end_m(&self, along_m: f64) -> [f64; 2] {
        [self.right.value_before_end(along_m), self.left.value(along_m)]
    }

    /// Lateral coordinates of the edges of the lanes that are driven in the direction of the route \[m\].
    pub fn same_direction_edges_m(&self, along_m: f64) -> [f64; 2] {
        match &self.same_direction {
            Some([right, left]) => [right.value(along_m), left.value(along_m)],
            None => self.edges_before_end_m(along_m),
        }
    }

    /// The end of the rightmost lane, if it ends.
    pub fn lane_end(&self) -> Option<LaneEnd> {
        self.right.end()
    }

    /// How far each of the four corners is inside its edge: the two right corners from the right edge, the two left ones from
    /// the left edge, in the order of [`Body::local_corners`]; negative outside \[m\]. Corners are searched from the
    /// arc length `near_m` of the vehicle on.
    ///
    /// On a straight road these are [`Corridor::clearances`](crate::Corridor::clearances). On a curved one, with a corner at
    /// `c(x, y, θ)`, the row is `±(n(c) − edge(s(c)))`, with exact first and second derivatives: with `h(c) = n − edge(s)`,
    ///
    /// ```text
    /// ∇h = ∇n − e′ ∇s,    ∇²h = ∇²n − e′ ∇²s − e″ ∇s ∇sᵀ
    /// ∂/∂θ = ∇h·c_θ,      ∂²/∂p∂θ = ∇²h c_θ,    ∂²/∂θ² = c_θᵀ ∇²h c_θ + ∇h·c_θθ
    /// ```
    pub fn clearances(&self, body: &Body, state: &State, near_m: f64) -> [PoseExpansion; 4] {
        if let Some(corridor) = self.straight() {
            return corridor.clearances(body, state);
        }
        let (sin, cos) = libm::sincos(state.heading_rad);
        let [x, y] = state.position();
        let middle = self.centre.project([x, y], Some(near_m));
        let (turn_sin, turn_cos) = libm::sincos(state.heading_rad - middle.heading_rad);
        body.local_corners().map(|[ahead, left]| {
            let arm = [ahead * cos - left * sin, ahead * sin + left * cos];
            let arm_in_road = [ahead * turn_cos - left * turn_sin, ahead * turn_sin + left * turn_cos];
            let turn = [-arm[1], arm[0]];
            let (edge, sign) = if left < 0.0 { (&self.right, 1.0) } else { (&self.left, -1.0) };
            let at = self.centre.expand([x + arm[0], y + arm[1]], Some(middle.along_beside_m(arm_in_road)));
            let [value, slope, bend] = edge.at(at.along_m);
            let gradient: [f64; 2] = std::array::from_fn(|i| at.across_gradient[i] - slope * at.along_gradient[i]);
            let [sx, sy] = at.along_gradient;
            let squares = [sx * sx, sx * sy, sy * sy];
            let [xx, xy, yy]: [f64; 3] =
                std::array::from_fn(|i| at.across_hessian[i] - slope * at.along_hessian[i] - bend * squares[i]);
            let mixed = [xx * turn[0] + xy * turn[1], xy * turn[0] + yy * turn[1]];
            let round = mixed[0] * turn[0] + mixed[1] * turn[1] - gradient[0] * arm[0] - gradient[1] * arm[1];
            let about = gradient[0] * turn[0] + gradient[1] * turn[1];
            PoseExpansion {
                value: sign * (at.across_m - value),
                gradient: [gradient[0], gradient[1], about].map(|slope| sign * slope),
                hessian: [xx, xy, mixed[0], yy, mixed[1], round].map(|bend| sign * bend),
            }
        })
    }

    /// The values of [`Route::clearances`]; where one is positive, a positive lower bound may stand in its place.
    ///
    /// On a line of curvature at most `K`, a point at `(a, b)` in the frame of the centre's foot point has a lateral coordinate
    /// within `K a²` of `b`, as long as `K |b| ≤ ½` and `K |a| ≤ ½`: the line lies between two circles of radius `1/K`. So most corners need no
    /// projection of their own.
    pub fn clearance_bounds(&self, body: &Body, state: &State, near_m: f64) -> [f64; 4] {
        if self.straight().is_some() {
            return self.clearances(body, state, near_m).map(|corner| corner.value);
        }
        let at = self.centre.project(state.position(), Some(near_m));
        let (sin, cos) = libm::sincos(state.heading_rad);
        let (road_sin, road_cos) = libm::sincos(at.heading_rad);
        let corners = body.local_corners().map(|[ahead, left]| {
            let arm = [ahead * cos - left * sin, ahead * sin + left * cos];
            (arm, road_cos * arm[0] + road_sin * arm[1], road_cos * arm[1] - road_sin * arm[0], left < 0.0)
        });
        let reach_m =
            corners.iter().map(|(_, along_m, across_m, _)| along_m.abs().max(across_m.abs())).fold(0.0, f64::max);
        let span = [at.along_m - 2.0 * reach_m, at.along_m + 2.0 * reach_m];
        let ([_, right_m], [left_m, _]) = (self.right.extremes(span[0], span[1]), self.left.extremes(span[0], span[1]));
        let is_gentle = self.max_curvature_1pm * (at.across_m.abs() + reach_m) <= 0.5;
        corners.map(|(arm, along_m, across_m, is_right)| {
            let sag_m = self.max_curvature_1pm * along_m * along_m;
            let lateral_m = at.across_m + across_m;
            let bound_m = if is_right { lateral_m - right_m } else { left_m - lateral_m } - sag_m;
            if is_gentle && bound_m > 0.0 {
                return bound_m;
            }
            let position = [state.x_m + arm[0], state.y_m + arm[1]];
            let corner = self.centre.project(position, Some(at.along_beside_m([along_m, across_m])));
            if is_right {
                corner.across_m - self.right.value(corner.along_m)
            } else {
                self.left.value(corner.along_m) - corner.across_m
            }
        })
    }

    /// Whether the whole footprint is on the road, to within `tolerance_m`.
    pub fn contains(&self, body: &Body, state: &State, tolerance_m: f64) -> bool {
        let near_m = self.along(state.position());
        self.clearance_bounds(body, state, near_m).iter().all(|corner_m| *corner_m >= -tolerance_m)
    }
}
