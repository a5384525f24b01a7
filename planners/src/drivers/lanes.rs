//! The lanes of the ego's road, and who is ahead and behind in each of them.
//!
//! A vehicle that is partly in a lane counts as being in it; a lane that ends counts as a standing vehicle at its end.

use std::cmp::Ordering;

use crate::prediction::steering::{admissible, steer, steer_over_step};
use crate::{Agent, Input, Scene, State};

/// What is missing of the width of a lane beside the route may be up to this share.
const LEAST_LANE_SHARE: f64 = 0.1;

/// A lane beside the route is looked at as far as the driver comes in this time, for 1/10 scale cars \[s\],
const LOOK_AHEAD_S: f64 = 3.0;
/// at this many places.
const LOOKS: usize = 20;

/// Width of lanes where nothing is said of it, for 1/10 scale cars \[m\].
const LANE_WIDTH_M: f64 = 0.37;

/// What is ahead in a lane: a vehicle, or what is as good as one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leader {
    /// Gap between bumpers \[m\].
    pub gap_m: f64,
    /// Its speed \[m/s\].
    pub speed_mps: f64,
}

/// The lanes of a road, numbered from the right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoadLanes {
    right_m: f64,
    width_m: f64,
    count: usize,
    /// On a route of a network: which lane it follows, and where the first lane to the right and to the left of it end \[m\].
    ends: Option<(usize, [Option<f64>; 2])>,
}

impl RoadLanes {
    /// The lanes of the ego's road; at least one. On a road of parallel lanes without names they are as wide as stated \[m\], and by
    /// default as is usual.
    pub fn of_road(scene: &Scene, width_m: Option<f64>) -> RoadLanes {
        let road = &scene.ego.route;
        let along_m = road.along(scene.ego.state.position());
        if road.is_in_network() {
            return RoadLanes::beside_route(scene, along_m);
        }
        RoadLanes::across(&scene.ego, along_m, width_m)
    }

    /// The lanes of a road without named ones at an arc length, each as wide as stated \[m\], and by default as is usual.
    pub(crate) fn across(own: &Agent, along_m: f64, width_m: Option<f64>) -> RoadLanes {
        let [right_m, left_m] = own.route.edges_before_end_m(along_m);
        let width_m = width_m.unwrap_or(LANE_WIDTH_M * own.body.scale);
        let count = ((left_m - right_m) / width_m).round().max(1.0) as usize;
        RoadLanes { right_m, width_m, count, ends: None }
    }

    /// The same, with lanes that share a road without named ones evenly.
    pub fn shared_evenly(scene: &Scene) -> RoadLanes {
        let (lanes, road) = (RoadLanes::of_road(scene, None), &scene.ego.route);
        if road.is_in_network() {
            return lanes;
        }
        let [right_m, left_m] = road.edges_before_end_m(road.along(scene.ego.state.position()));
        RoadLanes { width_m: (left_m - right_m) / lanes.count as f64, ..lanes }
    }

    /// The lane that the route follows, and those beside it that have room between the edges.
    fn beside_route(scene: &Scene, along_m: f64) -> RoadLanes {
        let (ego, road) = (&scene.ego, &scene.ego.route);
        let width_m = 2.0 * road.half_width.value(along_m);
        let on_side = |room_m: f64| (room_m / width_m - 0.5 + LEAST_LANE_SHARE).floor().max(0.0) as usize;
        let beside = |at_m: f64| {
            let [right_m, left_m] = road.same_direction_edges_m(at_m);
            [on_side(-right_m), on_side(left_m)]
        };
        let reach_m = LOOK_AHEAD_S * ego.body.time_ratio() * scene.goal.target.speed_mps.max(ego.state.speed_mps);
        let ahead: Vec<(f64, [usize; 2])> = (0..=LOOKS)
            .map(|look| along_m + reach_m * look as f64 / LOOKS as f64)
            .take_while(|at_m| *at_m <= road.end_m())
            .map(|at_m| (at_m, beside(at_m)))
            .collect();
        let [to_right, to_left] = beside(along_m);
        let ends = [0, 1].map(|side| ahead.iter().find(|(_, lanes)| lanes[side] == 0).map(|(at_m, _)| *at_m));
        let count = to_right + 1 + to_left;
        RoadLanes { right_m: -(to_right as f64 + 0.5) * width_m, width_m, count, ends: Some((to_right, ends)) }
    }

    /// How many lanes there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// How wide each of them is \[m\].
    pub fn width_m(&self) -> f64 {
        self.width_m
    }

    /// Where a lane beside the route ends \[m\]; none if it does not end soon.
    pub fn end_m(&self, lane: usize) -> Option<f64> {
        let (own, [right_m, left_m]) = self.ends?;
        match lane.cmp(&own) {
            Ordering::Less => right_m,
            Ordering::Equal => None,
            Ordering::Greater => left_m,
        }
    }

    /// The lane in which a lateral position lies; beside the road, the nearest.
    pub fn at(&self, lateral_m: f64) -> usize {
        let lane = ((lateral_m - self.right_m) / self.width_m) as usize;
        lane.min(self.count - 1)
    }

    /// The lateral position of a lane's centre \[m\].
    pub fn centre_m(&self, lane: usize) -> f64 {
        self.right_m + (lane as f64 + 0.5) * self.width_m
    }
}

/// Whether a vehicle is at least partly in a lane of the ego's road at time `t` of its prediction.
pub(crate) fn is_in(scene: &Scene, lanes: &RoadLanes, lane: usize, other: &Agent, t: usize) -> bool {
    let lateral = scene.ego.route.across(at(other, t).position());
    let reach = 0.5 * (lanes.width_m + other.body.width_m);
    (lateral - lanes.centre_m(lane)).abs() < reach
}

/// Where a vehicle is at time `t` of its prediction.
pub(crate) fn at(other: &Agent, t: usize) -> State {
    other.prediction.states.get(t).or(other.prediction.states.last()).copied().unwrap_or(other.state)
}

/// What is ahead of a state in a lane at time `t`: the nearest vehicle, or the lane's end.
pub fn leader(scene: &Scene, lanes: &RoadLanes, lane: usize, state: &State, t: usize) -> Option<Leader> {
    let (ego, road) = (&scene.ego, &scene.ego.route);
    let own = road.along(state.position());
    let vehicles = scene.others.iter().filter(|other| is_in(scene, lanes, lane, other, t)).filter_map(|other| {
        let there = at(other, t);
        let ahead = road.along(there.position()) - own;
        let gap_m = ahead - other.body.rear_m - ego.body.front_m;
        (ahead > 0.0).then_some(Leader { gap_m, speed_mps: there.speed_mps })
    });
    vehicles.chain(lane_ends(ego, lanes, lane, own)).min_by(|a, b| a.gap_m.total_cmp(&b.gap_m))
}

/// The ends of a lane ahead of a vehicle at an arc length \[m\], as standing vehicles.
pub(crate) fn lane_ends(ego: &Agent, lanes: &RoadLanes, lane: usize, own: f64) -> impl Iterator<Item = Leader> {
    // Three length scales of its taper before the end no room is left.
    let end = ego
        .route
        .lane_end()
        .filter(|_| lane == 0)
        .map(|end| Leader { gap_m: end.end_m - 3.0 * end.taper_m - own - ego.body.front_m, speed_mps: 0.0 });
    let ends = lanes.end_m(lane).map(|end_m| Leader { gap_m: end_m - own - ego.body.front_m, speed_mps: 0.0 });
    end.into_iter().chain(ends)
}

/// The nearest vehicle behind the ego in a lane, now.
pub fn follower<'a>(scene: &'a Scene, lanes: &RoadLanes, lane: usize) -> Option<&'a Agent> {
    let behind = |other: &&Agent| scene.ego.lead_of(other) <= 0.0 && is_in(scene, lanes, lane, other, 0);
    let behind = scene.others.iter().filter(behind);
    behind.max_by(|a, b| scene.ego.lead_of(a).total_cmp(&scene.ego.lead_of(b)))
}

/// Time in which a speed is reached but for a third, for 1/10 scale cars \[s\].
const SPEED_TIME_S: f64 = 0.2;

/// The input with which a vehicle comes to a lateral position on its route \[m\] and to a speed, whatever is in the way: the steering of
/// our drivers without an optimiser, and an acceleration in proportion to the speed that is missing, both as comfortable as the vehicle's
/// limits ask.
pub fn towards(scene: &Scene, lateral_m: f64, speed_mps: f64) -> Input {
    let (own, step_s) = (&scene.ego, scene.step_s);
    let state = &own.state;
    let steering_rad = match own.route.straight() {
        Some(_) => steer(own, state, lateral_m),
        None => steer_over_step(own, state, lateral_m, step_s),
    };
    let missing_mps = speed_mps - state.speed_mps;
    let wanted =
        Input { acceleration_mps2: missing_mps / (SPEED_TIME_S * own.body.time_ratio()).max(step_s), steering_rad };
    let input = own.comfortably(&own.previous_input, wanted, state.speed_mps, step_s);
    Input { acceleration_mps2: admissible(own, state, input.acceleration_mps2, step_s), ..input }
}
