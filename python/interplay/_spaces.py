"""Settings of environments, and arrays in the shapes of their spaces."""

from __future__ import annotations

import importlib
import json
import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: The views of a scene.
OBSERVATIONS = ("Kinematics", "Lane", "OccupancyGrid", "Plan", "Belief")
#: What an agent decides.
ACTIONS = ("Continuous", "DiscreteMeta", "Plan")


def needs(module: str, extra: str) -> Any:
    """A module that an extra of the package installs."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name is None or error.name.split(".")[0] != module.split(".")[0]:
            raise
        raise ModuleNotFoundError(f"{module} is not installed: pip install 'interplay[{extra}]'", name=module) from None


def observation_settings(observation: Any) -> list[dict[str, Any]]:
    """Views as a list of tables with a ``kind``."""
    if isinstance(observation, (str, Mapping)):
        observation = [observation]
    views = [{"kind": view} if isinstance(view, str) else dict(view) for view in observation]
    for view in views:
        if "type" in view:  # the word of HighwayEnv
            view["kind"] = view.pop("type")
        if view.get("kind") not in OBSERVATIONS:
            raise ValueError(f"observation {view.get('kind')!r}; choose from {', '.join(OBSERVATIONS)}")
    return views


def environment_settings(
    observation: Any,
    action: Any,
    reward: Mapping[str, float] | None,
    agents: Sequence[str] | None,
    perturb: bool | Mapping[str, Any],
    decision_s: float | None,
    streets: Mapping[str, Any] | None = None,
    set: Any = None,
) -> str:
    """The settings of an environment as JSON."""
    kind = action.get("type", action.get("kind")) if isinstance(action, Mapping) else action
    if kind not in ACTIONS:
        raise ValueError(f"action {kind!r}; choose from {', '.join(ACTIONS)}")
    start: dict[str, Any] = {"is_drawn": bool(perturb)}
    if isinstance(perturb, Mapping):
        start = {"is_drawn": True, **perturb}
    if start.get("safety_weights") is not None:
        start["safety_weights"] = [float(weight) for weight in start["safety_weights"]]
    settings = {
        "observations": observation_settings(observation),
        "action": kind,
        "start": start,
        "decision_s": decision_s,
        "agents": [agents] if isinstance(agents, str) else list(agents or []),
    }
    if streets is not None:
        from ._library import changes

        settings["streets"] = {**streets, "set": changes(set)}
    if reward is not None:
        settings["reward"] = dict(reward)
    return json.dumps(settings)


def drawn_scenarios(listed: Sequence[Any], streets: Mapping[str, Any] | None) -> tuple[str, dict[str, Any]]:
    """The first of some scenarios, and the settings with which each episode draws one of them."""
    if not listed or not all(isinstance(entry, (str, os.PathLike)) for entry in listed):
        raise ValueError("a list of scenarios, of which each episode draws one, has names and paths, and at least one")
    names = [os.fspath(entry) for entry in listed]
    return names[0], {**(streets or {}), "scenarios": names}


def shaped_observation(numbers: NDArray[np.float32], shapes: Sequence[tuple[str, Sequence[int]]], is_single: bool) -> Any:
    """Numbers in the shapes of views: one array, or a dictionary of arrays by the names of the views. A first axis may be worlds."""
    worlds, place, views = numbers.shape[:-1], 0, {}
    for name, shape in shapes:
        count = int(np.prod(shape))
        views[name] = numbers[..., place : place + count].reshape(*worlds, *shape)
        place += count
    return views[shapes[0][0]] if is_single else views


def own_seed(seed: Any) -> int:
    """A seed of a scenario."""
    number = int(seed)
    if not 0 <= number < 2**64:
        raise ValueError(f"a seed is from 0 to 2^64 - 1, and not {seed}")
    return number


def flat_action(action: Any) -> NDArray[np.float32]:
    """The numbers of an action, whatever its shape."""
    return np.ascontiguousarray(action, dtype=np.float32).reshape(-1)
