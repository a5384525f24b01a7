//! Which vehicles the ego negotiates with.
//!
//! The source asks the front vehicle first and the rear one when the acceptance probability has not risen by more than
//! `ε` five times in a row (section 6.5). That also happens at steady acceptance, so a low probability is required too. A
//! vehicle with which nothing is left to negotiate is skipped: one that drives ahead in the ego's target lane, or that has
//! crossed, or that the ego has crossed before. With one that a safe retreat passes ahead of no negotiation is begun: it need not be
//! asked for what the ego can have without its consent, and waiting for its answer could cost the way. A driver who takes notice of nobody outside its own lane is never asked:
//! the ego keeps out of its predicted way. With `partners_at_most` above 1 the next ones in this order are asked at the same time.

use super::settings::Settings;
use crate::encounter::{from_front_to_rear, is_settled};
use crate::{Agent, Scene};

/// An acceptance below this counts as a refusal.
const REFUSAL_ACCEPTANCE: f64 = 0.5;

/// The order in which vehicles are asked, and how long those that are asked have not accepted.
#[derive(Clone, Debug, Default)]
pub(super) struct PartnerSelection {
    /// Names from the front of the road to its rear; fixed at the first step.
    order: Vec<String>,
    /// Vehicles that refused for too long and are no longer asked.
    refused: Vec<String>,
    asked: Vec<AskedVehicle>,
}

/// How a vehicle that is asked has answered so far.
#[derive(Clone, Debug, Default)]
struct AskedVehicle {
    name: String,
    last_acceptance: Option<f64>,
    steps_without_progress: usize,
}

impl PartnerSelection {
    /// The vehicles to ask now, from the front to the rear. Those in `passed`, ahead of which the ego gets anyway, are not asked
    /// unless they are being asked already.
    pub(super) fn choose<'a>(&mut self, scene: &'a Scene, settings: &Settings, passed: &[String]) -> Vec<&'a Agent> {
        if self.order.is_empty() {
            self.order = from_front_to_rear(scene);
        }
        let open: Vec<&Agent> = self
            .order
            .iter()
            .filter_map(|name| scene.others.iter().find(|other| other.name == *name))
            .filter(|other| other.can_be_asked && (self.asks(&other.name) || !passed.contains(&other.name)))
            .filter(|other| !is_settled(scene, other, settings.clear_lead_m))
            .collect();
        let willing = open.iter().filter(|other| !self.refused.contains(&other.name)).copied();
        let mut chosen: Vec<&Agent> = willing.take(settings.partners_at_most).collect();
        if chosen.is_empty() {
            // The last one is asked however often it refuses.
            chosen.extend(open.last());
        }
        let known = |agent: &&Agent| self.asked.iter().find(|asked| asked.name == agent.name).cloned();
        let asked = |agent| known(agent).unwrap_or(AskedVehicle { name: agent.name.clone(), ..Default::default() });
        self.asked = chosen.iter().map(asked).collect();
        chosen
    }

    /// Whether a vehicle was asked last.
    fn asks(&self, name: &str) -> bool {
        self.asked.iter().any(|asked| asked.name == name)
    }

    /// Records the latest acceptance of a vehicle. After too many steps without progress it is not asked again.
    pub(super) fn record(&mut self, name: &str, accepted: f64, settings: &Settings) {
        let Some(asked) = self.asked.iter_mut().find(|asked| asked.name == name) else { return };
        let no_progress = accepted < REFUSAL_ACCEPTANCE
            && asked.last_acceptance.is_some_and(|last| accepted - last <= settings.epsilon);
        asked.steps_without_progress = if no_progress { asked.steps_without_progress + 1 } else { 0 };
        asked.last_acceptance = Some(accepted);
        if asked.steps_without_progress >= settings.patience_steps && !self.refused.contains(&asked.name) {
            self.refused.push(asked.name.clone());
        }
    }
}
