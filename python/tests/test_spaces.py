"""Environments of Gymnasium: what they say of themselves, what is seen and decided in them, and wrappers."""

from __future__ import annotations

import pickle
import warnings
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.wrappers import FlattenObservation, RecordEpisodeStatistics

import interplay
from helpers import ACTIONS, DRIVING, IDENTIFIERS, OBSERVATIONS, episode, equal, gentle_actions
from interplay.envs import InterplayEnv


def test_every_family_has_an_environment() -> None:
    families = {row.name.split("/")[0] for row in interplay.list()}
    names = {family.title().replace("-", "") for family in families} | {"Scenario", "Street", "Highway", "Merge"}
    discrete = {f"interplay/{name}-Discrete-v0" for name in names - {"Building"}}
    assert {f"interplay/{name}-v0" for name in names} | discrete == set(IDENTIFIERS)


@pytest.mark.parametrize("name", IDENTIFIERS)
def test_gymnasium_has_nothing_to_say_against_an_environment(name: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gymnasium.make(name).unwrapped, skip_render_check=True)


@pytest.mark.parametrize("name", ["interplay/LaneChange-v0", "interplay/Intersection-v0", "interplay/Mixed-v0"])
def test_pictures_are_arrays_of_one_size(name: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gymnasium.make(name, render_mode="rgb_array").unwrapped, skip_render_check=True)
    env = gymnasium.make(name, render_mode="rgb_array")
    env.reset(seed=1)
    first: Any = env.render()
    env.step(np.array([1.0, 0.0], np.float32))
    second: Any = env.render()
    assert first.shape == second.shape == (544, 720, 3)
    assert first.dtype == np.uint8
    assert len(np.unique(first)) > 10
    assert not np.array_equal(first, second)


def test_a_window_opens_and_closes(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pygame")
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    env = gymnasium.make("interplay/LaneChange-v0", render_mode="human")
    env.reset(seed=1)
    env.step(np.zeros(2, np.float32))
    assert env.render() is None
    env.close()
    env.close()


@pytest.mark.parametrize("action", ACTIONS)
@pytest.mark.parametrize("observation", [*OBSERVATIONS, OBSERVATIONS])
def test_what_is_seen_is_within_the_space(observation: Any, action: str) -> None:
    for name in ("lane-change/front-nice", "intersection/four-way"):
        env = InterplayEnv(name, observation=observation, action=action)
        env.action_space.seed(3)
        seen, info = env.reset(seed=3)
        for step in range(12):
            assert env.observation_space.contains(seen)
            seen, reward, terminated, truncated, info = env.step(env.action_space.sample())
            assert np.isfinite(reward)
            assert env.observation_space.contains(seen)
            if terminated or truncated:
                seen, info = env.reset()


@pytest.mark.parametrize("observation", OBSERVATIONS)
def test_the_entries_of_a_view_have_names(observation: str) -> None:
    env = InterplayEnv(observation=observation)
    names = env.observation_names[observation]
    shape = env.observation_space.shape
    assert shape is not None
    assert not names or len(names) in shape


def test_a_list_of_views_is_a_dictionary_of_what_each_shows() -> None:
    several = InterplayEnv(observation=["Kinematics", "Lane"])
    seen, _ = several.reset(seed=5)
    for name in ("Kinematics", "Lane"):
        alone, _ = InterplayEnv(observation=name).reset(seed=5)
        assert equal(seen[name], alone)


def test_views_have_settings() -> None:
    assert InterplayEnv(observation={"kind": "Kinematics", "count": 2}).observation_space.shape == (2, 7)
    assert InterplayEnv(observation={"type": "Kinematics", "count": 3}).observation_space.shape == (3, 7)


@pytest.mark.parametrize("observation", ["Lane", "Kinematics", ["Kinematics", "Lane"]])
@pytest.mark.parametrize("action", ACTIONS)
def test_stable_baselines_has_nothing_to_say_against_an_environment(observation: Any, action: str) -> None:
    pytest.importorskip("stable_baselines3")
    from stable_baselines3.common.env_checker import check_env as check

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # It would rather have rows as one row: true, and left to `FlattenObservation`.
        warnings.filterwarnings("ignore", message=".*unconventional shape")
        check(InterplayEnv(observation=observation, action=action), skip_render_check=True)


def test_meta_actions_that_cannot_be_done_are_masked() -> None:
    env = InterplayEnv(action="DiscreteMeta")
    _, info = env.reset(seed=1)
    mask = env.action_masks()
    assert mask.shape == (5,)
    assert np.array_equal(mask, info["action_mask"].astype(bool))
    assert info["action_mask"].dtype == np.int8
    assert mask.any() and not mask.all()
    assert env.action_space.contains(env.action_space.sample(info["action_mask"]))
    numbers = InterplayEnv()
    numbers.reset(seed=1)
    with pytest.raises(ValueError, match="meta-actions"):
        numbers.action_masks()


def test_a_pickled_environment_has_the_same_episodes() -> None:
    env = gymnasium.make("interplay/LaneChange-v0", observation="Lane", set={"duration_s": 5.0}).unwrapped
    assert isinstance(env, InterplayEnv)
    env.reset(seed=2)
    copy = pickle.loads(pickle.dumps(env))
    assert copy.scenario.duration_s == 5.0
    assert copy.spec == env.spec
    actions = gentle_actions(env, 30)
    assert equal(episode(env, 4, actions), episode(copy, 4, actions))


def test_an_environment_of_a_changed_scenario_can_be_pickled() -> None:
    env = InterplayEnv(interplay.load("lane-change/front-nice", set={"duration_s": 2.0}))
    assert pickle.loads(pickle.dumps(env)).scenario.duration_s == 2.0


def test_wrappers_of_gymnasium_work() -> None:
    env = RecordEpisodeStatistics(FlattenObservation(gymnasium.make("interplay/LaneChange-v0", max_episode_steps=4)))
    seen, _ = env.reset(seed=1)
    assert seen.shape == (35,)
    for step in range(4):
        seen, _, terminated, truncated, info = env.step(np.array([0.0, 0.0], np.float32))
    assert (terminated, truncated) == (False, True)
    assert info["episode"]["l"] == 4
    both = FlattenObservation(InterplayEnv(observation=["Kinematics", "Belief"]))
    assert both.reset(seed=1)[0].shape == both.observation_space.shape


def test_all_driving_environments_take_all_views_and_actions() -> None:
    for name in DRIVING:
        for action in ACTIONS:
            env = gymnasium.make(name, observation=OBSERVATIONS, action=action, disable_env_checker=True)
            seen, _ = env.reset(seed=1)
            assert env.observation_space.contains(seen), (name, action)
