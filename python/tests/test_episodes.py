"""One world: seeds, endings, options, and actions that are none."""

from __future__ import annotations

import json
from typing import Any

import gymnasium
import numpy as np
import pytest

import interplay
from helpers import ACTIONS, OBSERVATIONS, episode, equal, gentle_actions, refused
from interplay.envs import InterplayEnv


@pytest.mark.parametrize("action", ACTIONS)
@pytest.mark.parametrize("scenario", ["lane-change/front-nice", "intersection/four-way", "people/lane-keeping", "mixed/garage"])
def test_the_same_seed_and_actions_give_the_same_numbers(scenario: str, action: str) -> None:
    one, other = (InterplayEnv(scenario, observation=OBSERVATIONS, action=action) for _ in range(2))
    actions = gentle_actions(one, 25)
    other.reset(seed=99)
    assert equal(episode(one, 3, actions), episode(other, 3, actions))
    # The next episode of the sequence is another one, and the same in both.
    second = episode(one, None, actions)
    assert equal(second, episode(other, None, actions))
    assert not equal(second[0], episode(one, 3, [])[0])


def test_other_seeds_give_other_episodes() -> None:
    env = InterplayEnv()
    starts = [env.reset(seed=seed)[0].tobytes() for seed in range(8)]
    assert len(set(starts)) == 8


def test_environments_without_a_seed_differ() -> None:
    assert not equal(InterplayEnv().reset()[0], InterplayEnv().reset()[0])


def test_nothing_is_drawn_without_perturb() -> None:
    env = InterplayEnv(perturb=False)
    assert equal(env.reset(seed=1)[0], env.reset(seed=2)[0])


def test_an_observation_stays_as_it_was() -> None:
    env = InterplayEnv()
    seen, _ = env.reset(seed=1)
    before = seen.copy()
    env.step([0.5, 0.0])
    assert equal(seen, before)


def test_the_seed_of_a_scenario_is_the_scenario_as_it_is_written() -> None:
    env = InterplayEnv(observation="Kinematics")
    first, _ = env.reset(options={"seed": 7})
    again, _ = env.reset(options={"seed": 7})
    assert equal(first, again)
    world = interplay.Simulation("lane-change/front-nice", seed=7)
    ego = env.states()["ego"]
    assert np.array_equal(ego, world.observe("ego")["state"][0])


def test_a_task_that_is_done_terminates_and_the_end_of_time_truncates() -> None:
    env = InterplayEnv(perturb=False)
    planner = interplay.policy("negotiation").bind(env)
    env.reset(seed=1)
    for _ in range(200):
        _, _, terminated, truncated, info = env.step(planner.act())
        if terminated or truncated:
            break
    assert (terminated, truncated, info["ending"], info["is_success"]) == (True, False, "goal", True)
    short = InterplayEnv(set={"duration_s": 4.0}, perturb=False)
    *_, last = episode(short, 1, [[-0.2, 0.0]] * 50)
    assert last[2:] == (False, True)
    _, info = short.reset(seed=1)
    assert "ending" not in info
    assert refused(lambda: InterplayEnv().step([0.0, 0.0]), interplay.RunError)


def test_who_leaves_the_road_terminates() -> None:
    env = InterplayEnv()
    env.reset(seed=1)
    for _ in range(100):
        _, _, terminated, truncated, info = env.step([1.0, -1.0])
        if terminated:
            break
    assert (terminated, truncated, info["ending"], info["is_success"]) == (True, False, "off_road", False)
    assert "over" in refused(lambda: env.step([0.0, 0.0]), interplay.RunError)


def test_the_reward_is_the_sum_of_its_weighted_terms() -> None:
    plain = InterplayEnv()
    names = plain.reset(seed=1)[1]["reward_terms"].keys()
    env = InterplayEnv(reward={name: float(name == "progress") for name in names})
    env.reset(seed=1)
    _, reward, _, _, info = env.step([0.5, 0.0])
    assert reward == pytest.approx(info["reward_terms"]["progress"])
    assert info["reward_terms"].keys() == names


def test_info_says_nothing_of_the_clock_on_the_wall() -> None:
    def infos() -> list[Any]:
        env = InterplayEnv()
        found = [env.reset(seed=1)[1]]
        return found + [env.step([0.1, 0.0])[4] for _ in range(10)]

    one, other = json.dumps(infos()), json.dumps(infos())
    assert one == other
    assert "wall" not in one


def test_options_may_change_the_scenario_but_no_space() -> None:
    env = InterplayEnv(action="Plan")
    env.reset(seed=1)
    env.reset(options={"scenario": "intersection/nice"})
    assert env.scenario.name == "intersection/nice"
    shorter = interplay.load("lane-change/front-nice", set={"horizon_steps": 20})
    assert "spaces" in refused(lambda: env.reset(options={"scenario": shorter}))
    assert env.scenario.name == "intersection/nice"
    assert "colour" in refused(lambda: env.reset(options={"colour": 1}))
    refused(lambda: env.reset(options={"scenario": "no-such/thing"}), interplay.ScenarioError)


@pytest.mark.parametrize("seed", [-1, 2**64, 2**80])
def test_a_seed_out_of_range_is_refused(seed: int) -> None:
    env = InterplayEnv()
    refused(lambda: env.reset(options={"seed": seed}))
    refused(lambda: env.reset(seed=seed), (ValueError, gymnasium.error.Error))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "settings",
    [
        {"observation": "Everything"},
        {"observation": []},
        {"observation": ["Lane", "Lane"]},
        {"observation": {"kind": "Kinematics", "colour": 1}},
        {"action": "Shout"},
        {"agent": "stranger"},
        {"reward": {"colour": 1.0}},
        {"reward": {"progress": float("nan")}},
        {"perturb": {"colour": 1.0}},
        {"decision_s": -1.0},
        {"decision_s": float("nan")},
        {"render_mode": "smoke"},
        {"scenario": "no-such/thing"},
        {"scenario": "building/four-room-pid"},
    ],
    ids=str,
)
def test_settings_that_mean_nothing_are_refused(settings: dict[str, Any]) -> None:
    assert refused(lambda: InterplayEnv(**settings))


NUMBERS: list[Any] = [
    np.zeros(3),
    np.zeros((1, 2)),
    np.zeros((2, 1)),
    0.5,
    [],
    "left",
    ["a", "b"],
    None,
    [None, 0.0],
    {"steering": 0.0},
    [[1.0], [2.0, 3.0]],
    [1j, 0.0],
    [float("nan"), 0.0],
    [0.0, float("inf")],
    [0.0, float("-inf")],
]
CHOICES: list[Any] = [-1, 5, 2**40, 1.5, float("nan"), float("inf"), "1", [1], None, {}]


@pytest.mark.parametrize("kind, bad", [("Continuous", bad) for bad in NUMBERS] + [("DiscreteMeta", bad) for bad in CHOICES], ids=repr)
def test_an_action_that_is_none_is_refused_and_nothing_moves(kind: str, bad: Any) -> None:
    env, other = InterplayEnv(action=kind), InterplayEnv(action=kind)
    env.reset(seed=1)
    other.reset(seed=1)
    before = env.states()
    assert refused(lambda: env.step(bad))
    assert equal(env.states(), before)
    good = gentle_actions(env, 1)[0]
    assert equal(env.step(good)[:4], other.step(good)[:4])


def test_plans_of_another_shape_are_refused() -> None:
    env = InterplayEnv(action="Plan")
    env.reset(seed=1)
    for shape in ((29, 2), (30, 3), (60,), (1, 30, 2)):
        assert refused(lambda shape=shape: env.step(np.zeros(shape)))  # type: ignore[misc]
    bad = np.zeros((30, 2))
    bad[29, 1] = np.nan
    assert refused(lambda: env.step(bad))
    env.step(np.zeros((30, 2)))


def test_numbers_beyond_the_space_act_as_its_bounds() -> None:
    one, other = InterplayEnv(), InterplayEnv()
    one.reset(seed=1)
    other.reset(seed=1)
    assert equal(one.step([1e30, -5.0])[:4], other.step([1.0, -1.0])[:4])


def test_the_report_of_an_episode_is_that_of_a_run() -> None:
    env = InterplayEnv(perturb=False)
    assert env.report() is None
    planner = interplay.policy("negotiation").bind(env)
    env.reset(seed=1)
    for _ in range(10):
        env.step(planner.act())
    report = env.report()
    assert report is not None
    assert report.simulated_s == pytest.approx(10 * env.decision_s)
    assert report.scenario == "lane-change/front-nice"
    refused(lambda: env.step([0.0, 0.0]), interplay.RunError)
