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

/// The lateral coordinate `n` of a position, expanded to second order over `(x, y)`: a part of [`RoadExpansion`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::road) struct AcrossExpansion {
    /// `n` \[m\].
    pub across_m: f64,
    /// First derivatives over (x, y).
    pub gradient: [f64; 2],
    /// Second derivatives over (xx, xy, yy) \[1/m\].
    pub hessian: [f64; 3],
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

/// One step of a search, from a point of the curve towards the point nearest to a position.
#[derive(Clone, Copy)]
struct SearchStep {
    /// `g = (p − position)·p′`.
    slope: f64,
    /// `g′`.
    bend: f64,
    /// How far to go along the curve \[m\].
    length_m: f64,
}

impl SearchStep {
    /// The step of Halley's method `−g g′/(g′² − ½ g g″)`, or of steepest descent where the distance is not convex.
    #[inline(always)]
    fn from(point: &CurvePoint, position: [f64; 2]) -> SearchStep {
        let [place, first, second, third] = point.jet;
        let apart = [place[0] - position[0], place[1] - position[1]];
        let slope = dot(apart, first);
        let square = dot(first, first);
        let bend = square + dot(apart, second);
        let twist = 3.0 * dot(first, second) + dot(apart, third);
        let halley = bend * bend - 0.5 * slope * twist;
        let mut length_m = if bend > MIN_CONVEXITY * square && halley > 0.5 * bend * bend {
            -slope * bend / halley
        } else {
            -slope / square
        };
        let reach_squared = MAX_STEP_RATIO * MAX_STEP_RATIO * dot(apart, apart);
        if length_m * length_m > reach_squared {
            length_m = reach_squared.sqrt().copysign(length_m);
        }
        if bend <= 0.0 {
            // Beyond the centre of curvature the distance may have a maximum here, which the search must leave.
            let least_m = LEAST_STEP_RATIO * dot(apart, apart).sqrt();
            length_m = length_m.abs().max(least_m).copysign(-slope);
        }
        SearchStep { slope, bend, length_m }
    }

    fn is_last(&self) -> bool {
        self.length_m.abs() < LAST_STEP_M
    }
}

impl Curve {
    /// The point nearest to a position among those that a descent from an arc length reaches.
    fn descend(&self, position: [f64; 2], from_m: f64) -> (f64, CurvePoint<'_>) {
        let point = self.point(from_m);
        self.descend_on(position, from_m, point, SearchStep::from(&point, position))
    }

    /// The same from a point whose step is known.
    ///
    /// Finds a zero of `g(s) = (p(s) − position)·p′(s)` at which `g` increases, by Halley's method between the places where `g`
    /// was found negative and positive.
    fn descend_on<'a>(
        &'a self,
        position: [f64; 2],
        from_m: f64,
        from: CurvePoint<'a>,
        first: SearchStep,
    ) -> (f64, CurvePoint<'a>) {
        let (mut along_m, mut low_m, mut high_m) = (from_m, f64::NEG_INFINITY, f64::INFINITY);
        let (mut point, mut step) = (from, first);
        for _ in 0..MAX_STEPS {
            if step.slope < 0.0 {
                low_m = along_m;
            } else if step.slope > 0.0 {
                high_m = along_m;
            } else if step.bend > 0.0 {
                break;
            }
            if step.is_last() {
                return (along_m + step.length_m, point.moved(step.length_m));
            }
            let mut next_m = along_m + step.length_m;
            if next_m <= low_m || next_m >= high_m {
                next_m = 0.5 * (low_m + high_m);
            }
            along_m = next_m;
            point = self.point_near(along_m, &point);
            step = SearchStep::from(&point, position);
        }
        (along_m, point)
    }

    /// The point nearest to a position, by descents from every segment that may hold it.
    fn nearest(&self, position: [f64; 2]) -> (f64, CurvePoint<'_>) {
        let mut best = self.descend(position, self.nearest_chord_m(position));
        let mut best_m = distance(best.1.jet[0], position);
        for (segment, chord) in self.segments.iter().zip(&self.chords) {
            let sag_m = MAX_SAG_RATIO * segment.length_m;
            if chord.is_beyond(best_m + sag_m, position) {
                continue;
            }
            let [distance_m, share] = chord.nearest(position);
            // A descent from the best place would only be repeated.
            let is_known = (segment.from_m..=segment.end_m()).contains(&best.0);
            if !is_known && distance_m - sag_m < best_m {
                let other = self.descend(position, segment.from_m + share * segment.length_m);
                let other_m = distance(other.1.jet[0], position);
                if other_m < best_m && (0.0..=self.length_m).contains(&other.0) {
                    (best, best_m) = (other, other_m);
                }
            }
        }
        best
    }

    /// The arc length of the point of the chords that is nearest to a position; the first of equally near ones \[m\].
    fn nearest_chord_m(&self, position: [f64; 2]) -> f64 {
        let (mut nearby, mut least) = (0, f64::INFINITY);
        for (index, chord) in self.chords.iter().enumerate() {
            let square = chord.squared_to_middle(position);
            if square < least {
                (nearby, least) = (index, square);
            }
        }
        let bound_m = self.chords[nearby].nearest(position)[0];
        let mut best = [f64::INFINITY, 0.0];
        for (segment, chord) in self.segments.iter().zip(&self.chords) {
            if !chord.is_beyond(bound_m, position) {
                let [distance_m, share] = chord.nearest(position);
                if distance_m < best[0] {
                    best = [distance_m, segment.from_m + share * segment.length_m];
                }
            }
        }
        best[1]
    }

    /// Road coordinates of a position, searched from `near_m` on or on the whole curve.
    ///
    /// Where the first step of the search is the last one, as from a place that an expansion has led to, nothing passes through
    /// memory.
    #[inline(always)]
    fn locate<R: RoadReading>(&self, position: [f64; 2], near_m: Option<f64>) -> R {
        let Some(near_m) = near_m.filter(|near_m| near_m.is_finite()) else {
            return self.locate_anywhere(position);
        };
        let point = self.point(near_m);
        let step = SearchStep::from(&point, position);
        if step.slope != 0.0 && step.is_last() {
            return R::at(position, near_m + step.length_m, &point.moved(step.length_m));
        }
        self.locate_from(position, near_m, (point, step))
    }

    #[inline(never)]
    fn locate_from<'a, R: RoadReading>(
        &'a self,
        position: [f64; 2],
        near_m: f64,
        (point, step): (CurvePoint<'a>, SearchStep),
    ) -> R {
        let (along_m, point) = self.descend_on(position, near_m, point, step);
        R::at(position, along_m, &point)
    }

    #[inline(never)]
    fn locate_anywhere<R: RoadReading>(&self, position: [f64; 2]) -> R {
        let (along_m, point) = self.nearest(position);
        R::at(position, along_m, &point)
    }
}

/// Road coordinates that are read off the nearest point of a curve.
trait RoadReading {
    /// Those of a position whose nearest point lies at an arc length.
    fn at(position: [f64; 2], along_m: f64, point: &CurvePoint) -> Self;
}

impl RoadReading for RoadPoint {
    #[inline(always)]
    fn at(position: [f64; 2], along_m: f64, point: &CurvePoint) -> RoadPoint {
        let [place, first, ..] = point.jet;
        let apart = [position[0] - place[0], position[1] - place[1]];
        RoadPoint {
            along_m,
            across_m: cross(first, apart) * point.inverse_speed(),
            heading_rad: point.heading_rad(),
            curvature_1pm: point.curvature_1pm(),
        }
    }
}

impl RoadReading for AcrossExpansion {
    #[inline(always)]
    fn at(position: [f64; 2], _along_m: f64, point: &CurvePoint) -> AcrossExpansion {
        Foot::of(position, point).across()
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
        curve.locate(position, near_m)
    }

    /// Like [`CentreLine::project`], with the derivatives over the position that [`RoadExpansion`] states.
    ///
    /// The third derivative of the line is continuous between knots only, and so is the second derivative of `s`.
    #[inline(always)]
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
            Shape::Curve(curve) => curve.locate(position, near_m),
        }
    }
}

impl CentreLine {
    /// The lateral part of [`CentreLine::expand`].
    #[inline(always)]
    pub(in crate::road) fn expand_across(&self, position: [f64; 2], near_m: Option<f64>) -> AcrossExpansion {
        match &self.0 {
            Shape::Straight { cos, sin, .. } => {
                let [_, across_m] = straight_coordinates(*cos, *sin, position);
                AcrossExpansion { across_m, gradient: [-sin, *cos], hessian: [0.0; 3] }
            }
            Shape::Curve(curve) => curve.locate(position, near_m),
        }
    }
}

/// The expressions of [`Corridor::along`](crate::Corridor::along) and [`Corridor::across`](crate::Corridor::across).
fn straight_coordinates(cos: f64, sin: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    [cos * x + sin * y, -sin * x + cos * y]
}

/// What the road coordinates of a position and their derivatives share.
struct Foot {
    tangent: [f64; 2],
    normal: [f64; 2],
    /// `1/v`.
    slowness: f64,
    across_m: f64,
    curvature: f64,
    /// `1/q`.
    inverse_stretch: f64,
}

impl Foot {
    #[inline(always)]
    fn of(position: [f64; 2], point: &CurvePoint) -> Foot {
        let [place, first, second, _] = point.jet;
        let slowness = point.inverse_speed();
        let tangent = first.map(|component| component * slowness);
        let normal = [-tangent[1], tangent[0]];
        let across_m = dot(normal, [position[0] - place[0], position[1] - place[1]]);
        let curvature = cross(tangent, second) * (slowness * slowness);
        let inverse_stretch = 1.0 / (1.0 - curvature * across_m).max(RoadExpansion::MIN_STRETCH);
        Foot { tangent, normal, slowness, across_m, curvature, inverse_stretch }
    }

    /// The entries of `t tᵀ`.
    #[inline(always)]
    fn tangents(&self) -> [f64; 3] {
        let [x, y] = self.tangent;
        [x * x, x * y, y * y]
    }

    #[inline(always)]
    fn across(&self) -> AcrossExpansion {
        let bend = -self.curvature * self.inverse_stretch;
        let hessian = self.tangents().map(|entry| bend * entry);
        AcrossExpansion { across_m: self.across_m, gradient: self.normal, hessian }
    }
}

impl RoadReading for RoadExpansion {
    #[inline(always)]
    fn at(position: [f64; 2], along_m: f64, point: &CurvePoint) -> RoadExpansion {
        let [_, first, second, third] = point.jet;
        let foot = Foot::of(position, point);
        let Foot { tangent, normal, slowness, across_m, curvature, inverse_stretch } = foot;
        let speed = dot(first, first) * slowness;
        let speed_slope = dot(tangent, second);
        let curvature_slope = cross(tangent, third) * (slowness * slowness) - 3.0 * curvature * speed_slope * slowness;
        let shrink = inverse_stretch * slowness;
        let tangents = foot.tangents();
        let mixed = curvature * inverse_stretch * shrink;
        let along_bend = (curvature_slope * across_m * inverse_stretch - speed_slope * slowness) * (shrink * shrink);
        let AcrossExpansion { gradient: across_gradient, hessian: across_hessian, .. } = foot.across();
        RoadExpansion {
            along_m,
            along_gradient: tangent.map(|component| component * shrink),
            along_hessian: [
                2.0 * mixed * normal[0] * tangent[0] + along_bend * tangents[0],
                mixed * (normal[0] * tangent[1] + normal[1] * tangent[0]) + along_bend * tangents[1],
                2.0 * mixed * normal[1] * tangent[1] + along_bend * tangents[2],
            ],
            across_m,
            across_gradient,
            across_hessian,
            heading_rad: point.heading_rad(),
            heading_slope_radpm: curvature * speed,
            heading_bend_radpm2: curvature_slope * speed + curvature * speed_slope,
            curvature_1pm: curvature,
        }
    }
}
