//! Laws of environments: a batch equals its worlds alone, events end episodes, invalid actions are refused.

use std::sync::Arc;

use interplay_scenarios::{Scenario, load};

use super::*;
use crate::Simulation;

fn scenario() -> Scenario {
    load("lane-change/front-nice", &[]).expect("authored")
}

fn environment(settings: &EnvironmentSettings) -> Environment {
    Environment::new(&scenario(), settings).expect("an environment")
}

fn seen(environment: &Environment) -> Vec<f32> {
    let mut out = vec![0.0; environment.observation_len()];
    environment.observe(0, &mut out).expect("an observation");
    out
}

/// A sequence of actions that depends only on the step.
fn action(step: usize) -> [f32; 2] {
    [((step * 7) % 5) as f32 / 4.0 - 0.4, ((step * 3) % 7) as f32 / 30.0 - 0.1]
}

#[test]
fn every_observation_stays_within_its_stated_bounds() {
    let observations = vec![
        AgentView::Kinematics(Kinematics::default()),
        AgentView::Lane(LaneView::default()),
        AgentView::OccupancyGrid(OccupancyGrid::default()),
        AgentView::Plan(PlanView::default()),
        AgentView::Belief(BeliefView::default()),
    ];
    let mut environment = environment(&EnvironmentSettings { observations, ..EnvironmentSettings::default() });
    environment.reset(Some(3)).expect("an episode");
    for step in 0..15 {
        let numbers = seen(&environment);
        let mut rest = numbers.as_slice();
        for space in environment.observation_spaces() {
            let (own, others) = rest.split_at(space.len());
            assert!(own.iter().all(|number| (space.low..=space.high).contains(number)), "{}", space.kind);
            assert!(own.iter().any(|number| *number != 0.0), "{}", space.kind);
            rest = others;
        }
        assert!(rest.is_empty());
        environment.step(&action(step)).expect("a step");
    }
}

#[test]
fn worlds_in_a_batch_behave_as_they_do_alone() {
    const WORLDS: usize = 5;
    let settings = EnvironmentSettings::default();
    let worlds = || (0..WORLDS).map(|_| environment(&settings)).collect::<Vec<_>>();
    let mut batch = EnvironmentBatch::new(worlds(), Autoreset::NextStep).expect("equal spaces");
    let seeds: Vec<Option<u64>> = (0..WORLDS as u64).map(Some).collect();
    batch.reset(&seeds, &[true; WORLDS]).expect("episodes");
    let mut alone = worlds();
    for (seed, environment) in alone.iter_mut().enumerate() {
        environment.reset(Some(seed as u64)).expect("an episode");
    }
    let length = alone[0].observation_len();
    let mut was_over = [false; WORLDS];
    for step in 0..150 {
        let mut steps = BatchSteps::new(WORLDS, length);
        let actions: Vec<f32> = (0..WORLDS).flat_map(|world| action(step + world)).collect();
        batch.step(&actions, &mut steps).expect("a step");
        for (world, environment) in alone.iter_mut().enumerate() {
            if was_over[world] {
                environment.reset(None).expect("the next episode");
                assert_eq!(steps.rewards[world], 0.0);
            } else {
                environment.step(&action(step + world)).expect("a step");
                assert_eq!(steps.rewards[world].to_bits(), environment.reward(0).to_bits());
            }
            assert_eq!(steps.observations[world * length..(world + 1) * length], seen(environment));
            was_over[world] = environment.episode(0).is_over();
            assert_eq!(was_over[world], steps.terminated[world] || steps.truncated[world]);
        }
    }
}

#[test]
fn events_end_an_episode() {
    let ending = |agent: &str, seed: u64, numbers: [f32; 2]| {
        let settings = EnvironmentSettings { agents: vec![agent.to_owned()], ..EnvironmentSettings::default() };
        let mut environment = environment(&settings);
        environment.reset(Some(seed)).expect("an episode");
        while environment.is_live() {
            environment.step(&numbers).expect("a step");
        }
        assert!(environment.step(&numbers).is_err(), "it is over");
        let episode = environment.episode(0);
        (episode.ending, episode.is_terminated())
    };
    assert_eq!(ending("ego", 1, [0.0, -0.5]), (Some(Ending::OffRoad), true));
    assert_eq!(ending("ego", 1, [-1.0, 0.0]), (Some(Ending::Time), false));
    assert_eq!(ending("rear", 1, [1.0, 0.0]).0, Some(Ending::Contact));
}

#[test]
fn a_planner_reaches_the_goal_through_the_agent_interface() {
    let scenario = scenario();
    for action in [Action::Continuous, Action::Plan, Action::DiscreteMeta] {
        let mut environment = environment(&EnvironmentSettings { action, ..EnvironmentSettings::default() });
        environment.reset_as_written(scenario.seed).expect("an episode");
        let mut planner = environment.planner(0, &*scenario.vehicles[0].driver);
        while environment.is_live() {
            let numbers = environment.action_of(0, &mut planner).expect("an action");
            environment.step(&numbers).expect("a step");
        }
        assert_eq!(environment.episode(0).ending, Some(Ending::Goal), "{action:?}");
    }
}

/// A building beside the road has its own steps, which are not ticks of the vehicles.
#[test]
fn steps_of_a_building_are_not_counted_as_decisions() {
    let mixed = interplay_scenarios::embedded().iter().find(|file| file.name.starts_with("mixed/")).expect("one");
    let scenario = load(mixed.name, &[]).expect("authored");
    let mut environment = Environment::new(&scenario, &EnvironmentSettings::default()).expect("an environment");
    environment.reset(Some(1)).expect("an episode");
    for step in 1..=8 {
        environment.step(&[0.0, 0.0]).expect("a step");
        assert!((environment.time_s() - f64::from(step) * environment.decision_s()).abs() < 1e-9);
    }
}

#[test]
fn an_invalid_action_is_refused_and_changes_nothing() {
    let mut environment = environment(&EnvironmentSettings::default());
    assert!(environment.step(&[0.0, 0.0]).is_err(), "an episode has not begun");
    environment.reset(Some(1)).expect("an episode");
    let before = seen(&environment);
    for numbers in [&[f32::NAN, 0.0][..], &[0.0, f32::INFINITY], &[0.0], &[0.0; 3], &[]] {
        assert!(environment.step(numbers).is_err(), "{numbers:?}");
    }
    assert_eq!(seen(&environment), before);
    let settings = EnvironmentSettings { agents: vec!["missing".to_owned()], ..EnvironmentSettings::default() };
    let error = Environment::new(&scenario(), &settings).err().map(|error| error.to_string());
    assert!(error.is_some_and(|text| text.contains("choose from ego, front, rear")));
}

struct Steady;

impl Policy for Steady {
    fn act(&self, observation: &[f32]) -> Result<Vec<f32>, PolicyError> {
        assert_eq!(observation[0], 1.0, "the agent is present");
        Ok(vec![0.1, 0.0])
    }
}

/// A policy that drives in a run gives the same motion as its actions from outside.
#[test]
fn a_policy_in_a_run_drives_as_its_actions_from_outside_do() {
    let scenario = scenario();
    let settings = EnvironmentSettings::default();
    let mut environment = environment(&settings);
    environment.reset_as_written(scenario.seed).expect("an episode");
    let mut run = Simulation::new(&scenario).expect("a world");
    let interface = AgentInterface::new(&settings.observations, settings.action, scenario.horizon_steps);
    run.drive_with("ego", PolicyDriver::new(Arc::new(Steady), interface, 1)).expect("an ego");
    for _ in 0..20 {
        environment.step(&[0.1, 0.0]).expect("a step");
        run.step().expect("a step");
        let ego = |world: &Simulation| world.frame().expect("a frame").vehicles[0].state;
        assert_eq!(ego(&run), ego(environment.world().expect("an episode")));
    }
}
