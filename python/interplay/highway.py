"""The tasks ``highway-v0`` and ``merge-v0`` of HighwayEnv, with its settings, among drivers of Interplay."""

from __future__ import annotations

from typing import Any

from ._native import Scenario
from .envs import InterplayEnv, InterplayVectorEnv

#: What HighwayEnv rewards by default, where the reward has such terms: speed and contacts.
REWARD = {"progress": 0.0, "goal": 0.0, "speed": 0.4, "contact": -1.0, "off_road": -1.0, "hard_braking": 0.0, "gap": 0.0, "rule_broken": 0.0}
#: Distance between vehicles of one lane at the start, with density 1 [m].
SPACING_M = 40.0


def highway(
    lanes_count: int = 4, vehicles_count: int = 50, vehicles_density: float = 1.0, duration: float = 40.0, driver: Any = None
) -> Scenario:
    """A straight road with traffic around the ego; ``driver`` is that of the others, by default IDM and MOBIL."""
    spacing_m = SPACING_M / vehicles_density
    along_m = 40.0 + (vehicles_count // lanes_count // 4) * spacing_m
    ego = {"name": "ego", "start": {"lane": 1 % lanes_count, "along_m": along_m, "speed_mps": 25.0}, "goal": {"speed_mps": 30.0}}
    vehicles: list[dict[str, Any]] = [{**ego, "driver": {"kind": "idm"}}]
    for number in range(vehicles_count):
        row, lane = divmod(number, lanes_count)
        along_m = 40.0 + (row + 0.5 + 0.25 * (lane % 2)) * spacing_m
        start = {"lane": lane, "along_m": along_m, "speed_mps": 23.0 - 0.5 * (number % 5)}
        goal = {"speed_mps": 26.0 - number % 4 + lane}
        vehicles.append({"name": f"vehicle-{number + 1}", "start": start, "goal": goal, "driver": driver or {"kind": "idm"}})
    road = {"kind": "lanes", "lane_count": lanes_count, "lane_width_m": 4.0}
    title, shows = f"Highway with {vehicles_count} vehicles", "The ego drives fast among other vehicles"
    return Scenario.from_dict({"title": title, "shows": shows, "scale": "full", "duration_s": duration, "road": road, "vehicle": vehicles})


def merge(driver: Any = None) -> Scenario:
    """A road with two lanes that a vehicle joins from a lane that ends; the ego makes room or keeps ahead."""
    others = [("ahead", 1, 95.0, 29.0), ("beside", 2, 75.0, 31.0), ("behind", 1, 5.0, 31.5), ("merging", 0, 110.0, 20.0)]
    ego = {"name": "ego", "start": {"lane": 2, "along_m": 30.0, "speed_mps": 30.0}, "goal": {"speed_mps": 30.0}}
    vehicles: list[dict[str, Any]] = [{**ego, "driver": {"kind": "idm"}}]
    for name, lane, along_m, speed_mps in others:
        start = {"lane": lane, "along_m": along_m, "speed_mps": speed_mps}
        goal = {"speed_mps": 30.0, **({"lane": 1} if lane == 0 else {})}
        vehicles.append({"name": name, "start": start, "goal": goal, "driver": driver or {"kind": "idm"}})
    road = {"kind": "ramp-merge", "lane_count": 3, "lane_width_m": 4.0, "ramp_end_m": 310.0, "taper_m": 20.0}
    title, shows = "Merge with five vehicles", "A vehicle joins from a lane that ends, and the ego makes room"
    return Scenario.from_dict({"title": title, "shows": shows, "scale": "full", "duration_s": 14.0, "road": road, "vehicle": vehicles})


#: Settings of HighwayEnv: a decision a second among five meta-actions.
USUAL: dict[str, Any] = {"action": "DiscreteMeta", "decision_s": 1.0, "reward": REWARD}


def _highway(settings: dict[str, Any]) -> dict[str, Any]:
    road = {key: settings.pop(key) for key in ("lanes_count", "vehicles_count", "vehicles_density", "duration", "driver") if key in settings}
    shift_m = 0.2 * SPACING_M / road.get("vehicles_density", 1.0)
    return {"scenario": highway(**road), **USUAL, "perturb": {"position_m": shift_m, "speed_mps": 2.0}, **settings}


def highway_env(**settings: Any) -> InterplayEnv:
    """``interplay/Highway-v0``: settings of :func:`highway` and of :class:`interplay.envs.InterplayEnv`."""
    return InterplayEnv(**_highway(settings))


def highway_vector_env(**settings: Any) -> InterplayVectorEnv:
    """Many worlds of :func:`highway_env`."""
    return InterplayVectorEnv(**_highway(settings))


def merge_env(*, driver: Any = None, **settings: Any) -> InterplayEnv:
    """``interplay/Merge-v0``: see :func:`merge`."""
    return InterplayEnv(**{"scenario": merge(driver), **USUAL, **settings})


def merge_vector_env(*, driver: Any = None, **settings: Any) -> InterplayVectorEnv:
    """Many worlds of :func:`merge_env`."""
    return InterplayVectorEnv(**{"scenario": merge(driver), **USUAL, **settings})
