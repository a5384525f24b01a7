//! Who has arrived at its line, when, and who has stood there.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use super::obliged::Obliged;
use crate::Agent;
use crate::rules::giving_way::{car_length_m, front_m, signed_lines};
use crate::scene::relation::is_standing;

/// A vehicle that comes within this many lengths of a car of its line has arrived there.
const ARRIVAL_LENGTHS: f64 = 1.0;

/// A vehicle that stands at its line this long without being held has given up its turn: so often the time `√(length / 1 m/s²)`, for a
/// car 4.3 s.
const TURN_TIMES: f64 = 2.0;

/// Lower bound of a wanted speed, as a share of a car's length a second: a vehicle with less does not want to drive.
const LEAST_WANTED_LENGTHS: f64 = 0.02;

/// Headings whose sine of the difference is larger come from the right, or from the left.
const SIDE_SIN: f64 = 0.5;

/// What is remembered, by the names of vehicles.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Arrivals(BTreeMap<String, Memory>);

/// What is remembered of one vehicle.
#[derive(Clone, Debug, Default, PartialEq)]
struct Memory {
    /// Where it has arrived and is not past the line.
    arrival: Option<Arrival>,
    /// The last line at which it has stood \[m\].
    stood_at_m: Option<f64>,
    /// Time for which it has stood at its line \[s\].
    stood_s: f64,
}

/// The arrival of a vehicle at its line.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Arrival {
    tick: usize,
    line_m: f64,
}

impl Arrivals {
    /// Looks at all vehicles.
    pub(super) fn note_all(&mut self, tick: usize, step_s: f64, users: &[Obliged<'_>]) {
        for user in users {
            let others = users.iter().filter(|other| other.agent.name != user.agent.name);
            let lines: Vec<f64> = others
                .flat_map(|other| user.agent.route.conflicts_with(&other.agent.route))
                .map(|conflict| conflict.own_line_m)
                .chain(signed_lines(user.agent))
                .collect();
            let known = self.0.entry(user.agent.name.clone()).or_default();
            known.note(user.agent, &lines, tick, step_s);
        }
    }

    /// Whether a vehicle is at its line, and not past it.
    pub(super) fn has_arrived(&self, agent: &Agent) -> bool {
        self.arrival(agent).is_some()
    }

    /// Whether a vehicle stands at its line and will go when it may: it wants to drive and has not let its turn pass.
    pub(super) fn is_ready(&self, user: &Obliged<'_>) -> bool {
        let length_m = car_length_m(user.agent);
        let Some(known) = self.0.get(&user.agent.name).filter(|known| known.arrival.is_some()) else { return false };
        user.wanted_mps > LEAST_WANTED_LENGTHS * length_m && known.stood_s < TURN_TIMES * length_m.sqrt()
    }

    /// Whether a vehicle has stood at a line.
    pub(super) fn has_stood_at(&self, agent: &Agent, line_m: f64) -> bool {
        self.0.get(&agent.name).and_then(|known| known.stood_at_m).is_some_and(|stood_m| stood_m >= line_m)
    }

    /// When a vehicle came to its line, and the direction in which it came, counter-clockwise from the x axis \[rad\]: an order of all
    /// who wait. None for a vehicle that is not at its line.
    pub(super) fn turn(&self, agent: &Agent) -> Option<(usize, f64)> {
        let arrival = self.arrival(agent)?;
        let heading_rad = agent.route.centre.at(arrival.line_m).heading_rad;
        Some((arrival.tick, heading_rad.rem_euclid(std::f64::consts::TAU)))
    }

    fn arrival(&self, agent: &Agent) -> Option<Arrival> {
        self.0.get(&agent.name)?.arrival
    }
}

/// Whether the first of two vehicles came to its line before the second came to its own, by their turns; none unless both have. Of two who
/// came at once it is the one to the right of the other, and of two who come from opposite sides the one of [`Arrivals::turn`].
pub(super) fn came_before([first, second]: [Option<(usize, f64)>; 2]) -> Option<bool> {
    let [(tick, heading_rad), (their_tick, their_heading_rad)] = [first?, second?];
    let side = libm::sin(heading_rad - their_heading_rad);
    Some(match tick.cmp(&their_tick) {
        Ordering::Equal if side.abs() > SIDE_SIN => side > 0.0,
        Ordering::Equal => heading_rad < their_heading_rad,
        unequal => unequal == Ordering::Less,
    })
}

impl Memory {
    fn note(&mut self, agent: &Agent, lines: &[f64], tick: usize, step_s: f64) {
        let (front_m, near_m) = (front_m(agent), ARRIVAL_LENGTHS * car_length_m(agent));
        self.arrival = self.arrival.filter(|arrival| front_m < arrival.line_m);
        let reached = lines.iter().copied().find(|line_m| (0.0..near_m).contains(&(line_m - front_m)));
        self.arrival = self.arrival.or(reached.map(|line_m| Arrival { tick, line_m }));
        match self.arrival.filter(|_| is_standing(agent)) {
            Some(arrival) => {
                self.stood_at_m = Some(arrival.line_m);
                self.stood_s += step_s;
            }
            None => self.stood_s = 0.0,
        }
    }
}
