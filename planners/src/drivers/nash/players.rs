//! Who plays, and what the others are supposed to want.

use std::collections::BTreeMap;

use super::settings::Settings;
use crate::drivers::partner_choice::is_settled;
use crate::problem::JointVehicle;
use crate::{Agent, Goal, Scene, State};

/// The highest speed at which each vehicle was seen, by its name \[m/s\].
///
/// A vehicle that brakes for others wants to drive faster than it does, so its present speed says little.
#[derive(Clone, Debug, Default)]
pub(super) struct SeenSpeeds(BTreeMap<String, f64>);

impl SeenSpeeds {
    /// Looks at the speeds of all others.
    pub(super) fn look(&mut self, scene: &Scene) {
        for other in &scene.others {
            let highest = self.0.entry(other.name.clone()).or_default();
            *highest = highest.max(other.state.speed_mps);
        }
    }

    fn highest_mps(&self, agent: &Agent) -> f64 {
        self.0.get(&agent.name).copied().unwrap_or(agent.state.speed_mps)
    }
}

/// The ego, and the nearest others that play and with which something is left to settle, sorted by name.
pub(super) fn players(
    scene: &Scene,
    seen: &SeenSpeeds,
    settings: &Settings,
    plays: impl Fn(&str) -> bool,
) -> Vec<JointVehicle> {
    let distance_m = |other: &Agent| {
        let ([x, y], [ego_x, ego_y]) = (other.state.position(), scene.ego.state.position());
        libm::hypot(x - ego_x, y - ego_y)
    };
    let is_player =
        |other: &&Agent| other.can_be_asked && plays(&other.name) && !is_settled(scene, other, settings.clear_lead_m);
    let mut others: Vec<&Agent> = scene.others.iter().filter(is_player).collect();
    others.sort_by(|a, b| distance_m(a).total_cmp(&distance_m(b)));
    others.truncate(settings.players_at_most - 1);
    others.sort_by(|a, b| a.name.cmp(&b.name));
    let others = others.into_iter().map(|other| JointVehicle {
        agent: other.clone(),
        goal: supposed_goal(other, &scene.goal, seen.highest_mps(other), settings),
    });
    std::iter::once(JointVehicle { agent: scene.ego.clone(), goal: scene.goal }).chain(others).collect()
}

/// What a vehicle is supposed to want: the lateral position to which its predicted motion leads, on its road, and the highest speed
/// at which it was seen or is predicted, with the weights of the ego.
fn supposed_goal(agent: &Agent, own: &Goal, seen_mps: f64, settings: &Settings) -> Goal {
    let last = agent.prediction.states.last().unwrap_or(&agent.state);
    let at = agent.route.locate(last.position(), None);
    let [right_m, left_m] = agent.route.edges_before_end_m(at.along_m);
    let half_m = 0.5 * agent.body.width_m.min(left_m - right_m);
    let across_m = at.across_m.max(right_m + half_m).min(left_m - half_m);
    let [x_m, y_m] = agent.route.position(at.along_m, across_m);
    let target = State { x_m, y_m, heading_rad: at.heading_rad, speed_mps: seen_mps.max(last.speed_mps) };
    let share = 1.0 / settings.other_normaliser;
    let (tracking, comfort) = (own.tracking.map(|q| share * q), own.comfort.map(|r| share * r));
    Goal { target, tracking, comfort, ..*own }
}
