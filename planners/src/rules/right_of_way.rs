//! Giving way: where a driver who keeps the rules of the road must wait.
//!
//! Humans and drivers after the intelligent driver model keep them; the planners that interact settle the order themselves.
//! A driver waits at the line before a conflict ([`RouteConflict`])
//!
//! - until it has stood there once, if the sign says so,
//! - while a vehicle that goes first comes so soon that the driver could not clear the conflict before,
//! - while a vehicle is in the conflict, or past the own line towards it,
//! - where the first to arrive goes first, while a vehicle waits that came before.
//!
//! A driver who is past its line, or could no longer stop before it, goes on.

use std::collections::BTreeMap;

use crate::road::network::RouteConflict;
use crate::rules::giving_way::{Arrived, Pair, can_stop, car_length_m, front_m, signed_lines, stopping_distance_m};
use crate::{Agent, Scene};

/// A vehicle stands if it would come to rest within this share of a car's length, braking at [`REFERENCE_MPS2`].
const STANDING_LENGTHS: f64 = 0.02;

/// Acceleration that makes a speed of a length \[m/s²\].
const REFERENCE_MPS2: f64 = 1.0;

/// A vehicle that comes within this many lengths of a car of its line has arrived there.
const ARRIVAL_LENGTHS: f64 = 1.0;

/// What a driver remembers of when vehicles have arrived.
#[derive(Clone, Debug, Default)]
pub(crate) struct ArrivalMemory {
    /// Who has arrived at its line and is not past it.
    arrivals: BTreeMap<String, Arrival>,
    /// The last line at which the driver itself has stood \[m\].
    stood_at_m: Option<f64>,
}

/// The arrival of a vehicle at its line.
#[derive(Clone, Copy, Debug)]
struct Arrival {
    tick: usize,
    line_m: f64,
}

impl ArrivalMemory {
    /// How far along its route the front of the planning vehicle may come now; none if nothing holds it \[m\].
    pub(crate) fn stop_line_m(&mut self, scene: &Scene) -> Option<f64> {
        let ego = &scene.ego;
        if !ego.route.is_in_network() {
            return None;
        }
        for other in &scene.others {
            let lines = other.route.conflicts_with(&ego.route).map(|conflict| conflict.own_line_m);
            self.note(other, lines, scene.tick);
        }
        let signs = signed_lines(ego);
        let own_lines = scene.others.iter().flat_map(|other| ego.route.conflicts_with(&other.route));
        self.note(ego, own_lines.map(|conflict| conflict.own_line_m).chain(signs.iter().copied()), scene.tick);
        if let Some(arrival) = self.arrivals.get(&ego.name).filter(|_| is_standing(ego)) {
            self.stood_at_m = Some(arrival.line_m);
        }
        let stop = signs.into_iter().filter(|line_m| self.stood_at_m.is_none_or(|stood_m| stood_m < *line_m));
        let wanted_mps = scene.goal.target.speed_mps;
        let held = scene.others.iter().flat_map(|other| {
            let (arrived, they_stand) = (self.arrived(ego, other), is_standing(other));
            let holds = move |conflict: &&RouteConflict| {
                Pair::new([ego, other], conflict, wanted_mps, they_stand).holds(arrived)
            };
            ego.route.conflicts_with(&other.route).filter(holds).map(|conflict| conflict.own_line_m)
        });
        let before_m = stopping_distance_m(ego);
        let lines = stop.chain(held).filter(|line_m| can_stop(ego, *line_m - before_m));
        lines.min_by(f64::total_cmp).map(|line_m| line_m - before_m)
    }

    /// Notes whether a vehicle has arrived at one of its lines. It keeps its place in the order until it is past the line.
    fn note(&mut self, agent: &Agent, mut lines: impl Iterator<Item = f64>, tick: usize) {
        let (front_m, near_m) = (front_m(agent), ARRIVAL_LENGTHS * car_length_m(agent));
        self.arrivals.retain(|name, arrival| *name != agent.name || front_m < arrival.line_m);
        if let Some(line_m) = lines.find(|line_m| (0.0..near_m).contains(&(line_m - front_m))) {
            self.arrivals.entry(agent.name.clone()).or_insert(Arrival { tick, line_m });
        }
    }

    /// What is known of the arrival of the driver and of another vehicle. Of several who stand and have to let one another pass, the first
    /// to arrive goes.
    fn arrived(&self, ego: &Agent, other: &Agent) -> Arrived {
        let [own, their] = [ego, other].map(|agent| self.arrivals.get(&agent.name));
        let came_first = own.zip(their).map(|(own, their)| (their.tick, &other.name) < (own.tick, &ego.name));
        Arrived {
            own: own.is_some(),
            their: their.is_some(),
            they_came_first: came_first,
            they_are_ready: came_first == Some(true),
            they_win_ties: other.name < ego.name,
        }
    }
}

fn is_standing(agent: &Agent) -> bool {
    let speed_mps = agent.state.speed_mps;
    speed_mps * speed_mps < 2.0 * REFERENCE_MPS2 * STANDING_LENGTHS * car_length_m(agent)
}
