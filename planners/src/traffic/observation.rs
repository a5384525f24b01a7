//! What can be seen of all road users, and what a driver sees of them who reacts late.
//!
//! At each plan an [`Observation`] is made of every vehicle on the road: its state, its acceleration (and so its brake light), its
//! indicator, its body and its route, with the motion that follows from them ([`SeenMotion`]) and what the rules ask of it as far as others
//! can tell: a vehicle that would have to brake much harder than it does to stop before its line does not look as if it will wait. Its
//! steering, its plan, its goal and its wishes are not in it. A driver with a reaction time receives the observation of that
//! long ago, each vehicle driven on along its expected motion: a [`View`].

use std::collections::VecDeque;
use std::sync::Arc;

use super::neighbours::Neighbours;
use super::road_user::RoadUser;
use crate::drivers::SeenMotion;
use crate::rules::urgency::braking_within;
use crate::rules::{Arrivals, Obliged, Order, RoadRules};
use crate::{Agent, Input, Trajectory};

/// A vehicle that has to brake harder than it does by more than this to stop before its line does not look as if it will \[m/s²\].
const UNSEEN_BRAKING_MPS2: f64 = 2.5;
/// Ways to a line are at least this, of real vehicles \[m\].
const LEAST_WAY_M: f64 = 0.1;

/// All road users as they could be seen at one plan.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Observation {
    tick: usize,
    /// One for each row; none for a vehicle that was not on the road.
    pub agents: Vec<Option<Arc<Agent>>>,
    arrivals: Arrivals,
}

/// The road users as a driver sees them who observes them some steps late.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct View {
    late_steps: usize,
    /// When they were observed \[s\].
    pub seen_s: f64,
    /// One for each row, driven on to the present; none for a vehicle that is not on the road.
    pub agents: Vec<Option<Agent>>,
    /// Which vehicles can matter to which, by the states in `agents`.
    pub near: Neighbours,
    /// The rows of the vehicles on the road.
    pub rows: Vec<usize>,
    /// How fast each of them is taken to want to drive, in the order of `rows` \[m/s\].
    pub wanted_mps: Vec<f64>,
    /// Which of them have to wait for which, in the order of `rows`.
    pub order: Order,
    /// What had been noted of their arrivals when they were observed.
    pub arrivals: Arrivals,
}

/// The observations that some driver has yet to receive, and the views of the present plan.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Observations {
    /// From the earliest to the present one.
    made: VecDeque<Observation>,
    views: Vec<View>,
}

impl Observations {
    /// Adds the observation of this plan and makes the views of drivers with these reaction times, in steps.
    pub(super) fn note(&mut self, observation: Observation, late_steps: &[usize], made_of: &MadeOf<'_>) {
        let latest = late_steps.iter().copied().max().unwrap_or(0);
        let tick = observation.tick;
        self.made.push_back(observation);
        while self.made.get(1).is_some_and(|next| next.tick + latest <= tick) {
            self.made.pop_front();
        }
        self.views = late_steps.iter().map(|late| self.view(*late, tick, made_of)).collect();
    }

    /// What is expected of a vehicle by one who sees its motion without delay, over the horizon and the longest reaction time; none while no
    /// driver observes.
    pub(super) fn expected_of(&self, row: usize) -> Option<&Arc<Trajectory>> {
        Some(&self.made.back()?.agents.get(row)?.as_ref()?.prediction)
    }

    /// A vehicle as one sees it without delay; none while no driver observes.
    pub(super) fn present_of(&self, row: usize, horizon: usize) -> Option<Agent> {
        Some(driven_on(self.made.back()?.agents.get(row)?.as_ref()?, 0, horizon))
    }

    /// The view of drivers with a reaction time in steps.
    pub(super) fn view_of(&self, late_steps: usize) -> Option<&View> {
        self.views.iter().find(|view| view.late_steps == late_steps)
    }

    fn view(&self, late_steps: usize, tick: usize, made_of: &MadeOf<'_>) -> View {
        let seen = self.made.iter().position(|made| made.tick + late_steps >= tick).unwrap_or(0);
        let here = |row: usize| {
            // A vehicle that came later is seen as it was at first.
            let mut since = self.made.range(seen..);
            let (then, agent) = since.find_map(|made| Some((made.tick, made.agents.get(row)?.as_ref()?)))?;
            Some(driven_on(agent, tick - then, made_of.horizon))
        };
        let is_present = |row: &usize| !made_of.road_users[*row].is_absent();
        let agents: Vec<Option<Agent>> =
            (0..made_of.road_users.len()).map(|row| is_present(&row).then(|| here(row)).flatten()).collect();
        let rows: Vec<usize> = (0..agents.len()).filter(|row| agents[*row].is_some()).collect();
        let users: Vec<Obliged<'_>> = rows.iter().filter_map(|row| made_of.obliged(*row, &agents)).collect();
        let wanted_mps = users.iter().map(|user| user.wanted_mps).collect();
        let made = self.made.get(seen);
        let seen_s = made.map_or(tick, |made| made.tick) as f64 * made_of.step_s;
        let arrivals = made.map(|made| made.arrivals.clone()).unwrap_or_default();
        let order = Order::of(&arrivals, &users, seen_s);
        let near = Neighbours::of_agents(agents.iter().map(Option::as_ref), made_of.horizon as f64 * made_of.step_s);
        View { late_steps, seen_s, near, rows, wanted_mps, order, arrivals, agents }
    }
}

/// The traffic as it is: what observations are made of.
#[derive(Clone, Copy)]
pub(super) struct MadeOf<'a> {
    pub tick: usize,
    pub step_s: f64,
    pub horizon: usize,
    pub road_users: &'a [RoadUser],
    pub near: &'a Neighbours,
}

impl<'a> MadeOf<'a> {
    /// A road user as the others see it, of whom `agents` has one for each row.
    fn obliged<'b>(&self, row: usize, agents: &'b [Option<Agent>]) -> Option<Obliged<'b>> {
        Some(Obliged::as_seen(agents.get(row)?.as_ref()?, self.road_users[row].keeps_rules))
    }

    /// What can be seen of all; `rules` are what the rules ask of each row as far as others can tell, and motions are expected over the
    /// horizon and as long as the slowest driver is late, in steps.
    pub(super) fn observation(&self, rules: Vec<RoadRules>, latest: usize, arrivals: Arrivals) -> Observation {
        let seen = |user: &RoadUser, rules| Agent {
            previous_input: Input { steering_rad: 0.0, ..user.agent.previous_input },
            prediction: Arc::default(),
            shared_goal: user.agent.shared_goal.filter(|_| user.tells_plan),
            can_be_asked: !user.agent.is_obstacle,
            rules: as_it_shows(&user.agent, rules),
            urgency: 1.0,
            ..user.agent.clone()
        };
        let mut agents: Vec<Option<Agent>> = self
            .road_users
            .iter()
            .zip(rules)
            .map(|(user, rules)| (!user.is_absent()).then(|| seen(user, rules)))
            .collect();
        let leaders: Vec<Option<usize>> = (0..agents.len()).map(|row| self.leader(row, &agents)).collect();
        let mut is_done = vec![false; agents.len()];
        for row in 0..agents.len() {
            self.expect(row, &leaders, &mut agents, &mut is_done, latest);
        }
        Observation { tick: self.tick, agents: agents.into_iter().map(|agent| agent.map(Arc::new)).collect(), arrivals }
    }

    /// Writes the expected motion of a vehicle, after that of its leader: from the front of a queue to its rear. In a circle, the first
    /// that is asked for is expected without a leader.
    fn expect(
        &self,
        row: usize,
        leaders: &[Option<usize>],
        agents: &mut [Option<Agent>],
        is_done: &mut [bool],
        latest: usize,
    ) {
        let mut queue = vec![row];
        while let Some(ahead) = queue.last().and_then(|last| leaders[*last]) {
            if is_done[ahead] || queue.contains(&ahead) {
                break;
            }
            queue.push(ahead);
        }
        while let Some(row) = queue.pop() {
            let Some(vehicle) = agents[row].as_ref().filter(|_| !is_done[row]) else { continue };
            let leader = leaders[row].filter(|ahead| is_done[*ahead]).and_then(|ahead| agents[ahead].as_ref());
            let motion = SeenMotion { vehicle, leader }.expected(self.horizon + latest, self.step_s);
            is_done[row] = true;
            if let Some(agent) = &mut agents[row] {
                agent.prediction = Arc::new(motion);
            }
        }
    }

    /// The vehicle ahead in the same lane.
    fn leader(&self, row: usize, agents: &[Option<Agent>]) -> Option<usize> {
        let own = agents[row].as_ref()?;
        let near = self.near.of(row, self.road_users).into_iter();
        let ahead = near.filter_map(|other| {
            let agent = agents[other].as_ref()?;
            let lead_m = own.lead_of(agent);
            (lead_m > 0.0 && own.shares_lane_with(agent)).then_some((other, lead_m))
        });
        ahead.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(other, _)| other)
    }
}

/// What the rules ask of a vehicle, as far as it looks as if it will do it.
pub(super) fn as_it_shows(vehicle: &Agent, rules: RoadRules) -> RoadRules {
    let Agent { route, body, state, previous_input, .. } = vehicle;
    let waits = rules.stop_line_m.is_none_or(|line_m| {
        let way_m = (line_m - route.along(state.position()) - body.front_m).max(LEAST_WAY_M * body.real_ratio());
        let braking_mps2 = (-previous_input.acceleration_mps2).max(0.0);
        braking_within(state.speed_mps, way_m) - braking_mps2 <= UNSEEN_BRAKING_MPS2
    });
    let rules = RoadRules { passes: None, ..rules };
    if waits { rules } else { RoadRules { stop_line_m: None, waits_for: Vec::new(), ..rules } }
}

/// A vehicle some steps after it was observed, with as much of its expected motion as a plan needs.
fn driven_on(agent: &Agent, steps: usize, horizon: usize) -> Agent {
    let Agent { prediction, .. } = agent;
    if steps == 0 && prediction.inputs.len() <= horizon {
        return agent.clone();
    }
    let rest = |from: usize, count: usize, length: usize| from.min(length)..(from + count).min(length);
    let motion = Trajectory {
        states: prediction.states[rest(steps, horizon + 1, prediction.states.len())].to_vec(),
        inputs: prediction.inputs[rest(steps, horizon, prediction.inputs.len())].to_vec(),
    };
    let state = motion.states.first().copied().unwrap_or(agent.state);
    Agent { state, prediction: Arc::new(motion), ..agent.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::real_car;

    #[test]
    fn a_vehicle_that_would_have_to_brake_hard_before_its_line_does_not_look_as_if_it_will_wait() {
        let waits = |speed_mps: f64, acceleration_mps2: f64| {
            let mut vehicle = real_car(0.0, speed_mps);
            vehicle.previous_input.acceleration_mps2 = acceleration_mps2;
            let line_m = Some(vehicle.body.front_m + 14.0);
            let rules = RoadRules { stop_line_m: line_m, waits_for: vec!["other".to_owned()], ..RoadRules::default() };
            let shown = as_it_shows(&vehicle, rules);
            assert_eq!(shown.stop_line_m.is_some(), !shown.waits_for.is_empty());
            shown.stop_line_m.is_some()
        };
        // 100/28 = 3.6 m/s² are needed from 10 m/s.
        assert_eq!([waits(10.0, 0.0), waits(10.0, -2.0), waits(8.0, 0.0), waits(0.0, 0.0)], [false, true, true, true]);
    }
}
