"""What the environments of Gymnasium and PettingZoo have in common: spaces, observations and pictures."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Union

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._spaces import flat_action, needs, shaped_observation

needs("gymnasium", "rl")

from gymnasium import spaces

#: Weights of the terms by name, or a function of the terms and ``info``.
Reward = Union[Mapping[str, float], Callable[[dict[str, Any], dict[str, Any]], Any], None]

#: Pictures that are not as high get a margin below, so that all of an episode have one size [px].
PICTURE_PX = (544, 720)
PICTURES_PER_S = 10


class Views:
    """What the environments of one and of many agents have in common: the spaces of a native environment."""

    def __init__(self, native: Any, observation: Any, is_flat: bool = False) -> None:
        described = native.observation_spaces()
        self.is_flat = is_flat
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
        if is_flat:
            bounds = [[low, high] for _, shape, _, low, high in described for _ in range(int(np.prod(shape)))]
            self.observation_space = spaces.Box(*np.array(bounds, np.float32).T, dtype=np.float32)
        rows, count = native.action_space()
        self.action_space: spaces.Space[Any]
        if count is not None:
            self.action_space = spaces.Discrete(count)
        else:
            self.action_space = spaces.Box(-1.0, 1.0, (2,) if rows == 1 else (rows, 2), np.float32)

    def observed(self, numbers: NDArray[np.float32]) -> Any:
        """Numbers in the shapes of the views, or in one row of all."""
        return numbers if self.is_flat else shaped_observation(numbers, self.shapes, self.is_single)

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


def of_size(picture: NDArray[np.uint8], size: tuple[int, int]) -> NDArray[np.uint8]:
    """A picture in the middle of another size: cut off, or with a margin in the colour of its last corner."""
    fitted = np.empty((*size, 3), dtype=np.uint8)
    fitted[:] = picture[-1, -1]
    high, wide = min(size[0], picture.shape[0]), min(size[1], picture.shape[1])
    fitted[:high, :wide] = picture[:high, :wide]
    return fitted


def weights_of(reward: Reward) -> Mapping[str, float] | None:
    """The weights of a reward that is not a function."""
    return None if callable(reward) else reward
