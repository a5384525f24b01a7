//! Who is judged.

use crate::Agent;

/// A road user as the rules see it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Obliged<'a> {
    /// The vehicle.
    pub agent: &'a Agent,
    /// How fast it wants to drive \[m/s\].
    pub wanted_mps: f64,
    /// Where it wants to drive beside the centre line of its route \[m\].
    pub lateral_goal_m: f64,
    /// Whether it keeps the rules.
    pub keeps_rules: bool,
}

/// Share of its highest speed that a road user is taken to want where nothing limits its speed: 14 m/s of a car, 1.4 m/s of a pedestrian.
const USUAL_SHARE: f64 = 0.28;

impl<'a> Obliged<'a> {
    /// Whether the rules of a network apply to it.
    pub(crate) fn is_judged(&self) -> bool {
        self.keeps_rules && self.agent.route.is_in_network()
    }

    /// A road user as far as the others can tell: it wants to drive as fast as is permitted where it is, and to stay in its lane.
    pub(crate) fn as_seen(agent: &'a Agent, keeps_rules: bool) -> Obliged<'a> {
        let along_m = agent.along_m();
        let usual_mps = USUAL_SHARE * agent.limits.speed_max_mps;
        let wanted_mps = agent.permitted_speed_mps(along_m).unwrap_or(usual_mps).max(agent.state.speed_mps);
        let wanted_mps = wanted_mps.min(agent.limits.speed_max_mps);
        Obliged { agent, wanted_mps, lateral_goal_m: 0.0, keeps_rules }
    }
}
