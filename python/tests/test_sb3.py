"""Many worlds for stable-baselines3."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")

from stable_baselines3 import PPO
from stable_baselines3.common.evaluation import evaluate_policy
from stable_baselines3.common.vec_env import DummyVecEnv, SubprocVecEnv

import interplay
from helpers import equal
from interplay.envs import InterplayEnv
from interplay.sb3 import VecEnv


def alone(seed: int) -> InterplayEnv:
    """One world, made in whichever process."""
    return InterplayEnv("intersection/nice")


def steps(worlds: Any, count: int = 40) -> list[Any]:
    """Observations, rewards, ends and last observations under the same actions."""
    random, place = np.random.default_rng(3), worlds.num_envs
    worlds.seed(5)
    seen: list[Any] = [np.copy(worlds.reset())]
    for _ in range(count):
        observations, rewards, over, infos = worlds.step(random.uniform(-1, 1, (place, 2)).astype(np.float32))
        seen.append((np.copy(observations), np.float32(rewards), np.copy(over)))
        for world in np.flatnonzero(over):
            assert infos[world]["TimeLimit.truncated"] in (True, False)
            seen.append(np.copy(infos[world]["terminal_observation"]))
    worlds.close()
    return seen


def test_worlds_have_the_numbers_of_those_of_stable_baselines() -> None:
    found = steps(VecEnv("intersection/nice", num_envs=2))
    assert len(found) > 41
    assert equal(found, steps(DummyVecEnv([functools.partial(alone, seed) for seed in range(2)])))


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_worlds_in_other_processes_have_the_same_numbers(method: str) -> None:
    found = steps(VecEnv("intersection/nice", num_envs=2))
    assert equal(found, steps(SubprocVecEnv([functools.partial(alone, seed) for seed in range(2)], start_method=method)))


@pytest.mark.parametrize("settings", [{"observation": "Lane"}, {"observation": ["Kinematics", "Lane"]}, {"action": "DiscreteMeta"}])
def test_a_network_learns(settings: dict[str, Any]) -> None:
    worlds = VecEnv("intersection/nice", num_envs=4, **settings)
    kind = "MultiInputPolicy" if isinstance(settings.get("observation"), list) else "MlpPolicy"
    model = PPO(kind, worlds, n_steps=32, batch_size=64, n_epochs=2, seed=1, device="cpu")
    before = [parameter.detach().clone() for parameter in model.policy.parameters()]
    model.learn(256)
    assert any(not bool((one == other).all()) for one, other in zip(before, model.policy.parameters()))
    assert len(model.ep_info_buffer or ()) > 0


def test_a_network_drives_in_a_run_and_its_weights_are_its_version() -> None:
    model = PPO("MlpPolicy", VecEnv("intersection/nice", num_envs=2, observation="Lane"), n_steps=16, batch_size=16, seed=1, device="cpu")
    function = interplay.PolicyFunction(model, observation="Lane")
    first = function.version
    assert interplay.run("intersection/nice", planner={"network": function}).vehicles[0].driver
    model.learn(64)
    assert interplay.PolicyFunction(model, observation="Lane").version != first


def test_planners_of_ours_are_evaluated_like_networks() -> None:
    worlds = VecEnv("lane-change/front-nice", num_envs=2, perturb=False)
    policy = interplay.policy("negotiation").bind(worlds)
    mean, _ = evaluate_policy(policy, worlds, n_eval_episodes=2, warn=False)
    assert float(np.mean(mean)) > 0.5


def test_worlds_answer_questions() -> None:
    worlds = VecEnv(num_envs=3, action="DiscreteMeta")
    worlds.reset()
    assert worlds.action_masks().shape == (3, 5)
    assert worlds.get_attr("num_envs") == [3, 3, 3]
    assert len(worlds.env_method("action_masks", indices=[0, 2])) == 2
    assert worlds.env_is_wrapped(object) == [False] * 3
