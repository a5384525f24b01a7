"""Several agents at once."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

pytest.importorskip("pettingzoo")

from pettingzoo.test import parallel_api_test, parallel_seed_test

import interplay
from helpers import equal, refused
from interplay.envs import InterplayEnv
from interplay.parallel import parallel_env

WHO: list[tuple[str, list[str] | None]] = [
    ("lane-change/front-nice", ["ego", "front"]),
    ("lane-change/front-nice", ["rear"]),
    ("intersection/four-way", None),
]


@pytest.mark.parametrize("scenario, agents", WHO)
@pytest.mark.parametrize("action", ["Continuous", "DiscreteMeta"])
def test_pettingzoo_has_nothing_to_say(scenario: str, agents: list[str] | None, action: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parallel_api_test(parallel_env(scenario, agents, action=action), num_cycles=100)
        parallel_seed_test(lambda: parallel_env(scenario, agents, action=action), num_cycles=20)


def test_the_state_of_the_world_is_that_of_all_vehicles() -> None:
    from pettingzoo.test.state_test import test_parallel_env

    env = parallel_env("lane-change/front-nice", ["ego"])
    assert not env.state().any()
    env.reset(seed=1)
    assert env.state().shape == env.state_space.shape == (4 * len(env.scenario.vehicles),)
    test_parallel_env(env)


def acts(env: Any, value: float = 0.0) -> dict[str, Any]:
    """The same numbers for all agents."""
    return {agent: np.array([value, 0.0], np.float32) for agent in env.agents}


def test_all_who_have_a_driver_are_agents() -> None:
    env = parallel_env("lane-change/front-nice")
    assert env.possible_agents == ["ego", "front", "rear"]
    seen, infos = env.reset(seed=1)
    assert list(seen) == list(infos) == env.agents == env.possible_agents
    assert env.action_space("ego") is env.action_space("ego")
    assert env.action_space("ego") is not env.action_space("front")
    assert parallel_env("lane-change/front-nice", "front").possible_agents == ["front"]


def test_the_same_seed_gives_the_same_numbers() -> None:
    one, other = (parallel_env("intersection/nice") for _ in range(2))
    assert equal(one.reset(seed=3)[0], other.reset(seed=3)[0])
    while one.agents:
        found = one.step(acts(one, 0.3))
        assert equal(found[:4], other.step(acts(other, 0.3))[:4])


def test_one_agent_has_the_numbers_of_an_environment_of_its_own() -> None:
    env, alone = parallel_env("lane-change/front-nice", ["ego"]), InterplayEnv("lane-change/front-nice")
    assert equal(env.reset(seed=3)[0]["ego"], alone.reset(seed=3)[0])
    for _ in range(10):
        seen, rewards, *_ = env.step(acts(env, 0.2))
        observation, reward, *_ = alone.step([np.float32(0.2), 0.0])
        assert equal(seen["ego"], observation)
        assert rewards["ego"] == reward


def test_an_agent_leaves_when_its_episode_is_over() -> None:
    env = parallel_env("lane-change/front-nice", ["ego", "front"])
    env.reset(seed=1)
    left = []
    for _ in range(300):
        if not env.agents:
            break
        actions = acts(env)
        if "ego" in actions:
            actions["ego"] = np.array([1.0, -1.0], np.float32)
        _, _, terminated, truncated, infos = env.step(actions)
        for agent, info in infos.items():
            if "ending" in info:
                assert terminated[agent] or truncated[agent]
                assert agent not in env.agents
                left.append((agent, info["ending"]))
    assert len(left) == 2
    assert left[0] == ("ego", "off_road")
    assert env.step({}) == ({}, {}, {}, {}, {})


def test_an_invalid_action_moves_no_agent() -> None:
    one, other = (parallel_env("lane-change/front-nice") for _ in range(2))
    one.reset(seed=1)
    other.reset(seed=1)
    for bad in (np.array([np.nan, 0.0]), np.zeros(3), "left", None):
        assert refused(lambda bad=bad: one.step({**acts(one), "rear": bad}))  # type: ignore[misc]
    assert "rear" in refused(lambda: one.step({"ego": np.zeros(2), "front": np.zeros(2)}))
    assert equal(one.step(acts(one))[:4], other.step(acts(other))[:4])


def test_settings_and_options_that_mean_nothing_are_refused() -> None:
    refused(lambda: parallel_env("lane-change/front-nice", ["stranger"]))
    refused(lambda: parallel_env("lane-change/front-nice", ["ego", "ego"]))
    env = parallel_env("lane-change/front-nice")
    refused(lambda: env.reset(options={"seed": -1}))
    refused(lambda: env.reset(seed=-1))
    first, _ = env.reset(options={"seed": 3})
    assert equal(first, env.reset(options={"seed": 3})[0])


def test_planners_of_ours_act_for_each_agent() -> None:
    env = parallel_env("lane-change/front-nice", ["ego", "front"], perturb=False)
    planner = interplay.policy("conservative").bind(env)
    env.reset(seed=1)
    for _ in range(5):
        seen, *_ = env.step({agent: planner.act(agent) for agent in env.agents})
    assert env.observation_space("ego").contains(seen["ego"])


def test_a_picture_of_all_agents() -> None:
    env = parallel_env("lane-change/front-nice", render_mode="rgb_array")
    env.reset(seed=1)
    picture = env.render()
    assert picture.shape == (544, 720, 3)
    assert picture.dtype == np.uint8
