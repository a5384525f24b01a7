//! The rows that the parameters are trained on, and those that they are tested on.

use std::ops::Range;

use super::settings::IdentifySettings;
use super::telemetry::Telemetry;

/// Rows to train and to test on, as segments without a gap.
pub(super) struct TrainTestSplit {
    pub train: Vec<Range<usize>>,
    pub test: Vec<Range<usize>>,
    /// The first row that is not trained on.
    pub test_start: usize,
}

impl TrainTestSplit {
    /// The split after the `train_days` of the settings.
    pub fn new(telemetry: &Telemetry, settings: &IdentifySettings) -> Self {
        let limit = settings.train_days.zip(telemetry.time_s.first());
        let test_start = limit.map_or(telemetry.rows(), |(days, first)| {
            let end_s = first + days * 86_400.0;
            telemetry.time_s.iter().position(|&time| time >= end_s).unwrap_or(telemetry.rows())
        });
        let (train, test) = telemetry.split_at(test_start);
        Self { train, test, test_start }
    }
}
