//! Which vehicle the ego negotiates with.
//!
//! The source asks the front vehicle first and the rear one when the acceptance probability has not risen by more than
//! `ε` five times in a row (section 6.5). That also happens at steady acceptance, so a low probability is required too. A
//! vehicle with which nothing is left to negotiate is skipped: one that drives ahead in the ego's target lane, or that has
//! crossed, or that the ego has crossed before. A driver who takes notice of nobody outside its own lane is never asked:
//! the ego keeps out of its predicted way.

use super::settings::Settings;
use crate::encounter::{from_front_to_rear, is_settled};
use crate::{Agent, Scene};

/// An acceptance below this counts as a refusal.
const REFUSAL_ACCEPTANCE: f64 = 0.5;

/// The order in which vehicles are asked, and how long the present one has not accepted.
#[derive(Clone, Debug, Default)]
pub(super) struct PartnerSelection {
    /// Names from the front of the road to its rear; fixed at the first step.
    order: Vec<String>,
    /// Vehicles that refused for too long and are no longer asked.
    refused: Vec<String>,
    current: Option<String>,
    last_acceptance: Option<f64>,
    steps_without_progress: usize,
}

impl PartnerSelection {
    pub(super) fn current(&self) -> Option<&str> {
        self.current.as_deref()
    }

    /// The vehicle to ask now, if any.
    pub(super) fn choose<'a>(&mut self, scene: &'a Scene, settings: &Settings) -> Option<&'a Agent> {
        if self.order.is_empty() {
            self.order = from_front_to_rear(scene);
        }
        let open: Vec<&Agent> = self
            .order
            .iter()
            .filter_map(|name| scene.others.iter().find(|other| other.name == *name))
            .filter(|other| other.can_be_asked && !is_settled(scene, other, settings.clear_lead_m))
            .collect();
        // The last one is asked however often it refuses.
        let chosen = open.iter().find(|other| !self.refused.contains(&other.name)).or(open.last()).copied();
        let name = chosen.map(|other| other.name.clone());
        if name != self.current {
            self.current = name;
            self.last_acceptance = None;
            self.steps_without_progress = 0;
        }
        chosen
    }

    /// Records the latest acceptance. After too many steps without progress the present vehicle is not asked again.
    pub(super) fn record(&mut self, accepted: f64, settings: &Settings) {
        let no_progress = accepted < REFUSAL_ACCEPTANCE
            && self.last_acceptance.is_some_and(|last| accepted - last <= settings.epsilon);
        self.steps_without_progress = if no_progress { self.steps_without_progress + 1 } else { 0 };
        self.last_acceptance = Some(accepted);
        if self.steps_without_progress >= settings.patience_steps {
            self.refused.extend(self.current.clone().filter(|name| !self.refused.contains(name)));
        }
    }
}
