"""The environment of a building."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import pytest

import interplay
from helpers import equal, refused
from interplay.building import BuildingEnv


def day(env: Any, seed: int, share: float = 0.1) -> list[Any]:
    """A day with the same share of heat everywhere."""
    seen, is_over = [env.reset(seed=seed)[0]], False
    while not is_over:
        observation, reward, terminated, is_over, info = env.step(np.full(env.action_space.shape, share, np.float32))
        assert not terminated
        assert env.observation_space.contains(observation)
        seen.append((observation, reward, info["reward_terms"]["heat"]))
    return seen


def test_an_episode_is_a_day_of_steps() -> None:
    env = BuildingEnv()
    assert env.action_space.shape == (4,)
    assert len(day(env, 1)) == 49
    assert len(day(BuildingEnv(days=2), 1)) == 97
    refused(lambda: env.step(np.zeros(4)), interplay.RunError)
    refused(lambda: BuildingEnv().step(np.zeros(4)), interplay.RunError)


@pytest.mark.parametrize("name", ["building/four-room-pid", "building/distributed", "mixed/garage"])
def test_the_same_seed_and_heats_give_the_same_numbers(name: str) -> None:
    env = BuildingEnv(name)
    first = day(env, 5)
    assert equal(first, day(BuildingEnv(name), 5))


def test_heat_costs() -> None:
    cold, warm = day(BuildingEnv(), 1, 0.0), day(BuildingEnv(), 1, 0.5)
    assert sum(entry[2] for entry in cold[1:]) == pytest.approx(0.0)
    assert sum(entry[2] for entry in warm[1:]) > 1.0
    paid = BuildingEnv(reward={"discomfort": 0.0, "heat": -2.0})
    paid.reset(seed=1)
    _, reward, _, _, info = paid.step(np.ones(4, np.float32))
    assert reward == pytest.approx(-2.0 * info["reward_terms"]["heat"])


def test_what_is_no_heat_is_refused_and_nothing_moves() -> None:
    one, other = BuildingEnv(), BuildingEnv()
    one.reset(seed=1)
    other.reset(seed=1)
    for bad in (np.zeros(3), np.zeros((4, 1)), [np.nan] * 4, [np.inf, 0, 0, 0], 0.0, "warm", None, ["a"] * 4):
        assert refused(lambda bad=bad: one.step(bad))  # type: ignore[misc]
    assert equal(one.step(np.ones(4))[0], other.step(np.ones(4))[0])


def test_settings_and_options_that_mean_nothing_are_refused() -> None:
    assert "no building" in refused(lambda: BuildingEnv("lane-change/front-nice"))
    refused(lambda: BuildingEnv(reward={"colour": 1.0}))
    env = BuildingEnv()
    refused(lambda: env.reset(options={"colour": 1}))
    first, _ = env.reset(options={"seed": 3})
    assert equal(first, env.reset(options={"seed": 3})[0])


def test_it_is_registered() -> None:
    env = gymnasium.make("interplay/Building-v0", days=2)
    assert isinstance(env.unwrapped, BuildingEnv)
