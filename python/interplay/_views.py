"""What the environments of Gymnasium and PettingZoo have in common: spaces, infos, pictures, snapshots."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from . import _native
from ._spaces import flat_action, shaped_observation

#: Pictures that are not as high get a margin below, so that all of an episode have one size [px].
PICTURE_PX = (544, 720)
PICTURES_PER_S = 10


class Views:
    """What the environments of one and of many agents have in common: the spaces of a native environment."""

    def __init__(self, native: Any, observation: Any) -> None:
        described = native.observation_spaces()
        self.is_single = isinstance(observation, (str, Mapping))
        self.shapes: list[tuple[str, tuple[int, ...]]] = [(kind, tuple(shape)) for kind, shape, *_ in described]
        #: What the entries of the last axis are, by view.
        self.names: dict[str, list[str]] = {kind: names for kind, _, names, *_ in described}
        boxes: dict[str, spaces.Space[Any]] = {
            kind: spaces.Box(low, high, tuple(shape), np.float32) for kind, shape, _, low, high in described
        }
        if len(boxes) < len(described):
            raise ValueError("`observation` names a view twice")
        self.observation_space: spaces.Space[Any] = boxes[described[0][0]] if self.is_single else spaces.Dict(boxes)
        rows, count = native.action_space()
        self.action_space: spaces.Space[Any]
        if count is not None:
            self.action_space = spaces.Discrete(count)
        else:
            self.action_space = spaces.Box(-1.0, 1.0, (2,) if rows == 1 else (rows, 2), np.float32)

    def observed(self, numbers: NDArray[np.float32]) -> Any:
        """Numbers in the shapes of the views."""
        return shaped_observation(numbers, self.shapes, self.is_single)

    def acted(self, action: Any) -> NDArray[np.float32]:
        """The numbers of one action; what is none is a ValueError."""
        numbers = np.asarray(action)
        if numbers.dtype.kind not in "fiub":
            raise ValueError(f"an action is numbers, and not {action!r}")
        if numbers.shape != self.action_space.shape:
            raise ValueError(f"an action has the shape {self.action_space.shape}, and not {numbers.shape}")
        return flat_action(numbers)

    def planned(self, numbers: NDArray[np.float32]) -> Any:
        """Numbers as an action."""
        if isinstance(self.action_space, spaces.Discrete):
            return np.int64(numbers[0])
        return numbers.reshape(self.action_space.shape or (2,))


def info_of(native: _native.Environment, agent: int, ending: str | None) -> dict[str, Any]:
    """What an environment says of an agent beside what it sees: the terms of the reward, and how its episode ended, if it did."""
    info: dict[str, Any] = {"time_s": native.time_s, "reward_terms": native.terms(agent)}
    if (mask := native.action_mask(agent)) is not None:
        info["action_mask"] = np.array(mask, dtype=np.int8)
    return info if ending is None else {**info, "ending": ending, "is_success": ending == "goal"}


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


def of_size(picture: NDArray[np.uint8], size: tuple[int, int]) -> NDArray[np.uint8]:
    """A picture in the middle of another size: cut off, or with a margin in the colour of its last corner."""
    fitted = np.empty((*size, 3), dtype=np.uint8)
    fitted[:] = picture[-1, -1]
    high, wide = min(size[0], picture.shape[0]), min(size[1], picture.shape[1])
    fitted[:high, :wide] = picture[:high, :wide]
    return fitted
