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
from interplay.parallel import InterplayParallelEnv

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


def test_worlds_may_have_several_agents_in_rows() -> None:
    agents = ["ego", "crossing"]
    env = InterplayVectorEnv("intersection/nice", num_envs=2, agents=agents, autoreset_mode="SameStep")
    both = InterplayParallelEnv("intersection/nice", agents)
    seen, info = env.reset(seed=4)
    single = both.reset(seed=4)[0]
    assert env.num_envs == 4 and info["present"].all() and equal(seen[1], single["crossing"])
    absent = resets = 0
    for _ in range(80):
        was = info["present"]
        seen, rewards, terminated, truncated, info = env.step(np.tile(np.array([0.4, 0.0], np.float32), (4, 1)))
        if both.agents:
            single, expected, *_ = both.step({agent: np.array([0.4, 0.0], np.float32) for agent in both.agents})
            assert all(rewards[agents.index(agent)] == reward for agent, reward in expected.items())
        over = terminated | truncated
        assert not (over & ~was).any() and not rewards[~was].any()
        absent, resets = absent + int((~info["present"]).sum()), resets + int((info["present"] & ~was).sum())
    assert absent and resets
    assert "agent" in refused(lambda: InterplayVectorEnv(agent="ego", agents=["ego"]))


def test_worlds_are_drawn_and_answer_questions() -> None:
    env: Any = gymnasium.make_vec(
        "interplay/Street-v0", num_envs=2, vectorization_mode="vector_entry_point", render_mode="rgb_array"
    )
    env.reset(seed=1)
    pictures = env.render()
    assert pictures is not None and [picture.shape for picture in pictures] == [(544, 720, 3)] * 2
    assert len(set(env.get_attr("street"))) == 2 and env.call("time_s") == (0.0, 0.0)
    assert all("ego" in states for states in env.call("states"))
    assert "scenario" in refused(lambda: env.call("colour"), AttributeError)
    assert "cannot be set" in refused(lambda: env.set_attr("street", 1), AttributeError)


def test_a_reward_may_be_a_function() -> None:
    def reward(terms: Any, info: Any) -> Any:
        return 2.0 * terms["speed"] - terms["jerk"]

    env, one = InterplayVectorEnv(num_envs=2, reward=reward), InterplayEnv(reward=reward)
    weighted = InterplayEnv(reward={**dict.fromkeys(one.reset(seed=3)[1]["reward_terms"], 0.0), "speed": 2.0, "jerk": -1.0})
    env.reset(seed=3)
    weighted.reset(seed=3)
    action = np.array([0.5, 0.01], np.float32)
    for _ in range(5):
        found = env.step(np.tile(action, (2, 1)))[1]
        assert found[0] == one.step(action)[1] == pytest.approx(weighted.step(action)[1])
    assert found[0] != 0.0


def test_each_episode_may_draw_its_scenario() -> None:
    names = ["lane-change/front-nice", "intersection/nice", "roundabout/nice"]
    env = InterplayEnv(names, set={"duration_s": 4.0})
    found = [env.reset(seed=seed)[1]["street"] for seed in range(12)]
    assert set(found) == set(names) and env.reset(seed=3)[1]["street"] == found[3]
    assert "names and paths" in refused(lambda: InterplayEnv([]))


@pytest.mark.parametrize("name", ["Highway", "Merge"])
def test_tasks_of_highwayenv_have_its_settings(name: str) -> None:
    env: Any = gymnasium.make(f"interplay/{name}-v0", disable_env_checker=True)
    assert env.action_space.n == 5 and env.observation_space.shape == (5, 7) and env.unwrapped.decision_s == 1.0
    first, second = env.reset(seed=1)[0], env.reset(seed=2)[0]
    assert not equal(first, second)
    info, rewards = {}, []
    while "ending" not in info:
        _, reward, _, _, info = env.step(1)
        rewards.append(reward)
    assert info["ending"] in ("time", "contact") and max(rewards) <= 0.4 + 1e-9
    worlds = gymnasium.make_vec(f"interplay/{name}-v0", num_envs=2, vectorization_mode="vector_entry_point")
    assert equal(worlds.reset(seed=1)[0][0], first)
    flat = gymnasium.make(f"interplay/{name}-Discrete-v0", disable_env_checker=True).reset(seed=1)[0]
    assert equal(flat, first.ravel())
