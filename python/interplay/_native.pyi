"""The native half of the package: JSON, numbers and arrays, of which the modules beside it make objects."""

import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "Batch",
    "Environment",
    "Planner",
    "RecordedRun",
    "RunError",
    "Scenario",
    "ScenarioError",
    "Simulation",
    "Snapshot",
    "__version__",
    "driver_kinds",
    "identify",
    "list_scenarios",
    "main",
    "register_policy",
    "remove_policy",
    "run",
    "scenario_names",
    "sweep",
]

__version__: str

#: A path as a native function takes it.
_Path = str | os.PathLike[str]
#: A view of a scene: kind, shape, names of the last axis, lowest and highest number.
_Space = tuple[str, list[int], list[str], float, float]
#: A function from a flat observation, and the kind and shape of each view in it, to a flat action.
_Policy = Callable[[NDArray[np.float32], list[tuple[str, list[int]]]], NDArray[np.float32]]

class ScenarioError(ValueError):
    """A scenario, a plan or a mapping is refused; the attributes say where the first fault is."""

    file: str | None
    line: int | None
    column: int | None
    #: The key that is at fault, such as ``speed_mps``.
    key: str | None
    #: All faults: file, line and column, what is wrong, and what would work.
    faults: list[tuple[str | None, tuple[int, int] | None, str, str | None]]

class RunError(RuntimeError):
    """A run could not be finished, or a result could not be written."""

@final
class Scenario:
    """A scenario that was read and checked; it does not change."""

    @staticmethod
    def load(source: str, sets: Sequence[str] = ..., seed: int | None = None, planner: str | None = None) -> Scenario:
        """Reads a scenario: a name or a path, with changes such as ``vehicle.ego.goal.speed_mps=1.2``."""

    @staticmethod
    def from_toml(text: str, name: str = "scenario.toml") -> Scenario:
        """Reads the text of a scenario file; ``name`` is its name in errors, and paths in it are relative to it."""

    @staticmethod
    def from_dict(table: Mapping[str, Any]) -> Scenario:
        """The scenario of a dictionary with the keys of a scenario file; ``extends`` may name another scenario."""

    @staticmethod
    def written(text: str, seed: int, name: str, source: str, changes: tuple[list[str], int | None, str | None]) -> Scenario:
        """The scenario of a file as it was when it was pickled."""

    def __eq__(self, other: object) -> bool: ...
    def __hash__(self) -> int: ...
    def __deepcopy__(self, _memo: Any) -> Scenario: ...
    def to_toml(self) -> str:
        """The scenario as a file: everything stated."""

    @property
    def name(self) -> str:
        """What it is called in reports."""

    @property
    def source(self) -> str:
        """The name or path from which it was loaded."""

    @property
    def changes(self) -> tuple[list[str], int | None, str | None]:
        """The changes with which it was loaded: those of `set`, the seed, and the planner."""

    def __reduce__(self) -> tuple[Any, tuple[str, int, str, str, tuple[list[str], int | None, str | None]]]: ...

    @property
    def title(self) -> str:
        """Its title."""

    @property
    def shows(self) -> str:
        """What is to be seen in it."""

    @property
    def seed(self) -> int:
        """The seed of all random numbers."""

    @property
    def duration_s(self) -> float:
        """How long it lasts."""

    @property
    def step_s(self) -> float:
        """Time from one state of a plan to the next."""

    @property
    def horizon_steps(self) -> int:
        """How many steps a plan has."""

    @property
    def vehicles(self) -> list[str]:
        """The names of the vehicles, obstacles last."""

    @property
    def drivers(self) -> list[str]:
        """The kind of driver of each vehicle."""

    @property
    def obstacles(self) -> list[str]:
        """The names of the obstacles: parked cars, cones, walls."""

    @property
    def default_agents(self) -> list[str]:
        """The names of the vehicles that are agents of an environment unless others are named: their drivers decide what to do."""

    @property
    def has_building(self) -> bool:
        """Whether it has a building."""

    @property
    def remarks(self) -> list[str]:
        """What is allowed and may not have been meant."""

@final
class Snapshot:
    """All state of a world; it outlives the world."""

    @property
    def time_s(self) -> float:
        """Simulated time."""

    def to_json(self) -> str:
        """The snapshot as text."""

    @staticmethod
    def from_json(text: str) -> Snapshot:
        """The snapshot of such a text: it repeats the run, which takes as long as the run took."""

    def __reduce__(self) -> tuple[Any, tuple[str]]: ...
    def __deepcopy__(self, _memo: Any) -> Snapshot: ...

@final
class Simulation:
    """A scenario as a world that is stepped."""

    def __new__(cls, scenario: Scenario, external: Sequence[str] = ...) -> Simulation:
        """The world before its first tick; ``external`` vehicles are driven from Python."""

    @staticmethod
    def resumed(snapshot: Snapshot) -> Simulation:
        """A world that continues from a snapshot."""

    def __reduce__(self) -> tuple[Any, tuple[Snapshot]]: ...
    def __deepcopy__(self, _memo: Any) -> Simulation: ...
    def step(self) -> bool:
        """Moves the world by a tick or a step of the building; whether there was one left."""

    @property
    def is_over(self) -> bool:
        """Whether the scenario is over."""

    @property
    def time_s(self) -> float:
        """Simulated time up to which the world has moved."""

    def frame(self) -> dict[str, Any] | None:
        """The last tick as arrays by name, with its number as ``tick``; none before the first."""

    def observe(self, vehicle: str) -> dict[str, Any]:
        """What the driver of a vehicle would be given at the next tick."""

    def apply(self, vehicle: str, acceleration_mps2: float, steering_rad: float) -> None:
        """Hands in the input of an external vehicle for the next tick."""

    def apply_plan(self, vehicle: str, inputs: NDArray[np.float64]) -> None:
        """The same with a plan: a row of acceleration and steering for each step of the horizon."""

    def zones(self) -> list[tuple[str, float, float | None, float | None, float, float]]:
        """The zones: name, temperature, wanted temperature, comfortable deviation, strongest heating and cooling."""

    def apply_heats(self, heat_kw: Sequence[float]) -> None:
        """Hands in the heat of every zone for the next step of the building."""

    def snapshot(self) -> Snapshot:
        """A copy of all state."""

    def restore(self, snapshot: Snapshot) -> None:
        """Goes back, or forth, to a snapshot."""

    def finish(self) -> str:
        """Ends the run and returns its report as JSON."""

@final
class Environment:
    """A scenario in which some vehicles are driven from Python, episode by episode."""

    def __new__(cls, scenario: Scenario, settings_json: str) -> Environment:
        """An environment before its first episode."""

    @staticmethod
    def repeated(scenario: Scenario, settings_json: str, saved: str) -> Environment:
        """An environment in the middle of an episode, which it repeats from its text."""

    def __reduce__(self) -> tuple[Any, tuple[Scenario, str, str]]: ...
    def __deepcopy__(self, _memo: Any) -> Environment: ...
    @property
    def street(self) -> str | None:
        """The name of the street of the episode, if streets are drawn."""

    @property
    def agents(self) -> list[str]:
        """The names of the agents' vehicles."""

    @property
    def decision_s(self) -> float:
        """Time from one decision to the next."""

    def observation_spaces(self) -> list[_Space]:
        """What one agent sees."""

    def action_space(self) -> tuple[int | None, int | None]:
        """How many rows of two numbers an action has, or of how many meta-actions it is one."""

    @staticmethod
    def reward_terms() -> list[str]:
        """The names of the terms of the reward."""

    def reset(self, seed: int | None = None) -> None:
        """Begins an episode: of a new sequence if there is a seed, else the next of the sequence."""

    def reset_as_written(self, seed: int) -> None:
        """Begins the episode of the scenario as it is written."""

    def step(self, actions: NDArray[np.float32]) -> None:
        """Moves the world by one decision of every agent."""

    def observe(self, agent: int) -> NDArray[np.float32]:
        """What an agent sees now, in a new flat array."""

    def outcome(self, agent: int) -> tuple[float, bool, bool, str | None]:
        """Reward, terminated, truncated and how the episode ended, of an agent in the last decision."""

    def terms(self, agent: int) -> dict[str, float]:
        """The terms of the reward of an agent in the last decision."""

    @property
    def is_live(self) -> bool:
        """Whether any agent's episode goes on."""

    @property
    def time_s(self) -> float:
        """Simulated time; 0 before the first episode."""

    def action_mask(self, agent: int) -> list[bool] | None:
        """Which meta-actions an agent can do now; none where actions are numbers."""

    def states(self) -> list[tuple[str, list[float]]]:
        """Position, heading and speed of every vehicle now, by name."""

    def finish(self) -> str | None:
        """Ends the episode and returns its report as JSON; none before the first."""

    def picture(self) -> NDArray[np.uint8] | None:
        """The world from above: rows, columns and red, green, blue; none before the first episode."""

@final
class Planner:
    """A planner with all that it remembers, for the agents of one environment."""

    def __new__(cls, driver_json: str) -> Planner:
        """A planner of a kind with settings, as ``driver`` of a scenario file takes them."""

    def act(self, environment: Environment, agent: int) -> NDArray[np.float32]:
        """Its action for an agent now."""

    def act_in(self, batch: Batch, world: int) -> NDArray[np.float32]:
        """The same for a world of a batch."""

    def forget(self, which: int | None = None) -> None:
        """Forgets all that it remembers of an agent or a world, or of all."""

@final
class Batch:
    """Worlds that are stepped side by side, on all cores; a row is an agent, those of the first world first."""

    def __new__(cls, scenarios: Sequence[Scenario], settings_json: str, autoreset: str) -> Batch:
        """A world of each scenario; ``autoreset`` is ``next_step``, ``same_step`` or ``disabled``."""

    def observation_spaces(self) -> list[_Space]:
        """What one agent sees."""

    def action_space(self) -> tuple[int | None, int | None]:
        """How many rows of two numbers an action has, or of how many meta-actions it is one."""

    @property
    def decision_s(self) -> float:
        """Time from one decision to the next."""

    def reset(self, seeds: Sequence[int | None], which: Sequence[bool]) -> None:
        """Begins episodes where ``which`` says so, each with its seed or the next of its sequence."""

    def observe(self) -> NDArray[np.float32]:
        """What all agents see now, a row an agent."""

    def step(
        self, actions: NDArray[np.float32]
    ) -> tuple[
        NDArray[np.float32],
        NDArray[np.float32],
        NDArray[np.float64],
        NDArray[np.bool_],
        NDArray[np.bool_],
        NDArray[np.float64],
        NDArray[np.bool_],
        list[str | None],
    ]:
        """Steps all worlds; returns observations, last observations, rewards, terminated, truncated, terms, agents that go on, endings."""

    def action_masks(self) -> list[list[bool] | None]:
        """Which meta-actions each agent can do now."""

    def agents(self, world: int) -> list[str]:
        """The names of the agents' vehicles in a world."""

    def about(self, world: int) -> tuple[float, str | None]:
        """Simulated time of a world, and the name of its street, where streets are drawn."""

    def states(self, world: int) -> list[tuple[str, list[float]]]:
        """The state of every vehicle of a world."""

    def picture(self, world: int) -> NDArray[np.uint8] | None:
        """The picture of a world; none before the first episode."""

@final
class Network:
    """A trained network of a ``.safetensors`` file."""

    def __new__(cls, file: str) -> Network:
        """Reads the file."""

    def about(self) -> tuple[str, str, str]:
        """The views and the kind of action as JSON, and the digest of the file."""

    def decide(self, observation: NDArray[np.float32]) -> tuple[list[float], list[float]]:
        """The outputs of the last layer for one flat observation, and the flat action."""

@final
class RecordedRun:
    """A finished run: its report, and all its ticks."""

    def report(self) -> str:
        """The report as JSON."""

    def scenario(self) -> Scenario:
        """The scenario, as a value that can be run again."""

    def summary(self) -> str:
        """The words of ``interplay run``."""

    def frames(self) -> dict[str, Any]:
        """All ticks as arrays by name."""

    def animation(self, format: str) -> bytes:
        """The moving picture, as the bytes of a file: ``gif``, ``webp`` or ``png``."""

def main(arguments: Sequence[str]) -> int:
    """Runs the command with these arguments, of which the first is its name, and returns the exit code."""

def list_scenarios() -> list[tuple[str, str, str, str | None]]:
    """The scenarios in the package: name, title, what it shows, figure of the dissertation."""

def scenario_names() -> list[str]:
    """The names of the scenarios in the package."""

def driver_kinds() -> list[str]:
    """The kinds of drivers."""

def run(
    scenario: Scenario,
    record: _Path | None = None,
    outputs: dict[str, str] | None = None,
    is_cancelled: Callable[[], bool] | None = None,
) -> RecordedRun:
    """Runs a scenario and its counterfactuals, and writes a recording and the outputs of these flags."""

def sweep(
    source: str,
    folder: _Path,
    text: str | None = None,
    jobs: int | None = None,
    samples: int | None = None,
    keep_failures: bool = False,
) -> tuple[str, int, int]:
    """Runs a plan, and returns the path of its table, how many runs were made, and how many have no result."""

def identify(table: str, mapping: str, names: tuple[str, str]) -> tuple[str, str, str | None]:
    """Finds thermal parameters in a table; returns report as JSON, summary and scenario."""

def register_policy(name: str, registration: int, function: _Policy) -> bool:
    """Registers a function under a name and a number; whether the place was free."""

def remove_policy(name: str, registration: int) -> None:
    """Takes away a registered function."""
