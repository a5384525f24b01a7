"""Scenarios, runs and reports."""

from __future__ import annotations

import builtins
import copy
import json
import os
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from . import _native
from ._native import Scenario
from ._reports import Entry, Record, VehicleReport, records
from ._spaces import needs, own_seed

if TYPE_CHECKING:
    import pandas as pd

    from ._policies import Planner

ScenarioLike = Union[str, "os.PathLike[str]", Scenario]
Changes = Union[Mapping[str, Any], Sequence[str], None]


def as_json(value: Any) -> str:
    """A value as JSON, arrays and numbers of NumPy included."""

    def plain(entry: Any) -> Any:
        if hasattr(entry, "tolist"):
            return entry.tolist()
        raise TypeError(f"a scenario cannot hold {entry!r}; choose numbers, texts, lists and dictionaries")

    if not isinstance(value, Mapping):
        raise TypeError(f"a scenario is a dictionary with the keys of a scenario file, and not {value!r}")
    return json.dumps(dict(value), default=plain)


def toml_value(value: Any) -> str:
    """A value as TOML, for ``set``."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{json.dumps(key)} = {toml_value(entry)}" for key, entry in value.items() if entry is not None) + " }"
    if isinstance(value, Sequence) or isinstance(value, np.ndarray):
        return "[" + ", ".join(toml_value(entry) for entry in value) + "]"
    if isinstance(value, np.generic):
        return toml_value(value.item())
    if isinstance(value, (int, float)):
        return repr(value)
    raise TypeError(f"a scenario cannot hold {value!r}; choose numbers, texts, lists and dictionaries")


def changes(set: Changes) -> builtins.list[str]:
    """Changes as ``--set`` takes them: ``PATH=VALUE``."""
    if set is None:
        return []
    if isinstance(set, str):
        return [set]
    if isinstance(set, Mapping):
        return [f"{path}={toml_value(value)}" for path, value in set.items()]
    return builtins.list(set)


def load(name_or_path: ScenarioLike, *, set: Changes = None, seed: int | None = None, planner: str | None = None) -> Scenario:
    """Reads a scenario: a name of :func:`interplay.list`, or the path of a file.

    ``set`` are changes by path, such as ``{"vehicle.ego.goal.speed_mps": 1.2}``; ``planner`` is a kind of driver for the ego.
    Raises :class:`interplay.ScenarioError` with ``file``, ``line``, ``column``, ``key`` and ``faults``.
    """
    if seed is not None:
        seed = own_seed(seed)
    if isinstance(name_or_path, Scenario):
        if set is None and seed is None and planner is None:
            return name_or_path
        before, old_seed, old_planner = name_or_path.changes
        set, seed = [*before, *changes(set)], old_seed if seed is None else seed
        name_or_path, planner = name_or_path.source, planner or old_planner
    return Scenario.load(os.fspath(name_or_path), changes(set), seed, planner)


def list() -> builtins.list[Entry]:
    """The scenarios of the package: name, title, what each shows, figure of the dissertation."""
    names = ("name", "title", "shows", "figure")
    return [Entry(zip(names, row)) for row in _native.list_scenarios()]


def check(name_or_path: ScenarioLike, *, set: Changes = None) -> builtins.list[str]:
    """Checks a scenario without running it; returns what is allowed and may not have been meant."""
    return load(name_or_path, set=set).remarks


class Frames(Mapping[str, Any]):
    """The ticks of a run as arrays by name; the first axis is time.

    ``about`` has unit and axes of each: ``{"speed_mps": ("m/s", ("time", "vehicle"))}``.
    """

    _AXES = {
        "time_s": ("time",),
        "gap_m": ("time",),
        "plan": ("time", "vehicle", "step", "x_m, y_m, heading_rad, speed_mps"),
        "building_time_s": ("building_time",),
        "ambient_c": ("building_time",),
        "forecast_c": ("building_time",),
    }
    _ZONE = ("temperature_c", "next_c", "reference_c", "band_k", "requested_kw", "heat_kw", "gains_kw")
    _UNITS = {"_m": "m", "_s": "s", "_rad": "rad", "_mps": "m/s", "_mps2": "m/s²", "_c": "°C", "_k": "K", "_kw": "kW"}

    def __init__(self, arrays: Mapping[str, Any]) -> None:
        self._arrays = dict(arrays)
        self.vehicles: builtins.list[str] = self._arrays.pop("vehicles", [])

    def __getitem__(self, name: str) -> Any:
        return self._arrays[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._arrays)

    def __len__(self) -> int:
        return len(self._arrays)

    @property
    def about(self) -> dict[str, tuple[str, tuple[str, ...]]]:
        """Unit and axes of each array."""

        def unit(name: str) -> str:
            if name == "plan":
                return "m, m, rad, m/s"
            ends = [end for end in self._UNITS if name.endswith(end)]
            return self._UNITS[max(ends, key=len)] if ends else "1"

        def axes(name: str) -> tuple[str, ...]:
            usual = ("building_time", "zone") if name in self._ZONE else ("time", "vehicle")
            return self._AXES.get(name, usual)

        return {name: (unit(name), axes(name)) for name in self}

    def __repr__(self) -> str:
        return "<Frames " + ", ".join(f"{name} {np.shape(array)}" for name, array in self._arrays.items()) + ">"


class RecordedTicks:
    """The ticks of a run that has come from another process."""

    def __init__(self, recorded: _native.RecordedRun) -> None:
        self._frames, self._summary, self._scenario = recorded.frames(), recorded.summary(), recorded.scenario()

    def frames(self) -> dict[str, Any]:
        """All ticks as arrays by name."""
        return dict(self._frames)

    def summary(self) -> str:
        """The words of ``interplay run``."""
        return self._summary

    def animation(self, format: str) -> bytes:
        """The moving picture, for which the scenario is run again."""
        if "python" in self._scenario.drivers:
            raise _native.RunError("a run with a function of Python is drawn in the process in which it was made")
        return _native.run(self._scenario).animation(format)


class Report(Record):
    """What was measured in a run, with the keys of ``interplay run --json``, which are attributes, too."""

    scenario: str
    passed: bool
    seed: int
    simulated_s: float
    wall_s: float
    digest: str
    phase_digests: Any
    collisions: builtins.list[Any]
    contact_by_ego: bool
    min_gap_m: float | None
    smallest_gap: Any
    shortest_time_to_collision: Any
    right_of_way: builtins.list[Any]
    broken_rules: builtins.list[Any]
    deadlocks: builtins.list[Any]
    order: builtins.list[str]
    vehicles: builtins.list[VehicleReport]
    building: Any
    expectations: builtins.list[Any]
    counterfactuals: builtins.list[Any]
    _recorded: _native.RecordedRun | RecordedTicks | None = None

    @classmethod
    def of(cls, recorded: _native.RecordedRun) -> Report:
        """The report of a run with its ticks."""
        report = cls(records(recorded.report()))
        object.__setattr__(report, "_recorded", recorded)
        return report

    def __deepcopy__(self, memo: dict[int, Any]) -> Report:
        return self._copied(copy.deepcopy(dict(self), memo), self._recorded)

    def __reduce__(self) -> tuple[Any, ...]:
        recorded = self._recorded
        if isinstance(recorded, _native.RecordedRun):
            recorded = RecordedTicks(recorded)
        return Report._copied, (dict(self), recorded)

    @classmethod
    def _copied(cls, table: dict[str, Any], recorded: Any) -> Report:
        report = cls(table)
        if recorded is not None:
            object.__setattr__(report, "_recorded", recorded)
        return report

    def _run(self) -> _native.RecordedRun | RecordedTicks:
        if self._recorded is None:
            raise _native.RunError("only `interplay.run` keeps all ticks")
        return self._recorded

    def __repr__(self) -> str:
        return f"<Report of {self['scenario']!r}, seed {self['seed']}: {'passed' if self['passed'] else 'failed'}>"

    def __str__(self) -> str:
        return self.summary() if self._recorded is not None else repr(self)

    def to_dict(self) -> dict[str, Any]:
        """The report as plain dictionaries and lists."""
        plain: dict[str, Any] = json.loads(json.dumps(self))
        return plain

    def frames(self) -> Frames:
        """All ticks as arrays."""
        return Frames(self._run().frames())

    def to_pandas(self) -> pd.DataFrame:
        """All ticks of all vehicles, or of all zones, as one table: a row for each of them at each time."""
        pd = needs("pandas", "pandas")
        frames = self.frames()
        axes = {name: axes for name, (_, axes) in frames.about.items()}
        of_vehicles = [name for name in frames if axes[name] == ("time", "vehicle")]
        if of_vehicles:
            count = len(frames.vehicles)
            table = {"time_s": np.repeat(frames["time_s"], count), "vehicle": frames.vehicles * len(frames["time_s"])}
            return pd.DataFrame({**table, **{name: frames[name].ravel() for name in of_vehicles}})
        of_zones = [name for name in frames if axes[name] == ("building_time", "zone")]
        times, count = frames["building_time_s"], frames[of_zones[0]].shape[1]
        table = {"time_s": np.repeat(times, count), "zone": builtins.list(range(count)) * len(times)}
        return pd.DataFrame({**table, **{name: frames[name].ravel() for name in of_zones}})

    def animation(self, format: str = "gif") -> bytes:
        """The moving picture of the run, as the bytes of a ``gif``, ``webp`` or ``png`` (a filmstrip)."""
        return self._run().animation(format)

    def summary(self) -> str:
        """The words of ``interplay run``."""
        return self._run().summary()

    def _repr_html_(self) -> str:
        """What a notebook shows: the moving picture, and the summary below it."""
        import base64
        import html

        words = html.escape(self.summary()) if self._recorded is not None else html.escape(json.dumps(self, indent=1))
        picture = ""
        if self._recorded is not None:
            data = base64.b64encode(self.animation("webp")).decode()
            picture = f'<img alt="animation of the run" src="data:image/webp;base64,{data}">'
        return f"<div>{picture}<pre>{words}</pre></div>"


def run(
    scenario: ScenarioLike,
    planner: Planner = None,
    *,
    set: Changes = None,
    seed: int | None = None,
    record: str | os.PathLike[str] | None = None,
    animate: str | os.PathLike[str] | None = None,
    trajectories: str | os.PathLike[str] | None = None,
    detectors: str | os.PathLike[str] | None = None,
    series: str | os.PathLike[str] | None = None,
    export: str | os.PathLike[str] | None = None,
) -> Report:
    """Runs a scenario to its end and returns its report.

    ``planner`` drives the ego instead of the scenario's choice: a kind of driver, :func:`interplay.policy` with its settings, the path
    of a network (``.safetensors``), or ``{name: function}``, where the function maps an observation to an action
    (:class:`interplay.PolicyFunction`); what it raises is raised when the run is over.

    The others are files to be written, as by the flags of ``interplay run``: ``record`` (``.rrd``), ``animate`` (``.gif``,
    ``.webp``, ``.png`` or ``.mp4``), the tables ``trajectories``, ``detectors`` and ``series`` (``.csv`` or ``.parquet``), and
    ``export``, a scenario of CommonRoad with its solution beside it (``.xml``).
    """
    asked = {"animate": animate, "trajectories": trajectories, "detectors": detectors, "series": series, "export": export}
    outputs = {flag: os.fspath(path) for flag, path in asked.items() if path is not None}
    return _run(scenario, planner, set, seed, None if record is None else os.fspath(record), outputs, None)


def _run(
    scenario: ScenarioLike,
    planner: Planner,
    set: Changes,
    seed: int | None,
    record: str | None,
    outputs: dict[str, str],
    is_cancelled: Callable[[], bool] | None,
) -> Report:
    from ._policies import resolved

    kind, settings, function = resolved(planner)
    if settings is not None:
        set = [*changes(set), f"vehicle.ego.driver={toml_value(settings)}"]
    loaded = load(scenario, set=set, seed=seed, planner=kind)
    if function is None:
        return Report.of(_native.run(loaded, record, outputs, is_cancelled))
    function.function.seed = loaded.seed
    with function:
        recorded = _native.run(loaded, record, outputs, is_cancelled)
        function.raise_failure()
    return Report.of(recorded)


def run_many(
    scenarios: ScenarioLike | Sequence[ScenarioLike],
    planners: Planner | Sequence[Planner] = None,
    seeds: Sequence[int | None] | None = None,
    jobs: int | None = None,
    *,
    set: Changes = None,
) -> builtins.list[Report]:
    """Runs every scenario with every planner and every seed, and returns the reports in this order, the seeds fastest.

    ``jobs`` is the number of runs side by side, by default one for each core. The reports do not depend on it. The first error ends
    all runs and is raised.
    """
    from concurrent.futures import ThreadPoolExecutor

    listed = [scenarios] if isinstance(scenarios, (str, os.PathLike, Scenario)) else [*scenarios]
    drivers: builtins.list[Any] = [*planners] if isinstance(planners, (builtins.list, tuple)) else [planners]
    every = [(scenario, planner, seed) for scenario in listed for planner in drivers for seed in ([None] if seeds is None else seeds)]
    count = (os.cpu_count() or 1) if jobs is None else jobs
    if not 1 <= count <= 1024:
        raise ValueError(f"`jobs` is from 1 to 1024, and not {jobs}")
    ended, pool = threading.Event(), ThreadPoolExecutor(count)
    try:
        futures = [pool.submit(_run, scenario, planner, set, seed, None, {}, ended.is_set) for scenario, planner, seed in every]
        return [future.result() for future in futures]
    except BaseException:
        ended.set()
        raise
    finally:
        pool.shutdown(wait=False, cancel_futures=True)


def identify(table: Any, mapping: Any, *, scenario: str | os.PathLike[str] | None = None) -> Any:
    """Finds thermal parameters in telemetry: the document of ``interplay identify --json``.

    ``table`` is a pandas table or the path of a CSV file, ``mapping`` says which column is what (``interplay identify --help``): a
    dictionary or the path of a TOML file. With ``scenario`` a scenario with the network that was found is written there; a file that
    exists is never overwritten.
    """
    if hasattr(table, "to_csv"):
        text, name = table.to_csv(index=False), "table"
    else:
        text, name = Path(table).read_text(encoding="utf-8-sig"), os.fspath(table)
    if isinstance(mapping, Mapping):
        described, where = "\n".join(f"{key} = {toml_value(value)}" for key, value in mapping.items()), "mapping"
    else:
        described, where = Path(mapping).read_text(encoding="utf-8-sig"), os.fspath(mapping)
    report, summary, found = _native.identify(text, described, (name, where))
    result: Record = records(report)
    object.__setattr__(result, "summary", lambda: summary)
    if scenario is not None:
        if found is None:
            raise _native.RunError(f"{name}: no network was found that a scenario could hold")
        with open(scenario, "x", encoding="utf-8") as file:
            file.write(found)
    return result
