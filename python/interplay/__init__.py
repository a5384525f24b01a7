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

from ._library import Frames, Record, Report, check, identify, list, load, run
from ._native import RunError, Scenario, ScenarioError, Snapshot, __version__
from ._policies import PlannerPolicy, PolicyFunction, policy
from ._simulation import Simulation, Zone
from ._sweep import compare, sweep

__all__ = [
    "Frames",
    "PlannerPolicy",
    "PolicyFunction",
    "Record",
    "Report",
    "RunError",
    "Scenario",
    "ScenarioError",
    "Simulation",
    "Snapshot",
    "Zone",
    "__version__",
    "check",
    "compare",
    "identify",
    "list",
    "load",
    "policy",
    "run",
    "sweep",
]

if _util.find_spec("gymnasium") is not None:
    from ._registration import register as _register

    _register()
