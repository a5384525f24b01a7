//! How fast a vehicle drives.

/// Slowest and fastest so far.
#[derive(Clone, Copy, Debug)]
pub struct SpeedRange {
    /// Slowest \[m/s\].
    pub min_mps: f64,
    /// Fastest \[m/s\].
    pub max_mps: f64,
}

impl SpeedRange {
    /// A vehicle at its start.
    pub fn new(speed_mps: f64) -> Self {
        SpeedRange { min_mps: speed_mps, max_mps: speed_mps }
    }

    /// Looks at one time.
    pub fn observe(&mut self, speed_mps: f64) {
        self.min_mps = self.min_mps.min(speed_mps);
        self.max_mps = self.max_mps.max(speed_mps);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slowest_and_fastest_are_kept() {
        let mut range = SpeedRange::new(2.0);
        for speed_mps in [3.0, 1.0, 2.5] {
            range.observe(speed_mps);
        }
        assert_eq!([range.min_mps, range.max_mps], [1.0, 3.0]);
    }
}
