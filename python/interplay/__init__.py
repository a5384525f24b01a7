"""Interplay in Python: agents that must interact, as a library and as environments for learning.

>>> import interplay
>>> report = interplay.run("lane-change/front-nice")
>>> report.passed
True

With Gymnasium installed, ``import interplay`` registers its environments:

>>> import gymnasium
>>> env = gymnasium.make("interplay/LaneChange-v0")
"""

import importlib.util as _util
from typing import Any as _Any

from ._library import Frames, Report, check, identify, list, load, run, run_many
from ._native import RunError, Scenario, ScenarioError, Snapshot, __version__
from ._policies import Network, PlannerPolicy, PolicyFunction, policy
from ._reports import Record, VehicleReport
from ._simulation import Simulation, Zone
from ._sweep import compare, sweep

__all__ = [
    "Frames",
    "Network",
    "PlannerPolicy",
    "PolicyFunction",
    "Record",
    "Report",
    "RunError",
    "Scenario",
    "ScenarioError",
    "Simulation",
    "Snapshot",
    "VehicleReport",
    "Zone",
    "__version__",
    "check",
    "compare",
    "identify",
    "list",
    "load",
    "policy",
    "run",
    "run_many",
    "sweep",
]

#: Modules that need an extra of the package; `interplay.envs` imports one when it is first used.
_MODULES = {"building": "gymnasium", "envs": "gymnasium", "highway": "gymnasium", "parallel": "pettingzoo", "sb3": "stable_baselines3", "streets": "gymnasium"}


def __getattr__(name: str) -> _Any:
    if name not in _MODULES:
        raise AttributeError(f"module 'interplay' has no attribute {name!r}")
    from ._spaces import needs

    needs(_MODULES[name], "sb3" if name == "sb3" else "rl")
    return needs(f"interplay.{name}", "rl")


if _util.find_spec("gymnasium") is not None:
    from ._registration import register as _register

    _register()
