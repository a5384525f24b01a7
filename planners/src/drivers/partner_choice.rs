//! Which vehicle a planner interacts with: whose path it crosses, and whether the order of the two is settled.
//!
//! The source interacts with one vehicle after the other, from the front of the road to its rear (section 6.5). A vehicle
//! with which nothing is left to settle is skipped: one that drives ahead in the ego's target lane, or that has crossed, or
//! that the ego has crossed before.

use crate::scene::relation::{PARALLEL_RAD, Relation};
use crate::{Agent, PlanEvent, PlanEventKind, Scene};

/// Whether the order of two vehicles is settled; one on the same road is if it is ahead by `clear_lead_m` in the lane that
/// the ego wants. On routes of a network it is also settled if the other follows in the ego's lane, or
/// if the rules decide now which of them waits.
pub(crate) fn is_settled(scene: &Scene, other: &Agent, clear_lead_m: f64) -> bool {
    let ego = &scene.ego;
    if ego.has_order_with(other) {
        return true;
    }
    match ego.relation(other) {
        Relation::CrossingRoads => return has_crossed(other, ego) || has_crossed(ego, other),
        Relation::Conflict(_) => return false,
        Relation::Apart => return true,
        Relation::Alongside => {}
    }
    if ego.route.is_in_network() && ego.shares_lane_with(other) && ego.lead_of(other) <= 0.0 {
        return true;
    }
    let off_lane = ego.route.across(other.state.position()) - ego.route.across(scene.goal.target.position());
    let in_target_lane = off_lane.abs() < 0.5 * (ego.body.width_m + other.body.width_m);
    in_target_lane && ego.lead_of(other) > clear_lead_m
}

/// Whether the whole body of `agent` is beyond the path of `other`, whose road it crosses.
fn has_crossed(agent: &Agent, other: &Agent) -> bool {
    let (from, to, place) = (&other.route, &agent.route, agent.state.position());
    let side = from.across(place) - from.across(other.state.position());
    let direction = libm::sin(to.heading_at(place) - from.heading_at(place));
    side * direction.signum() > agent.body.rear_m + 0.5 * other.body.width_m
}

/// How far `agent` has to drive along its road until its centre is on the path of `other`; negative once it is beyond, `None`
/// where the paths do not cross \[m\].
pub(crate) fn distance_to_path(agent: &Agent, other: &Agent) -> Option<f64> {
    match agent.relation(other) {
        Relation::Conflict(conflict) => {
            return Some(conflict.own_meeting_m - agent.along_m());
        }
        Relation::Apart => return None,
        Relation::Alongside | Relation::CrossingRoads => {}
    }
    let (from, to, place) = (&other.route, &agent.route, agent.state.position());
    let closing = libm::sin(to.heading_at(place) - from.heading_at(place));
    let side = from.across(place) - from.across(other.state.position());
    (closing.abs() > libm::sin(PARALLEL_RAD)).then(|| -side / closing)
}

/// The names of all others in the order in which a planner turns to them.
pub(crate) fn from_front_to_rear(scene: &Scene) -> Vec<String> {
    let mut others: Vec<&Agent> = scene.others.iter().collect();
    others.sort_by(|a, b| scene.ego.lead_or_nearness_of(b).total_cmp(&scene.ego.lead_or_nearness_of(a)));
    others.into_iter().map(|other| other.name.clone()).collect()
}

/// The vehicle that is interacted with, and those before and after it.
#[derive(Clone, Debug, Default)]
pub(crate) struct PartnerSequence {
    /// Names from the front of the road to its rear; fixed at the first step.
    order: Vec<String>,
    current: Option<String>,
    /// Steps since the current one was chosen.
    steps: usize,
}

/// Whom a planner turns to.
#[derive(Clone, Debug)]
pub(crate) struct PartnerChoice<'a> {
    /// The vehicle, if one is left.
    pub partner: Option<&'a Agent>,
    /// Whether it is another one than a step before.
    pub is_new: bool,
    /// How many steps it has been this one.
    pub steps: usize,
    /// Whether it is the first in the order.
    pub is_first: bool,
}

impl PartnerSequence {
    /// The first vehicle with which something is left to settle.
    pub(crate) fn choose<'a>(&mut self, scene: &'a Scene, clear_lead_m: f64) -> PartnerChoice<'a> {
        if self.order.is_empty() {
            self.order = from_front_to_rear(scene);
        }
        let known = self.order.iter().filter_map(|name| scene.others.iter().find(|other| other.name == *name));
        let partner = known.into_iter().find(|other| !is_settled(scene, other, clear_lead_m));
        let name = partner.map(|partner| partner.name.clone());
        let is_new = name != self.current;
        self.steps = if is_new { 0 } else { self.steps + 1 };
        self.current = name;
        PartnerChoice { partner, is_new, steps: self.steps, is_first: self.order.first() == self.current.as_ref() }
    }
}

impl PartnerChoice<'_> {
    /// Whether what the partner does may be an answer: it has been the partner for longer than `answer_s`.
    pub(crate) fn may_have_answered(&self, answer_s: f64, step_s: f64) -> bool {
        self.steps as f64 * step_s >= answer_s
    }

    /// What to say about a change: "`does` NAME", or that no vehicle is left `to_do` it with.
    pub(crate) fn event(&self, does: &str, to_do: &str) -> Option<PlanEvent> {
        self.is_new.then(|| partner_event(self.partner.map(|partner| &*partner.name), does, to_do))
    }
}

/// A planner turns to a partner: "`does` NAME", or no vehicle is left `to_do` it with.
pub(crate) fn partner_event(partner: Option<&str>, does: &str, to_do: &str) -> PlanEvent {
    let text = partner.map_or_else(|| format!("nobody left {to_do}"), |name| format!("{does} {name}"));
    PlanEvent { kind: PlanEventKind::Partner(partner.map(str::to_owned)), text }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{agent, crossing, scene};

    #[test]
    fn the_distance_to_a_path_is_that_along_the_own_road() {
        let (east, north) = (agent(-2.0, 0.185, 0.0, 1.0), crossing(0.0, -1.6, 1.0));
        let distances = [distance_to_path(&east, &north), distance_to_path(&north, &east)];
        for (found, expected) in distances.into_iter().zip([2.0, 1.785]) {
            assert!((found.expect("they cross") - expected).abs() < 1e-12);
        }
        assert!((distance_to_path(&agent(1.0, 0.0, 0.0, 1.0), &north).expect("crosses") + 1.0).abs() < 1e-12);
        // At 45°, the way is longer by √2.
        let slanted = agent(0.0, -1.0, std::f64::consts::FRAC_PI_4, 1.0);
        let distance = distance_to_path(&slanted, &agent(5.0, 0.0, 0.0, 1.0)).expect("crosses");
        assert!((distance - 2.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(distance_to_path(&east, &agent(1.0, 0.5, 0.0, 1.0)), None);
    }

    #[test]
    fn a_vehicle_has_crossed_when_its_rear_is_beyond_the_other_s_side() {
        let north = crossing(0.0, -1.6, 1.0);
        for (x, crossed) in [(-0.5, false), (0.2, false), (0.28, false), (0.29, true)] {
            assert_eq!(has_crossed(&agent(x, 0.185, 0.0, 1.0), &north), crossed, "{x}");
        }
    }

    /// The front vehicle, the rear one once the front one is clear ahead in the wanted lane, and then none.
    #[test]
    fn partners_are_met_from_front_to_rear() {
        let mut partner = PartnerSequence::default();
        let mut meet = |front: f64, rear: f64| {
            let others = vec![named("rear", rear), named("front", front)];
            let mut scene = scene(agent(0.0, 0.0, 0.0, 1.0), others);
            scene.goal.target.y_m = 0.4;
            let choice = partner.choose(&scene, 0.2);
            let name = choice.partner.map(|partner| partner.name.clone());
            (name, choice.is_first, choice.steps, choice.event("asks", "to ask").map(|event| event.text))
        };
        let named_front = Some("front".to_owned());
        assert_eq!(meet(-0.4, -1.7), (named_front.clone(), true, 0, Some("asks front".to_owned())));
        assert_eq!(meet(0.1, -1.2), (named_front, true, 1, None));
        assert_eq!(meet(0.3, -1.0), (Some("rear".to_owned()), false, 0, Some("asks rear".to_owned())));
        assert_eq!(meet(1.6, 0.3), (None, false, 0, Some("nobody left to ask".to_owned())));
    }

    fn named(name: &str, x_m: f64) -> Agent {
        Agent { name: name.to_owned(), ..agent(x_m, 0.4, 0.0, 1.4) }
    }
}
