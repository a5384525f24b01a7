//! Laws of the loop that hold whatever the planners do.

use super::*;
use crate::Agent;
use crate::State;
use crate::fixture::{agent, scene};
use crate::plan::certificate::rolled_out;
use crate::prediction::{constant_velocity, steady};
use crate::{Input, Plan, PlanError, Scene, Trajectory};
use proptest::prelude::*;

const STEP_S: f64 = 0.1;
const HORIZON: usize = 5;

fn road_user(name: &str, x_m: f64, goes_first: bool) -> RoadUser {
    let agent = Agent { name: name.to_owned(), ..agent(x_m, 0.0, 0.0, 1.0) };
    let goal = scene(agent.clone(), Vec::new()).goal;
    RoadUser::new(agent, goal, goes_first)
}

fn traffic(road_users: Vec<RoadUser>) -> Traffic {
    Traffic { step_s: STEP_S, horizon: HORIZON, road_users, ..Traffic::default() }
}

/// A plan whose inputs are told apart by their number: 0.01, 0.02, … m/s².
fn numbered_plan(scene: &Scene) -> Plan {
    let input = |k: usize| Input { acceleration_mps2: 0.01 * (k + 1) as f64, steering_rad: 0.0 };
    Plan { trajectory: rolled_out(scene, (0..scene.horizon).map(input).collect()), ..Plan::default() }
}

fn failure() -> PlanError {
    PlanError::Infeasible("on purpose".to_owned())
}

/// Per name, what a vehicle is shown in a tick, and what it applies in the end; the others by name.
type Seen = Vec<(String, Vec<Agent>, Input)>;

/// Two ticks of planners that accelerate the more the more the others are expected to move.
fn seen(road_users: Vec<RoadUser>) -> Seen {
    let mut traffic = traffic(road_users);
    let mut seen = Seen::new();
    for _ in 0..2 {
        let mut scenes = vec![Vec::new(); traffic.road_users.len()];
        let decisions = traffic.drive(|vehicle, scene| {
            let mut others = scene.others.clone();
            others.sort_by(|a, b| a.name.cmp(&b.name));
            let moved_m: f64 =
                others.iter().filter_map(|other| Some(other.prediction.states.last()?.x_m - other.state.x_m)).sum();
            scenes[vehicle] = others;
            let limits = &scene.ego.limits;
            let inputs = steady(&scene.ego.state, 0.05 * moved_m, limits, scene.horizon, scene.step_s);
            Ok(Plan { trajectory: rolled_out(scene, inputs), ..Plan::default() })
        });
        assert_eq!(decisions.len(), traffic.road_users.len(), "each driver decides once");
        for (user, others) in traffic.road_users.iter().zip(scenes) {
            seen.push((user.agent.name.clone(), others, user.agent.previous_input));
        }
    }
    seen.sort_by(|a, b| a.0.cmp(&b.0));
    seen
}

proptest! {
    /// Those who go first plan from front to rear, before all the others, who follow as listed.
    #[test]
    fn planning_goes_from_front_to_rear_and_then_as_listed(
        users in prop::collection::vec((-5_i32..5, any::<bool>()), 1..8),
    ) {
        let users: Vec<RoadUser> =
            users.iter().map(|(x, goes_first)| road_user("", f64::from(*x), *goes_first)).collect();
        let traffic = traffic(users);
        let order = planning_order(&traffic.road_users);
        let mut indices = order.clone();
        indices.sort_unstable();
        prop_assert!(indices.into_iter().eq(0..traffic.road_users.len()));
        for pair in order.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|index| &traffic.road_users[index]);
            prop_assert!(a.goes_first || !b.goes_first);
            if a.goes_first && b.goes_first {
                prop_assert!((a.agent.state.x_m, pair[1]) >= (b.agent.state.x_m, pair[0]));
            } else if a.goes_first == b.goes_first {
                prop_assert!(pair[0] < pair[1]);
            }
        }
    }

    /// In whatever order the road users are listed, each is shown the same and does the same, bit for bit. (Two who go first from
    /// the same place are the exception, so places differ.)
    #[test]
    fn the_order_of_listing_has_no_influence(
        listing in Just((0..5).collect::<Vec<usize>>()).prop_shuffle(), first in prop::collection::vec(any::<bool>(), 5),
    ) {
        let user = |index: usize| road_user(&index.to_string(), 1.1 * index as f64, first[index]);
        let sorted = seen((0..5).map(user).collect());
        let listed = seen(listing.into_iter().map(user).collect());
        prop_assert!(sorted == listed);
    }
}

/// Each vehicle's prediction as the others are shown it, by the names of the observer and the observed.
fn shown(traffic: &mut Traffic) -> impl Fn(&str, &str) -> Trajectory + use<> {
    let mut shown = Vec::new();
    traffic.drive(|_, scene| {
        for other in &scene.others {
            shown.push((scene.ego.name.clone(), other.name.clone(), (*other.prediction).clone()));
        }
        Ok(numbered_plan(scene))
    });
    move |who, whom| {
        let found = shown.iter().find(|(a, b, _)| (a.as_str(), b.as_str()) == (who, whom));
        found.expect("each vehicle looks at all others").2.clone()
    }
}

#[test]
fn plans_of_drivers_that_go_first_are_known_at_once_and_others_a_tick_later() {
    let users = [("rear", 0.0, true), ("front", 2.0, true), ("one", 1.0, false), ("two", 3.0, false)];
    let mut traffic = traffic(users.map(|(name, x_m, goes_first)| road_user(name, x_m, goes_first)).into());
    let start = |index: usize| constant_velocity(&traffic.road_users[index].agent.state, HORIZON, STEP_S);
    let (rear_start, one_start) = (start(0), start(2));
    let first = shown(&mut traffic);
    let plans: Vec<Trajectory> =
        traffic.road_users.iter().map(|user| (**user.committed.trajectory.as_ref().expect("a plan")).clone()).collect();
    assert_eq!(first("rear", "front"), plans[1], "from front to rear");
    assert_eq!(first("front", "rear"), rear_start, "the rear one has not planned yet");
    assert_eq!(first("one", "rear"), plans[0]);
    assert_eq!(first("two", "one"), one_start, "no vehicle that plans later knows the other's new plan …");
    assert_eq!(first("one", "two").states[0], traffic_start(3.0));
    let second = shown(&mut traffic);
    assert_eq!(second("two", "one").inputs, plans[2].shifted().inputs, "… but its last one");
}

fn traffic_start(x_m: f64) -> State {
    road_user("", x_m, false).agent.state
}

/// With a plan of `N` inputs, `N − 1` are left to continue; then the vehicle brakes until its planner succeeds again.
#[test]
fn a_planner_that_fails_is_replaced_by_its_last_plan_and_then_by_braking() {
    use Origin::{Braking, Continued, Planned};
    let mut traffic = traffic(vec![road_user("ego", 0.0, false)]);
    let (mut origins, mut applied) = (Vec::new(), Vec::new());
    for at in 0..12 {
        let decisions =
            traffic.drive(|_, scene| if [0, 8].contains(&at) { Ok(numbered_plan(scene)) } else { Err(failure()) });
        assert_eq!(decisions[0].failure.is_some(), decisions[0].origin != Planned);
        origins.push(decisions[0].origin);
        applied.push(traffic.road_users[0].agent.previous_input.acceleration_mps2);
    }
    let expected = [
        [Planned, Continued, Continued, Continued],
        [Continued, Braking, Braking, Braking],
        [Planned, Continued, Continued, Continued],
    ];
    assert_eq!(origins, expected.concat());
    assert_eq!(applied[..5], [0.01, 0.02, 0.03, 0.04, 0.05], "the inputs of the plan, one after another");
    assert!(applied[5..8].iter().all(|braking| *braking < -0.5), "{applied:?}");
}

#[test]
fn without_any_plan_a_vehicle_brakes() {
    let mut traffic = traffic(vec![road_user("ego", 0.0, true)]);
    let decisions = traffic.drive(|_, _| Err(failure()));
    let limits = traffic.road_users[0].agent.limits;
    assert_eq!((decisions[0].origin, decisions[0].failure.clone()), (Origin::Braking, Some(failure())));
    assert_eq!(traffic.road_users[0].agent.previous_input.acceleration_mps2, limits.acceleration_min_mps2);
    assert_eq!(*traffic.road_users[0].agent.prediction, decisions[0].plan.trajectory, "published like any plan");
}

#[test]
fn a_crashed_vehicle_is_not_asked_and_brakes_until_it_stands() {
    let mut traffic = traffic(vec![road_user("ego", 0.0, false)]);
    traffic.drive(|_, scene| Ok(numbered_plan(scene)));
    traffic.road_users[0].is_crashed = true;
    for _ in 0..15 {
        let decisions = traffic.drive(|_, _| panic!("a crashed vehicle's planner is asked"));
        assert_eq!((decisions[0].origin, &decisions[0].failure), (Origin::Crashed, &None));
    }
    assert!(traffic.road_users[0].agent.state.speed_mps.abs() < 1e-12);
}

/// A plant may leave the plan: the prediction starts where the vehicle is and then follows the plan.
#[test]
fn a_prediction_starts_where_the_vehicle_is() {
    let mut traffic = traffic(vec![road_user("ego", 0.0, false)]);
    let decisions = traffic.drive(|_, scene| Ok(numbered_plan(scene)));
    traffic.road_users[0].agent.state.y_m += 0.3;
    traffic.predict();
    let RoadUser { agent, .. } = &traffic.road_users[0];
    let later = decisions[0].plan.trajectory.shifted();
    assert_eq!(agent.prediction.states[0], agent.state);
    assert_eq!(agent.prediction.states[1..], later.states[1..]);
    assert_eq!(agent.prediction.inputs, later.inputs);
}
