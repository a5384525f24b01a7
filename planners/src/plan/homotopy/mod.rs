//! The homotopy class of a plan: on which side of each other vehicle it leads.
//!
//! Two plans are in one class if one can be deformed into the other without driving through a vehicle (Bender et al., "The
//! combinatorial aspect of motion planning: maneuver variants in structured environments", 2015).
//!
//! It is read off the plan and the predictions in plain geometry, so any plan has one, whichever planner made it.
//!
//! - **Roads that cross**: the plan goes *ahead* of the other if it reaches the other's path before the other reaches its
//!   own, and *behind* it otherwise. While neither gets there within the plan this is open and not reported, and once one of
//!   them is past the other's path it is settled and no longer reported.
//! - **Roads side by side**: the sector around the other's predicted centre in which the plan ends, between the diagonals of
//!   the safety ellipse's box: ahead, left, behind or right, as the other faces.
//!
//! The other's motion is its prediction; of a vehicle that the plan asks for something it is the proposed motion, which the
//! plan relies on. Vehicles that the plan stays far from (`RELEVANT_HALF_AXES`) have no part in the class.

mod log;

use crate::plan::planned_passing::{PassingSide, PlannedPassing};
pub(crate) use log::HomotopyLog;

use crate::problem::clearance::ellipses;
use crate::road::network::RouteConflict;
use crate::scene::relation::{PARALLEL_RAD, Relation};
use crate::{Agent, Axes, Plan, Scene, State};

/// A vehicle is relevant if the plan comes nearer to it than this many half axes of the safety ellipse.
const RELEVANT_HALF_AXES: f64 = 3.0;

/// How a plan passes each relevant vehicle, in the scene's order; obstacles, which have no driver, are left out.
pub fn homotopy_class(scene: &Scene, plan: &Plan) -> Vec<PlannedPassing> {
    let passing = |other: &Agent| {
        let proposal = plan.proposals.iter().find(|proposal| proposal.to == other.name);
        let theirs = proposal.map_or(&*other.prediction, |proposal| &proposal.trajectory);
        let side = side(scene, other, &plan.trajectory.states, &theirs.states)?;
        Some(PlannedPassing { of: other.name.clone(), side })
    };
    scene.others.iter().filter(|other| !other.is_obstacle).filter_map(passing).collect()
}

/// On which side of a vehicle in motion the states of a plan lead; both begin at the present step.
fn side(scene: &Scene, other: &Agent, own: &[State], theirs: &[State]) -> Option<PassingSide> {
    let centres: Vec<[f64; 2]> = theirs.iter().map(State::position).collect();
    let ellipses = ellipses(scene.goal.safety, &other.route, &centres);
    let places = own.iter().zip(&centres).zip(&ellipses);
    let squared = places.map(|((own, centre), ellipse)| ellipse.distance(own.position(), *centre).squared);
    let nearest = squared.fold(f64::INFINITY, f64::min);
    if nearest > RELEVANT_HALF_AXES * RELEVANT_HALF_AXES {
        return None;
    }
    match scene.ego.relation(other) {
        Relation::Conflict(conflict) => return side_at_conflict(scene, other, conflict, own, theirs),
        Relation::Apart => return None,
        Relation::Alongside | Relation::CrossingRoads => {}
    }
    if let Some(crossing) = Crossing::find(&scene.ego, other) {
        return crossing.side(own, theirs);
    }
    let steps = own.len().min(theirs.len());
    let ([x, y], [other_x, other_y]) = (own[..steps].last()?.position(), theirs[..steps].last()?.position());
    let heading_rad = other.route.heading_at([other_x, other_y]);
    let [along, across] = Axes::along(heading_rad).components([x - other_x, y - other_y]);
    let safety = scene.goal.safety;
    Some(sector([along / safety.along_m, across / safety.across_m]))
}

/// Two roads that cross.
struct Crossing {
    own: Axes,
    their: Axes,
    /// Sine of the angle from the other's road to the own one.
    sin: f64,
}

impl Crossing {
    /// The crossing of the roads of two vehicles; none where they run side by side.
    fn find(ego: &Agent, other: &Agent) -> Option<Crossing> {
        let [own, their] = [ego, other].map(|agent| agent.route.heading_at(other.state.position()));
        let sin = libm::sin(own - their);
        (sin.abs() > libm::sin(PARALLEL_RAD)).then(|| Crossing {
            own: Axes::along(own),
            their: Axes::along(their),
            sin,
        })
    }

    /// Who of two motions comes first, while that is open.
    fn side(&self, own: &[State], theirs: &[State]) -> Option<PassingSide> {
        let relative = |(own, their): (&State, &State)| {
            let ([x, y], [other_x, other_y]) = (own.position(), their.position());
            [x - other_x, y - other_y]
        };
        let pairs = || own.iter().zip(theirs).map(relative);
        let own_way_m = pairs().map(|relative| -self.their.components(relative)[1] / self.sin);
        let their_way_m = pairs().map(|relative| -self.own.components(relative)[1] / self.sin);
        first_to_arrive(arrival(own_way_m), arrival(their_way_m))
    }
}

/// Who of two motions comes first to where the routes meet, while that is open.
fn side_at_conflict(
    scene: &Scene,
    other: &Agent,
    conflict: &RouteConflict,
    own: &[State],
    theirs: &[State],
) -> Option<PassingSide> {
    let own_way_m = own.iter().map(|state| conflict.own_meeting_m - scene.ego.route.along(state.position()));
    let their_way_m = theirs.iter().map(|state| conflict.their_meeting_m - other.route.along(state.position()));
    first_to_arrive(arrival(own_way_m), arrival(their_way_m))
}

/// The order of two arrivals, while it is open.
fn first_to_arrive(own: Arrival, their: Arrival) -> Option<PassingSide> {
    match (own, their) {
        (Arrival::Past, _) | (_, Arrival::Past) | (Arrival::Never, Arrival::Never) => None,
        (Arrival::After(own), Arrival::After(their)) if own > their => Some(PassingSide::Behind),
        (Arrival::Never, Arrival::After(_)) => Some(PassingSide::Behind),
        (Arrival::After(_), _) => Some(PassingSide::Ahead),
    }
}

/// When a way has been covered.
enum Arrival {
    /// Before the beginning.
    Past,
    /// After this many steps.
    After(f64),
    /// Not within the plan.
    Never,
}

/// When the remaining way \[m\], at steps 0, 1 and so on, reaches zero; between two steps it falls linearly.
fn arrival(remaining_m: impl Iterator<Item = f64>) -> Arrival {
    let mut before_m: Option<f64> = None;
    for (step, now_m) in remaining_m.enumerate() {
        match before_m {
            None if now_m <= 0.0 => return Arrival::Past,
            Some(before_m) if now_m <= 0.0 => {
                return Arrival::After(step as f64 - 1.0 + before_m / (before_m - now_m));
            }
            _ => before_m = Some(now_m),
        }
    }
    Arrival::Never
}

/// The sector of a position in half axes.
fn sector([along, across]: [f64; 2]) -> PassingSide {
    if along >= across.abs() {
        PassingSide::Ahead
    } else if -along >= across.abs() {
        PassingSide::Behind
    } else if across > 0.0 {
        PassingSide::Left
    } else {
        PassingSide::Right
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{agent, crossing, scene};
    use crate::prediction::constant_velocity;
    use crate::{Proposal, Trajectory};

    /// A plan at constant velocity of an ego at `x_m`, `y_m`.
    fn steady(scene: &Scene, speed_mps: f64) -> Plan {
        let state = State { speed_mps, ..scene.ego.state };
        Plan { trajectory: constant_velocity(&state, scene.horizon, scene.step_s), ..Plan::default() }
    }

    fn words(scene: &Scene, plan: &Plan) -> Vec<String> {
        homotopy_class(scene, plan).iter().map(PlannedPassing::sentence).collect()
    }

    fn named(name: &str, agent: Agent) -> Agent {
        Agent { name: name.to_owned(), ..agent }
    }

    #[test]
    fn beside_one_another_the_end_of_the_plan_counts() {
        let others =
            [("front", 1.0, 0.0), ("rear", -1.0, 0.0), ("left", 0.1, 0.4), ("right", -0.1, -0.4), ("far", 9.0, 0.0)];
        let others = others.map(|(name, x_m, y_m)| named(name, agent(x_m, y_m, 0.0, 1.0)));
        let scene = scene(agent(0.0, 0.0, 0.0, 1.0), others.to_vec());
        let expected = ["stays behind front", "goes ahead of rear", "drives right of left", "drives left of right"];
        assert_eq!(words(&scene, &steady(&scene, 1.0)), expected);
        assert_eq!(words(&scene, &steady(&scene, 1.9))[0], "goes ahead of front", "it overtakes");
    }

    /// Who reaches the other's path first goes ahead, wherever the plan ends relative to the other.
    #[test]
    fn where_roads_cross_the_first_to_arrive_goes_ahead() {
        let ego = agent(-1.0, 0.185, 0.0, 1.0);
        let scene = scene(ego, vec![named("crossing", crossing(0.0, -1.0, 1.0))]);
        assert_eq!(words(&scene, &steady(&scene, 1.0)), ["goes ahead of crossing"]);
        assert_eq!(words(&scene, &steady(&scene, 0.8)), ["stays behind crossing"]);
        assert_eq!(words(&scene, &steady(&scene, 0.0)), ["stays behind crossing"], "it waits");
    }

    #[test]
    fn an_order_at_a_crossing_is_reported_while_it_is_open() {
        let meet = |ego_x_m: f64, other_y_m: f64, speed_mps: f64| {
            let other = named("crossing", crossing(0.0, other_y_m, speed_mps));
            let scene = scene(agent(ego_x_m, 0.0, 0.0, speed_mps), vec![other]);
            words(&scene, &steady(&scene, speed_mps))
        };
        assert!(meet(0.1, -0.5, 1.0).is_empty(), "the ego is across");
        assert!(meet(-0.5, 0.1, 1.0).is_empty(), "the other is across");
        assert!(meet(-1.0, -1.0, 0.0).is_empty(), "both stand");
        assert_eq!(meet(-0.5, -0.6, 1.0), ["goes ahead of crossing"]);
    }

    /// A plan that relies on the motion it asks for is judged by that motion.
    #[test]
    fn an_asked_vehicle_is_expected_to_follow_the_proposal() {
        let other = named("crossing", crossing(0.0, -0.8, 1.0));
        let scene = scene(agent(-1.0, 0.0, 0.0, 1.0), vec![other.clone()]);
        let mut plan = steady(&scene, 1.0);
        assert_eq!(words(&scene, &plan), ["stays behind crossing"]);
        let waits = constant_velocity(&State { speed_mps: 0.1, ..other.state }, 30, 0.1);
        plan.proposals = vec![Proposal { to: "crossing".to_owned(), trajectory: waits, acceptance: None }];
        assert_eq!(words(&scene, &plan), ["goes ahead of crossing"]);
        assert!(words(&scene, &Plan { trajectory: Trajectory::default(), ..plan }).is_empty());
    }
}
