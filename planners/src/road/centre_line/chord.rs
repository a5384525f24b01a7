//! The straight line between the ends of a segment, for the search of the segment that is nearest to a position.

use std::ops::Range;

/// A chord, with what is needed to tell how near it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Chord {
    /// Where it begins \[m\].
    from: [f64; 2],
    /// From its begin to its end \[m\].
    to_end: [f64; 2],
    /// The square of its length \[m²\].
    square: f64,
    /// Its middle \[m\].
    middle: [f64; 2],
    /// Half of its length \[m\].
    half_m: f64,
}

/// A chord counts as beyond a distance only by more than this share: far more than rounding.
const MARGIN_RATIO: f64 = 1e-6;

impl Chord {
    pub fn new(from: [f64; 2], to: [f64; 2]) -> Chord {
        let to_end = [to[0] - from[0], to[1] - from[1]];
        let square = to_end[0] * to_end[0] + to_end[1] * to_end[1];
        let middle = [from[0] + 0.5 * to_end[0], from[1] + 0.5 * to_end[1]];
        Chord { from, to_end, square, middle, half_m: 0.5 * square.sqrt() }
    }

    /// The distance of a position from the chord \[m\], and the share of the chord before the nearest point.
    pub fn nearest(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let Chord { from, to_end, square, .. } = *self;
        let apart = [x - from[0], y - from[1]];
        let share = ((to_end[0] * apart[0] + to_end[1] * apart[1]) / square).clamp(0.0, 1.0);
        let foot = [from[0] + share * to_end[0], from[1] + share * to_end[1]];
        let missed = [foot[0] - x, foot[1] - y];
        [(missed[0] * missed[0] + missed[1] * missed[1]).sqrt(), share]
    }

    /// The squared distance of a position from the middle of the chord \[m²\].
    pub fn squared_to_middle(&self, [x, y]: [f64; 2]) -> f64 {
        let apart = [x - self.middle[0], y - self.middle[1]];
        apart[0] * apart[0] + apart[1] * apart[1]
    }

    /// Whether it is certain that every point of the chord is farther than `distance_m` from a position.
    pub fn is_beyond(&self, distance_m: f64, position: [f64; 2]) -> bool {
        let reach_m = (1.0 + MARGIN_RATIO) * (distance_m + self.half_m);
        self.squared_to_middle(position) > reach_m * reach_m
    }
}

/// Chords one after another, and a circle around them, so that a search passes over all of them at once.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ChordGroup {
    /// Numbers of its chords.
    pub chords: Range<usize>,
    /// The length of the longest of them \[m\].
    pub longest_m: f64,
    /// The centre of the circle \[m\].
    middle: [f64; 2],
    /// The radius of the circle \[m\].
    reach_m: f64,
}

/// How many chords make a group.
const GROUP: usize = 12;

impl ChordGroup {
    /// Divides all chords of a curve into groups.
    pub fn all(chords: &[Chord]) -> Vec<ChordGroup> {
        let group = |(number, members): (usize, &[Chord])| {
            let mean = |axis: usize| members.iter().map(|chord| chord.middle[axis]).sum::<f64>() / members.len() as f64;
            let middle = [mean(0), mean(1)];
            let reaches_m = members.iter().map(|chord| chord.squared_to_middle(middle).sqrt() + chord.half_m);
            let first = number * GROUP;
            ChordGroup {
                chords: first..first + members.len(),
                longest_m: members.iter().map(|chord| 2.0 * chord.half_m).fold(0.0, f64::max),
                middle,
                reach_m: reaches_m.fold(0.0, f64::max),
            }
        };
        chords.chunks(GROUP).enumerate().map(group).collect()
    }

    /// Whether it is certain that every point of the chords of this group is farther than `distance_m` from a position.
    pub fn is_beyond(&self, distance_m: f64, [x, y]: [f64; 2]) -> bool {
        let apart = [x - self.middle[0], y - self.middle[1]];
        let reach_m = (1.0 + MARGIN_RATIO) * (distance_m + self.reach_m);
        apart[0] * apart[0] + apart[1] * apart[1] > reach_m * reach_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chord of 5 m: beside it, beyond its end, and what is certainly farther than a distance.
    #[test]
    fn the_nearest_point_on_a_chord_lies_between_its_ends() {
        let chord = Chord::new([1.0, 2.0], [4.0, 6.0]);
        let close = |[distance_m, share]: [f64; 2], expected: [f64; 2]| {
            (distance_m - expected[0]).abs() < 1e-12 && (share - expected[1]).abs() < 1e-12
        };
        // Two metres to the left of its middle, and three metres beyond its end.
        let (beside, ahead) = ([2.5 - 1.6, 4.0 + 1.2], [4.0 + 1.8, 6.0 + 2.4]);
        assert!(close(chord.nearest(beside), [2.0, 0.5]) && close(chord.nearest(ahead), [3.0, 1.0]));
        assert!(!chord.is_beyond(3.0, ahead) && chord.is_beyond(2.99, ahead));
        assert!(!chord.is_beyond(2.0, beside), "its circle reaches farther than the chord");
    }
}
