"""Many worlds for stable-baselines3, stepped in one call on all cores."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from . import _native
from ._spaces import needs

needs("stable_baselines3", "sb3")

from stable_baselines3.common.vec_env.base_vec_env import VecEnv as BaseVecEnv

from .envs import InterplayVectorEnv


class VecEnv(BaseVecEnv):
    """:class:`interplay.envs.InterplayVectorEnv` as stable-baselines3 takes it; settings are those of that one."""

    def __init__(self, scenario: Any = "lane-change/front-nice", *, num_envs: int = 8, **settings: Any) -> None:
        self.worlds = InterplayVectorEnv(scenario, num_envs=num_envs, autoreset_mode="SameStep", **settings)
        num_envs, self._each = self.worlds.num_envs, self.worlds.num_envs // num_envs
        super().__init__(num_envs, self.worlds.single_observation_space, self.worlds.single_action_space)
        self._actions: Any = None
        self._returns = np.zeros(num_envs)
        self._lengths = np.zeros(num_envs, dtype=np.int64)

    def reset(self) -> Any:
        """Begins an episode in every world, with the seeds that were set."""
        own = self._seeds[:: self._each]
        seeds = own if any(seed is not None for seed in own) else None
        seen, info = self.worlds.reset(seed=seeds)
        self._reset_seeds()
        self._reset_options()
        self._returns[:], self._lengths[:] = 0.0, 0
        self.reset_infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        return seen

    def step_async(self, actions: Any) -> None:
        """Takes the actions."""
        self._actions = actions

    def step_wait(self) -> Any:
        """Steps all worlds; episodes that end begin anew, with what a ``Monitor`` would say of them."""
        seen, rewards, terminated, truncated, info = self.worlds.step(self._actions)
        over = terminated | truncated
        self._returns += rewards
        self._lengths += 1
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for world in np.flatnonzero(over):
            infos[world] = {
                "terminal_observation": info["final_obs"][world],
                "TimeLimit.truncated": bool(truncated[world]),
                "ending": info["ending"][world],
                "is_success": bool(info["is_success"][world]),
                "episode": {"r": float(self._returns[world]), "l": int(self._lengths[world]), "t": 0.0},
            }
        self._returns[over], self._lengths[over] = 0.0, 0
        return seen, rewards.astype(np.float32), over, infos

    def close(self) -> None:
        """Nothing is left open."""

    def get_images(self) -> Sequence[Any]:
        """The picture of each world."""
        return list(self.worlds.render() or ())

    def action_masks(self) -> Any:
        """Which meta-actions can be done now, for ``MaskablePPO``."""
        return self.worlds.action_masks()

    def planned(self, planner: _native.Planner, agent: str | int | None = None) -> Any:
        """The actions of an Interplay planner in all worlds now; see :func:`interplay.policy`."""
        return self.worlds.planned(planner, agent)

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """An attribute of the worlds, once for each."""
        return [getattr(self.worlds, attr_name)] * len(self._places(indices))

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Sets an attribute of all worlds."""
        setattr(self.worlds, attr_name, value)

    def env_method(self, method_name: str, *method_args: Any, indices: Any = None, **method_kwargs: Any) -> list[Any]:
        """Calls a method of the worlds and returns the results of those selected."""
        found = getattr(self.worlds, method_name)(*method_args, **method_kwargs)
        return [found[place] for place in self._places(indices)]

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        """No world is in a wrapper; episodes are reported as ``Monitor`` does."""
        return [False] * len(self._places(indices))

    def _places(self, indices: Any) -> Sequence[int]:
        return list(self._get_indices(indices))
