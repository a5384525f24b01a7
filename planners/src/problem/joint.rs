//! The trajectory problem of several deciding vehicles, each with its own goal (eq. 6.6-6.12).

use crate::trajectory::terms::KeepOut;
use crate::trajectory::{Penalty, Problem, Term};
use crate::{Agent, Goal, Scene};

/// A vehicle that decides in a joint problem, with its goal.
#[derive(Clone, Debug, PartialEq)]
pub struct JointVehicle {
    /// The deciding vehicle.
    pub agent: Agent,
    /// The vehicle's goal, with weights `Q` and `R` that are divided by its normaliser `Z_i`.
    pub goal: Goal,
}

/// The joint problem: the inputs of all `vehicles` are decision variables, and its cost is the sum of theirs. The safety ellipses
/// around the predictions of all others are soft constraints with an exact penalty, as for the conservative planner. (The
/// source has two vehicles and no others.)
///
/// A pair has two separation constraints, one for the ellipse of each vehicle. If both ellipses have the same size and
/// direction, the two constraints are equal, and only one is kept.
pub fn joint_problem(scene: &Scene, vehicles: &[JointVehicle]) -> Problem {
    let decides = |agent: &&Agent| vehicles.iter().any(|vehicle| vehicle.agent.name == agent.name);
    let mut strangers: Vec<&Agent> = scene.others.iter().filter(|agent| !decides(agent)).collect();
    strangers.sort_by(|a, b| a.name.cmp(&b.name));
    let (mut participants, mut terms) = (Vec::new(), Vec::new());
    for (vehicle, JointVehicle { agent, goal }) in vehicles.iter().enumerate() {
        let view = Scene { ego: agent.clone(), goal: *goal, others: Vec::new(), ..*scene };
        participants.push(view.participant());
        terms.extend(view.own_terms(vehicle, goal));
        terms.extend(strangers.iter().filter(|other| view.minds(other)).map(|other| {
            let keep_out = view.safety_around(other, Penalty::EXACT);
            Term::KeepOut(KeepOut { vehicle, ..keep_out })
        }));
    }
    for i in 0..vehicles.len() {
        for j in 0..i {
            let ([first, second], mutual) = ([j, i], is_mutual(&vehicles[i], &vehicles[j]));
            let separation = |vehicle: usize, from: usize| {
                scene.separation(vehicles[vehicle].goal.safety, vehicle, from, &vehicles[from].agent)
            };
            terms.push(separation(first, second));
            if !mutual {
                terms.push(separation(second, first));
            }
        }
    }
    Problem { horizon: scene.horizon, participants, shared_steps: 0, terms }
}

/// Whether the safety ellipses of two vehicles are equal.
fn is_mutual(a: &JointVehicle, b: &JointVehicle) -> bool {
    a.goal.safety == b.goal.safety && a.agent.route == b.agent.route
}
