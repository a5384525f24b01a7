//! Makes centre lines from others: sections, parallels, the reverse, and several joined to one.

use super::error::CentreLineError;
use super::line::{CentreLine, Curve, Shape};
use super::reparametrisation::{by_arc_length, segments};
use super::segment::{Knot, Segment};

/// A section of a line that becomes part of a joined line.
#[derive(Clone, Copy, Debug)]
pub struct LineSection<'a> {
    /// The centre line.
    pub line: &'a CentreLine,
    /// Arc length at which the section begins \[m\].
    pub from_m: f64,
    /// Arc length at which it ends \[m\].
    pub to_m: f64,
}

/// Several sections joined to one line.
#[derive(Clone, Debug, PartialEq)]
pub struct JoinedLine {
    /// The centre line.
    pub line: CentreLine,
    /// For each section, where it begins and ends on the line \[m\]. Between them are the curves that join them.
    pub sections_m: Vec<[f64; 2]>,
}

/// Knots that differ by less continue each other: positions \[m\], tangents and the turn of curvatures over a metre \[rad\].
const JOINT_TOLERANCE: f64 = 1e-9;

/// How often the parameter of a joining curve is set to its length.
const LENGTH_PASSES: usize = 4;

/// Sections of lines are at least this long \[m\]: shorter ones are lost in rounding.
const MIN_SECTION_M: f64 = 1e-6;

impl CentreLine {
    /// The section between two arc lengths as a separate line \[m\].
    ///
    /// # Errors
    /// [`CentreLineError::NoSection`] where the section is empty, or reaches beyond the ends of the line by more than
    /// rounding, or has no finite length.
    pub fn between(&self, from_m: f64, to_m: f64) -> Result<CentreLine, CentreLineError> {
        let parts = section(&LineSection { line: self, from_m, to_m })?;
        CentreLine::from_segments(parts).ok_or(CentreLineError::NoSection { from_m, to_m })
    }

    /// The line at a constant lateral distance from this one, positive to the left \[m\]. Its curvature is `κ/(1 − κ n)`.
    ///
    /// # Errors
    /// [`CentreLineError::Cusp`] where `κ n ≥ 1`, and [`CentreLineError::NoSection`] for a line without ends.
    pub fn parallel(&self, across_m: f64) -> Result<CentreLine, CentreLineError> {
        let curve = self.curve()?;
        let mut found = Vec::new();
        for segment in &curve.segments {
            let offset = |u: f64| parallel_knot(segment, u, across_m);
            if let Some(at) = [0.0, 0.5, 1.0].iter().find(|share| offset(*share * segment.length_m).is_none()) {
                let [x_m, y_m] = segment.knot(at * segment.length_m)[0];
                return Err(CentreLineError::Cusp { x_m, y_m });
            }
            let knot = |u: f64| offset(u).unwrap_or([[f64::NAN; 2]; 3]);
            segments(&knot, 0.0, segment.length_m, &mut found)?;
        }
        CentreLine::from_segments(found).ok_or(CentreLineError::NoPieces)
    }

    /// The line in the opposite direction.
    ///
    /// # Errors
    /// [`CentreLineError::NoSection`] for a line without ends.
    pub fn reversed(&self) -> Result<CentreLine, CentreLineError> {
        let back = |[place, [x, y], bend]: Knot| [place, [-x, -y], bend];
        let reversed = |segment: &Segment| {
            let ends = [segment.knot(segment.length_m), segment.knot(0.0)].map(back);
            Segment::new(segment.length_m, ends[0], ends[1])
        };
        let parts = self.curve()?.segments.iter().rev().map(reversed).collect();
        CentreLine::from_segments(parts).ok_or(CentreLineError::NoPieces)
    }

    /// Joins sections, one after the other, to one line.
    ///
    /// Where a section does not begin with the position, heading and curvature of the end before it, a polynomial of degree 5
    /// joins them, which has those of both.
    ///
    /// # Errors
    /// [`CentreLineError::NoSection`] for a section as in [`CentreLine::between`], [`CentreLineError::NoPieces`] without
    /// sections, and [`CentreLineError::Cusp`] where two sections face each other so badly that no smooth curve joins them.
    pub fn joined(sections: &[LineSection]) -> Result<JoinedLine, CentreLineError> {
        let mut found: Vec<Segment> = Vec::new();
        let mut sections_m = Vec::new();
        let mut length_m = 0.0;
        for part in sections {
            let next = section(part)?;
            let before = found.len();
            if let (Some(last), Some(first)) = (found.last(), next.first()) {
                let ends = [last.knot(last.length_m), first.knot(0.0)].map(by_arc_length);
                if !continues(ends) {
                    join(ends, &mut found)?;
                }
            }
            length_m += found[before..].iter().map(|segment| segment.length_m).sum::<f64>();
            let from_m = length_m;
            length_m += next.iter().map(|segment| segment.length_m).sum::<f64>();
            sections_m.push([from_m, length_m]);
            found.extend(next);
        }
        let line = CentreLine::from_segments(found).ok_or(CentreLineError::NoPieces)?;
        Ok(JoinedLine { line, sections_m })
    }

    /// Whether another line begins with the position, heading and curvature of the end of this one, to `1e-9`.
    pub fn is_continued_by(&self, next: &CentreLine) -> bool {
        let (Ok(curve), Ok(next)) = (self.curve(), next.curve()) else { return false };
        let ([_, last], [first, _]) = (curve.ends(), next.ends());
        continues([last.knot(last.length_m), first.knot(0.0)].map(by_arc_length))
    }

    fn curve(&self) -> Result<&Curve, CentreLineError> {
        match &self.0 {
            Shape::Curve(curve) => Ok(curve),
            Shape::Straight { .. } => {
                Err(CentreLineError::NoSection { from_m: f64::NEG_INFINITY, to_m: f64::INFINITY })
            }
        }
    }
}

fn section(section: &LineSection) -> Result<Vec<Segment>, CentreLineError> {
    let &LineSection { line, from_m, to_m } = section;
    let nothing = CentreLineError::NoSection { from_m, to_m };
    if !(from_m.is_finite() && to_m.is_finite() && to_m - from_m > MIN_SECTION_M) {
        return Err(nothing);
    }
    let curve = match &line.0 {
        Shape::Straight { cos, sin, .. } => {
            let ends = [from_m, to_m].map(|along_m| [line.at(along_m).position, [*cos, *sin], [0.0; 2]]);
            return Ok(vec![Segment::new(to_m - from_m, ends[0], ends[1])]);
        }
        Shape::Curve(curve) => curve,
    };
    if from_m < -MIN_SECTION_M || to_m > curve.length_m + MIN_SECTION_M {
        return Err(nothing);
    }
    let (from_m, to_m) = (from_m.max(0.0), to_m.min(curve.length_m));
    let mut parts = Vec::new();
    for segment in &curve.segments {
        let (begin_m, end_m) = (from_m.max(segment.from_m), to_m.min(segment.end_m()));
        if begin_m == segment.from_m && end_m == segment.end_m() {
            parts.push(*segment);
        } else if end_m - begin_m > MIN_SECTION_M {
            parts.push(segment.part(begin_m - segment.from_m, end_m - segment.from_m));
        }
    }
    Ok(parts)
}

/// Whether two knots are the same, up to rounding.
pub(super) fn continues([before, after]: [Knot; 2]) -> bool {
    before.iter().flatten().zip(after.iter().flatten()).all(|(before, after)| (before - after).abs() < JOINT_TOLERANCE)
}

/// Adds the segments of a curve between two knots that are given by arc length.
fn join([before, after]: [Knot; 2], found: &mut Vec<Segment>) -> Result<(), CentreLineError> {
    let apart = [after[0][0] - before[0][0], after[0][1] - before[0][1]];
    let mut length_m = (apart[0] * apart[0] + apart[1] * apart[1]).sqrt();
    let mut joining = Vec::new();
    for _ in 0..LENGTH_PASSES {
        let whole = Segment::new(length_m, before, after);
        joining.clear();
        segments(&|u: f64| whole.knot(u), 0.0, length_m, &mut joining)?;
        length_m = joining.iter().map(|segment| segment.length_m).sum();
    }
    found.append(&mut joining);
    Ok(())
}

/// Position, first and second derivative of a parallel; none where it has no direction.
///
/// With the normal `m`, `p = c + n m`, `p′ = (1 − κ n) c′` and `p″ = (1 − κ n) c″ − κ′ n c′`.
fn parallel_knot(segment: &Segment, u: f64, across_m: f64) -> Option<Knot> {
    let [place, first, second, third] = segment.jet(u);
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let square = first[0] * first[0] + first[1] * first[1];
    let speed = square.sqrt();
    let curvature = cross(first, second) / (square * speed);
    let speed_slope = (first[0] * second[0] + first[1] * second[1]) / speed;
    let curvature_slope = cross(first, third) / (square * speed) - 3.0 * curvature * speed_slope / speed;
    let stretch = 1.0 - curvature * across_m;
    let bend = |axis: usize| stretch * second[axis] - curvature_slope * across_m * first[axis];
    (stretch > 0.0).then_some([
        [place[0] - across_m * first[1] / speed, place[1] + across_m * first[0] / speed],
        [stretch * first[0], stretch * first[1]],
        [bend(0), bend(1)],
    ])
}
