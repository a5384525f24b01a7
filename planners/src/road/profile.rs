//! Quantities along a road, such as the width of a lane or the lateral coordinate of an edge.

use std::sync::Arc;

use thiserror::Error;

use super::corridor::LaneEnd;

/// A twice continuously differentiable quantity over the arc length of a road. Copies share their knots.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile(Form);

#[derive(Clone, Debug, PartialEq)]
enum Form {
    Constant(f64),
    LaneEnd {
        edge_m: f64,
        end: LaneEnd,
    },
    /// At least one, in the order of arc length.
    Stretches(Arc<[Stretch]>),
}

/// A monotone polynomial of degree 5 between two knots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Arc length at the first knot \[m\].
    pub from_m: f64,
    /// Arc length at the second knot \[m\].
    pub to_m: f64,
    /// Coefficients over the distance from the first knot, from the constant on.
    pub coefficients: [f64; 6],
}

/// Why knots do not define a [`Profile`]. Knots are counted from 0.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum ProfileError {
    /// There are no knots.
    #[error("a profile needs at least one knot")]
    NoKnots,
    /// A number of a knot is infinite or not a number (NaN).
    #[error("knot {knot} has a number that is not finite")]
    NotFinite {
        /// Index of the knot.
        knot: usize,
    },
    /// The arc lengths do not increase.
    #[error("knot {knot} at {along_m} m does not lie beyond the knot before it")]
    NotIncreasing {
        /// Index of the later knot.
        knot: usize,
        /// Arc length of the later knot \[m\].
        along_m: f64,
    },
    /// A stretch does not begin with the arc length, value, slope and bend of the end before it.
    #[error("stretch {stretch} does not continue the one before it")]
    Gap {
        /// Index of the stretch.
        stretch: usize,
    },
}

/// Values, slopes and bends that differ by less continue each other.
const JOINT_TOLERANCE: f64 = 1e-9;

impl Profile {
    /// A profile with the same value everywhere.
    pub fn constant(value: f64) -> Profile {
        Profile(Form::Constant(value))
    }

    /// A right edge at `edge_m` that moves to the left where the rightmost lane ends, equal to
    /// [`Corridor::right_edge_m`](crate::Corridor::right_edge_m) bit for bit \[m\].
    pub fn lane_end(edge_m: f64, end: LaneEnd) -> Profile {
        Profile(Form::LaneEnd { edge_m, end })
    }

    /// Values at arc lengths, given as (arc length \[m\], value), and between them the quintic smoothstep
    /// `6 τ⁵ − 15 τ⁴ + 10 τ³`: slope and bend are zero at every knot. Before the first knot and after the last one the value
    /// is constant.
    ///
    /// # Errors
    /// [`ProfileError`] where there are no knots, their arc lengths do not increase, or a number is not finite.
    pub fn steps(knots: &[[f64; 2]]) -> Result<Profile, ProfileError> {
        Profile::hermite(knots, &vec![0.0; knots.len()])
    }

    /// A curve through values at arc lengths, given as (arc length \[m\], value), without overshoot: between two knots it is
    /// monotone. Before the first knot and after the last one the value is constant.
    ///
    /// At a knot the slope is the harmonic mean of the slopes beside it, and zero at an extremum or an end (Fritsch and
    /// Butland); the bend is zero. Values that lie on a straight line stay on it.
    ///
    /// # Errors
    /// [`ProfileError`] where there are no knots, their arc lengths do not increase, or a number is not finite.
    pub fn through(knots: &[[f64; 2]]) -> Result<Profile, ProfileError> {
        let secant = |i: usize| (knots[i + 1][1] - knots[i][1]) / (knots[i + 1][0] - knots[i][0]);
        let slope = |i: usize| {
            if i == 0 || i + 1 >= knots.len() {
                return 0.0;
            }
            let (before, after) = (secant(i - 1), secant(i));
            if before * after > 0.0 { 2.0 * before * after / (before + after) } else { 0.0 }
        };
        let slopes: Vec<f64> = (0..knots.len()).map(slope).collect();
        Profile::hermite(knots, &slopes)
    }

    /// The polynomials of degree 5 with these values and slopes at knots, and no bend there.
    fn hermite(knots: &[[f64; 2]], slopes: &[f64]) -> Result<Profile, ProfileError> {
        if let Some(knot) = knots.iter().position(|knot| !knot.iter().all(|number| number.is_finite())) {
            return Err(ProfileError::NotFinite { knot });
        }
        if let Some(before) = knots.windows(2).position(|pair| pair[1][0] <= pair[0][0]) {
            return Err(ProfileError::NotIncreasing { knot: before + 1, along_m: knots[before + 1][0] });
        }
        let Some([_, first]) = knots.first() else { return Err(ProfileError::NoKnots) };
        if knots.iter().all(|[_, value]| value == first) {
            return Ok(Profile::constant(*first));
        }
        // Knots inside a constant part are removed: with fewer knots a search is faster.
        let is_needed = |i: &usize| {
            *i == 0 || *i + 1 == knots.len() || knots[i - 1][1] != knots[*i][1] || knots[i + 1][1] != knots[*i][1]
        };
        let needed: Vec<usize> = (0..knots.len()).filter(is_needed).collect();
        let stretch = |pair: &[usize]| {
            let ([from_m, from], [to_m, to]) = (knots[pair[0]], knots[pair[1]]);
            let [slope, end_slope] = [slopes[pair[0]], slopes[pair[1]]];
            let h = to_m - from_m;
            let (place, bow) = (to - from - h * slope, h * (end_slope - slope));
            let coefficients = [
                from,
                slope,
                0.0,
                (10.0 * place - 4.0 * bow) / (h * h * h),
                (-15.0 * place + 7.0 * bow) / (h * h * h * h),
                (6.0 * place - 3.0 * bow) / (h * h * h * h * h),
            ];
            Stretch { from_m, to_m, coefficients }
        };
        Ok(Profile(Form::Stretches(needed.windows(2).map(stretch).collect())))
    }

    /// The polynomials between its knots, in the order of arc length; none for a profile that is constant or the edge at a lane
    /// end.
    pub fn stretches(&self) -> &[Stretch] {
        match &self.0 {
            Form::Stretches(stretches) => stretches,
            _ => &[],
        }
    }

    /// The profile of [`Profile::stretches`]. Each must be monotone, which is not checked: [`Profile::extremes`] relies on it.
    ///
    /// # Errors
    /// [`ProfileError`] where there are no stretches, one has no length, one does not continue the one before, or a number is not
    /// finite.
    pub fn from_stretches(stretches: &[Stretch]) -> Result<Profile, ProfileError> {
        for (knot, stretch) in stretches.iter().enumerate() {
            if !stretch.coefficients.iter().chain([&stretch.from_m, &stretch.to_m]).all(|number| number.is_finite()) {
                return Err(ProfileError::NotFinite { knot });
            }
            if stretch.to_m <= stretch.from_m {
                return Err(ProfileError::NotIncreasing { knot: knot + 1, along_m: stretch.to_m });
            }
        }
        let is_gap = |pair: &[Stretch]| {
            let (end, begin) = (pair[0].at(pair[0].to_m - pair[0].from_m), pair[1].at(0.0));
            pair[0].to_m != pair[1].from_m || end.iter().zip(begin).any(|(a, b)| (a - b).abs() > JOINT_TOLERANCE)
        };
        match stretches.windows(2).position(is_gap) {
            _ if stretches.is_empty() => Err(ProfileError::NoKnots),
            Some(before) => Err(ProfileError::Gap { stretch: before + 1 }),
            None => Ok(Profile(Form::Stretches(stretches.into()))),
        }
    }

    /// The profile with the opposite sign, without the end of a lane.
    pub(super) fn mirrored(&self) -> Profile {
        Profile(match &self.0 {
            Form::Constant(value) => Form::Constant(-value),
            Form::LaneEnd { edge_m, .. } => Form::Constant(-edge_m),
            Form::Stretches(stretches) => {
                let mirrored =
                    |stretch: &Stretch| Stretch { coefficients: stretch.coefficients.map(|c| -c), ..*stretch };
                Form::Stretches(stretches.iter().map(mirrored).collect())
            }
        })
    }

    /// The value everywhere, if it is the same.
    pub(super) fn as_constant(&self) -> Option<f64> {
        match &self.0 {
            Form::Constant(value) => Some(*value),
            _ => None,
        }
    }

    /// The lane end at which this edge moves, if any.
    pub fn end(&self) -> Option<LaneEnd> {
        match &self.0 {
            Form::LaneEnd { end, .. } => Some(*end),
            _ => None,
        }
    }

    /// The value at an arc length \[m\], ignoring any lane end.
    pub fn value_before_end(&self, along_m: f64) -> f64 {
        match &self.0 {
            Form::LaneEnd { edge_m, .. } => *edge_m,
            _ => self.value(along_m),
        }
    }

    /// Value, slope and bend (first and second derivative over the arc length) at an arc length \[m\].
    pub fn at(&self, along_m: f64) -> [f64; 3] {
        match &self.0 {
            Form::Constant(value) => [*value, 0.0, 0.0],
            Form::LaneEnd { edge_m, end } => end.edge(*edge_m, along_m),
            Form::Stretches(stretches) => {
                let after = stretches.partition_point(|stretch| stretch.from_m <= along_m);
                match (after.checked_sub(1).map(|index| &stretches[index]), stretches.first()) {
                    (Some(stretch), _) if along_m < stretch.to_m => stretch.at(along_m - stretch.from_m),
                    (Some(stretch), _) => [stretch.at(stretch.to_m - stretch.from_m)[0], 0.0, 0.0],
                    (None, first) => [first.map_or(0.0, |first| first.coefficients[0]), 0.0, 0.0],
                }
            }
        }
    }

    /// The value at an arc length \[m\].
    pub fn value(&self, along_m: f64) -> f64 {
        self.at(along_m)[0]
    }

    /// The first derivative over the arc length.
    pub fn slope(&self, along_m: f64) -> f64 {
        self.at(along_m)[1]
    }

    /// The second derivative over the arc length.
    pub fn bend(&self, along_m: f64) -> f64 {
        self.at(along_m)[2]
    }

    /// The least and the greatest value between two arc lengths \[m\]. It is exact: between knots a profile is monotone.
    pub fn extremes(&self, from_m: f64, to_m: f64) -> [f64; 2] {
        let knots = match &self.0 {
            Form::Constant(value) => return [*value; 2],
            Form::LaneEnd { .. } => &[],
            Form::Stretches(stretches) => {
                let first = stretches.partition_point(|stretch| stretch.to_m < from_m);
                let count = stretches[first..].partition_point(|stretch| stretch.from_m <= to_m);
                &stretches[first..first + count]
            }
        };
        let between =
            knots.iter().flat_map(|knot| [knot.from_m, knot.to_m]).filter(|at_m| (from_m..=to_m).contains(at_m));
        let values = between.chain([from_m, to_m]).map(|at_m| self.value(at_m));
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], value| [least.min(value), most.max(value)])
    }
}

impl Stretch {
    fn at(&self, u: f64) -> [f64; 3] {
        let c = &self.coefficients;
        [
            c[0] + u * (c[1] + u * (c[2] + u * (c[3] + u * (c[4] + u * c[5])))),
            c[1] + u * (2.0 * c[2] + u * (3.0 * c[3] + u * (4.0 * c[4] + u * (5.0 * c[5])))),
            2.0 * c[2] + u * (6.0 * c[3] + u * (12.0 * c[4] + u * (20.0 * c[5]))),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Body, Corridor, State};

    #[test]
    fn the_profile_of_a_lane_end_equals_the_corridor_bit_for_bit() {
        let end = LaneEnd { end_m: 3.5, height_m: 0.37, taper_m: 0.3 };
        let corridor = Corridor { heading_rad: 0.0, right_m: -0.1, left_m: 0.9, end: Some(end) };
        let (profile, body) = (Profile::lane_end(-0.1, end), Body::default());
        for step in -20..80 {
            let along_m = 0.05 * f64::from(step);
            assert_eq!(profile.value(along_m).to_bits(), corridor.right_edge_m(along_m).to_bits());
            let state = State { x_m: along_m, y_m: 0.4, heading_rad: 0.0, speed_mps: 0.0 };
            let corner = corridor.clearances(&body, &state)[0];
            let [_, slope, bend] = profile.at(along_m + body.front_m);
            assert_eq!((-corner.gradient[0], -corner.hessian[0]), (slope, bend));
        }
    }

    #[test]
    fn derivatives_agree_with_finite_differences_and_are_continuous() {
        let knots = [[1.0, 3.0], [4.0, 3.0], [6.0, 5.0], [7.0, 2.0], [9.0, 1.0], [12.0, 0.5]];
        let end = LaneEnd { end_m: 5.0, height_m: 2.0, taper_m: 1.0 };
        let profiles = [Profile::steps(&knots), Profile::through(&knots), Ok(Profile::lane_end(0.0, end))];
        for profile in profiles.map(|profile| profile.expect("sound knots")) {
            for step in 0..1300 {
                let at_m = 0.01 * f64::from(step) + 0.003;
                let ([before, ..], [_, slope, bend], [after, ..]) =
                    (profile.at(at_m - 1e-5), profile.at(at_m), profile.at(at_m + 1e-5));
                assert!(((after - before) / 2e-5 - slope).abs() < 1e-6, "slope at {at_m}");
                let difference = (profile.slope(at_m + 1e-5) - profile.slope(at_m - 1e-5)) / 2e-5;
                assert!((difference - bend).abs() < 1e-4, "bend at {at_m}");
            }
            for [knot_m, _] in knots {
                let (before, after) = (profile.at(knot_m - 1e-9), profile.at(knot_m + 1e-9));
                assert!((0..3).all(|order| (before[order] - after[order]).abs() < 1e-6), "{before:?} {after:?}");
            }
        }
    }

    #[test]
    fn profiles_are_monotone_between_knots_and_keep_straight_lines() {
        let knots = [[0.0, 0.0], [1.0, 0.1], [2.0, 4.0], [3.0, 4.1], [4.0, 1.0], [5.0, 1.0]];
        for profile in [Profile::steps(&knots), Profile::through(&knots)].map(|profile| profile.expect("sound knots")) {
            for pair in knots.windows(2) {
                let rises = pair[1][1] >= pair[0][1];
                let slopes = (0..=100).map(|step| profile.slope(pair[0][0] + 0.01 * f64::from(step)));
                assert!(slopes.into_iter().all(|slope| if rises { slope >= -1e-12 } else { slope <= 1e-12 }));
            }
            let (extremes, part) = (profile.extremes(-1.0, 9.0), profile.extremes(3.2, 3.4));
            assert!((extremes[0] - 0.0).abs() < 1e-12 && (extremes[1] - 4.1).abs() < 1e-12);
            assert_eq!(part, [profile.value(3.4), profile.value(3.2)]);
        }
        let flat = [[0.0, 1.0], [1.0, 1.0], [2.0, 1.0], [3.0, 1.0], [4.0, 2.0]];
        let fewer = [flat[0], flat[3], flat[4]];
        assert_eq!(Profile::through(&flat), Profile::through(&fewer), "constant parts need no knots");
        let line: Vec<[f64; 2]> = (0..6).map(|i| [f64::from(i), 2.0 * f64::from(i)]).collect();
        assert!((Profile::through(&line).expect("sound knots").value(2.3) - 4.6).abs() < 1e-14);
    }

    #[test]
    fn invalid_profiles_are_refused() {
        assert_eq!(Profile::steps(&[]), Err(ProfileError::NoKnots));
        assert_eq!(Profile::through(&[[0.0, f64::NAN]]), Err(ProfileError::NotFinite { knot: 0 }));
        let back = [[0.0, 1.0], [2.0, 1.0], [2.0, 3.0]];
        assert_eq!(Profile::steps(&back), Err(ProfileError::NotIncreasing { knot: 2, along_m: 2.0 }));
        assert_eq!(Profile::steps(&[[3.0, 7.0]]), Ok(Profile::constant(7.0)));
        assert_eq!(Profile::from_stretches(&[]), Err(ProfileError::NoKnots));
        let parts = Profile::steps(&[[0.0, 1.0], [2.0, 4.0], [3.0, 5.0]]).expect("sound knots").stretches().to_vec();
        assert_eq!(Profile::from_stretches(&[parts[1], parts[0]]), Err(ProfileError::Gap { stretch: 1 }));
    }

    #[test]
    fn a_profile_rebuilt_from_its_polynomials_is_the_same_profile() {
        let knots = [[1.0, 3.0], [4.0, 3.0], [6.0, 5.0], [7.0, 2.0], [9.0, 1.0], [12.0, 0.5]];
        for profile in [Profile::steps(&knots), Profile::through(&knots)].map(|profile| profile.expect("sound knots")) {
            assert_eq!(Profile::from_stretches(profile.stretches()), Ok(profile));
        }
    }
}
