//! The messages between neighbouring zones.
//!
//! Every zone simulates itself (and the walls it owns) by forward Euler, step by step, which needs only the temperatures of its
//! neighbours. Backwards in time it computes the sensitivity λ of J to its temperatures, which needs only theirs:
//!
//! ```text
//! T_p(t+1) = T_p(t) + h/c_p (Σ_q g_pq (T_q(t) − T_p(t)) + k_p (T₀(t) − T_p(t)) + w_p(t) + u_p(t))
//! λ_p(t)   = ∂J/∂T_p(t) + λ_p(t+1) − h/c_p (Σ_q g_pq + k_p) λ_p(t+1) + Σ_q h/c_q g_qp λ_q(t+1)
//! ∂J/∂u_p(t) = h/c_p λ_p(t+1) + 2 W_u u_p(t)
//! ```
//!
//! So the exact gradient of the common cost comes from messages between neighbours alone. A message is a zone's series over the day, with
//! one number for each step. A lost message is sent again; if no message of a zone arrives in a round, its last message is used.

use std::collections::VecDeque;

use interplay_common::random::Random;

use crate::lifted::Lifted;

/// How often a message that was lost is sent again in its round. Of messages of which 20 % are lost, one in two million is then
/// missing.
const MAX_REPEATS: usize = 8;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Subject {
    Temperature,
    Sensitivity,
    /// The change of the temperatures under the proposals; only that of the current round is of use.
    Direction,
}

/// A link over which a zone receives the series of a neighbouring node of another zone.
#[derive(Clone, Debug)]
struct Edge {
    /// The node that the messages describe.
    from: usize,
    /// The node next to it, of another zone.
    to: usize,
    conductance_kw_per_k: f64,
    /// The last messages received: temperature and sensitivity.
    heard: [Vec<f64>; 2],
    /// Messages that are not yet delivered.
    late: [VecDeque<Vec<f64>>; 2],
    live: bool,
    /// How many rounds old the messages heard are, unless all of them are late.
    age: [usize; 2],
}

/// The zones' network of messages over days.
#[derive(Clone, Debug)]
pub(super) struct Messages {
    steps: usize,
    /// h/c of each node.
    gain: Vec<f64>,
    /// Conductance of each node to outdoors and all its neighbours.
    leaving_kw_per_k: Vec<f64>,
    /// Links between nodes of one zone.
    inner: Vec<(usize, usize, f64)>,
    edges: Vec<Edge>,
    /// The zone of each node.
    owner: Vec<usize>,
    loss: f64,
    delay: usize,
    silent: Option<usize>,
    random: Random,
    /// Messages that each zone sent since [`Messages::start`].
    pub sent: Vec<usize>,
    /// Messages since then that did not arrive in their round.
    pub undelivered: usize,
}

impl Messages {
    /// The network of messages of a building whose model is forward Euler.
    pub fn new(lifted: &Lifted, loss: f64, delay: usize, silent: Option<usize>) -> Self {
        let network = lifted.model().network();
        let (zones, nodes) = (network.zone_count(), network.node_count());
        let mut owner: Vec<usize> = (0..nodes).collect();
        let mut leaving_kw_per_k = network.ambient_kw_per_k().to_vec();
        for link in network.links() {
            leaving_kw_per_k[link.from] += link.conductance_kw_per_k;
            leaving_kw_per_k[link.to] += link.conductance_kw_per_k;
            // A wall belongs to the adjacent zone with the lowest number.
            let (wall, zone) = (link.from.max(link.to), link.from.min(link.to));
            if wall >= zones && (owner[wall] == wall || zone < owner[wall]) {
                owner[wall] = zone;
            }
        }
        let (mut inner, mut edges) = (Vec::new(), Vec::new());
        for link in network.links() {
            for (from, to) in [(link.from, link.to), (link.to, link.from)] {
                if owner[from] == owner[to] {
                    inner.push((from, to, link.conductance_kw_per_k));
                } else {
                    edges.push(Edge {
                        from,
                        to,
                        conductance_kw_per_k: link.conductance_kw_per_k,
                        heard: [Vec::new(), Vec::new()],
                        late: Default::default(),
                        live: true,
                        age: [0; 2],
                    });
                }
            }
        }
        Self {
            steps: lifted.steps(),
            gain: network.capacities_kj_per_k().iter().map(|c| lifted.model().step_s() / c).collect(),
            leaving_kw_per_k,
            inner,
            edges,
            owner,
            loss,
            delay,
            silent,
            random: Random::new(0, 0),
            sent: vec![0; zones],
            undelivered: 0,
        }
    }

    /// Starts a day: each zone knows the temperatures of its neighbours at midnight, and none of their plans.
    pub fn start(&mut self, initial_c: &[f64]) {
        for edge in &mut self.edges {
            let sound = |series: &Vec<f64>| !series.is_empty() && series.iter().all(|value| value.is_finite());
            if !edge.heard.iter().all(sound) {
                edge.heard[0] = vec![initial_c[edge.from]; self.steps];
                edge.heard[1] = vec![0.0; self.steps];
            }
            edge.late = Default::default();
            edge.age = [0; 2];
        }
        self.sent.fill(0);
        self.undelivered = 0;
    }

    /// The zones with which a zone exchanges messages.
    pub fn neighbours(&self, zone: usize) -> impl Iterator<Item = usize> + '_ {
        self.edges.iter().filter(move |edge| self.owner[edge.to] == zone).map(|edge| self.owner[edge.from])
    }

    /// Age in rounds of the oldest message that each zone uses; silent zones and messages that are late by design do not count.
    pub fn staleness(&self) -> Vec<usize> {
        let mut oldest = vec![0; self.sent.len()];
        for edge in &self.edges {
            let zone = &mut oldest[self.owner[edge.to]];
            *zone = (*zone).max(edge.age[0]).max(edge.age[1]);
        }
        oldest
    }

    /// Draws which messages of a series arrive.
    fn draw(&mut self, subject: Subject) {
        for edge in &mut self.edges {
            let (from, to) = (self.owner[edge.from], self.owner[edge.to]);
            let silent = self.silent == Some(from) || self.silent == Some(to);
            // A zone repeats its request for a missing message, unless its neighbour is silent.
            let tries = if silent { 1 } else { 1 + MAX_REPEATS };
            let lost_tries =
                (0..tries).take_while(|_| self.loss > 0.0 && self.random.chance_of_32_bits(self.loss)).count();
            let lost = lost_tries == tries;
            let late = self.delay > 0;
            edge.live = !silent && !lost && !late;
            if subject != Subject::Direction {
                let age = &mut edge.age[subject as usize];
                *age = if lost && !silent { *age + 1 } else { 0 };
            }
            if self.silent != Some(from) {
                self.sent[from] += (lost_tries + 1).min(tries);
            }
            self.undelivered += if edge.live { lost_tries } else { lost_tries.max(1) };
            if late && !silent && !lost && subject != Subject::Direction {
                edge.late[subject as usize].push_back(Vec::new());
            }
        }
    }

    /// Sends the series of a round, and delivers the messages that are due.
    fn dispatch(&mut self, subject: Subject, series: &[Vec<f64>]) {
        if self.delay == 0 || subject == Subject::Direction {
            return;
        }
        for edge in &mut self.edges {
            let queue = &mut edge.late[subject as usize];
            if let Some(last) = queue.back_mut()
                && last.is_empty()
            {
                last.clone_from(&series[edge.from]);
            }
            if queue.len() >= self.delay
                && let Some(due) = queue.pop_front()
            {
                edge.heard[subject as usize] = due;
            }
        }
    }

    /// Temperatures of the nodes at the start of each step and at the end, N + 1 each, as the zones that own them know them. `heat_kw` is
    /// the heat of the zones' equipment, stacked, and `driving` all other heat into the nodes, with the nodes of a step together.
    pub fn temperatures(&mut self, initial_c: &[f64], heat_kw: &[f64], driving: &[f64]) -> Vec<Vec<f64>> {
        self.draw(Subject::Temperature);
        let series = self.forwards(initial_c, heat_kw, Some(driving));
        self.dispatch(Subject::Temperature, &series);
        series
    }

    /// The response of temperatures to inputs, as the zones compute it from the messages that arrive.
    pub fn directions(&mut self, heat_kw: &[f64]) -> Vec<Vec<f64>> {
        self.draw(Subject::Direction);
        self.forwards(&vec![0.0; self.gain.len()], heat_kw, None)
    }

    fn forwards(&mut self, initial: &[f64], heat_kw: &[f64], driving: Option<&[f64]>) -> Vec<Vec<f64>> {
        let (nodes, zones) = (self.gain.len(), self.sent.len());
        let mut series: Vec<Vec<f64>> = initial.iter().map(|value| vec![*value]).collect();
        for t in 0..self.steps {
            let mut net: Vec<f64> = (0..nodes).map(|p| -self.leaving_kw_per_k[p] * series[p][t]).collect();
            for &(from, to, conductance) in &self.inner {
                net[to] += conductance * series[from][t];
            }
            for edge in &mut self.edges {
                let value = match (edge.live, driving) {
                    (true, Some(_)) => {
                        edge.heard[0][t] = series[edge.from][t];
                        series[edge.from][t]
                    }
                    (true, None) => series[edge.from][t],
                    (false, Some(_)) => edge.heard[0][t],
                    (false, None) => 0.0,
                };
                net[edge.to] += edge.conductance_kw_per_k * value;
            }
            for p in 0..nodes {
                let own = if p < zones { heat_kw[t * zones + p] } else { 0.0 };
                let other = driving.map_or(0.0, |driving| driving[t * nodes + p]);
                let next = series[p][t] + self.gain[p] * (net[p] + own + other);
                series[p].push(next);
            }
        }
        series
    }

    /// ∂J/∂u without the inputs' own cost, stacked, from ∂J/∂T of the zones, stacked.
    pub fn sensitivities(&mut self, slope: &[f64]) -> Vec<f64> {
        self.draw(Subject::Sensitivity);
        let (nodes, zones) = (self.gain.len(), self.sent.len());
        let mut gradient = vec![0.0; zones * self.steps];
        // λ(t + 1) h/c: the sensitivity of J to heat into the node in step t.
        let mut series: Vec<Vec<f64>> = vec![vec![0.0; self.steps]; nodes];
        let mut lambda = vec![0.0; nodes];
        for t in (0..self.steps).rev() {
            if t + 1 < self.steps {
                let worth = |p: usize, series: &[Vec<f64>]| series[p][t + 1];
                let mut next: Vec<f64> =
                    (0..nodes).map(|p| lambda[p] - self.leaving_kw_per_k[p] * worth(p, &series)).collect();
                for &(from, to, conductance) in &self.inner {
                    next[to] += conductance * worth(from, &series);
                }
                for edge in &mut self.edges {
                    if edge.live {
                        edge.heard[1][t + 1] = worth(edge.from, &series);
                    }
                    next[edge.to] += edge.conductance_kw_per_k * edge.heard[1][t + 1];
                }
                lambda = next;
            }
            for (zone, lambda) in lambda.iter_mut().take(zones).enumerate() {
                *lambda += slope[t * zones + zone];
            }
            for p in 0..nodes {
                series[p][t] = self.gain[p] * lambda[p];
            }
            for zone in 0..zones {
                gradient[t * zones + zone] = series[zone][t];
            }
        }
        self.dispatch(Subject::Sensitivity, &series);
        gradient
    }
}
