//! The lane in which a driver drives who takes over from a record.

use crate::model::scenario::Vehicle;
use crate::roads::Road;

impl Vehicle {
    /// Lateral coordinate of the middle of the lane in which its record ends, on parallel lanes \[m\].
    pub(crate) fn recorded_lane_m(&self, road: &Road) -> Option<f64> {
        let (record, lanes) = (self.driver.record()?, road.parallel_lanes()?);
        let end_m = self.route.across(record.state_at(record.span_s()[1])?.position());
        let middles = (0..lanes.count).filter_map(|lane| road.lane_centre_m(self.road, lane));
        middles.min_by(|a, b| (a - end_m).abs().total_cmp(&(b - end_m).abs()))
    }
}
