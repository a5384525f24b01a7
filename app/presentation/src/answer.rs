//! What vehicles ask for and what they answer, in words.

use interplay_planners::{Plan, PlanEvent, PlanEventKind, Proposal};
use interplay_scenarios::Scenario;
use interplay_simulation::frame::{Frame, VehicleFrame};
use interplay_simulation::measure::is_arrival;

/// From this share of acceptance on a vehicle accepts, below the other it declines.
const ACCEPTS: f64 = 0.7;
const DECLINES: f64 = 0.3;

/// What a vehicle does that follows a proposal by a share from 0 to 1.
fn answer(share: f64) -> &'static str {
    match share {
        share if share >= ACCEPTS => "accepts",
        share if share < DECLINES => "declines",
        _ => "hesitates",
    }
}

/// A motion that nowhere leaves the expected one by more than this share of the asked vehicle's width asks for nothing: its
/// dots lie on the band of the plan, so nobody can see a difference either.
const NOTHING_NEW_WIDTHS: f64 = 0.5;

/// What vehicles ask one another for.
///
/// A driver who follows a proposal is expected to do what it is asked for, so the past counts, too, until one of both has
/// arrived: then nothing is left to ask for.
#[derive(Clone, Debug, Default)]
pub struct Requests {
    /// Of every vehicle whom it asks without a pause, and of each whether it has asked for anything but what was expected anyway.
    asked: Vec<Vec<(String, bool)>>,
    /// Of every vehicle whether it has reached its goal.
    has_arrived: Vec<bool>,
}

impl Requests {
    /// Observes a tick, which must be the next one.
    pub fn tick(&mut self, scenario: &Scenario, frame: &Frame) {
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
                let known = before.get(index).is_some_and(was_asked);
                let is_over = has_arrived[index] || scenario.index_of(&proposal.to).is_some_and(|to| has_arrived[to]);
                let counts = match proposal.acceptance {
                    Some(_) => known && !is_over || asks_for_more(scenario, frame, proposal),
                    None => !is_over,
                };
                (proposal.to.clone(), counts)
            });
            asked.collect()
        };
        self.asked = frame.vehicles.iter().enumerate().map(now).collect();
    }

    /// The motions that a vehicle asks others for at the last tick, or expects of them, without those that were expected
    /// anyway.
    pub fn proposals<'a>(&self, frame: &'a Frame, vehicle: usize) -> impl Iterator<Item = &'a Proposal> {
        let asks = self.asked.get(vehicle);
        let asks_for_nothing = move |to: &String| asks.is_some_and(|asks| asks.contains(&(to.clone(), false)));
        let proposals = frame.vehicles[vehicle].plan.proposals.iter();
        proposals.filter(move |proposal| !asks_for_nothing(&proposal.to))
    }

    /// What a vehicle asks for at the last tick and what the other answers, without the subject; none if it asks for nothing.
    pub fn sentence(&self, frame: &Frame, vehicle: usize) -> Option<String> {
        let proposals: Vec<&Proposal> = self.proposals(frame, vehicle).collect();
        let does = if proposals.first()?.acceptance.is_some() { "asks" } else { "expects" };
        let names: Vec<&str> = proposals.iter().map(|proposal| proposal.to.as_str()).collect();
        let way = if names.len() == 1 { "way" } else { "ways" };
        let asks = format!("{does} {} to take the dotted {way}", names.join(", "));
        let plan = &frame.vehicles[vehicle].plan;
        let answers = proposals.iter().filter(|proposal| !is_new(plan, &proposal.to)).filter_map(|proposal| {
            let share = proposal.acceptance?;
            Some(format!("{} {} ({:.0} %)", proposal.to, answer(share), 100.0 * share))
        });
        let answers = answers.collect::<Vec<_>>().join(", ");
        Some(if answers.is_empty() { asks } else { format!("{asks} – {answers}") })
    }
}

/// Whether a proposal anywhere differs visibly from what is expected of the asked vehicle.
fn asks_for_more(scenario: &Scenario, frame: &Frame, proposal: &Proposal) -> bool {
    let Some(index) = scenario.index_of(&proposal.to) else { return true };
    let expected = &frame.vehicles[index].prediction.states;
    let most_m = NOTHING_NEW_WIDTHS * scenario.vehicles[index].body.width_m;
    let pairs = proposal.trajectory.states.iter().zip(expected);
    pairs.into_iter().any(|(a, b)| libm::hypot(a.x_m - b.x_m, a.y_m - b.y_m) > most_m)
}

/// Whether a plan is the first that asks a vehicle: nobody has answered it.
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
            requests.tick(scenario, frame);
            requests.sentence(frame, scenario.ego_index())
        });
        said.collect()
    }

    /// Who is made to wait is asked for something, and its answer counts as long as it is asked.
    #[test]
    fn who_yields_was_asked_for_something() {
        let said = sentences("intersection/nice");
        assert!(said.iter().all(|words| words.starts_with("asks crossing to take the dotted way")), "{said:?}");
        assert!(said.last().is_some_and(|words| words.contains("accepts")), "{said:?}");
    }

    /// The ego ends in its lane ahead of a driver who lets it in: that driver is then not asked any more.
    #[test]
    fn who_has_arrived_asks_for_nothing_more() {
        let name = "lane-change/front-nice";
        let recorded = RecordedRun::record(name, load(name, &[]).expect("embedded"), Vec::new(), "").expect("a run");
        let (scenario, mut requests) = (&recorded.scenario, Requests::default());
        recorded.frames.iter().for_each(|frame| requests.tick(scenario, frame));
        let last = recorded.frames.last().expect("ticks");
        assert!(!last.vehicles[scenario.ego_index()].plan.proposals.is_empty(), "it still has a proposal");
        assert_eq!(requests.sentence(last, scenario.ego_index()), None);
    }

    /// The tough driver ahead of the ramp is asked for what it does anyway: nothing is said of it.
    #[test]
    fn who_is_asked_for_what_it_does_is_not_asked() {
        let said = sentences("on-ramp/five");
        assert!(!said.iter().any(|words| words.contains("front")), "{said:?}");
    }
}
