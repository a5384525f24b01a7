//! Frenet coordinates of a position: its nearest point on a centre line, with derivatives.

use super::frenet::{AcrossExpansion, FrenetExpansion, FrenetPoint};
use super::line::{CentreLine, Curve, CurvePoint, Shape};
use super::nearest::SearchStep;
use super::segment::{cross, dot};

impl Curve {
    /// Frenet coordinates of a position, searched from `near_m` on or on the whole curve.
    ///
    /// Where the first step of the search is the last one, as from a place that an expansion has led to, nothing passes through
    /// memory.
    #[inline(always)]
    fn locate<R: FrenetReading>(&self, position: [f64; 2], near_m: Option<f64>) -> R {
        let Some(near_m) = near_m.filter(|near_m| near_m.is_finite()) else {
            return self.locate_anywhere(position);
        };
        let point = self.point(near_m);
        let step = SearchStep::from(&point, position);
        if step.slope != 0.0 && step.is_last() {
            return R::at(position, near_m + step.length_m, &point.moved(step.length_m));
        }
        self.locate_from(position, near_m, point, step)
    }

    #[inline(never)]
    fn locate_from<'a, R: FrenetReading>(
        &'a self,
        position: [f64; 2],
        near_m: f64,
        point: CurvePoint<'a>,
        step: SearchStep,
    ) -> R {
        let (along_m, point) = self.descend_on(position, near_m, point, step);
        R::at(position, along_m, &point)
    }

    #[inline(never)]
    fn locate_anywhere<R: FrenetReading>(&self, position: [f64; 2]) -> R {
        let (along_m, point) = self.nearest(position);
        R::at(position, along_m, &point)
    }
}

/// Frenet coordinates that are read off the nearest point of a curve.
trait FrenetReading {
    /// Those of a position whose nearest point lies at an arc length.
    fn at(position: [f64; 2], along_m: f64, point: &CurvePoint) -> Self;
}

impl FrenetReading for FrenetPoint {
    #[inline(always)]
    fn at(position: [f64; 2], along_m: f64, point: &CurvePoint) -> FrenetPoint {
        let [place, first, ..] = point.jet;
        let apart = [position[0] - place[0], position[1] - place[1]];
        FrenetPoint {
            along_m,
            across_m: cross(first, apart) * point.inverse_speed(),
            heading_rad: point.heading_rad(),
            curvature_1pm: point.curvature_1pm(),
        }
    }
}

impl FrenetReading for AcrossExpansion {
    #[inline(always)]
    fn at(position: [f64; 2], _along_m: f64, point: &CurvePoint) -> AcrossExpansion {
        Foot::of(position, point).across()
    }
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
    pub fn project(&self, position: [f64; 2], near_m: Option<f64>) -> FrenetPoint {
        let curve = match &self.0 {
            Shape::Straight { heading_rad, cos, sin } => {
                let [along_m, across_m] = straight_coordinates(*cos, *sin, position);
                return FrenetPoint { along_m, across_m, heading_rad: *heading_rad, curvature_1pm: 0.0 };
            }
            Shape::Curve(curve) => curve,
        };
        curve.locate(position, near_m)
    }

    /// Like [`CentreLine::project`], with the derivatives over the position that [`FrenetExpansion`] states.
    ///
    /// The third derivative of the line is continuous between knots only, and so is the second derivative of `s`.
    #[inline(always)]
    pub fn expand(&self, position: [f64; 2], near_m: Option<f64>) -> FrenetExpansion {
        match &self.0 {
            Shape::Straight { heading_rad, cos, sin } => {
                let [along_m, across_m] = straight_coordinates(*cos, *sin, position);
                FrenetExpansion {
                    along_m,
                    along_gradient: [*cos, *sin],
                    across_m,
                    across_gradient: [-sin, *cos],
                    heading_rad: *heading_rad,
                    ..FrenetExpansion::default()
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

/// What the Frenet coordinates of a position and their derivatives share.
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
        let inverse_stretch = 1.0 / (1.0 - curvature * across_m).max(FrenetExpansion::MIN_STRETCH);
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

impl FrenetReading for FrenetExpansion {
    #[inline(always)]
    fn at(position: [f64; 2], along_m: f64, point: &CurvePoint) -> FrenetExpansion {
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
        FrenetExpansion {
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
