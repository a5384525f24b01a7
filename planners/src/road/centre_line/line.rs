//! A centre line and its points.

use std::sync::Arc;

use super::chord::{Chord, ChordGroup};
use super::segment::{Jet, Segment};

/// A plane curve of which position, heading and curvature are continuous, by arc length.
///
/// Beyond both ends the line continues straight, with the heading of that end and zero curvature. So the curvature
/// jumps at an end that is curved. Copies share their knots.
#[derive(Clone, Debug, PartialEq)]
pub struct CentreLine(pub(super) Shape);

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    /// A straight line through the origin, without ends.
    Straight {
        /// Its heading \[rad\].
        heading_rad: f64,
        /// Cosine of the heading.
        cos: f64,
        /// Sine of the heading.
        sin: f64,
    },
    /// A curve by its knots.
    Curve(Arc<Curve>),
}

/// A point of a centre line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinePoint {
    /// Position of the point \[m\].
    pub position: [f64; 2],
    /// Direction of the line, without jumps of a full turn along the line \[rad\].
    pub heading_rad: f64,
    /// Signed curvature, positive to the left \[1/m\].
    pub curvature_1pm: f64,
}

/// How many sections of the index there are for each segment: with more, fewer sections hold a knot and need a search.
const SECTIONS_PER_SEGMENT: usize = 4;

/// Segments that follow each other, with an index by arc length.
#[derive(Debug, PartialEq)]
pub(super) struct Curve {
    /// At least one, in the order of arc length, from 0.
    pub segments: Vec<Segment>,
    /// Arc length of all segments \[m\].
    pub length_m: f64,
    pub chords: Vec<Chord>,
    pub groups: Vec<ChordGroup>,
    /// For the begin of each of equally long sections, and for the end of the line: the number of the segment there.
    sections: Vec<u32>,
    sections_per_m: f64,
}

/// A place on a curve: its derivatives, and the segment whose heading counts there.
#[derive(Clone, Copy, Debug)]
pub(super) struct CurvePoint<'a> {
    pub jet: Jet,
    segment: &'a Segment,
}

impl CurvePoint<'_> {
    /// Heading of the curve \[rad\].
    pub fn heading_rad(&self) -> f64 {
        self.segment.heading_rad(self.jet[1])
    }

    /// The point a small distance further along the curve, by its Taylor series.
    #[inline(always)]
    pub fn moved(self, by_m: f64) -> Self {
        let [place, first, second, third] = self.jet;
        let jet = [
            std::array::from_fn(|axis| place[axis] + by_m * (first[axis] + 0.5 * by_m * second[axis])),
            std::array::from_fn(|axis| first[axis] + by_m * (second[axis] + 0.5 * by_m * third[axis])),
            std::array::from_fn(|axis| second[axis] + by_m * third[axis]),
            third,
        ];
        CurvePoint { jet, ..self }
    }

    /// The inverse `1/v` of the speed `v = |p′|` over the arc length.
    pub fn inverse_speed(&self) -> f64 {
        let [_, [x, y], ..] = self.jet;
        1.0 / (x * x + y * y).sqrt()
    }

    /// Signed curvature `(x′y″ − y′x″)/v³` \[1/m\].
    pub fn curvature_1pm(&self) -> f64 {
        let ([_, first, second, _], slowness) = (self.jet, self.inverse_speed());
        (first[0] * second[1] - first[1] * second[0]) * (slowness * slowness * slowness)
    }
}

impl Curve {
    /// Joins segments end to end and continues the heading of the first. `None` without segments.
    pub fn new(parts: Vec<Segment>) -> Option<Curve> {
        let first = parts.first()?;
        let mut heading_rad = first.heading_rad(first.knot(0.0)[1]);
        let mut from_m = 0.0;
        let mut segments = Vec::with_capacity(parts.len());
        for part in parts {
            let segment = part.placed(from_m, heading_rad);
            heading_rad = segment.heading_rad(segment.knot(segment.length_m)[1]);
            from_m = segment.end_m();
            segments.push(segment);
        }
        let count = SECTIONS_PER_SEGMENT * segments.len();
        let sections_per_m = count as f64 / from_m;
        let begins = (0..=count).map(|section| section as f64 / sections_per_m);
        let number = |along_m: f64| segments.partition_point(|segment| segment.from_m <= along_m).saturating_sub(1);
        let sections = begins.map(|along_m| number(along_m) as u32).collect();
        let starts = segments.iter().map(Segment::start);
        let last = segments.last().map(|last| last.knot(last.length_m)[0]);
        let ends = starts.clone().zip(starts.skip(1).chain(last));
        let chords: Vec<Chord> = ends.map(|(from, to)| Chord::new(from, to)).collect();
        let groups = ChordGroup::all(&chords);
        Some(Curve { segments, length_m: from_m, chords, groups, sections, sections_per_m })
    }

    /// The segment that holds an arc length between 0 and the length; at a knot, up to rounding, one of both.
    #[inline(always)]
    fn segment(&self, along_m: f64) -> &Segment {
        let section = ((along_m * self.sections_per_m) as usize).min(self.sections.len() - 2);
        let (first, last) = (self.sections[section] as usize, self.sections[section + 1] as usize);
        if first == last {
            return &self.segments[first];
        }
        let after = &self.segments[first + 1..=last];
        &self.segments[first + after.partition_point(|segment| segment.from_m <= along_m)]
    }

    /// The first and the last segment.
    pub fn ends(&self) -> [&Segment; 2] {
        [&self.segments[0], &self.segments[self.segments.len() - 1]]
    }

    /// The point of the curve at an arc length; beyond its ends the curve is straight.
    #[inline(always)]
    pub fn point(&self, along_m: f64) -> CurvePoint<'_> {
        let [first, last] = self.ends();
        if along_m < 0.0 {
            CurvePoint { jet: beyond(first.jet(0.0), along_m), segment: first }
        } else if along_m > self.length_m {
            CurvePoint { jet: beyond(last.jet(last.length_m), along_m - self.length_m), segment: last }
        } else {
            let segment = self.segment(along_m);
            CurvePoint { jet: segment.jet(along_m - segment.from_m), segment }
        }
    }

    /// As [`Curve::point`], but without a search if the arc length is on the segment of another point.
    #[inline]
    pub fn point_near<'a>(&'a self, along_m: f64, other: &CurvePoint<'a>) -> CurvePoint<'a> {
        let u = along_m - other.segment.from_m;
        if u >= 0.0 && u <= other.segment.length_m {
            CurvePoint { jet: other.segment.jet(u), segment: other.segment }
        } else {
            self.point(along_m)
        }
    }
}

/// The straight continuation of a curve at a distance from its end.
fn beyond([end, tangent, ..]: Jet, distance: f64) -> Jet {
    let position = [end[0] + distance * tangent[0], end[1] + distance * tangent[1]];
    [position, tangent, [0.0; 2], [0.0; 2]]
}

impl CentreLine {
    /// The straight line of a heading \[rad\] through the origin, without ends; its arc length is 0 at the origin.
    ///
    /// `along = cos ψ x + sin ψ y` and `across = −sin ψ x + cos ψ y` are those of a [`Corridor`](crate::Corridor), bit for
    /// bit.
    pub fn straight(heading_rad: f64) -> CentreLine {
        let (sin, cos) = libm::sincos(heading_rad);
        CentreLine(Shape::Straight { heading_rad, cos, sin })
    }

    /// The line of these segments, if there are any.
    pub(super) fn from_segments(parts: Vec<Segment>) -> Option<CentreLine> {
        Some(CentreLine(Shape::Curve(Arc::new(Curve::new(parts)?))))
    }

    /// Arc length of the line; infinite for [`CentreLine::straight`] \[m\].
    pub fn length_m(&self) -> f64 {
        match &self.0 {
            Shape::Straight { .. } => f64::INFINITY,
            Shape::Curve(curve) => curve.length_m,
        }
    }

    /// The point at an arc length \[m\]; beyond the ends it is on the straight continuation.
    pub fn at(&self, along_m: f64) -> LinePoint {
        match &self.0 {
            Shape::Straight { heading_rad, cos, sin } => {
                LinePoint { position: [cos * along_m, sin * along_m], heading_rad: *heading_rad, curvature_1pm: 0.0 }
            }
            Shape::Curve(curve) => {
                let point = curve.point(along_m);
                LinePoint {
                    position: point.jet[0],
                    heading_rad: point.heading_rad(),
                    curvature_1pm: point.curvature_1pm(),
                }
            }
        }
    }

    /// The position at an arc length and a lateral distance, positive to the left \[m\].
    pub fn position(&self, along_m: f64, across_m: f64) -> [f64; 2] {
        match &self.0 {
            Shape::Straight { cos, sin, .. } => [cos * along_m - sin * across_m, sin * along_m + cos * across_m],
            Shape::Curve(curve) => {
                let [position, [x, y], ..] = curve.point(along_m).jet;
                let scale = across_m / (x * x + y * y).sqrt();
                [position[0] - scale * y, position[1] + scale * x]
            }
        }
    }

    /// Arc lengths of the knots, both ends included \[m\]; none for [`CentreLine::straight`].
    pub fn knots_m(&self) -> Vec<f64> {
        match &self.0 {
            Shape::Straight { .. } => Vec::new(),
            Shape::Curve(curve) => {
                curve.segments.iter().map(|segment| segment.from_m).chain([curve.length_m]).collect()
            }
        }
    }
}
