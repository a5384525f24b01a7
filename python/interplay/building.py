"""A building whose heat an agent decides."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ._library import Changes, ScenarioLike
from ._simulation import Simulation, Zone
from ._spaces import needs

needs("gymnasium", "rl")

import gymnasium
from gymnasium import spaces

#: What numbers are divided by: degrees of an error, and degrees outdoors.
ERROR_K, OUTDOOR_C = 10.0, 30.0


class BuildingEnv(gymnasium.Env[Any, Any]):
    """The heat of every zone, as a share of what its equipment can give, at every step of the building; an episode is a day.

    The observation is, for each zone, the error of its temperature (0 where it is free), whether a temperature is wanted, whether
    the zone is occupied, and the heat of the last step; then the time of day as a point on a circle, and the outdoor temperature of the
    last step. The reward is the sum of the terms in ``info["reward_terms"]``, each with its weight: ``discomfort``, in kelvins
    beyond the comfortable band times hours, and ``heat``, in kilowatt-hours.

    ``perturb`` draws weather and people anew for each episode, by the seed of the scenario.
    """

    metadata: dict[str, Any] = {"render_modes": [], "render_fps": 1}
    TERMS: ClassVar[dict[str, float]] = {"discomfort": -1.0, "heat": -0.05}

    def __init__(
        self,
        scenario: ScenarioLike = "building/four-room-pid",
        *,
        reward: Mapping[str, float] | None = None,
        perturb: bool = True,
        days: int = 1,
        set: Changes = None,
        render_mode: str | None = None,
    ) -> None:
        if unknown := [name for name in reward or {} if name not in self.TERMS]:
            raise ValueError(f"reward {unknown[0]!r}; choose from {', '.join(self.TERMS)}")
        self.render_mode, self._scenario, self._set, self._perturb = render_mode, scenario, set, perturb
        self._weights, self._days = {**self.TERMS, **(reward or {})}, days
        world = Simulation(scenario, set=set)
        zones = world.zones()
        if not zones:
            raise ValueError(f"`{world.scenario.source}` has no building")
        self.zones = [zone.name for zone in zones]
        self._limits = np.array([[zone.cooling_kw, zone.heating_kw] for zone in zones])
        self.observation_space = spaces.Box(-1.0, 1.0, (4 * len(zones) + 3,), np.float32)
        self.action_space = spaces.Box(-1.0, 1.0, (len(zones),), np.float32)
        self._world: Simulation | None = None

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begins a day. ``options={"seed": …}`` is the seed of the scenario itself."""
        super().reset(seed=seed)
        if options and (unknown := [name for name in options if name != "seed"]):
            raise ValueError(f"option {unknown[0]!r}; the only one is seed")
        own = (options or {}).get("seed")
        if own is None and self._perturb:
            own = int(self.np_random.integers(2**63))
        self._world = Simulation(self._scenario, set=self._set, seed=own)
        self._heats: NDArray[np.float64] = np.zeros(len(self.zones))
        self._outdoor_c, self._before_s = OUTDOOR_C / 3, 0.0
        return self._observed(self._world.zones()), {"time_s": 0.0}

    def _observed(self, zones: list[Zone]) -> NDArray[np.float32]:
        assert self._world is not None
        error = [0.0 if zone.reference_c is None else (zone.temperature_c - zone.reference_c) / ERROR_K for zone in zones]
        wanted = [float(zone.reference_c is not None) for zone in zones]
        occupied = [float(zone.band_k is not None) for zone in zones]
        angle = 2 * np.pi * (self._world.time_s / 86_400 % 1)
        rest = [np.sin(angle), np.cos(angle), self._outdoor_c / OUTDOOR_C]
        numbers = np.concatenate([error, wanted, occupied, self._heats, rest])
        seen: NDArray[np.float32] = np.clip(numbers, -1, 1).astype(np.float32)
        return seen

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Heats for one step of the building."""
        if self._world is None or self._world.is_over or self._world.time_s >= 86_400 * self._days:
            from ._native import RunError

            raise RunError("the episode is over, or none has begun: call reset")
        heats = np.asarray(action, dtype=np.float64)
        if heats.shape != self.action_space.shape or not np.isfinite(heats).all():
            raise ValueError(f"an action is {self.action_space.shape} finite numbers, and not {action!r}")
        self._heats = np.clip(heats, -1, 1)
        limits = np.where(self._heats < 0, self._limits[:, 0], self._limits[:, 1])
        self._world.apply_heats(self._heats * limits)
        self._world.step()
        while not self._world.is_over and (frame := self._world.frame()) is not None and not len(frame["heat_kw"]):
            self._world.step()
        frame = self._world.frame()
        assert frame is not None
        zones = self._world.zones()
        hours = (self._world.time_s - self._before_s) / 3600
        self._before_s, self._outdoor_c = self._world.time_s, float(frame["ambient_c"][0])
        beyond = [
            max(0.0, abs(zone.temperature_c - zone.reference_c) - zone.band_k)
            for zone in zones
            if zone.reference_c is not None and zone.band_k is not None
        ]
        terms = {"discomfort": hours * sum(beyond), "heat": hours * float(np.abs(frame["heat_kw"]).sum())}
        reward = sum(self._weights[name] * value for name, value in terms.items())
        is_over = self._world.is_over or self._world.time_s >= 86_400 * self._days - 1e-6
        return self._observed(zones), float(reward), False, is_over, {"time_s": self._world.time_s, "reward_terms": terms}
