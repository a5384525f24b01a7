"""A world that is stepped from Python."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from ._library import Changes, Frames, Report, ScenarioLike, load
from ._reports import Record, records


class Zone(NamedTuple):
    """A zone of a building before its next step."""

    name: str
    temperature_c: float
    #: The wanted temperature; none where it is free.
    reference_c: float | None
    #: Deviations from it that are comfortable; none while the zone is unoccupied.
    band_k: float | None
    #: The strongest heating.
    heating_kw: float
    #: The strongest cooling, at least 0.
    cooling_kw: float


class Simulation:
    """A scenario as a world that is stepped, looked at, steered from outside, copied and resumed.

    ``external`` are vehicles that are driven from here: each of them needs an input before every step. What happens depends on the
    scenario and on what is handed in, bit for bit.
    """

    def __init__(
        self, scenario: ScenarioLike, *, external: Sequence[str] = (), set: Changes = None, seed: int | None = None
    ) -> None:
        self.scenario = load(scenario, set=set, seed=seed)
        self._world = _native.Simulation(self.scenario, [external] if isinstance(external, str) else [*external])

    def step(self) -> bool:
        """Moves the world by a tick of the vehicles, or a step of the building; whether there was one left."""
        return self._world.step()

    @property
    def is_over(self) -> bool:
        """Whether the scenario is over, so that a step moves nothing."""
        return self._world.is_over

    @property
    def time_s(self) -> float:
        """Simulated time up to which the world has moved."""
        return self._world.time_s

    def frame(self) -> Frames | None:
        """The last tick, with a first axis of length 1; none before the first."""
        arrays = self._world.frame()
        return None if arrays is None else Frames({name: array for name, array in arrays.items() if name != "tick"})

    def observe(self, vehicle: str) -> Any:
        """The scene that the driver of a vehicle would plan from at the next tick: its own vehicle first, then those that it sees.

        ``vehicles``: names; ``state``: x_m, y_m, heading_rad, speed_mps of each; ``body_m``: front, rear, width, front axle, rear
        axle; ``prediction``: states from now to the end of the horizon; ``route``: along_m, across_m and the heading of the road
        beside each; ``goal``: a state; ``limits``: least and largest acceleration, largest steering angle, largest speed.
        """
        return Record(self._world.observe(vehicle))

    def apply(self, vehicle: str, acceleration_mps2: float, steering_rad: float) -> None:
        """Hands in the input of an external vehicle for the next step."""
        self._world.apply(vehicle, acceleration_mps2, steering_rad)

    def apply_plan(self, vehicle: str, inputs: ArrayLike) -> None:
        """Hands in a whole plan, which the others know: rows of acceleration and steering, one for each step of the horizon."""
        rows = np.ascontiguousarray(inputs, dtype=np.float64)
        if rows.ndim != 2:
            raise ValueError(f"a plan is rows of acceleration and steering, and not of the shape {rows.shape}")
        self._world.apply_plan(vehicle, rows)

    def zones(self) -> list[Zone]:
        """The zones of the building now."""
        return [Zone(*row) for row in self._world.zones()]

    def apply_heats(self, heat_kw: ArrayLike) -> None:
        """Hands in the heat of every zone for the next step of the building, negative for cooling; the controller is not asked."""
        self._world.apply_heats([float(heat) for heat in np.ravel(heat_kw)])

    def snapshot(self) -> _native.Snapshot:
        """A copy of all state."""
        return self._world.snapshot()

    def restore(self, snapshot: _native.Snapshot) -> None:
        """Goes back, or forth, to a snapshot."""
        self._world.restore(snapshot)

    def finish(self) -> Report:
        """Ends the run and says what was measured; the world cannot be stepped any more."""
        report: Any = records(self._world.finish())
        return Report(report)
