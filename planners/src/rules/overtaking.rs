//! Overtaking on the lane of oncoming traffic: when there is a reason and room for it, and then in one motion.
//!
//! A driver follows a slow vehicle for as long as it is patient. Then it changes to the other lane if it can be past the whole row ahead
//! within a bounded time, nothing comes there, and no light, junction or crossing is on the way. It goes back behind the row if that ends
//! before it is beside it. Else the lines of its lane bind.

use super::giving_way::length_m;
use super::lane::is_forbidden;
use super::obstacle::swing_m;
use super::queue;
use crate::scene::relation::is_standing;
use crate::{Agent, Scene};

/// A row is overtaken if it is slower than wanted by this, for 1/10 scale cars \[m/s\]: 3 m/s of a real one.
const FASTER_MPS: f64 = 0.95;
/// Overtaking takes at most this time on the other side, besides that for the length of the row, for 1/10 scale cars \[s\]: 8 s of a real
/// one.
const LONGEST_S: f64 = 2.53;
/// Vehicles ahead are considered as far as the driver comes in this time at the speed that it wants, for 1/10 scale cars \[s\].
const LOOK_AHEAD_S: f64 = 2.5;
/// A driver changes to the other lane when the one ahead is this time of its speed away, and this time at which it closes up, for 1/10
/// scale cars \[s\]: 2.2 and 2.5 s of real ones.
const BEGIN_S: [f64; 2] = [0.7, 0.8];
/// Time to spare before an oncoming vehicle arrives, for 1/10 scale cars \[s\]: 2.5 s of a real one.
const SPARE_S: f64 = 0.8;
/// A driver overtakes with this share of its strongest acceleration.
const ACCELERATION_SHARE: f64 = 0.3;
/// A vehicle that accelerates by more than this pulls away \[m/s²\].
const PULLING_AWAY_MPS2: f64 = 0.3;
/// A driver returns when it is ahead by this many lengths of its body; less room between two vehicles is too little to return.
const AHEAD_LENGTHS: f64 = 1.5;
/// Room that a lane has to have besides a body, for 1/10 scale cars \[m\].
const SPARE_WIDTH_M: f64 = 0.05;

/// What a driver remembers of overtaking.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Overtaking {
    /// The slow vehicle ahead, and the tick at which it was first there.
    behind: Option<(String, usize)>,
    /// Whether it drives on the other side because of it.
    is_under_way: bool,
}

/// The slow vehicles ahead that are overtaken together, along the driver's route.
struct Row<'a> {
    first: &'a Agent,
    /// Where the row begins and ends now \[m\].
    along_m: [f64; 2],
    /// The speed of the fastest of them \[m/s\].
    speed_mps: f64,
}

/// The way to be past a row.
#[derive(Clone, Copy, Default)]
struct Way {
    /// Until then \[s\].
    time_s: f64,
    /// Of it, beside the row or so near that the other lane is used \[s\].
    beside_s: f64,
    /// How far the driver has come \[m\].
    length_m: f64,
}

impl Overtaking {
    /// The lateral coordinate on the other lane at which the driver overtakes now; none if it keeps to its lane \[m\]. To be called once a
    /// tick; `patience_s` is how long it follows a slow vehicle first, for 1/10 scale cars \[s\].
    pub(super) fn judge(&mut self, scene: &Scene, patience_s: f64, other_lane_m: f64) -> Option<f64> {
        let Some(row) = row_ahead(scene, self.is_under_way) else {
            *self = Overtaking::default();
            return None;
        };
        let since = match &self.behind {
            Some((name, since)) if *name == row.first.name => *since,
            _ if self.is_under_way => 0,
            _ => scene.tick,
        };
        self.behind = Some((row.first.name.clone(), since));
        let ratio = scene.ego.body.time_ratio();
        let has_waited = (scene.tick - since) as f64 * scene.step_s >= patience_s * ratio;
        let own_m = scene.ego.along_m();
        let is_beside = self.is_under_way && own_m + scene.ego.body.front_m > row.along_m[0];
        self.is_under_way = is_beside
            || (self.is_under_way || has_waited && is_near(scene, &row)) && {
                let way = way_past(scene, &row);
                let longest_s = LONGEST_S * ratio + (row.along_m[1] - row.along_m[0]) / faster_mps(scene, &row);
                let is_short = way.beside_s <= longest_s || self.is_under_way;
                let back_m = own_m + way.length_m;
                let is_allowed = back_m <= scene.ego.route.end_m() && !is_forbidden(&scene.ego, [own_m, back_m]);
                is_short && is_allowed && !is_met(scene, &row, way, other_lane_m)
            };
        self.is_under_way.then_some(other_lane_m)
    }
}

/// The middle of the lane of oncoming traffic beside the own lane, which the driver may use; none if there is none \[m\].
pub(super) fn other_lane_m(ego: &Agent) -> Option<f64> {
    let own_m = ego.along_m();
    let [_, lane_left_m] = ego.route.own_lane()?.edges_before_end_m(own_m);
    let [_, same_left_m] = ego.route.same_direction_edges_m(own_m);
    let [_, left_m] = ego.route.edges_before_end_m(own_m);
    let spare_m = SPARE_WIDTH_M * ego.body.scale;
    let has_lane = (same_left_m - lane_left_m).abs() < spare_m && left_m - same_left_m > ego.body.width_m + spare_m;
    has_lane.then_some(0.5 * (same_left_m + left_m))
}

fn faster_mps(scene: &Scene, row: &Row<'_>) -> f64 {
    scene.goal.target.speed_mps - row.speed_mps
}

/// The row of slow vehicles ahead in the lane, or beside a driver who overtakes; none if nothing there is slow and moves, or if it waits.
fn row_ahead(scene: &Scene, is_under_way: bool) -> Option<Row<'_>> {
    let ego = &scene.ego;
    let own_m = ego.along_m();
    let ahead_m = AHEAD_LENGTHS * length_m(ego);
    let from_m = own_m - if is_under_way { ego.body.rear_m + ahead_m } else { 0.0 };
    let reach_m = LOOK_AHEAD_S * ego.body.time_ratio() * scene.goal.target.speed_mps + ego.body.front_m;
    let in_lane = scene.others.iter().filter(|other| !other.is_obstacle).filter_map(|other| {
        let at = ego.route.locate(other.state.position(), None);
        let along_mps = other.state.speed_mps * libm::cos(other.state.heading_rad - at.heading_rad);
        let is_in_lane = at.across_m.abs() < 0.5 * (ego.body.width_m + other.body.width_m);
        let is_along = along_mps > std::f64::consts::FRAC_1_SQRT_2 * other.state.speed_mps || is_standing(other);
        let along_m = [at.along_m - other.body.rear_m, at.along_m + other.body.front_m];
        (is_in_lane && is_along && along_m[1] > from_m).then_some((along_m, other))
    });
    let mut in_lane: Vec<([f64; 2], &Agent)> = in_lane.collect();
    in_lane.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
    let (first_m, first) = in_lane.first().filter(|(along_m, _)| along_m[0] < own_m + reach_m)?;
    let mut row = Row { first, along_m: *first_m, speed_mps: first.state.speed_mps };
    let room_m = length_m(ego) + 2.0 * ahead_m;
    for (along_m, other) in &in_lane[1..] {
        if along_m[0] > row.along_m[1] + room_m {
            break;
        }
        row.along_m[1] = along_m[1];
        row.speed_mps = row.speed_mps.max(other.state.speed_mps);
    }
    let is_slow = faster_mps(scene, &row) >= FASTER_MPS * ego.body.time_ratio();
    let is_beside = is_under_way && own_m + ego.body.front_m > row.along_m[0];
    let moves = (is_under_way || !is_standing(first)) && (is_beside || !pulls_away(scene, first));
    (is_slow && moves && !queue::waits(first, scene.others.iter())).then_some(row)
}

/// Whether a vehicle gains speed, as a bus that leaves its stop: it will not be slow.
fn pulls_away(scene: &Scene, other: &Agent) -> bool {
    let next = other.prediction.states.get(1).unwrap_or(&other.state);
    next.speed_mps - other.state.speed_mps > PULLING_AWAY_MPS2 * scene.step_s
}

/// Whether a driver is so near to a row that it changes to the other lane.
fn is_near(scene: &Scene, row: &Row<'_>) -> bool {
    let ego = &scene.ego;
    let gap_m = row.along_m[0] - ego.along_m() - ego.body.front_m;
    let [following_s, closing_s] = BEGIN_S.map(|time_s| time_s * ego.body.time_ratio());
    let closing_mps = (ego.state.speed_mps - row.speed_mps).max(0.0);
    gap_m <= length_m(ego) + following_s * row.speed_mps + closing_s * closing_mps
}

/// The way past a row that keeps its speed, while the driver accelerates to the speed that it wants.
fn way_past(scene: &Scene, row: &Row<'_>) -> Way {
    let ego = &scene.ego;
    let own_m = ego.along_m();
    let acceleration_mps2 = ACCELERATION_SHARE * ego.limits.acceleration_max_mps2;
    let past_m = row.along_m[1] + ego.body.rear_m + AHEAD_LENGTHS * length_m(ego) - own_m;
    let begins_m = row.along_m[0] - ego.body.front_m - swing_m(ego, row.speed_mps) - own_m;
    let (mut way, mut speed_mps) = (Way::default(), ego.state.speed_mps);
    let most_mps = scene.goal.target.speed_mps.max(speed_mps);
    let longest_s = 4.0 * LONGEST_S * ego.body.time_ratio();
    while way.time_s < longest_s && way.length_m - row.speed_mps * way.time_s < past_m {
        if way.length_m - row.speed_mps * way.time_s >= begins_m {
            way.beside_s += scene.step_s;
        }
        way.time_s += scene.step_s;
        way.length_m += speed_mps * scene.step_s;
        speed_mps = (speed_mps + acceleration_mps2 * scene.step_s).min(most_mps);
    }
    way
}

/// Whether another vehicle is on the other lane before the driver is past a row, be it oncoming, standing or overtaking from behind.
fn is_met(scene: &Scene, row: &Row<'_>, way: Way, other_lane_m: f64) -> bool {
    let ego = &scene.ego;
    let own_m = ego.along_m();
    let until_s = way.time_s + SPARE_S * ego.body.time_ratio();
    scene.others.iter().any(|other| {
        let at = ego.route.locate(other.state.position(), None);
        let reach_m = 0.5 * (ego.body.width_m + other.body.width_m);
        if (at.across_m - other_lane_m).abs() >= reach_m {
            return false;
        }
        let along_mps = other.state.speed_mps * libm::cos(other.state.heading_rad - at.heading_rad);
        if at.along_m + other.body.front_m < own_m - ego.body.rear_m {
            // An oncoming vehicle that has passed goes away.
            return along_mps > ego.state.speed_mps;
        }
        let rear_m = at.along_m - other.body.front_m.max(other.body.rear_m);
        let meets_m = own_m + way.length_m + along_mps.min(0.0).abs() * until_s;
        rear_m < meets_m && along_mps < row.speed_mps.max(ego.state.speed_mps)
    })
}
