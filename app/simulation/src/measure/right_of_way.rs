//! Who goes first where the ways of two vehicles cross or merge.

use interplay_scenarios::Scenario;
use serde::Serialize;

use crate::components::to_nanosecond;

/// Two vehicles in a conflict zone of their ways, of which at least one has entered it: the front bumper has reached it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Passage {
    /// Who entered first.
    pub first: String,
    /// The other one.
    pub second: String,
    /// When the first entered \[s\].
    pub first_s: f64,
    /// When the second entered \[s\]; none if it never did.
    pub second_s: Option<f64>,
}

/// A place where the ways of two vehicles overlap, and who has entered it.
#[derive(Clone, Debug)]
struct WatchedZone {
    /// Both vehicles by index, and where the zone begins on the route of each \[m\].
    entrances: [(usize, f64); 2],
    /// When each entered \[s\].
    entered_s: [Option<f64>; 2],
}

/// All conflict zones of a scenario.
///
/// A vehicle that starts in a zone enters it at the start; one that starts behind it never does. The time of an entrance within
/// a tick is found by linear interpolation.
#[derive(Clone, Debug)]
pub struct Passages {
    names: Vec<String>,
    /// Distance from the mass centre to the front bumper of each vehicle \[m\].
    reaches_m: Vec<f64>,
    /// Arc length of each front bumper at the last look \[m\].
    fronts_m: Vec<f64>,
    zones: Vec<WatchedZone>,
}

impl Passages {
    /// The vehicles at their starts, where their mass centres are at these arc lengths of their routes \[m\].
    pub fn new(scenario: &Scenario, along_m: &[f64]) -> Self {
        let vehicles: Vec<_> = scenario.vehicles.iter().zip(along_m).collect();
        let entered_s = |index: usize, [from_m, to_m]: [f64; 2]| {
            let (vehicle, along_m) = vehicles[index];
            let body = vehicle.body;
            (along_m + body.front_m >= from_m && along_m - body.rear_m <= to_m).then_some(0.0)
        };
        let mut zones = Vec::new();
        for (index, (first, _)) in vehicles.iter().enumerate() {
            for (other, (second, _)) in vehicles.iter().enumerate().skip(index + 1) {
                zones.extend(scenario.road.conflict_zones(first, second).into_iter().map(|zone| WatchedZone {
                    entrances: [(index, zone.first_m[0]), (other, zone.second_m[0])],
                    entered_s: [entered_s(index, zone.first_m), entered_s(other, zone.second_m)],
                }));
            }
        }
        Passages {
            names: scenario.vehicles.iter().map(|vehicle| vehicle.name.clone()).collect(),
            reaches_m: scenario.vehicles.iter().map(|vehicle| vehicle.body.front_m).collect(),
            fronts_m: vehicles.iter().map(|(vehicle, along_m)| *along_m + vehicle.body.front_m).collect(),
            zones,
        }
    }

    /// Takes a tick from `times_s[0]` to `times_s[1]`, after which the mass centres are at these arc lengths \[m\].
    pub fn observe(&mut self, along_m: &[f64], times_s: [f64; 2]) {
        let fronts_m: Vec<f64> =
            along_m.iter().zip(&self.reaches_m).map(|(along_m, reach_m)| along_m + reach_m).collect();
        for zone in &mut self.zones {
            for ((index, from_m), entered_s) in zone.entrances.iter().zip(&mut zone.entered_s) {
                let (before_m, after_m) = (self.fronts_m[*index], fronts_m[*index]);
                if entered_s.is_none() && before_m < *from_m && after_m >= *from_m {
                    let share = (from_m - before_m) / (after_m - before_m);
                    *entered_s = Some(to_nanosecond(times_s[0] + share * (times_s[1] - times_s[0])));
                }
            }
        }
        self.fronts_m = fronts_m;
    }

    /// Who went first in each zone that somebody entered, pairs in the scenario's order.
    pub fn passages(&self) -> Vec<Passage> {
        let passage = |zone: &WatchedZone| {
            let [a, b] = zone.entrances.map(|(index, _)| self.names[index].clone());
            let [a_s, b_s] = zone.entered_s;
            match (a_s, b_s) {
                (Some(a_s), _) if b_s.is_none_or(|b_s| a_s <= b_s) => {
                    Some(Passage { first: a, second: b, first_s: a_s, second_s: b_s })
                }
                (_, Some(b_s)) => Some(Passage { first: b, second: a, first_s: b_s, second_s: a_s }),
                (_, None) => None,
            }
        };
        self.zones.iter().filter_map(passage).collect()
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
    fn crossing(along_m: &[[f64; 2]]) -> Vec<Passage> {
        let scenario = load("intersection/nice", &[]).expect("authored");
        let mut passages = Passages::new(&scenario, &along_m[0]);
        for (tick, along_m) in along_m.iter().enumerate().skip(1) {
            passages.observe(along_m, [tick as f64 - 1.0, tick as f64]);
        }
        passages.passages()
    }

    fn passage(first: &str, second: &str, first_s: f64, second_s: Option<f64>) -> Vec<Passage> {
        vec![Passage { first: first.to_owned(), second: second.to_owned(), first_s, second_s }]
    }

    #[test]
    fn who_enters_first_goes_first() {
        // Fronts of the ego: −0.685, −0.285, −0.085; of the other: −0.29, −0.29, 0.11.
        let both = crossing(&[[-0.895, -0.5], [-0.495, -0.5], [-0.295, -0.1]]);
        assert_eq!(both, passage("ego", "crossing", 1.5, Some(1.725)));
        let other_first = crossing(&[[-0.895, -0.5], [-0.495, -0.1], [-0.295, 0.3]]);
        assert_eq!(other_first, passage("crossing", "ego", 0.725, Some(1.5)));
    }

    /// Within a tick of half a second the time of entering is found by the share of the way.
    #[test]
    fn times_are_those_within_a_tick() {
        let scenario = load("intersection/nice", &[]).expect("authored");
        let mut passages = Passages::new(&scenario, &[-0.495, -0.5]);
        passages.observe(&[-0.295, -0.5], [3.0, 3.5]);
        assert_eq!(passages.passages(), passage("ego", "crossing", 3.25, None));
    }

    #[test]
    fn who_never_enters_has_let_the_other_go() {
        assert_eq!(crossing(&[[-2.0, -0.5], [-1.0, -0.1], [-0.6, 0.9]]), passage("crossing", "ego", 0.725, None));
        assert_eq!(crossing(&[[-2.0, -0.5], [-1.0, -0.4], [-0.6, -0.3]]), []);
    }

    #[test]
    fn starts_in_the_zone_count_and_starts_behind_it_do_not() {
        assert_eq!(crossing(&[[0.1, -0.5], [0.9, 0.3]]), passage("ego", "crossing", 0.0, Some(0.3625)));
        assert_eq!(crossing(&[[0.5, -0.5], [0.9, 0.3]]), passage("crossing", "ego", 0.3625, None));
    }

    /// A side lane joins a main lane after 100 m: the zone begins where the lanes overlap, well before the centre lines meet.
    #[test]
    fn merging_routes_have_a_zone() {
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
        passages.observe(&before_m.map(|along_m| along_m + 4.0), [0.0, 1.0]);
        assert_eq!(passages.passages(), passage("ego", "crossing", 0.25, Some(0.5)));
    }
}
