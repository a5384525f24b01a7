//! Which vehicles the ego negotiates with.
//!
//! The source asks the front vehicle first and the rear one when the front one has refused for too long ([`Patience`]). A vehicle with
//! which nothing is left to negotiate is skipped: one that drives ahead in the ego's target lane, or that has crossed, or that the ego
//! has crossed before. With one that a safe fallback passes ahead of no negotiation is begun: it need not be asked for what the ego can
//! have without its consent, and waiting for its answer could cost the way. A driver who takes notice of no vehicle outside its own lane
//! is never asked: the ego keeps out of its predicted way. With `partners_at_most` above 1 the next ones in this order are asked at the
//! same time. When all have refused the ego asks no vehicle and drives by its fallback.

use super::filter::MAX_VIOLATION;
use super::patience::{FallbackPrice, Patience};
use super::settings::Settings;
use crate::drivers::partner_choice::{from_front_to_rear, is_settled};
use crate::drivers::receding_horizon::Solved;
use crate::plan::homotopy::homotopy_class;
use crate::plan::planned_passing::PassingSide;
use crate::trajectory::Violation;
use crate::{Agent, Plan, PlanError, Scene};

/// For how long the ego asks no more after it has conceded, with real vehicles \[s\].
const PAUSE_S: f64 = 3.0;

/// The order in which vehicles are asked, and how long those that are asked have not accepted.
#[derive(Clone, Debug, Default)]
pub(super) struct PartnerSelection {
    /// Names from the front of the road to its rear; fixed at the first step.
    order: Vec<String>,
    /// Vehicles that refused for too long and are no longer asked.
    refused: Vec<String>,
    /// Vehicles to which the ego has conceded once, with the plan from which on they may be asked again, by number.
    paused: Vec<(String, usize)>,
    asked: Vec<AskedVehicle>,
    fallback: FallbackPrice,
}

/// A vehicle that is asked, and the patience with it.
#[derive(Clone, Debug)]
struct AskedVehicle {
    name: String,
    patience: Patience,
}

impl PartnerSelection {
    /// The vehicles to ask now, from the front to the rear. Those in `passed`, ahead of which the ego gets anyway, are not asked
    /// unless they are being asked already.
    pub(super) fn choose<'a>(&mut self, scene: &'a Scene, settings: &Settings, passed: &[String]) -> Vec<&'a Agent> {
        if self.order.is_empty() {
            self.order = from_front_to_rear(scene);
        }
        let open = self
            .order
            .iter()
            .filter(|name| !self.refused.contains(name))
            .filter(|name| self.paused.iter().all(|(paused, until)| paused != *name || scene.tick >= *until))
            .filter_map(|name| scene.others.iter().find(|other| other.name == *name))
            .filter(|other| other.can_be_asked && (self.asks(&other.name) || !passed.contains(&other.name)))
            .filter(|other| !is_settled(scene, other, settings.clear_lead_m));
        let chosen: Vec<&Agent> = open.take(settings.partners_at_most).collect();
        let known = |name: &str| self.asked.iter().find(|asked| asked.name == name).map(|asked| asked.patience.clone());
        let asked = |name: &String| AskedVehicle { name: name.clone(), patience: known(name).unwrap_or_default() };
        self.asked = chosen.iter().map(|agent| asked(&agent.name)).collect();
        chosen
    }

    /// Whether a vehicle was asked last.
    fn asks(&self, name: &str) -> bool {
        self.asked.iter().any(|asked| asked.name == name)
    }

    /// Asks those that are asked no more. Among people, of whom only the motion is seen, it asks each of them once more after a pause.
    pub(super) fn concede(&mut self, scene: &Scene) {
        if scene.knowledge.is_of_motion() {
            // A second talk has a price of its own.
            self.fallback = FallbackPrice::default();
        }
        let until = scene.tick + (PAUSE_S * scene.ego.body.real_ratio().sqrt() / scene.step_s).round() as usize;
        for AskedVehicle { name, .. } in self.asked.drain(..) {
            let is_first = self.paused.iter().all(|(paused, _)| *paused != name);
            if scene.knowledge.is_of_motion() && is_first {
                self.paused.push((name, until));
            } else {
                self.refused.push(name);
            }
        }
    }

    /// Records the latest acceptances of those that are asked, in their order (`None` of one that has not answered yet), and what the
    /// fallback costs now. A vehicle that was asked long enough is not asked again.
    pub(super) fn record(
        &mut self,
        accepted: &[Option<f64>],
        fallback_cost: Option<f64>,
        settings: &Settings,
        answer_steps: usize,
    ) {
        let pairs = self.asked.iter_mut().zip(accepted);
        let had_time = pairs.map(|(asked, accepted)| accepted.is_some() && asked.patience.has_answered(answer_steps));
        let had_time: Vec<bool> = had_time.collect();
        let counts = answer_steps == 0 || had_time.contains(&true);
        let dearer = if counts { self.fallback.dearer(fallback_cost) } else { 0.0 };
        let answers = accepted.iter().zip(&had_time).map(|(accepted, had_time)| accepted.filter(|_| *had_time));
        for (asked, accepted) in self.asked.iter_mut().zip(answers) {
            if accepted.is_some_and(|accepted| asked.patience.ends(accepted, dearer, settings)) {
                self.refused.push(asked.name.clone());
            }
        }
    }
}

/// The names of the vehicles that a fallback passes ahead of, if it is safe.
pub(super) fn passed_by(scene: &Scene, fallback: &Result<Solved, PlanError>) -> Vec<String> {
    let Ok(Solved { optimum, .. }) = fallback else { return Vec::new() };
    if optimum.cost.violation(Violation::Safety) > MAX_VIOLATION {
        return Vec::new();
    }
    let plan = Plan { trajectory: optimum.trajectory(0), ..Plan::default() };
    let ahead = homotopy_class(scene, &plan).into_iter().filter(|passing| passing.side == PassingSide::Ahead);
    ahead.map(|order| order.of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use crate::scene::Knowledge;

    #[test]
    fn one_to_whom_the_ego_conceded_is_asked_once_more_after_a_pause() {
        let mut ahead = fixture::real_car(20.0, 20.0);
        ahead.state.y_m = 3.5;
        let mut scene = fixture::scene(fixture::real_car(0.0, 20.0), vec![ahead]);
        (scene.step_s, scene.knowledge) = (0.2, Knowledge::Motion { late_steps: 0 });
        scene.goal.target.y_m = 3.5;
        let settings = Settings { clear_lead_m: 30.0, ..Settings::default() };
        let mut selection = PartnerSelection::default();
        let asks_at = |scene: &Scene, selection: &mut PartnerSelection, tick: usize| {
            let scene = Scene { tick, ..scene.clone() };
            !selection.choose(&scene, &settings, &[]).is_empty()
        };
        assert!(asks_at(&scene, &mut selection, 0));
        selection.concede(&scene);
        let asked = [1, 14, 15].map(|tick| asks_at(&scene, &mut selection, tick));
        assert_eq!(asked, [false, false, true], "the pause takes 3 s");
        selection.concede(&scene);
        assert!(!asks_at(&scene, &mut selection, 100), "a third talk does not begin");
    }
}
