"""What several tests need."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import gymnasium
import numpy as np
import pytest

import interplay  # noqa: F401, registers the environments

IDENTIFIERS = sorted(name for name in gymnasium.registry if name.startswith("interplay/"))
DRIVING = [name for name in IDENTIFIERS if name != "interplay/Building-v0"]
OBSERVATIONS = ["Kinematics", "Lane", "OccupancyGrid", "Plan", "Belief"]
ACTIONS = ["Continuous", "DiscreteMeta", "Plan"]


def command(*arguments: str, module: str = "interplay", before: tuple[str, ...] = ()) -> subprocess.CompletedProcess[str]:
    """Runs the command of the package in another process."""
    return subprocess.run([sys.executable, *before, "-m", module, *arguments], capture_output=True, text=True, timeout=120)


def report_of_command(scenario: str, *arguments: str) -> dict[str, Any]:
    """The report of ``interplay run --json``, also of a run whose expectations do not hold."""
    found = command("run", scenario, "--json", "--no-record", *arguments)
    assert found.returncode in (0, 1), found.stderr
    report: dict[str, Any] = json.loads(found.stdout)
    return report


def equal(one: Any, other: Any) -> bool:
    """Whether observations, or what is made of them, are the same bit for bit."""
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(equal(one[name], other[name]) for name in one)
    if isinstance(one, (tuple, list)):
        return len(one) == len(other) and all(equal(*pair) for pair in zip(one, other))
    first, second = np.asarray(one), np.asarray(other)
    return first.dtype == second.dtype and first.shape == second.shape and first.tobytes() == second.tobytes()


def episode(env: gymnasium.Env[Any, Any], seed: int | None, actions: list[Any], **reset: Any) -> list[Any]:
    """An episode: observations, rewards and endings, from reset until it is over or the actions are at their end."""
    seen = [env.reset(seed=seed, **reset)[0]]
    for action in actions:
        observation, reward, terminated, truncated, _ = env.step(action)
        seen.append((observation, float(reward), terminated, truncated))
        if terminated or truncated:
            break
    return seen


def gentle_actions(env: gymnasium.Env[Any, Any], count: int, seed: int = 7) -> list[Any]:
    """Random actions with little steering, so that episodes last."""
    space = env.action_space
    if isinstance(space, gymnasium.spaces.Discrete):
        return [int(number) for number in np.random.default_rng(seed).integers(int(space.n), size=count)]
    random = np.random.default_rng(seed)
    return [(np.array([0.5, 0.02]) * random.uniform(-1, 1, space.shape)).astype(np.float32) for _ in range(count)]


def refused(call: Callable[[], Any], error: type[BaseException] = ValueError) -> str:
    """The words with which something is refused."""
    with pytest.raises(error) as caught:
        call()
    return str(caught.value)


