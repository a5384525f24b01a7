//! The strip of a route in Frenet coordinates: projections of positions, and distances of a body to the edges.

use super::super::centre_line::FrenetPoint;
use super::super::corridor::LaneEnd;
use super::route::Route;
use crate::vehicle::{Body, PoseExpansion, State};

/// A corner of a body beside a road.
struct Corner {
    /// Where it is \[m\].
    position: [f64; 2],
    /// From the mass centre to the corner \[m\].
    arm: [f64; 2],
    /// The same along and across the road beside the mass centre \[m\].
    arm_in_road: [f64; 2],
    /// Whether its edge is the right one.
    is_right: bool,
    /// It is at least so far inside its edge \[m\].
    least_m: f64,
}

impl Corner {
    /// The row `sign · h` of this corner, from `h` and its derivatives over the corner's position.
    #[inline(always)]
    fn row(&self, sign: f64, value: f64, gradient: [f64; 2], [xx, xy, yy]: [f64; 3]) -> PoseExpansion {
        let arm = self.arm;
        let turn = [-arm[1], arm[0]];
        let mixed = [xx * turn[0] + xy * turn[1], xy * turn[0] + yy * turn[1]];
        let round = mixed[0] * turn[0] + mixed[1] * turn[1] - gradient[0] * arm[0] - gradient[1] * arm[1];
        let about = gradient[0] * turn[0] + gradient[1] * turn[1];
        PoseExpansion {
            value: sign * value,
            gradient: [gradient[0], gradient[1], about].map(|slope| sign * slope),
            hessian: [xx, xy, mixed[0], yy, mixed[1], round].map(|bend| sign * bend),
        }
    }
}

/// What the corners of a body beside a road share.
struct Frame {
    /// Sine and cosine of the body's heading.
    turn: (f64, f64),
    /// The same of its heading less that of the road.
    turn_in_road: (f64, f64),
    /// Where the mass centre is across the road \[m\].
    across_m: f64,
    /// The innermost lateral coordinates of both edges there \[m\].
    edges_m: [f64; 2],
    max_curvature_1pm: f64,
    is_gentle: bool,
}

impl Frame {
    /// A corner at a place `(ahead, left)` of the body.
    ///
    /// On a line of curvature at most `K`, a point at `(a, b)` in the frame of the centre's foot point has a lateral coordinate
    /// within `K a²` of `b`, as long as `K |b| ≤ ½` and `K |a| ≤ ½`: the line lies between two circles of radius `1/K`.
    #[inline]
    fn corner(&self, [ahead, left]: [f64; 2], state: &State) -> Corner {
        let turned = |(sin, cos): (f64, f64)| [ahead * cos - left * sin, ahead * sin + left * cos];
        let (arm, arm_in_road) = (turned(self.turn), turned(self.turn_in_road));
        let is_right = left < 0.0;
        let lateral_m = self.across_m + arm_in_road[1];
        let sag_m = self.max_curvature_1pm * arm_in_road[0] * arm_in_road[0];
        let inside_m = if is_right { lateral_m - self.edges_m[0] } else { self.edges_m[1] - lateral_m };
        let least_m = if self.is_gentle { inside_m - sag_m } else { f64::NEG_INFINITY };
        Corner { position: [state.x_m + arm[0], state.y_m + arm[1]], arm, arm_in_road, is_right, least_m }
    }

    /// The row of a corner as if the road were straight, along the tangent beside the mass centre.
    fn straight_row(&self, corner: &Corner) -> PoseExpansion {
        let ((sin, cos), (turn_sin, turn_cos)) = (self.turn, self.turn_in_road);
        let direction = [sin * turn_cos - cos * turn_sin, cos * turn_cos + sin * turn_sin];
        let ([ahead, left], sign) = (corner.arm_in_road, if corner.is_right { 1.0 } else { -1.0 });
        PoseExpansion {
            value: corner.least_m,
            gradient: [-sign * direction[0], sign * direction[1], sign * ahead],
            hessian: [0.0, 0.0, 0.0, 0.0, 0.0, -sign * left],
        }
    }
}

impl Route {
    /// Frenet coordinates of a position. The search begins at the arc length `near_m`, if given.
    pub fn locate(&self, position: [f64; 2], near_m: Option<f64>) -> FrenetPoint {
        self.centre.project(position, near_m)
    }

    /// Frenet coordinates of the positions of a motion; each search begins at the result of the previous one.
    pub fn locate_all(&self, positions: &[[f64; 2]]) -> impl Iterator<Item = FrenetPoint> {
        let mut near_m = None;
        positions.iter().map(move |position| {
            let at = self.locate(*position, near_m);
            near_m = Some(at.along_m);
            at
        })
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

    /// The position with these Frenet coordinates \[m\].
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

    /// The end of the rightmost lane, if that lane ends on this road.
    pub fn lane_end(&self) -> Option<LaneEnd> {
        self.right.end()
    }

    /// The distance of each of the four corners to its edge \[m\], negative outside: of the two right corners to the
    /// right edge, and of the two left ones to the left edge, in the order of [`Body::local_corners`]. `at` is the
    /// projection of the mass centre on the road.
    ///
    /// On a straight road these are [`Corridor::clearances`](crate::Corridor::clearances). On a curved one, with a corner at
    /// `c(x, y, θ)`, the row is `±(n(c) − edge(s(c)))`, with exact first and second derivatives: with `h(c) = n − edge(s)`,
    ///
    /// ```text
    /// ∇h = ∇n − e′ ∇s,    ∇²h = ∇²n − e′ ∇²s − e″ ∇s ∇sᵀ
    /// ∂/∂θ = ∇h·c_θ,      ∂²/∂p∂θ = ∇²h c_θ,    ∂²/∂θ² = c_θᵀ ∇²h c_θ + ∇h·c_θθ
    /// ```
    pub fn clearances(&self, body: &Body, state: &State, at: &FrenetPoint) -> [PoseExpansion; 4] {
        let mut rows = [PoseExpansion::default(); 4];
        self.write_clearances(f64::INFINITY, body, state, at, &mut rows);
        rows
    }

    /// Writes the same to `rows`, where on a curved road a corner that is certainly farther than `exact_m` inside its edge has the
    /// row of a straight road along the tangent beside the mass centre \[m\]: a lower bound of its distance, above `exact_m`, with
    /// the derivatives of that straight road. They need no projection of the corner.
    pub(crate) fn write_clearances(
        &self,
        exact_m: f64,
        body: &Body,
        state: &State,
        at: &FrenetPoint,
        rows: &mut [PoseExpansion],
    ) {
        if let Some(corridor) = self.straight() {
            return corridor.write_clearances(body, state, rows);
        }
        let frame = self.frame(body, state, at);
        for (row, local) in rows.iter_mut().zip(body.local_corners()) {
            let corner = frame.corner(local, state);
            *row = if corner.least_m > exact_m {
                frame.straight_row(&corner)
            } else {
                self.clearance(&corner, at.along_beside_m(corner.arm_in_road))
            };
        }
    }

    /// How far a corner is inside its edge.
    fn clearance(&self, corner: &Corner, near_m: f64) -> PoseExpansion {
        let (edge, sign) = if corner.is_right { (&self.right, 1.0) } else { (&self.left, -1.0) };
        if let Some(value) = edge.as_constant() {
            let at = self.centre.expand_across(corner.position, Some(near_m));
            return corner.row(sign, at.across_m - value, at.gradient, at.hessian);
        }
        let at = self.centre.expand(corner.position, Some(near_m));
        let [value, slope, bend] = edge.at(at.along_m);
        let gradient = std::array::from_fn(|i| at.across_gradient[i] - slope * at.along_gradient[i]);
        let [sx, sy] = at.along_gradient;
        let squares = [sx * sx, sx * sy, sy * sy];
        let hessian = std::array::from_fn(|i| at.across_hessian[i] - slope * at.along_hessian[i] - bend * squares[i]);
        corner.row(sign, at.across_m - value, gradient, hessian)
    }

    /// The values of [`Route::clearances`], except that a positive lower bound may replace a positive value. So most
    /// corners need no separate projection.
    pub fn clearance_bounds(&self, body: &Body, state: &State, at: &FrenetPoint) -> [f64; 4] {
        if let Some(corridor) = self.straight() {
            return corridor.clearances(body, state).map(|corner| corner.value);
        }
        if let Some([right_m, left_m]) = self.inside_both_m(body, state, at) {
            return body.local_corners().map(|[_, left]| if left < 0.0 { right_m } else { left_m });
        }
        let frame = self.frame(body, state, at);
        body.local_corners().map(|local| {
            let corner = frame.corner(local, state);
            if corner.least_m > 0.0 {
                return corner.least_m;
            }
            let beside = self.centre.project(corner.position, Some(at.along_beside_m(corner.arm_in_road)));
            if corner.is_right {
                beside.across_m - self.right.value(beside.along_m)
            } else {
                self.left.value(beside.along_m) - beside.across_m
            }
        })
    }

    /// How far both right corners are at least inside the right edge, and both left ones inside the left edge, if these bounds are
    /// positive \[m\]. A corner is at most `beside + ahead |θ − ψ|` beside the mass centre, and by [`Frame::corner`] the line leaves
    /// its tangent by no more than `K reach²`.
    fn inside_both_m(&self, body: &Body, state: &State, at: &FrenetPoint) -> Option<[f64; 2]> {
        let (ahead_m, beside_m, reach_m) = extents_m(body);
        if self.max_curvature_1pm * (at.across_m.abs() + reach_m) > 0.5 {
            return None;
        }
        let swept_m = beside_m + ahead_m * (state.heading_rad - at.heading_rad).abs();
        let margin_m = swept_m + self.max_curvature_1pm * reach_m * reach_m;
        let [right_m, left_m] = self.nearest_edges_m(at.along_m, reach_m);
        let inside_m = [at.across_m - right_m - margin_m, left_m - at.across_m - margin_m];
        (inside_m[0] > 0.0 && inside_m[1] > 0.0).then_some(inside_m)
    }

    /// The innermost lateral coordinates of the edges beside a body that reaches `reach_m` from its mass centre \[m\].
    fn nearest_edges_m(&self, along_m: f64, reach_m: f64) -> [f64; 2] {
        let [from_m, to_m] = [along_m - 2.0 * reach_m, along_m + 2.0 * reach_m];
        [self.right.extremes(from_m, to_m)[1], self.left.extremes(from_m, to_m)[0]]
    }

    /// What the corners of a body share.
    fn frame(&self, body: &Body, state: &State, at: &FrenetPoint) -> Frame {
        let (_, _, reach_m) = extents_m(body);
        Frame {
            turn: libm::sincos(state.heading_rad),
            turn_in_road: libm::sincos(state.heading_rad - at.heading_rad),
            across_m: at.across_m,
            edges_m: self.nearest_edges_m(at.along_m, reach_m),
            max_curvature_1pm: self.max_curvature_1pm,
            is_gentle: self.max_curvature_1pm * (at.across_m.abs() + reach_m) <= 0.5,
        }
    }

    /// Whether the whole footprint is on the road, to within `tolerance_m`.
    pub fn contains(&self, body: &Body, state: &State, tolerance_m: f64) -> bool {
        let at = self.locate(state.position(), None);
        self.clearance_bounds(body, state, &at).iter().all(|corner_m| *corner_m >= -tolerance_m)
    }
}

/// How far a body reaches from its mass centre: along it, to its side, and to its farthest corner \[m\].
fn extents_m(body: &Body) -> (f64, f64, f64) {
    let (ahead_m, beside_m) = (body.front_m.max(body.rear_m), 0.5 * body.width_m);
    (ahead_m, beside_m, (ahead_m * ahead_m + beside_m * beside_m).sqrt())
}
