"""Snapshots of the environments of Gymnasium and PettingZoo."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from . import _native


@dataclass(frozen=True)
class EnvSnapshot:
    """All state of an environment, its random numbers included; it can be restored any number of times, and pickled.

    Unpickling repeats the episode, which takes as long as it took.
    """

    native: _native.Environment
    scenario: _native.Scenario
    is_seeded: bool
    random: Any
    #: The agents that are still there, of an environment with several.
    agents: tuple[str, ...] = ()


def copied(snapshot: EnvSnapshot, agents: list[str]) -> _native.Environment:
    """The native environment of a snapshot, for an environment with these agents."""
    if snapshot.native.agents != agents:
        raise ValueError(f"the snapshot is of an environment with the agents {snapshot.native.agents}, and not {agents}")
    return copy.deepcopy(snapshot.native)


def without_window(state: Mapping[str, Any]) -> dict[str, Any]:
    """The attributes of an environment that its copies have, too: all but the window."""
    return {**state, "_window": None} if "_window" in state else dict(state)
