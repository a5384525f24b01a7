//! The joint trajectory problem of the cooperating vehicles (eq. 6.6-6.12).

use crate::scene::ellipses;
use crate::trajectory::terms::{KeepOut, Separation};
use crate::trajectory::{Penalty, Problem, Term};
use crate::{Agent, Goal, Scene};

/// A vehicle of the joint problem, with its goal. The weights `Q` and `R` of the goal are divided by its normaliser `Z_i`.
#[derive(Clone, Debug, PartialEq)]
pub struct Cooperator {
    /// The vehicle.
    pub agent: Agent,
    /// Its goal.
    pub goal: Goal,
}

/// All vehicles of the joint problem, sorted by name. Each of them computes a bit-identical list.
pub fn cooperators(scene: &Scene, own: Goal) -> Vec<Cooperator> {
    let others = scene.others.iter().filter_map(|agent| Some((agent, agent.shared_goal?)));
    let everybody = others.chain([(&scene.ego, own)]);
    let mut found: Vec<Cooperator> = everybody.map(|(agent, goal)| Cooperator { agent: agent.clone(), goal }).collect();
    found.sort_by(|a, b| a.agent.name.cmp(&b.agent.name));
    found
}

/// The joint problem: the inputs of all cooperators are decision variables. The safety ellipses around the predictions of all
/// other vehicles are soft constraints with an exact penalty, as for the conservative planner. (The source has two vehicles
/// and no others.)
///
/// A pair has two separation constraints, one for the ellipse of each vehicle. If both ellipses have the same size and
/// direction, the two constraints are equal, and only one is kept.
pub fn problem(scene: &Scene, cooperators: &[Cooperator]) -> Problem {
    let mut strangers: Vec<&Agent> = scene.others.iter().filter(|agent| agent.shared_goal.is_none()).collect();
    strangers.sort_by(|a, b| a.name.cmp(&b.name));
    let (mut participants, mut terms) = (Vec::new(), Vec::new());
    for (vehicle, Cooperator { agent, goal }) in cooperators.iter().enumerate() {
        let view = Scene { ego: agent.clone(), goal: *goal, others: Vec::new(), ..*scene };
        participants.push(view.participant());
        terms.extend(view.own_terms(vehicle, goal));
        terms.extend(strangers.iter().map(|other| {
            let keep_out = view.keep_out(&other.prediction, &other.route, Penalty::EXACT);
            Term::KeepOut(KeepOut { vehicle, ..keep_out })
        }));
    }
    for i in 0..cooperators.len() {
        for j in 0..i {
            let ([first, second], mutual) = ([j, i], is_mutual(&cooperators[i], &cooperators[j]));
            terms.push(separation(scene, cooperators, first, second));
            if !mutual {
                terms.push(separation(scene, cooperators, second, first));
            }
        }
    }
    Problem { horizon: scene.horizon, participants, terms }
}

/// Whether the safety ellipses of two vehicles are equal.
fn is_mutual(a: &Cooperator, b: &Cooperator) -> bool {
    a.goal.safety == b.goal.safety && a.agent.route == b.agent.route
}

fn separation(scene: &Scene, cooperators: &[Cooperator], vehicle: usize, from: usize) -> Term {
    let Agent { route, prediction, .. } = &cooperators[from].agent;
    let ellipses = ellipses(cooperators[vehicle].goal.safety, route, &scene.centres(prediction));
    Term::Separation(Separation { vehicle, from, ellipses, penalty: Penalty::EXACT })
}
