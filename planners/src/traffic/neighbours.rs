//! Which road users can matter to which within the horizon of a plan: found in a grid, without comparing all pairs.

use std::borrow::Cow;

use crate::{Agent, Scene, State};

use super::road_user::RoadUser;

/// Beyond the reach of both, this many lengths of their bodies are looked at besides: room for ellipses and gaps at a standstill.
const MARGIN_LENGTHS: f64 = 4.0;
/// Who faces the same way to within this angle \[rad\] drives behind or before another, not towards it.
const SAME_WAY_RAD: f64 = 0.5;

/// Who is where: road users by cells of a grid, each as wide as the farthest reach. By default no place is known, and then
/// all count as near.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Neighbours {
    cell_m: f64,
    /// Cells with the indices of those in them, sorted by cell and index.
    cells: Vec<([i64; 2], usize)>,
    /// How far each road user can come within the horizon \[m\].
    reaches_m: Vec<f64>,
}

impl Neighbours {
    /// Sorts the road users on the road into cells.
    pub fn find(road_users: &[RoadUser], horizon_s: f64) -> Neighbours {
        Neighbours::of_agents(road_users.iter().map(|user| (!user.is_absent()).then_some(&user.agent)), horizon_s)
    }

    /// Sorts vehicles into cells; absent ones are none.
    pub(super) fn of_agents<'a>(agents: impl Iterator<Item = Option<&'a Agent>> + Clone, horizon_s: f64) -> Neighbours {
        let present = || agents.clone().enumerate().filter_map(|(index, agent)| Some((index, agent?)));
        let reaches_m: Vec<f64> = agents.clone().map(|agent| agent.map_or(0.0, |it| reach_m(it, horizon_s))).collect();
        // Those who come towards each other meet within both reaches.
        let farthest_m = present().map(|(index, agent)| reaches_m[index] + margin_m(agent)).fold(0.0, f64::max);
        let cell_m = 2.0 * farthest_m.max(1.0);
        let mut cells: Vec<_> = present().map(|(index, agent)| (cell_of(&agent.state, cell_m), index)).collect();
        cells.sort_unstable();
        Neighbours { cell_m, cells, reaches_m }
    }

    /// The indices of the road users that can matter to one, in the order in which they are listed.
    pub fn of(&self, vehicle: usize, road_users: &[RoadUser]) -> Vec<usize> {
        let ego = &road_users[vehicle].agent;
        if self.cells.is_empty() {
            let present = road_users.iter().enumerate().filter(|(other, user)| *other != vehicle && !user.is_absent());
            return present.map(|(other, _)| other).collect();
        }
        self.near_to(ego, vehicle, |other| Some(&road_users[other].agent))
    }

    /// The same of a vehicle that is not where it was when they were sorted, among agents as they were then.
    pub(super) fn near_to<'a>(
        &self,
        ego: &Agent,
        vehicle: usize,
        agent: impl Fn(usize) -> Option<&'a Agent>,
    ) -> Vec<usize> {
        let is_near = |other: &usize| {
            agent(*other).is_some_and(|it| can_matter(ego, self.reaches_m[vehicle], it, self.reaches_m[*other]))
        };
        let [column, row] = cell_of(&ego.state, self.cell_m);
        let mut found = Vec::new();
        for x in column.saturating_sub(1)..=column.saturating_add(1) {
            for y in row.saturating_sub(1)..=row.saturating_add(1) {
                let from = self.cells.partition_point(|(cell, _)| *cell < [x, y]);
                let here = self.cells[from..].iter().take_while(|(cell, _)| *cell == [x, y]);
                let others = here.map(|(_, index)| *index).filter(|index| *index != vehicle);
                found.extend(others.filter(is_near));
            }
        }
        found.sort_unstable();
        found
    }
}

impl Scene {
    /// The scene with those others only who can reach the planning vehicle within the horizon, or be reached by it.
    pub(crate) fn within_reach(&self) -> Cow<'_, Scene> {
        let horizon_s = self.horizon as f64 * self.step_s;
        let own_m = reach_m(&self.ego, horizon_s);
        let is_near = |other: &Agent| can_matter(&self.ego, own_m, other, reach_m(other, horizon_s));
        if self.others.iter().all(is_near) {
            return Cow::Borrowed(self);
        }
        let others = self.others.iter().filter(|other| is_near(other)).cloned().collect();
        Cow::Owned(Scene { others, ego: self.ego.clone(), ..*self })
    }
}

/// Whether two vehicles can come to each other within a horizon, whatever both do: one reaches the place of the other if they go the same
/// way, and else both together the way between them. Each comes with its reach \[m\].
fn can_matter(one: &Agent, own_m: f64, other: &Agent, their_m: f64) -> bool {
    let margin_m = margin_m(one) + margin_m(other);
    let turned = libm::cos(one.state.heading_rad - other.state.heading_rad);
    let reach_m = if turned > libm::cos(SAME_WAY_RAD) { own_m.max(their_m) } else { own_m + their_m } + margin_m;
    let [x_m, y_m] = [one.state.x_m - other.state.x_m, one.state.y_m - other.state.y_m];
    // A state that is not a number is near to all.
    (x_m * x_m + y_m * y_m).partial_cmp(&(reach_m * reach_m)).is_none_or(std::cmp::Ordering::is_le)
}

/// How far a vehicle can come within a time \[m\]: with its strongest acceleration up to its highest speed.
fn reach_m(agent: &Agent, time_s: f64) -> f64 {
    let (limits, now_mps) = (&agent.limits, agent.state.speed_mps.abs());
    let most_mps = limits.speed_max_mps.max(-limits.speed_min_mps).max(now_mps);
    let gain_mps2 = limits.acceleration_max_mps2.max(1e-9);
    let rise_s = ((most_mps - now_mps) / gain_mps2).min(time_s);
    now_mps * rise_s
        + 0.5 * gain_mps2 * rise_s * rise_s
        + most_mps.min(now_mps + gain_mps2 * rise_s) * (time_s - rise_s)
}

fn margin_m(agent: &Agent) -> f64 {
    MARGIN_LENGTHS * (agent.body.front_m + agent.body.rear_m)
}

fn cell_of(state: &State, cell_m: f64) -> [i64; 2] {
    state.position().map(|place_m| (place_m / cell_m).floor() as i64)
}
