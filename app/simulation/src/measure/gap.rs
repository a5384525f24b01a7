//! The smallest distances between footprints in a run.

use crate::frame::{Frame, PairGap};

/// The smallest distances so far.
#[derive(Clone, Debug, Default)]
pub struct SmallestGap {
    /// Of the ego to another \[m\]; none without other vehicles.
    pub smallest_m: Option<f64>,
    /// Of any two vehicles, when it was reached first; none if there is only one.
    pub closest: Option<PairGap>,
}

impl SmallestGap {
    /// Takes in one tick.
    pub fn observe(&mut self, frame: &Frame) {
        self.smallest_m = self.smallest_m.into_iter().chain(frame.smallest_gap_m).min_by(f64::total_cmp);
        let smallest_m = self.closest.as_ref().map_or(f64::INFINITY, |closest| closest.m);
        if let Some(closest) = frame.closest.as_ref().filter(|closest| closest.m < smallest_m) {
            self.closest = Some(closest.clone());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_of_the_smallest_gaps_counts() {
        let mut gap = SmallestGap::default();
        let names = |pair: [&str; 2]| pair.map(str::to_owned);
        let seen = [(0.3, ["a", "b"], 0.0), (0.1, ["b", "c"], 0.13), (0.1, ["a", "c"], 0.2), (0.2, ["a", "b"], 0.3)];
        for (m, between, time_s) in seen {
            let closest = Some(PairGap { m, between: names(between), time_s });
            gap.observe(&Frame { closest, ..Frame::default() });
        }
        assert_eq!(gap.closest, Some(PairGap { m: 0.1, between: names(["b", "c"]), time_s: 0.13 }));
        assert_eq!(gap.smallest_m, None, "no tick said anything of the ego");
    }
}
