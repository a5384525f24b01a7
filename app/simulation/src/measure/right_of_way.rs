//! Determines which of two vehicles goes first where their routes cross or merge, and whether the other one yields.

use interplay_planners::Body;
use interplay_scenarios::{ConflictZone, Scenario};
use serde::Serialize;

use crate::state::components::to_nanosecond;
use crate::state::standing::STANDING_MPS;

/// Speed reduction that counts as slowing down, for a real car \[m/s\].
const SLOWED_MPS: f64 = 1.0;
/// A vehicle that leaves this time margin to the other yields without slowing down, for a real car \[s\].
const MARGIN_S: f64 = 1.0;

/// Two vehicles in a conflict zone of their routes, of which at least one has entered it: its front bumper has reached it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Passage {
    /// The vehicle that entered first.
    pub first: String,
    /// The other vehicle.
    pub second: String,
    /// When the first entered \[s\].
    pub first_s: f64,
    /// When the second entered \[s\]; none if it never did.
    pub second_s: Option<f64>,
    /// Time from when the rear of the first left the path of the second until the front of the second entered the path of the
    /// first \[s\]; 0 if it entered before, none if it never entered.
    pub post_encroachment_s: Option<f64>,
    /// Whether the second one yielded: it never entered, slowed down before the first was gone, or left at least 1 s of a real car.
    pub yielded: bool,
}

/// A zone where the routes of two vehicles overlap, with its entries.
#[derive(Clone, Debug)]
struct WatchedZone {
    approaches: [ZoneApproach; 2],
}

/// One of the two vehicles of a zone.
#[derive(Clone, Debug)]
struct ZoneApproach {
    vehicle: usize,
    /// Where the zone begins on its route \[m\].
    from_m: f64,
    /// Arc lengths at which its front enters the other's path, and its rear leaves it \[m\].
    way_m: [f64; 2],
    /// Time at which its front entered the zone \[s\].
    entered_s: Option<f64>,
    /// Time at which its front entered the other's path \[s\].
    came_s: Option<f64>,
    /// Time at which its rear left the other's path \[s\].
    left_s: Option<f64>,
    /// Its highest speed so far \[m/s\].
    fastest_mps: f64,
    /// Whether it slowed down before it entered and before the other one was gone.
    has_slowed: bool,
}

/// All conflict zones of a scenario.
///
/// A vehicle that starts in a zone enters it at the start; one that starts beyond it never does. The time of entry within
/// a tick is interpolated linearly.
#[derive(Clone, Debug, Default)]
pub struct Passages {
    names: Vec<String>,
    bodies: Vec<Body>,
    /// Arc lengths of the mass centres at the last tick \[m\].
    along_m: Vec<f64>,
    zones: Vec<WatchedZone>,
}

impl Passages {
    /// The zones with the vehicles at their starts; `along_m` are the arc lengths of the mass centres on their routes \[m\].
    pub fn new(scenario: &Scenario, along_m: &[f64]) -> Self {
        let vehicles = &scenario.vehicles;
        let approach = |vehicle: usize, [from_m, to_m]: [f64; 2], way_m: [f64; 2]| {
            let (along_m, body) = (along_m[vehicle], &vehicles[vehicle].body);
            let starts_in = |[from_m, to_m]: [f64; 2]| {
                (along_m + body.front_m >= from_m && along_m - body.rear_m <= to_m).then_some(0.0)
            };
            ZoneApproach {
                vehicle,
                from_m,
                way_m,
                entered_s: starts_in([from_m, to_m]),
                came_s: starts_in(way_m),
                left_s: None,
                fastest_mps: 0.0,
                has_slowed: false,
            }
        };
        let mut zones = Vec::new();
        for (index, first) in vehicles.iter().enumerate() {
            for (other, second) in vehicles.iter().enumerate().skip(index + 1) {
                let watched = |zone: ConflictZone| WatchedZone {
                    approaches: [
                        approach(index, zone.first_m, zone.first_way_m),
                        approach(other, zone.second_m, zone.second_way_m),
                    ],
                };
                zones.extend(scenario.road.conflict_zones(first, second).into_iter().map(watched));
            }
        }
        Passages {
            names: vehicles.iter().map(|vehicle| vehicle.name.clone()).collect(),
            bodies: vehicles.iter().map(|vehicle| vehicle.body).collect(),
            along_m: along_m.to_vec(),
            zones,
        }
    }

    /// Updates the passages with a tick from `times_s[0]` to `times_s[1]`, after which the mass centres are at these
    /// arc lengths \[m\] and the vehicles have these speeds \[m/s\].
    pub fn observe(&mut self, along_m: &[f64], speeds_mps: &[f64], times_s: [f64; 2]) {
        for zone in &mut self.zones {
            let [a, b] = &mut zone.approaches;
            let are_gone = [b.left_s.is_some(), a.left_s.is_some()];
            for (approach, other_is_gone) in [a, b].into_iter().zip(are_gone) {
                let (vehicle, body) = (approach.vehicle, &self.bodies[approach.vehicle]);
                let moved_m = [self.along_m[vehicle], along_m[vehicle]];
                approach.slow(speeds_mps[vehicle], body, other_is_gone);
                approach.move_on(moved_m, body, times_s);
            }
        }
        self.along_m = along_m.to_vec();
    }

    /// The passages of all zones that a vehicle has entered, pairs in the scenario's order.
    pub fn passages(&self) -> Vec<Passage> {
        let passage = |zone: &WatchedZone| {
            let [a, b] = &zone.approaches;
            match (a.entered_s, b.entered_s) {
                (Some(a_s), b_s) if b_s.is_none_or(|b_s| a_s <= b_s) => Some(self.passage(a, a_s, b)),
                (_, Some(b_s)) => Some(self.passage(b, b_s, a)),
                (_, None) => None,
            }
        };
        self.zones.iter().filter_map(passage).collect()
    }

    fn passage(&self, first: &ZoneApproach, first_s: f64, second: &ZoneApproach) -> Passage {
        let spare_s = |came_s: f64| first.left_s.map_or(0.0, |left_s| (came_s - left_s).max(0.0));
        let post_encroachment_s = second.came_s.map(spare_s).map(to_nanosecond);
        let margin_s = MARGIN_S * self.bodies[second.vehicle].real_ratio().sqrt();
        let has_margin = post_encroachment_s.is_none_or(|spare_s| spare_s >= margin_s);
        Passage {
            first: self.names[first.vehicle].clone(),
            second: self.names[second.vehicle].clone(),
            first_s,
            second_s: second.entered_s,
            post_encroachment_s,
            yielded: second.entered_s.is_none_or(|second_s| second_s > first_s && (second.has_slowed || has_margin)),
        }
    }
}

impl ZoneApproach {
    /// Updates the speed and whether the vehicle has slowed down.
    fn slow(&mut self, speed_mps: f64, body: &Body, other_is_gone: bool) {
        let ratio = body.real_ratio().sqrt();
        self.fastest_mps = self.fastest_mps.max(speed_mps);
        if self.entered_s.is_none() && !other_is_gone {
            let is_slower = self.fastest_mps - speed_mps >= SLOWED_MPS * ratio;
            self.has_slowed |= is_slower || speed_mps < STANDING_MPS * ratio;
        }
    }

    /// Records the times at which it passes boundaries within a tick.
    fn move_on(&mut self, [before_m, after_m]: [f64; 2], body: &Body, times_s: [f64; 2]) {
        let passes = |place_m: f64| {
            let share = (place_m - before_m) / (after_m - before_m);
            let time_s = times_s[0] + share * (times_s[1] - times_s[0]);
            (before_m < place_m && after_m >= place_m).then(|| to_nanosecond(time_s))
        };
        self.entered_s = self.entered_s.or_else(|| passes(self.from_m - body.front_m));
        self.came_s = self.came_s.or_else(|| passes(self.way_m[0] - body.front_m));
        self.left_s = self.left_s.or_else(|| passes(self.way_m[1] + body.rear_m));
    }
}

#[cfg(test)]
mod tests {
    use interplay_planners::CentreLine;
    use interplay_planners::road::centre_line::{Piece, smooth};
    use interplay_planners::road::network::{Lane, RoadNetwork};
    use interplay_scenarios::load;

    use super::*;

    /// The ego enters the crossing at x = −0.185 m, the other vehicle at y = 0; both reach 0.21 m ahead. Arc lengths of the
    /// mass centres, one pair a second.
    fn crossing(along_m: &[[f64; 2]]) -> Order {
        let scenario = load("intersection/nice", &[]).expect("authored");
        let mut passages = Passages::new(&scenario, &along_m[0]);
        for (tick, along_m) in along_m.iter().enumerate().skip(1) {
            passages.observe(along_m, &[1.0; 2], [tick as f64 - 1.0, tick as f64]);
        }
        order(&passages)
    }

    /// First, second, and their entry times; other tests check the rest of a passage.
    type Order = Vec<(String, String, f64, Option<f64>)>;

    fn order(passages: &Passages) -> Order {
        passages.passages().into_iter().map(|one| (one.first, one.second, one.first_s, one.second_s)).collect()
    }

    fn passage(first: &str, second: &str, first_s: f64, second_s: Option<f64>) -> Order {
        vec![(first.to_owned(), second.to_owned(), first_s, second_s)]
    }

    /// The ego crosses first in one second; the other arrives then, with these positions and speeds in ticks of 0.1 s.
    fn second(moves: &[[f64; 2]]) -> Passage {
        let scenario = load("intersection/nice", &[]).expect("authored");
        let mut passages = Passages::new(&scenario, &[-1.0, moves[0][0]]);
        for (tick, [along_m, speed_mps]) in moves.iter().enumerate().skip(1) {
            let ego_m = -1.0 + 2.0 * 0.1 * tick as f64;
            let times_s = [0.1 * (tick as f64 - 1.0), 0.1 * tick as f64];
            passages.observe(&[ego_m, *along_m], &[2.0, *speed_mps], times_s);
        }
        passages.passages().pop().expect("the ego enters")
    }

    /// Being second is not yielding: the vehicle must slow down or leave a margin, 0.32 s for model cars.
    #[test]
    fn a_vehicle_that_follows_closely_at_full_speed_has_not_yielded() {
        // The zone of the other is from 0 to 0.37 m, its front 0.21 m ahead; the ego's rear leaves at 0.185 + 0.19 m after 0.6875 s.
        let at = |along_m: f64, speed_mps: f64, tick: usize| [along_m + 0.1 * speed_mps * tick as f64, speed_mps];
        let drive = |start_m: f64, speed_mps: f64| -> Vec<[f64; 2]> {
            (0..30).map(|tick| at(start_m, speed_mps, tick)).collect()
        };
        let close = second(&drive(-0.96, 1.0));
        let spare_s = close.post_encroachment_s.expect("it comes");
        assert!((spare_s - 0.0625).abs() < 1e-9 && !close.yielded, "{close:?}");
        let late = second(&drive(-1.3, 1.0));
        assert!(late.post_encroachment_s.is_some_and(|spare_s| spare_s > 0.32) && late.yielded, "{late:?}");
        let mut slower = drive(-0.96, 1.0);
        slower[4][1] = 0.5;
        assert!(second(&slower).yielded, "it slowed down for the ego");
        let mut afterwards = drive(-0.96, 1.0);
        afterwards[20][1] = 0.0;
        assert!(!second(&afterwards).yielded, "it slowed down when it was over");
    }

    #[test]
    fn the_vehicle_that_enters_first_goes_first() {
        // Fronts of the ego: −0.685, −0.285, −0.085; of the other: −0.29, −0.29, 0.11.
        let both = crossing(&[[-0.895, -0.5], [-0.495, -0.5], [-0.295, -0.1]]);
        assert_eq!(both, passage("ego", "crossing", 1.5, Some(1.725)));
        let other_first = crossing(&[[-0.895, -0.5], [-0.495, -0.1], [-0.295, 0.3]]);
        assert_eq!(other_first, passage("crossing", "ego", 0.725, Some(1.5)));
    }

    /// In a tick of half a second the time of entry is interpolated by distance.
    #[test]
    fn entry_times_are_interpolated_within_a_tick() {
        let scenario = load("intersection/nice", &[]).expect("authored");
        let mut passages = Passages::new(&scenario, &[-0.495, -0.5]);
        passages.observe(&[-0.295, -0.5], &[1.0; 2], [3.0, 3.5]);
        assert_eq!(order(&passages), passage("ego", "crossing", 3.25, None));
    }

    #[test]
    fn a_vehicle_that_never_enters_has_yielded() {
        assert_eq!(crossing(&[[-2.0, -0.5], [-1.0, -0.1], [-0.6, 0.9]]), passage("crossing", "ego", 0.725, None));
        assert_eq!(crossing(&[[-2.0, -0.5], [-1.0, -0.4], [-0.6, -0.3]]), []);
    }

    #[test]
    fn a_start_inside_the_conflict_zone_counts_as_entry_and_one_beyond_does_not() {
        assert_eq!(crossing(&[[0.1, -0.5], [0.9, 0.3]]), passage("ego", "crossing", 0.0, Some(0.3625)));
        assert_eq!(crossing(&[[0.5, -0.5], [0.9, 0.3]]), passage("crossing", "ego", 0.3625, None));
    }

    /// A side lane joins a main lane after 100 m: the zone begins where the lanes overlap, well before the centre lines meet.
    #[test]
    fn merging_routes_have_a_conflict_zone() {
        let line = |start: [f64; 2], heading_rad: f64, length_m: f64| {
            CentreLine::from_pieces(start, heading_rad, &[Piece::Straight { length_m }]).expect("a piece")
        };
        let lane = |name: &str, centre: CentreLine, next: &[&str]| {
            let mut lane = Lane::new(name, centre, 3.5);
            lane.successors = next.iter().map(|name| (*name).to_owned()).collect();
            lane
        };
        let turn = [Piece::Straight { length_m: 80.0 }, Piece::Arc { length_m: 40.0, curvature_1pm: -1.0 / 50.0 }];
        let turn = smooth(&turn, 20.0).expect("long enough");
        let shape = CentreLine::from_pieces([0.0; 2], 0.8, &turn).expect("pieces");
        let end = shape.at(shape.length_m()).position;
        let side = CentreLine::from_pieces([100.0 - end[0], -end[1]], 0.8, &turn).expect("pieces");
        let lanes = vec![
            lane("main", line([0.0; 2], 0.0, 100.0), &["on"]),
            lane("side", side, &["on"]),
            lane("on", line([100.0, 0.0], 0.0, 100.0), &[]),
        ];
        let network = RoadNetwork::new(lanes).expect("a sound network");
        let routes = network.routes(&[vec!["main", "on"], vec!["side", "on"]]).expect("routes");
        let mut scenario = load("intersection/nice", &[]).expect("authored");
        for (vehicle, route) in scenario.vehicles.iter_mut().zip(&routes) {
            vehicle.route = std::sync::Arc::clone(route);
        }
        let zones = scenario.road.conflict_zones(&scenario.vehicles[0], &scenario.vehicles[1]);
        let [zone] = zones.as_slice() else { panic!("{zones:?}") };
        assert!((60.0..99.0).contains(&zone.first_m[0]) && (80.0..119.0).contains(&zone.second_m[0]), "{zone:?}");
        let before_m = [zone.first_m[0] - 1.21, zone.second_m[0] - 2.21];
        let mut passages = Passages::new(&scenario, &before_m);
        passages.observe(&before_m.map(|along_m| along_m + 4.0), &[4.0; 2], [0.0, 1.0]);
        assert_eq!(order(&passages), passage("ego", "crossing", 0.25, Some(0.5)));
    }
}
