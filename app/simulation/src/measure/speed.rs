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
