//! Road coordinates of a position: its nearest point on a centre line, with derivatives.

use super::line::{CentreLine, Curve, CurvePoint, Shape};

/// Where a position is beside a centre line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RoadPoint {
    /// Arc length `s` of the nearest point; negative before the begin, above the length after the end \[m\].
    pub along_m: f64,
    /// Signed distance `n` from the line, positive to the left \[m\].
    pub across_m: f64,
    /// Heading of the line at the nearest point, without jumps of a full turn along the line \[rad\].
    pub heading_rad: f64,
    /// Curvature of the line at the nearest point \[1/m\].
    pub curvature_1pm: f64,
}

impl RoadPoint {
    /// The arc length beside a place `[a, b]` along and across the line from here \[m\]: exact, to the fifth power of `κ a`, where
    /// the line is a circle.
    ///
    /// On a circle it is `s + atan(z)/κ` with `z = κ a/(1 − κ (n + b))`.
    pub(in crate::road) fn along_beside_m(&self, [a, b]: [f64; 2]) -> f64 {
        let stretch = (1.0 - self.curvature_1pm * (self.across_m + b)).max(RoadExpansion::MIN_STRETCH);
        let shift_m = a / stretch;
        let turn = self.curvature_1pm * shift_m;
        self.along_m + shift_m * (1.0 - turn * turn * (1.0 / 3.0))
    }
}

/// The road coordinates `(s, n)` of a position, expanded to second order over `(x, y)`.
///
/// With the curve `p(s)`, its speed `v = |p′|`, tangent `t`, normal `m` (to the left), curvature `κ` and `q = 1 − κ n`:
///
/// - `∇n = m`, `∇²n = −κ/q · t tᵀ`
/// - `∇s = t/(v q)`
/// - `∇²s = (κ/q² · (m tᵀ + t mᵀ) + (κ′ n/(v q³) − v′/(v² q²)) · t tᵀ)/v`
///
/// where `′` is the derivative over `s`. Beyond the centre of curvature, where `q ≤ 0`, the derivatives do not exist. `q` is
/// taken as at least [`RoadExpansion::MIN_STRETCH`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RoadExpansion {
    /// Arc length `s` of the nearest point \[m\].
    pub along_m: f64,
    /// First derivatives of `s` over (x, y).
    pub along_gradient: [f64; 2],
    /// Second derivatives of `s` over (xx, xy, yy) \[1/m\].
    pub along_hessian: [f64; 3],
    /// Signed distance `n` from the line, positive to the left \[m\].
    pub across_m: f64,
    /// First derivatives of `n` over (x, y).
    pub across_gradient: [f64; 2],
    /// Second derivatives of `n` over (xx, xy, yy) \[1/m\].
    pub across_hessian: [f64; 3],
    /// Heading `ψ` of the line at the nearest point \[rad\].
    pub heading_rad: f64,
    /// `ψ′ = κ v` \[rad/m\].
    pub heading_slope_radpm: f64,
    /// `ψ″ = κ′ v + κ v′` \[rad/m²\].
    pub heading_bend_radpm2: f64,
    /// Curvature `κ` of the line at the nearest point \[1/m\].
    pub curvature_1pm: f64,
}

/// Most steps of a search. Halley's method needs 1 to 4; the rest is for bisection.
const MAX_STEPS: usize = 64;

/// A search ends with a step that is shorter \[m\]: Halley's method leaves about `κ²/6` times its cube, which is rounding. The last
/// step is taken in the series of the curve, whose position and direction are exact to rounding then, and whose curvature is to
/// the square of the step.
const LAST_STEP_M: f64 = 1e-4;

/// A step of Halley's method needs a second derivative of at least this share of `v²`; otherwise the curvature is ignored.
const MIN_CONVEXITY: f64 = 0.1;

/// A step is at most this many times the distance to the position, so that a search stays on its branch of the line.
const MAX_STEP_RATIO: f64 = 2.0;

/// Beyond the centre of curvature a step is at least this share of the distance to the position.
const LEAST_STEP_RATIO: f64 = 0.25;

/// Most by which a curve leaves the chord between two knots, by its length: above `½ tan 0.2`, the largest turn of a segment.
const MAX_SAG_RATIO: f64 = 0.11;

impl RoadExpansion {
    /// Least value of `1 − κ n` in derivatives.
    pub const MIN_STRETCH: f64 = 0.05;

    /// Only the road coordinates.
    pub fn point(&self) -> RoadPoint {
        let RoadExpansion { along_m, across_m, heading_rad, curvature_1pm, .. } = *self;
        RoadPoint { along_m, across_m, heading_rad, curvature_1pm }
    }

    /// The arc length after a move `d`, to second order: `s + ∇s·d + ½ dᵀ ∇²s d` \[m\].
    pub(crate) fn along_after_m(&self, [x, y]: [f64; 2]) -> f64 {
        let ([sx, sy], [xx, xy, yy]) = (self.along_gradient, self.along_hessian);
        self.along_m + sx * x + sy * y + 0.5 * (xx * x * x + 2.0 * xy * x * y + yy * y * y)
    }
}

impl Curve {
    /// The point nearest to a position among those that a descent from an arc length reaches.
    ///
    /// Finds a zero of `g(s) = (p(s) − position)·p′(s)` at which `g` increases, by Halley's method
    /// `s − g g′/(g′² − ½ g g″)` between the places where `g` was found negative and positive.
    fn descend(&self, position: [f64; 2], from_m: f64) -> (f64, CurvePoint<'_>) {
        let (mut along_m, mut low_m, mut high_m) = (from_m, f64::NEG_INFINITY, f64::INFINITY);
        let mut point = self.point(along_m);
        for _ in 0..MAX_STEPS {
            let [place, first, second, third] = point.jet;
            let apart = [place[0] - position[0], place[1] - position[1]];
            let slope = dot(apart, first);
            let square = dot(first, first);
            let bend = square + dot(apart, second);
            let twist = 3.0 * dot(first, second) + dot(apart, third);
            if slope < 0.0 {
                low_m = along_m;
            } else if slope > 0.0 {
                high_m = along_m;
            } else if bend > 0.0 {
                break;
            }
            let halley = bend * bend - 0.5 * slope * twist;
            let mut step_m = if bend > MIN_CONVEXITY * square && halley > 0.5 * bend * bend {
                -slope * bend / halley
            } else {
                -slope / square
            };
            let reach_squared = MAX_STEP_RATIO * MAX_STEP_RATIO * dot(apart, apart);
            if step_m * step_m > reach_squared {
                step_m = reach_squared.sqrt().copysign(step_m);
            }
            if bend <= 0.0 {
                // Beyond the centre of curvature the distance may have a maximum here, which the search must leave.
                let least_m = LEAST_STEP_RATIO * dot(apart, apart).sqrt();
                step_m = step_m.abs().max(least_m).copysign(-slope);
            }
            if step_m.abs() < LAST_STEP_M {
                return (along_m + step_m, point.moved(step_m));
            }
            let mut next_m = along_m + step_m;
            if next_m <= low_m || next_m >= high_m {
                next_m = 0.5 * (low_m + high_m);
            }
            along_m = next_m;
            point = self.point_near(along_m, &point);
        }
        (along_m, point)
    }

    /// The point nearest to a position, by descents from every segment that may hold it.
    fn nearest(&self, position: [f64; 2]) -> (f64, CurvePoint<'_>) {
        let chords: Vec<[f64; 2]> = (0..self.segments.len()).map(|index| self.chord(index, position)).collect();
        let nearest = chords.iter().min_by(|a, b| a[0].total_cmp(&b[0])).map_or(0.0, |chord| chord[1]);
        let mut best = self.descend(position, nearest);
        let mut best_m = distance(best.1.jet[0], position);
        for (segment, [distance_m, from_m]) in self.segments.iter().zip(&chords) {
            // A descent from the best place would only be repeated.
            let is_known = (segment.from_m..=segment.end_m()).contains(&best.0);
            if !is_known && distance_m - MAX_SAG_RATIO * segment.length_m < best_m {
                let other = self.descend(position, *from_m);
                let other_m = distance(other.1.jet[0], position);
                if other_m < best_m && (0.0..=self.length_m).contains(&other.0) {
                    (best, best_m) = (other, other_m);
                }
            }
        }
        best
    }

    /// The distance of a position from the chord of a segment, and the arc length of the point of the chord there \[m\].
    fn chord(&self, index: usize, [x, y]: [f64; 2]) -> [f64; 2] {
        let segment = &self.segments[index];
        let start = segment.start();
        let end = self.segments.get(index + 1).map_or_else(|| segment.knot(segment.length_m)[0], |next| next.start());
        let (chord, apart) = ([end[0] - start[0], end[1] - start[1]], [x - start[0], y - start[1]]);
        let square = chord[0] * chord[0] + chord[1] * chord[1];
        let share = ((chord[0] * apart[0] + chord[1] * apart[1]) / square).clamp(0.0, 1.0);
        let foot = [start[0] + share * chord[0], start[1] + share * chord[1]];
        [distance(foot, [x, y]), segment.from_m + share * segment.length_m]
    }

    #[inline]
    fn foot(&self, position: [f64; 2], near_m: Option<f64>) -> (f64, CurvePoint<'_>) {
        match near_m {
            Some(near_m) if near_m.is_finite() => self.descend(position, near_m),
            _ => self.nearest(position),
        }
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let apart = [a[0] - b[0], a[1] - b[1]];
    (apart[0] * apart[0] + apart[1] * apart[1]).sqrt()
}

impl CentreLine {
    /// The point of the line that is nearest to a position.
    ///
    /// With an arc length `near_m`, such as that of a moment before, this is the nearest point on the branch of the line
    /// there: the minimum that a descent from `near_m` reaches, at most 64 steps, usually 1 to 3. Without it, it is the
    /// nearest point of the whole line, at a cost that grows with the number of knots. A continuation beyond an end counts
    /// only where that end is the nearest point of the line.
    ///
    /// The result is finite for every position up to `1e100` m. At the centre of curvature the nearest point is not unique, and
    /// which of the nearest points is returned depends on `near_m`.
    #[inline]
    pub fn project(&self, position: [f64; 2], near_m: Option<f64>) -> RoadPoint {
        let curve = match &self.0 {
            Shape::Straight { heading_rad, cos, sin } => {
                let [along_m, across_m] = straight_coordinates(*cos, *sin, position);
                return RoadPoint { along_m, across_m, heading_rad: *heading_rad, curvature_1pm: 0.0 };
            }
            Shape::Curve(curve) => curve,
        };
        let (along_m, point) = curve.foot(position, near_m);
        let [place, first, ..] = point.jet;
        let apart = [position[0] - place[0], position[1] - place[1]];
        RoadPoint {
            along_m,
            across_m: cross(first, apart) * point.inverse_speed(),
            heading_rad: point.heading_rad(),
            curvature_1pm: point.curvature_1pm(),
        }
    }

    /// Like [`CentreLine::project`], with the derivatives over the position that [`RoadExpansion`] states.
    ///
    /// The third derivative of the line is continuous between knots only, and so is the second derivative of `s`.
    #[inline]
    pub fn expand(&self, position: [f64; 2], near_m: Option<f64>) -> RoadExpansion {
        match &self.0 {
            Shape::Straight { heading_rad, cos, sin } => {
                let [along_m, across_m] = straight_coordinates(*cos, *sin, position);
                RoadExpansion {
                    along_m,
                    along_gradient: [*cos, *sin],
                    across_m,
                    across_gradient: [-sin, *cos],
                    heading_rad: *heading_rad,
                    ..RoadExpansion::default()
                }
            }
            Shape::Curve(curve) => {
                let (along_m, point) = curve.foot(position, near_m);
                expansion(position, along_m, &point)
            }
        }
    }
}

/// The expressions of [`Corridor::along`](crate::Corridor::along) and [`Corridor::across`](crate::Corridor::across).
fn straight_coordinates(cos: f64, sin: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    [cos * x + sin * y, -sin * x + cos * y]
}

#[inline]
fn expansion(position: [f64; 2], along_m: f64, point: &CurvePoint) -> RoadExpansion {
    let [place, first, second, third] = point.jet;
    let slowness = point.inverse_speed();
    let speed = dot(first, first) * slowness;
    let tangent = first.map(|component| component * slowness);
    let normal = [-tangent[1], tangent[0]];
    let across_m = dot(normal, [position[0] - place[0], position[1] - place[1]]);
    let speed_slope = dot(tangent, second);
    let square = slowness * slowness;
    let curvature = cross(tangent, second) * square;
    let curvature_slope = cross(tangent, third) * square - 3.0 * curvature * speed_slope * slowness;
    let inverse_stretch = 1.0 / (1.0 - curvature * across_m).max(RoadExpansion::MIN_STRETCH);
    let shrink = inverse_stretch * slowness;
    let tangents = [tangent[0] * tangent[0], tangent[0] * tangent[1], tangent[1] * tangent[1]];
    let across_bend = -curvature * inverse_stretch;
    let mixed = curvature * inverse_stretch * shrink;
    let along_bend = (curvature_slope * across_m * inverse_stretch - speed_slope * slowness) * (shrink * shrink);
    RoadExpansion {
        along_m,
        along_gradient: tangent.map(|component| component * shrink),
        along_hessian: [
            2.0 * mixed * normal[0] * tangent[0] + along_bend * tangents[0],
            mixed * (normal[0] * tangent[1] + normal[1] * tangent[0]) + along_bend * tangents[1],
            2.0 * mixed * normal[1] * tangent[1] + along_bend * tangents[2],
        ],
        across_m,
        across_gradient: normal,
        across_hessian: tangents.map(|entry| across_bend * entry),
        heading_rad: point.heading_rad(),
        heading_slope_radpm: curvature * speed,
        heading_bend_radpm2: curvature_slope * speed + curvature * speed_slope,
        curvature_1pm: curvature,
    }
}
