//! The requests that vehicles make of each other by their proposals, and the answers, in words.

use interplay_planners::{Plan, PlanEvent, PlanEventKind, Proposal};
use interplay_scenarios::Scenario;
use interplay_simulation::frame::{Frame, VehicleFrame};
use interplay_simulation::measure::is_arrival;

/// Acceptance from which a vehicle accepts, and below which it declines.
const ACCEPTS: f64 = 0.7;
const DECLINES: f64 = 0.3;

/// The reaction of a vehicle whose acceptance of a proposal is `share`, from 0 to 1.
fn reaction(share: f64) -> &'static str {
    match share {
        share if share >= ACCEPTS => "accepts",
        share if share < DECLINES => "declines",
        _ => "hesitates",
    }
}

/// A proposal that stays within this distance of the expected motion, in widths of the asked vehicle, requests nothing: its
/// dots would lie on the band of the plan.
const MIN_REQUEST_WIDTHS: f64 = 0.5;

/// The open requests of all vehicles.
///
/// A vehicle that follows a proposal is then expected to move as proposed, so a request stays open once it was made,
/// until one of the two vehicles has reached its goal.
#[derive(Clone, Debug, Default)]
pub struct Requests {
    /// For each vehicle: the vehicles that it addresses without interruption, each with whether it requests a change of motion.
    asked: Vec<Vec<(String, bool)>>,
    /// For each vehicle whether it has reached its goal.
    has_arrived: Vec<bool>,
}

impl Requests {
    pub fn observe(&mut self, scenario: &Scenario, frame: &Frame) {
        let before = std::mem::take(&mut self.asked);
        self.has_arrived.resize(frame.vehicles.len(), false);
        for event in frame.events.iter().filter(|event| is_arrival(event)) {
            let arrived = frame.vehicles.iter().position(|vehicle| vehicle.name == event.vehicle);
            arrived.into_iter().for_each(|index| self.has_arrived[index] = true);
        }
        let has_arrived = &self.has_arrived;
        let now = |(index, vehicle): (usize, &VehicleFrame)| {
            let proposals = vehicle.plan.proposals.iter();
            let asked = proposals.map(|proposal| {
                let was_asked = |asked: &Vec<(String, bool)>| asked.contains(&(proposal.to.clone(), true));
                let was_open = before.get(index).is_some_and(was_asked);
                let is_over = has_arrived[index] || scenario.index_of(&proposal.to).is_some_and(|to| has_arrived[to]);
                let counts = match proposal.acceptance {
                    Some(_) => was_open && !is_over || requests_change(scenario, frame, proposal),
                    None => !is_over,
                };
                (proposal.to.clone(), counts)
            });
            asked.collect()
        };
        self.asked = frame.vehicles.iter().enumerate().map(now).collect();
    }

    /// The proposals of a vehicle at the last observed tick, without those that request nothing.
    pub fn proposals<'a>(&self, frame: &'a Frame, vehicle: usize) -> impl Iterator<Item = &'a Proposal> {
        let asks = self.asked.get(vehicle);
        let requests_nothing = move |to: &String| asks.is_some_and(|asks| asks.contains(&(to.clone(), false)));
        let proposals = frame.vehicles[vehicle].plan.proposals.iter();
        proposals.filter(move |proposal| !requests_nothing(&proposal.to))
    }

    /// The request of a vehicle at the last observed tick and the answers, without the subject; `None` without a request.
    pub fn sentence(&self, frame: &Frame, vehicle: usize) -> Option<String> {
        let proposals: Vec<&Proposal> = self.proposals(frame, vehicle).collect();
        let does = if proposals.first()?.acceptance.is_some() { "asks" } else { "expects" };
        let names: Vec<&str> = proposals.iter().map(|proposal| proposal.to.as_str()).collect();
        let way = if names.len() == 1 { "way" } else { "ways" };
        let asks = format!("{does} {} to take the dotted {way}", names.join(", "));
        let plan = &frame.vehicles[vehicle].plan;
        let answers = proposals.iter().filter(|proposal| !is_new(plan, &proposal.to)).filter_map(|proposal| {
            let share = proposal.acceptance?;
            Some(format!("{} {} ({:.0} %)", proposal.to, reaction(share), 100.0 * share))
        });
        let answers = answers.collect::<Vec<_>>().join(", ");
        Some(if answers.is_empty() { asks } else { format!("{asks} – {answers}") })
    }
}

/// Whether a proposal differs visibly from the expected motion of the asked vehicle.
fn requests_change(scenario: &Scenario, frame: &Frame, proposal: &Proposal) -> bool {
    let Some(index) = scenario.index_of(&proposal.to) else { return true };
    let expected = &frame.vehicles[index].prediction.states;
    let most_m = MIN_REQUEST_WIDTHS * scenario.vehicles[index].body.width_m;
    let pairs = proposal.trajectory.states.iter().zip(expected);
    pairs.into_iter().any(|(a, b)| libm::hypot(a.x_m - b.x_m, a.y_m - b.y_m) > most_m)
}

/// Whether a plan is the first that asks a vehicle, before any answer.
fn is_new(plan: &Plan, to: &str) -> bool {
    let names = |event: &PlanEvent| matches!(&event.kind, PlanEventKind::Partner(Some(partner)) if partner == to);
    plan.events.iter().any(names)
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;
    use crate::figures::RecordedRun;

    fn sentences(name: &str) -> Vec<String> {
        let recorded = RecordedRun::record(name, load(name, &[]).expect("embedded"), Vec::new(), "").expect("a run");
        let (scenario, mut requests) = (&recorded.scenario, Requests::default());
        let said = recorded.frames.iter().filter_map(|frame| {
            requests.observe(scenario, frame);
            requests.sentence(frame, scenario.ego_index())
        });
        said.collect()
    }

    /// The request stays open, and has an answer, as long as the crossing vehicle is asked to wait.
    #[test]
    fn a_request_stays_open_while_the_other_vehicle_is_asked_to_wait() {
        let said = sentences("intersection/nice");
        assert!(said.iter().all(|words| words.starts_with("asks crossing to take the dotted way")), "{said:?}");
        assert!(said.last().is_some_and(|words| words.contains("accepts")), "{said:?}");
    }

    /// After the ego has reached its lane, it requests nothing of the driver who let it in.
    #[test]
    fn a_vehicle_at_its_goal_requests_nothing() {
        let name = "lane-change/front-nice";
        let recorded = RecordedRun::record(name, load(name, &[]).expect("embedded"), Vec::new(), "").expect("a run");
        let (scenario, mut requests) = (&recorded.scenario, Requests::default());
        recorded.frames.iter().for_each(|frame| requests.observe(scenario, frame));
        let last = recorded.frames.last().expect("ticks");
        assert!(!last.vehicles[scenario.ego_index()].plan.proposals.is_empty(), "it still has a proposal");
        assert_eq!(requests.sentence(last, scenario.ego_index()), None);
    }

    /// The proposal to the tough driver ahead of the ramp is its expected motion, so the sentence does not mention it.
    #[test]
    fn a_proposal_of_the_expected_motion_is_not_a_request() {
        let said = sentences("on-ramp/five");
        assert!(!said.iter().any(|words| words.contains("front")), "{said:?}");
    }
}
