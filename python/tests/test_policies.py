"""Planners of Interplay in environments, and Python functions in runs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import interplay
from helpers import ACTIONS, equal, refused
from interplay import PolicyFunction
from interplay.envs import InterplayEnv

KINDS = ["human", "idm", "conservative", "negotiation", "bayesian", "game", "cooperative", "nash", "contingency"]


@pytest.mark.parametrize("action", ACTIONS)
@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_planner_acts_in_every_kind_of_action(kind: str, action: str) -> None:
    env = InterplayEnv("lane-change/front-nice", action=action, perturb=False)
    policy = interplay.policy(kind).bind(env)
    seen, _ = env.reset(seed=1)
    for _ in range(4):
        decided, _ = policy.predict(seen)
        assert env.action_space.contains(decided), decided
        seen, _, terminated, truncated, _ = env.step(decided)
        if terminated or truncated:
            break


@pytest.mark.parametrize("action", ACTIONS)
def test_negotiation_changes_lanes_through_any_kind_of_action(action: str) -> None:
    env = InterplayEnv("lane-change/front-nice", action=action, perturb=False)
    policy = interplay.policy("negotiation").bind(env)
    env.reset(seed=1)
    for _ in range(200):
        _, _, terminated, truncated, info = env.step(policy.act())
        if terminated or truncated:
            break
    assert info["ending"] == "goal"


@pytest.mark.parametrize("scenario", ["lane-change/front-nice", "intersection/nice"])
def test_plans_are_driven_as_their_planner_drives_them(scenario: str) -> None:
    env = InterplayEnv(scenario, action="Plan")
    # It needs no plan of anybody who decides before it in the same tick, which is not told in an environment.
    policy = interplay.policy("idm").bind(env)
    env.reset(options={"seed": 1})
    frames = interplay.run(scenario, "idm").frames()
    for tick in range(15):
        for place, name in enumerate(frames.vehicles):
            driven = [frames[part][tick, place] for part in ("x_m", "y_m", "heading_rad", "speed_mps")]
            assert env.states()[name] == pytest.approx(driven, abs=1e-6)
        env.step(policy.act())


def test_a_planner_that_forgets_acts_as_a_new_one() -> None:
    env = InterplayEnv("lane-change/front-nice", perturb=False)
    policy = interplay.policy("bayesian").bind(env)

    def acts() -> list[Any]:
        env.reset(seed=1)
        found = []
        for _ in range(5):
            found.append(policy.act())
            env.step(found[-1])
        return found

    first = acts()
    policy.reset()
    assert equal(acts(), first)


def test_what_is_no_planner_is_refused() -> None:
    assert "negotiation" in refused(lambda: interplay.policy("magic"))
    assert "headway_s" in refused(lambda: interplay.policy("idm", colour=1))
    assert "bind" in refused(interplay.policy("idm").act, interplay.RunError)
    assert interplay.policy("idm", headway_s=2.0).kind == "idm"


def steady(seen: Any) -> Any:
    """Neither pedal nor wheel."""
    return [0.0, 0.0]


def test_a_function_drives_the_ego_of_a_run() -> None:
    seen: list[Any] = []

    def mine(observation: Any) -> Any:
        seen.append(observation)
        return np.array([0.0, 0.0])

    report = interplay.run("lane-change/front-nice", planner={"mine": mine})
    assert report.vehicles[0].driver == "python"
    assert report.vehicles[0].plans.failed == 0
    assert report.vehicles[0].final.speed_mps == pytest.approx(1.0)
    assert seen[0].shape == (5, 7) and seen[0].dtype == np.float32
    assert equal(seen[0], InterplayEnv("lane-change/front-nice").reset(options={"seed": 1})[0])


@pytest.mark.parametrize("action, decided", [("Continuous", [0.02, 0.0]), ("DiscreteMeta", 1), ("Plan", np.zeros((30, 2)))])
def test_a_function_sees_and_decides_what_it_says(action: str, decided: Any) -> None:
    def mine(observation: Any) -> Any:
        assert set(observation) == {"Lane", "Belief"}
        assert observation["Belief"].shape == (4, 5)
        return decided

    function = PolicyFunction(mine, observation=["Lane", "Belief"], action=action, decision_s=0.2)
    report = interplay.run("lane-change/front-nice", planner={"mine": function})
    assert report.vehicles[0].plans.failed == 0


def test_a_function_and_the_environment_come_to_the_same() -> None:
    env = InterplayEnv("intersection/nice")
    env.reset(options={"seed": 1})
    for _ in range(15):
        env.step([0.1, 0.0])
    frames = interplay.run("intersection/nice", planner={"mine": lambda seen: [0.1, 0.0]}).frames()
    tick = int(np.argmin(np.abs(frames["time_s"] - 15 * env.decision_s)))
    place = frames.vehicles.index("ego")
    assert env.states()["ego"][:2] == pytest.approx([frames["x_m"][tick, place], frames["y_m"][tick, place]], abs=1e-9)


def test_a_function_at_the_largest_speed_and_the_environment_come_to_the_same() -> None:
    report = interplay.run("lane-change/front-nice", planner={"mine": lambda seen: [1.0, 0.0]})
    assert report.vehicles[0].plans.failed == 0
    assert report.vehicles[0].final.speed_mps == pytest.approx(1.5)


def test_whatever_predicts_is_a_function() -> None:
    class Model:
        def predict(self, observation: Any, deterministic: bool = False) -> tuple[Any, None]:
            assert deterministic
            return np.zeros(2, np.float32), None

    report = interplay.run("lane-change/front-nice", planner={"model": Model()})
    assert report.vehicles[0].plans.failed == 0


def test_what_a_function_raises_is_raised() -> None:
    def broken(seen: Any) -> Any:
        raise KeyError("the weights are missing")

    assert "weights" in refused(lambda: interplay.run("lane-change/front-nice", planner={"mine": broken}), KeyError)
    for bad in ("left", None, [0.0], [0.0, 0.0, 0.0], [np.nan, 0.0]):
        assert refused(lambda bad=bad: interplay.run("lane-change/front-nice", planner={"mine": lambda seen: bad}))  # type: ignore[misc]
    assert interplay.run("lane-change/front-nice", planner={"mine": steady}).vehicles[0].plans.failed == 0


def test_one_planner_is_named_in_a_run() -> None:
    with pytest.raises(TypeError):
        interplay.run("lane-change/front-nice", planner={"one": steady, "other": steady})
    with pytest.raises(TypeError):
        interplay.run("lane-change/front-nice", planner=steady)  # type: ignore[arg-type]


def test_the_version_of_a_function_is_made_of_its_source() -> None:
    assert PolicyFunction(steady).version == PolicyFunction(steady).version
    assert PolicyFunction(steady).version != PolicyFunction(refused).version
    assert PolicyFunction(steady, version="2").version == "2"
