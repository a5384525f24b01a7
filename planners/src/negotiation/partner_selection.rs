//! Whom to ask.
//!
//! The source asks the front vehicle first and the rear one when the acceptance probability has not risen by more than
//! `ε` five times in a row (section 6.5). That also happens at steady acceptance, so a low probability is required too. A
//! vehicle with which nothing is left to negotiate is skipped: one that drives ahead in the ego's target lane, or that has
//! crossed, or that the ego has crossed before.

use super::Settings;
use crate::encounter::is_settled;
use crate::{Agent, Scene};

/// An acceptance below this counts as a refusal.
const REFUSAL: f64 = 0.5;

/// The order of asking, and how patient the ego still is.
#[derive(Clone, Debug, Default)]
pub(super) struct Interlocutor {
    /// Names from the front of the road to its rear; fixed at the first step.
    order: Vec<String>,
    /// Who was refused by, and is no longer asked.
    refused: Vec<String>,
    current: Option<String>,
    last_acceptance: Option<f64>,
    fruitless_steps: usize,
}

impl Interlocutor {
    pub(super) fn current(&self) -> Option<&str> {
        self.current.as_deref()
    }

    /// The vehicle to ask now, if any.
    pub(super) fn choose<'a>(&mut self, scene: &'a Scene, settings: &Settings) -> Option<&'a Agent> {
        if self.order.is_empty() {
            let mut others: Vec<&Agent> = scene.others.iter().collect();
            others.sort_by(|a, b| scene.ego.lead_of(b).total_cmp(&scene.ego.lead_of(a)));
            self.order = others.iter().map(|other| other.name.clone()).collect();
        }
        let open: Vec<&Agent> = self
            .order
            .iter()
            .filter_map(|name| scene.others.iter().find(|other| other.name == *name))
            .filter(|other| !is_settled(scene, other, settings.clear_lead_m))
            .collect();
        // The last one is asked however often it refuses.
        let chosen = open.iter().find(|other| !self.refused.contains(&other.name)).or(open.last()).copied();
        let name = chosen.map(|other| other.name.clone());
        if name != self.current {
            self.current = name;
            self.last_acceptance = None;
            self.fruitless_steps = 0;
        }
        chosen
    }

    /// Takes note of the latest acceptance; after too many fruitless steps the present vehicle is not asked again.
    pub(super) fn note(&mut self, accepted: f64, settings: &Settings) {
        let fruitless =
            accepted < REFUSAL && self.last_acceptance.is_some_and(|last| accepted - last <= settings.epsilon);
        self.fruitless_steps = if fruitless { self.fruitless_steps + 1 } else { 0 };
        self.last_acceptance = Some(accepted);
        if self.fruitless_steps >= settings.patience_steps {
            self.refused.extend(self.current.clone().filter(|name| !self.refused.contains(name)));
        }
    }
}
