//! Indicators of vehicles.
//!
//! A driver indicates a change of lane that it planned at the last tick, and a vehicle that follows a script or a record one that has
//! begun. So an indicator tells nothing that is only decided later.

use crate::road::centre_line::FrenetPoint;
use crate::scene::IndicatorSide;
use crate::{Agent, State, Trajectory};

/// Time before the change of lane from which it is indicated, for 1/10 scale cars \[s\]: 3 s of a real one.
const AHEAD_S: f64 = 1.0;
/// A vehicle changes the lane if it comes further than this from the middle of its lane, in lane widths.
const CHANGE_LANES: f64 = 0.6;
/// Width of a lane where lanes have no names, in widths of the body.
const LANE_WIDTHS: f64 = 1.9;
/// A change of lane has begun at this lateral speed, for 1/10 scale cars \[m/s\].
const BEGUN_MPS: f64 = 0.15;

impl IndicatorSide {
    /// The side of a displacement, positive to the left.
    fn of(displacement: f64) -> IndicatorSide {
        if displacement > 0.0 { IndicatorSide::Left } else { IndicatorSide::Right }
    }
}

impl Agent {
    /// What it indicates after it has made a plan, or, of a vehicle whose plan is not its own, of its present motion.
    pub(crate) fn indicates(&self, plan: Option<&Trajectory>, step_s: f64) -> Option<IndicatorSide> {
        let here = self.place();
        let Some(plan) = plan else {
            let across_mps = self.state.speed_mps * libm::sin(self.state.heading_rad - here.heading_rad);
            let has_begun = across_mps.abs() > BEGUN_MPS * self.body.time_ratio();
            return has_begun.then(|| IndicatorSide::of(across_mps));
        };
        let steps = (AHEAD_S * self.body.time_ratio() / step_s).ceil() as usize;
        let soon: Vec<[f64; 2]> = plan.states.iter().take(steps + 1).map(State::position).collect();
        let lane = (here.across_m / self.lane_width_m(&here)).round();
        let off = |at: FrenetPoint| at.across_m / self.lane_width_m(&at) - lane;
        self.route.locate_all(&soon).map(off).find(|off| off.abs() > CHANGE_LANES).map(IndicatorSide::of)
    }

    /// What it indicates while it drives to a lateral position \[m\].
    pub(crate) fn indicates_towards(&self, lateral_m: f64) -> Option<IndicatorSide> {
        let here = self.place();
        let width_m = self.lane_width_m(&here);
        let off = lateral_m / width_m - (here.across_m / width_m).round();
        (off.abs() > CHANGE_LANES).then(|| IndicatorSide::of(off))
    }

    /// The middle of the lane to which it indicates across its route, from where it is; none if it does not \[m\].
    pub(crate) fn indicated_across_m(&self, here: &FrenetPoint) -> Option<f64> {
        let width_m = self.lane_width_m(here);
        let shift = match self.indicator? {
            IndicatorSide::Left => 1.0,
            IndicatorSide::Right => -1.0,
        };
        let aim_m = ((here.across_m / width_m).round() + shift) * width_m;
        let [right_m, left_m] = self.route.edges_before_end_m(here.along_m);
        (right_m..=left_m).contains(&aim_m).then_some(aim_m)
    }

    fn lane_width_m(&self, at: &FrenetPoint) -> f64 {
        if self.route.is_in_network() {
            2.0 * self.route.half_width.value(at.along_m)
        } else {
            LANE_WIDTHS * self.body.width_m
        }
    }
}
