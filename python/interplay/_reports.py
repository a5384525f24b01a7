"""Tables of JSON whose keys are attributes, of which type checkers know the names."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any


class Record(dict[str, Any]):
    """A table of JSON whose keys are attributes, too."""

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            try:
                return self[name]
            except KeyError:
                raise AttributeError(f"no `{name}`; there are {', '.join(self)}") from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self]


class Entry(Record):
    """A scenario of the package."""

    name: str
    title: str
    shows: str
    figure: str | None


class VehicleReport(Record):
    """What was measured of a vehicle; metrics of other packages are entries, without attributes that type checkers know."""

    name: str
    driver: str
    completed_s: float | None
    contacts_at_fault: int
    cut_ins: int
    mean_abs_acceleration: float | None
    mean_abs_jerk: float | None
    peak_acceleration_mps2: float | None
    peak_braking_mps2: float | None
    peak_braking_share: float | None
    hard_braking: bool | None
    peak_jerk_mps3: float | None
    peak_lateral_acceleration_mps2: float | None
    min_speed_mps: float | None
    max_speed_mps: float | None
    off_road_m: float | None
    leaves_road: bool | None
    speeding_mps: float | None
    peak_steering_rate_radps: float | None
    short_gap_share: float | None
    median_time_gap_s: float | None
    accepted_lead_gap_s: float | None
    accepted_lag_gap_s: float | None
    follower_braking_mps2: float | None
    follower_brakes: bool | None
    post_encroachment_s: float | None
    emergency_braking: int
    rules_broken: int
    unexplained_standing_s: float | None
    deadlocks: int
    peak_times_s: Any
    plans: Any
    beliefs: list[Any]


def records(text: str) -> Any:
    """JSON as numbers, lists and records."""
    return json.loads(text, object_hook=Record)
