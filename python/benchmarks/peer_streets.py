"""The streets of HighwayEnv and EnvPool as scenarios of Interplay: as many vehicles, in the same lanes, with the same time steps.

``python peer_streets.py DIR`` writes them as files, for ``interplay run`` and for profilers.
"""

from __future__ import annotations

import random
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True)
class Street:
    """A street, and what it is called elsewhere."""

    name: str
    peer: str
    envpool: str
    #: Time steps of the simulation a second of HighwayEnv and EnvPool.
    rate_hz: int
    duration_s: float
    road: str
    place: Callable[[random.Random], list[tuple[str, str, str, float]]]
    #: Rows of the observation.
    rows: int = 5
    #: What is not equal beside it.
    unequal: list[str] = field(default_factory=list)

    def toml(self, driver: str, *, horizon_steps: int = 30, rate_hz: int | None = None, plans_a_second: float | None = None) -> str:
        """The scenario with one driver for all but the agent. Without ``plans_a_second``, every step begins with a plan."""
        step_s = 1.0 / (rate_hz or self.rate_hz)
        planning = "" if plans_a_second is None else f"planning_period_s = {1.0 / plans_a_second!r}\n"
        text = f"""title = "{self.name} of HighwayEnv"
shows = "Traffic around an agent"
scale = "full"
duration_s = {self.duration_s!r}
step_s = {step_s!r}
{planning}horizon_steps = {horizon_steps}
budget = {{ plans = 1_000_000_000, steps = 1_000_000_000 }}

[road]
{self.road}

[defaults]
class = "car"
"""
        # The same traffic every time.
        for name, start, goal, wanted_mps in self.place(random.Random(1)):
            stated = '{ kind = "conservative" }' if name == "ego" else driver
            text += f"""
[[vehicle]]
name = "{name}"
start = {start}
goal = {{ {goal}speed_mps = {wanted_mps:.2f} }}
driver = {stated}
"""
        return text


def _highway(vehicles: int, lanes: int, spacing: float, ego_spacing: float) -> Callable[[random.Random], list[tuple[str, str, str, float]]]:
    def place(drawn: random.Random) -> list[tuple[str, str, str, float]]:
        found = []
        along_m = 3.0 * 25.0
        for index in range(vehicles):
            speed_mps = 25.0 if index == 0 else drawn.uniform(21.0, 24.0)
            ratio = ego_spacing if index == 0 else 1.0
            along_m += ratio * spacing * (12.0 + speed_mps) * drawn.uniform(0.9, 1.1)
            lane = drawn.randrange(lanes)
            start = f"{{ lane = {lane}, along_m = {along_m:.2f}, speed_mps = {speed_mps:.2f} }}"
            found.append(("ego" if index == 0 else f"v{index}", start, "", 25.0 if index == 0 else drawn.uniform(21.0, 24.0)))
        return found

    return place


def _roundabout(drawn: random.Random) -> list[tuple[str, str, str, float]]:
    places = [
        ("ego", "south-in-0", 25.0, 8.0, "north-out-0"),
        ("v1", "west-in-0", 60.0, 12.0, "east-out-0"),
        ("v2", "west-in-0", 35.0, 12.0, "south-out-0"),
        ("v3", "north-in-0", 55.0, 12.0, "east-out-0"),
        ("v4", "east-in-0", 40.0, 12.0, "north-out-0"),
    ]
    return [_named(*place) for place in places]


def _intersection(drawn: random.Random) -> list[tuple[str, str, str, float]]:
    arms = ["south", "west", "north", "east"]
    found = [_named("ego", "south-in", 35.0, 9.0, "north-out")]
    for index in range(9):
        arm = arms[(index + 1) % 4]
        to = arms[(index + 1 + (2 if index % 3 else 3)) % 4]
        found.append(_named(f"v{index + 1}", f"{arm}-in", 65.0 - 25.0 * (index // 4), 8.0 + drawn.uniform(-1.0, 1.0), f"{to}-out"))
    return found


def _named(name: str, lane: str, along_m: float, speed_mps: float, goal: str) -> tuple[str, str, str, float]:
    start = f'{{ lane = "{lane}", along_m = {along_m:.2f}, speed_mps = {speed_mps:.2f} }}'
    return name, start, f'lane = "{goal}", ', speed_mps


def _merge(drawn: random.Random) -> list[tuple[str, str, str, float]]:
    # Lane 0 is the ramp.
    places = [("ego", 1, 30.0, 30.0), ("v1", 2, 90.0, 29.0), ("v2", 1, 75.0, 31.0), ("v3", 2, 5.0, 31.5), ("merging", 0, 110.0, 20.0)]
    return [
        (name, f"{{ lane = {lane}, along_m = {along_m}, speed_mps = {speed_mps} }}", "lane = 1, " if lane == 0 else "", 30.0)
        for name, lane, along_m, speed_mps in places
    ]


LANES = 'kind = "lanes"\nlane_count = {}\nlane_width_m = 4.0'
STREETS = [
    Street("Highway", "highway-v0", "Highway-v0", 15, 40.0, LANES.format(4), _highway(51, 4, 0.607, 2.0)),
    Street("Roundabout", "roundabout-v1", "Roundabout-v1", 15, 11.0, 'kind = "roundabout"\nradius_m = 22.0\nlane_count = 2\nspeed_limit_mps = 16.0', _roundabout),
    Street("Intersection", "intersection-v2", "Intersection-v2", 15, 13.0, 'kind = "crossing"\nlane_width_m = 4.0', _intersection, rows=15),
    Street("HighwayFast", "highway-fast-v0", "HighwayFast-v0", 5, 30.0, LANES.format(3), _highway(21, 3, 0.687, 1.5)),
    Street("Merge", "merge-v1", "Merge-v1", 15, 11.0, 'kind = "ramp-merge"\nlane_count = 3\nlane_width_m = 4.0\nramp_end_m = 310.0\ntaper_m = 20.0', _merge),
]
IDM = '{ kind = "idm" }'
HUMAN = '{ kind = "human", style = "normal" }'
NEGOTIATION = '{ kind = "negotiation" }'


def main() -> None:
    """Writes each street with IDM traffic."""
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for street in STREETS:
        for label, driver in (("idm", IDM), ("human", HUMAN)):
            (folder / f"{street.name.lower()}-{label}.toml").write_text(street.toml(driver))
        (folder / f"{street.name.lower()}-idm-short.toml").write_text(street.toml(IDM, horizon_steps=2))


if __name__ == "__main__":
    main()
