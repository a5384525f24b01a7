"""Copies: of environments in mid-episode, of reports, snapshots and scenarios."""

from __future__ import annotations

import copy
import pickle
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest

import interplay
from helpers import equal, gentle_actions, refused
from interplay.building import BuildingEnv
from interplay.envs import InterplayEnv
from interplay.parallel import InterplayParallelEnv


def on(env: Any, actions: list[Any]) -> list[Any]:
    """What the actions lead to."""
    return [env.step(action)[:4] for action in actions]


@pytest.mark.parametrize("name", ["LaneChange", "Street", "LaneChange-Discrete", "Intersection"])
def test_copies_in_mid_episode_go_on_with_equal_bits(name: str) -> None:
    env = gymnasium.make(f"interplay/{name}-v0", observation=["Kinematics", "Belief"], disable_env_checker=True)
    first, later = gentle_actions(env, 5), gentle_actions(env, 4, seed=8)
    env.reset(seed=3)
    env.action_space.seed(3)
    on(env, first)
    inner = env.unwrapped
    assert isinstance(inner, InterplayEnv)
    snapshot, deep, pickled = inner.snapshot(), copy.deepcopy(env), pickle.dumps(env)
    expected = on(env, later)
    for other in (deep, pickle.loads(pickled)):
        assert equal(on(other, later), expected)
        assert equal(env.action_space.sample(), other.action_space.sample()) or other is not deep
    for state in (snapshot, pickle.loads(pickle.dumps(snapshot))):
        inner.restore(state)
        assert equal(on(inner, later), expected)
    assert equal(deep.reset()[0], inner.reset()[0])


def test_a_copy_is_independent_and_leaves_the_original_as_it_is() -> None:
    env = InterplayEnv()
    env.reset(seed=1)
    other = copy.deepcopy(env)
    before = env.states()
    on(other, gentle_actions(env, 6))
    assert equal(env.states(), before)
    assert "agents" in refused(lambda: env.restore(InterplayEnv("intersection/nice", agent="human").snapshot()))
    assert "spaces" in refused(lambda: env.restore(InterplayEnv(observation="Lane").snapshot()))


def test_environments_of_several_agents_and_of_buildings_are_copied_in_mid_episode() -> None:
    env = InterplayParallelEnv("intersection/nice", observation="Belief")
    env.reset(seed=2)
    actions = {agent: np.array([0.1, 0.0], np.float32) for agent in env.agents}
    on(env, [actions] * 4)
    snapshot, others = env.snapshot(), [copy.deepcopy(env), pickle.loads(pickle.dumps(env))]
    expected = on(env, [actions] * 3)
    assert all(equal(on(other, [actions] * 3), expected) for other in others)
    env.restore(snapshot)
    assert equal(on(env, [actions] * 3), expected)
    building = BuildingEnv()
    building.reset(seed=2)
    heats = np.full(4, 0.3, np.float32)
    on(building, [heats] * 4)
    others = [copy.deepcopy(building), pickle.loads(pickle.dumps(building))]
    expected = on(building, [heats] * 3)
    assert all(equal(on(other, [heats] * 3), expected) for other in others)


def test_snapshots_and_worlds_are_pickled() -> None:
    world = interplay.Simulation("lane-change/front-nice")
    for _ in range(6):
        world.step()
    snapshot = world.snapshot()
    assert copy.deepcopy(snapshot) is snapshot
    others = [interplay.Snapshot.from_json(snapshot.to_json()), pickle.loads(pickle.dumps(snapshot))]
    worlds = [copy.deepcopy(world), pickle.loads(pickle.dumps(world))]
    expected = world.finish().digest
    for other in others:
        again = interplay.Simulation("lane-change/front-nice")
        again.restore(other)
        worlds.append(again)
    assert {other.finish().digest for other in worlds} == {expected}
    assert "not a snapshot" in refused(lambda: interplay.Snapshot.from_json("{}"))


def test_reports_are_pickled_with_their_ticks() -> None:
    report = interplay.run("lane-change/front-nice")
    other = pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(report))))
    assert other == report and other.vehicles[0].driver == report.vehicles[0].driver
    assert equal(dict(other.frames()), dict(report.frames())) and other.frames().vehicles == report.frames().vehicles
    assert other.summary() == report.summary() and other.animation("png") == report.animation("png")
    assert copy.deepcopy(report).animation("png") == report.animation("png")


def test_many_runs_have_the_reports_of_single_ones() -> None:
    scenarios, seeds = ["lane-change/front-nice", "intersection/nice"], [1, 2]
    planners: list[Any] = ["idm", interplay.policy("conservative")]
    expected = [interplay.run(s, p, seed=n).digest for s in scenarios for p in planners for n in seeds]
    for jobs in (1, 3):
        assert [report.digest for report in interplay.run_many(scenarios, planners, seeds, jobs)] == expected
    with ProcessPoolExecutor(2) as pool:
        names = ["lane-change/front-nice"] * 2
        assert [report.digest for report in pool.map(interplay.run, names, ["idm"] * 2)] == [expected[0]] * 2
    assert "jobs" in refused(lambda: interplay.run_many("lane-change/front-nice", jobs=0))


def test_a_scenario_is_its_content(tmp_path: Path) -> None:
    first = interplay.load("lane-change/front-nice")
    written = interplay.Scenario.from_toml(first.to_toml(), "mine.toml")
    table = interplay.Scenario.from_dict({"extends": "lane-change/front-nice", "duration_s": np.float64(first.duration_s)})
    assert first == written == table and len({first, written, table}) == 1
    assert first != interplay.load("lane-change/front-nice", seed=99) and first != "lane-change/front-nice"
    assert written.name == "mine" and "\n" not in repr(first)
    path = tmp_path / "street.toml"
    path.write_text("extends = 'lane-change/front-nice'\nduration_s = 2.0\n")
    scenario = interplay.load(path)
    pickled = pickle.dumps(scenario)
    path.write_text("extends = 'lane-change/front-nice'\nduration_s = 3.0\n")
    other = pickle.loads(pickled)
    assert other == scenario and other.duration_s == 2.0 and copy.deepcopy(scenario) is scenario
    assert "duration" in refused(lambda: interplay.Scenario.from_dict({"extends": "lane-change/front-nice", "duratoin_s": 2.0}))
    for entry in interplay.list():
        scenario = interplay.load(entry.name)
        assert pickle.loads(pickle.dumps(scenario)) == scenario, entry.name
