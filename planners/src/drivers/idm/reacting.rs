//! The answer of a driver on a straight road who sees the others by lanes: the model itself, at the present moment.

use super::Settings;
use super::diagnostics::{GAP, INCENTIVE, LANE};
use super::mobil::{BESIDE_GAP_M, Changing, Follower, LOOK_AHEAD_S, LaneTraffic, SeenLanes, choose};
use super::motion::Motion;
use crate::Agent;
use crate::drivers::lanes::{Leader, RoadLanes, lane_ends};
use crate::drivers::reaction::Reaction;
use crate::scene::Moment;
use crate::scene::lane_order::{OnRoad, OnStraightRoad, Strip};
use crate::scene::relation::is_standing_at;

/// A driver on a straight road.
struct Driver<'a> {
    own: &'a Agent,
    road: OnStraightRoad<'a>,
    lanes: RoadLanes,
    changing: Changing,
}

/// The answer at a moment, and the lateral position of the centre of the lane that the driver drives in or changes to \[m\]; `lane_m` is
/// that of the last answer. None on other than straight roads.
pub(super) fn answer(settings: &Settings, lane_m: Option<f64>, moment: &Moment<'_>) -> Option<(Reaction, f64)> {
    let road = moment.on_straight_road()?;
    let (own, goal) = (moment.own, moment.goal);
    let OnRoad { along_m, across_m, ends_m: [front_m, rear_m], speed_mps, .. } = *road.own;
    let changing = Changing {
        along_m,
        front_m,
        rear_m,
        across_m,
        goal_across_m: own.route.across(goal.target.position()),
        speed_mps,
        wanted_mps: goal.target.speed_mps,
    };
    let lanes = RoadLanes::across(own, along_m, settings.mobil.lane_width_m);
    let driver = Driver { own, road, lanes, changing };
    let here = lanes.at(across_m);
    let chosen = lane_m.map_or(here, |lane_m| lanes.at(lane_m));
    let now = if chosen != here && driver.is_blocked(chosen) { here } else { chosen };
    let choice = choose(&changing, settings, &lanes, now, &driver);
    let taken = driver.ahead(choice.lane);
    let left = if here == choice.lane { taken } else { driver.ahead(here) };
    let motion = Motion {
        settings,
        own,
        wanted_mps: goal.target.speed_mps,
        step_s: moment.step_s,
        lanes,
        from_to: [now, choice.lane],
        line_m: None,
        passed: None,
    };
    let input = motion.input(&own.state, &own.previous_input, [left, taken], None);
    let lane_m = lanes.centre_m(choice.lane);
    let reaction = Reaction {
        input,
        lateral_m: (here != choice.lane).then_some(lane_m),
        changes_to: (choice.lane != now).then_some(choice.lane),
        diagnostics: [
            Some(LANE.is(choice.lane as f64)),
            Some(INCENTIVE.is(choice.incentive_mps2)),
            taken.map(|leader| GAP.is(leader.gap_m)),
        ],
        plan: None,
    };
    Some((reaction, lane_m))
}

impl Driver<'_> {
    fn strip(&self, lane: usize) -> Strip {
        Strip { centre_m: self.lanes.centre_m(lane), width_m: self.lanes.width_m() }
    }

    fn ahead(&self, lane: usize) -> Option<Leader> {
        let vehicle = self.road.ahead(self.strip(lane));
        let vehicle = vehicle.map(|(leader, gap_m)| Leader { gap_m, speed_mps: leader.speed_mps });
        let ends = lane_ends(self.own, &self.lanes, lane, self.changing.along_m);
        vehicle.into_iter().chain(ends).min_by(|a, b| a.gap_m.total_cmp(&b.gap_m))
    }

    /// Whether a vehicle is beside it in the lane to which it changes, so that it goes back: one that is ahead by a part of a length, also
    /// if that comes from the other side, or one that drives there.
    fn is_blocked(&self, lane: usize) -> bool {
        let strip = self.strip(lane);
        let drives_there = |other: &OnRoad| (other.across_m - strip.centre_m).abs() < 0.5 * strip.width_m;
        let rear_m = self.changing.along_m - self.changing.rear_m;
        let ahead = self.road.ahead(strip).is_some_and(|(_, gap_m)| gap_m < 0.0);
        ahead || self.road.behind(strip, drives_there).is_some_and(|other| other.along_m + other.ends_m[0] > rear_m)
    }
}

impl SeenLanes for Driver<'_> {
    fn seen(&self, lane: usize) -> LaneTraffic {
        let behind = self.road.behind(self.strip(lane), |_| true);
        let behind =
            behind.map(|other| Follower { front_m: other.along_m + other.ends_m[0], speed_mps: other.speed_mps });
        LaneTraffic { ahead: self.ahead(lane), behind }
    }

    /// Of the vehicles ahead and behind the nearest comes beside first, at their present speeds.
    fn is_taken(&self, _: usize, LaneTraffic { ahead, behind }: &LaneTraffic) -> bool {
        let (ratio, Changing { along_m, rear_m, speed_mps, .. }) = (self.own.body.real_ratio(), self.changing);
        let (reach_m, until_s) = (BESIDE_GAP_M * ratio, LOOK_AHEAD_S * ratio.sqrt());
        let comes = |gap_m: f64, closing_mps: f64| gap_m - closing_mps.max(0.0) * until_s < reach_m;
        ahead.is_some_and(|leader| comes(leader.gap_m, speed_mps - leader.speed_mps))
            || behind.is_some_and(|other| comes(along_m - rear_m - other.front_m, other.speed_mps - speed_mps))
    }

    /// Whether it comes past what stands ahead in its way.
    fn has_room(&self) -> bool {
        let way = Strip { centre_m: self.changing.across_m, width_m: self.own.body.width_m };
        let ahead = self.road.ahead(way).filter(|(other, _)| is_standing_at(self.own, other.speed_mps));
        ahead.is_none_or(|(other, room_m)| {
            let beside_m = 0.5 * (self.own.body.width_m + other.width_m);
            let apart_m = other.across_m - self.changing.across_m;
            !self.own.is_too_near_to_swing_out(room_m, beside_m - apart_m.abs())
        })
    }
}
