"""Many worlds: the same numbers as each world alone, in every way of beginning anew."""

from __future__ import annotations

import functools
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AsyncVectorEnv, AutoresetMode, SyncVectorEnv

import interplay
from helpers import equal, refused
from interplay.envs import InterplayEnv, InterplayVectorEnv

WORLDS = 3
MODES = [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP, AutoresetMode.DISABLED]


def steps(env: Any, seed: int, count: int = 40, mode: AutoresetMode = AutoresetMode.NEXT_STEP) -> list[Any]:
    """What is seen in many worlds under the same random actions; some of them leave the road early."""
    random = np.random.default_rng(5)
    seen = [env.reset(seed=seed)[0]]
    for _ in range(count):
        if isinstance(env.single_action_space, gymnasium.spaces.Discrete):
            actions = random.integers(5, size=WORLDS)
        else:
            actions = (random.uniform(-1, 1, (WORLDS, 2)) * np.array([1.0, 0.4])).astype(np.float32)
        observations, rewards, terminated, truncated, info = env.step(actions)
        seen.append((observations, np.asarray(rewards, np.float64), np.asarray(terminated), np.asarray(truncated)))
        over = seen[-1][2] | seen[-1][3]
        if mode == AutoresetMode.SAME_STEP and over.any():
            assert np.array_equal(info["_final_obs"], over)
            seen.append([info["final_obs"][world] for world in np.flatnonzero(over)])
        if mode == AutoresetMode.DISABLED and over.any():
            seen.append(env.reset(options={"reset_mask": over})[0])
    return seen


def alone(**settings: Any) -> InterplayEnv:
    """One of the worlds, made in whichever process."""
    return InterplayEnv("intersection/nice", **settings)


@pytest.mark.parametrize("mode", MODES, ids=lambda mode: mode.name)
@pytest.mark.parametrize("observation", ["Kinematics", ["Kinematics", "Lane"]], ids=str)
@pytest.mark.parametrize("action", ["Continuous", "DiscreteMeta"])
def test_worlds_in_one_call_have_the_numbers_of_worlds_one_by_one(mode: AutoresetMode, observation: Any, action: str) -> None:
    settings = {"observation": observation, "action": action}
    ours = gymnasium.make_vec(
        "interplay/Intersection-v0",
        num_envs=WORLDS,
        vectorization_mode="vector_entry_point",
        autoreset_mode=mode,
        **settings,
    )
    theirs = SyncVectorEnv([functools.partial(alone, **settings)] * WORLDS, autoreset_mode=mode)
    assert ours.metadata["autoreset_mode"] == mode
    assert ours.single_observation_space == theirs.single_observation_space
    assert ours.observation_space == theirs.observation_space
    assert ours.action_space == theirs.action_space
    found = steps(ours, 11, mode=mode)
    assert any(np.any(step[2]) for step in found if isinstance(step, tuple))
    assert equal(found, steps(theirs, 11, mode=mode))


@pytest.mark.parametrize("context", ["fork", "spawn"])
def test_worlds_in_other_processes_have_the_same_numbers(context: str) -> None:
    # The parent steps first: a fork does not have the threads in which it did.
    found = steps(InterplayVectorEnv("intersection/nice", num_envs=WORLDS), 11)
    theirs = AsyncVectorEnv([alone] * WORLDS, context=context)
    try:
        assert equal(found, steps(theirs, 11))
    finally:
        theirs.close()


def many(_: int) -> Any:
    """Steps many worlds; for a process of its own."""
    return steps(InterplayVectorEnv("intersection/nice", num_envs=WORLDS), 11)


@pytest.mark.parametrize("context", ["fork", "spawn"])
def test_a_process_steps_many_worlds_after_its_parent_did(context: Any) -> None:
    import multiprocessing

    found = many(0)
    with multiprocessing.get_context(context).Pool(1) as pool:
        assert equal(found, pool.map_async(many, [0]).get(timeout=60)[0])


def test_the_last_observation_is_told_in_the_same_step() -> None:
    env = InterplayVectorEnv("intersection/nice", num_envs=WORLDS, autoreset_mode="SameStep")
    env.reset(seed=1)
    for _ in range(60):
        seen, _, terminated, truncated, info = env.step(np.tile(np.array([1.0, 1.0], np.float32), (WORLDS, 1)))
        over = terminated | truncated
        assert ("final_obs" in info) == over.any()
        for world in np.flatnonzero(over):
            assert env.single_observation_space.contains(info["final_obs"][world])
            assert not equal(info["final_obs"][world], seen[world])
            assert info["final_info"]["ending"][world] in ("contact", "off_road", "goal", "time")
        for world in np.flatnonzero(~over):
            if "final_obs" in info:
                assert info["final_obs"][world] is None
        if over.any():
            return
    pytest.fail("no episode ended")


def test_each_world_may_have_a_scenario_of_its_own() -> None:
    names = ["lane-change/front-nice", "intersection/nice", "roundabout/nice"]
    env = InterplayVectorEnv(names, num_envs=3)
    seen, _ = env.reset(seed=4)
    for place, name in enumerate(names):
        assert equal(seen[place], InterplayEnv(name).reset(seed=4 + place)[0])
    assert "2 scenarios for 3" in refused(lambda: InterplayVectorEnv(names[:2], num_envs=3))


def test_worlds_may_have_seeds_each() -> None:
    env = InterplayVectorEnv(num_envs=2)
    seen, _ = env.reset(seed=[8, 8])
    assert equal(seen[0], seen[1])
    refused(lambda: env.reset(seed=[1]))
    refused(lambda: env.reset(seed=[-1, 1]))
    refused(lambda: env.reset(options={"colour": 1}))


def test_an_action_that_is_none_moves_no_world() -> None:
    one, other = (InterplayVectorEnv(num_envs=2) for _ in range(2))
    one.reset(seed=1)
    other.reset(seed=1)
    good = np.zeros((2, 2), np.float32)
    for bad in (np.zeros(2), np.zeros((3, 2)), "left", None, [[0.0, 0.0], [np.nan, 0.0]], [[np.inf, 0.0], [0.0, 0.0]]):
        assert refused(lambda bad=bad: one.step(bad))  # type: ignore[misc]
    assert equal(one.step(good)[:4], other.step(good)[:4])


def test_observations_may_share_one_array() -> None:
    env = InterplayVectorEnv(num_envs=2, copy=False)
    first, _ = env.reset(seed=1)
    kept = first.copy()
    second = env.step(np.ones((2, 2), np.float32))[0]
    assert np.shares_memory(first, second)
    assert not equal(kept, second)


def test_meta_actions_of_all_worlds_have_masks() -> None:
    env = InterplayVectorEnv(num_envs=2, action="DiscreteMeta")
    _, info = env.reset(seed=1)
    assert np.array_equal(info["action_mask"], env.action_masks())
    assert env.action_masks().shape == (2, 5)


def test_planners_of_ours_drive_all_worlds() -> None:
    env = InterplayVectorEnv(num_envs=2, perturb=False, autoreset_mode="Disabled")
    planner = interplay.policy("negotiation").bind(env)
    env.reset(seed=1)
    for _ in range(100):
        _, _, terminated, _, info = env.step(planner.act())
        if terminated.any():
            break
    assert list(info["ending"]) == ["goal", "goal"]
