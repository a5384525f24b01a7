"""Tables of recorded vehicles: for `predict` and `fit`, and as the record of a vehicle in a scenario."""

import math
import random

import edits
from target import RECORD, Commands, Target

STEP_S, STEPS, VEHICLES = 0.2, 60, 6
READER = """title = "A record"
shows = "A vehicle drives as it was recorded"
duration_s = 6.0

[road]
kind = "lanes"
lane_width_m = 3.5

[defaults]
class = "car"

[[vehicle]]
name = "ego"
start = { lane = 0, along_m = 5.0, speed_mps = 12.0 }

[[vehicle]]
name = "front"
start = { x_m = 60.0, y_m = 1.75, speed_mps = 15.0 }
driver = { kind = "recorded", file = "input.csv"WHO }
"""


def queue(vehicles: int, with_id: bool) -> str:
    """Cars on a straight road, each of which follows the one ahead, as a table."""
    rows = [("id," if with_id else "") + "time_s,x_m,y_m,heading_rad,speed_mps"]
    states = [(60.0 - 30.0 * car, 15.0) for car in range(vehicles)]
    for step in range(STEPS):
        time_s, nexts = STEP_S * step, []
        for car, (along_m, speed_mps) in enumerate(states):
            name = f"car-{car}," if with_id else ""
            rows.append(f"{name}{time_s:.1f},{along_m:.3f},1.75,0,{speed_mps:.3f}")
            ahead_m, ahead_mps = states[car - 1] if car else (0.0, 0.0)
            wanted = 0.15 * (ahead_m - along_m - 8.0 - (0.8 + 0.1 * car) * speed_mps) + 0.6 * (ahead_mps - speed_mps)
            change = 1.2 * math.sin(0.35 * time_s) if car == 0 else max(-4.0, min(2.0, wanted))
            faster = max(0.0, speed_mps + STEP_S * change)
            nexts.append((along_m + 0.5 * STEP_S * (speed_mps + faster), faster))
        states = nexts
    return "\n".join(rows) + "\n"


def _spoil(text: str, _others: list[str], dice: random.Random) -> str:
    return edits.table(text, dice)


def _predict_commands(text: str) -> Commands:
    starts = ["--starts", "40"]
    return ["predict", "input.csv", *starts], [["predict", "input.csv", *starts, "--json"], ["fit", "input.csv", *[[], ["--json"]][len(text) % 2]]]


def _reader_commands(_: str) -> Commands:
    return ["check", "reader.toml"], [["run", "reader.toml", *RECORD, "--trajectories", "all.csv", "--export", "driven.xml"], ["check", "driven.xml"]]


def targets(_binary: str) -> dict[str, Target]:
    """Tables of many vehicles, of one of many, and of one alone."""
    handed = ', id = "car-0", hands_over = { to = "human", when = "disturbed" }'
    return {
        "recorded": Target("csv", [queue(VEHICLES, True), queue(3, True)], _spoil, _predict_commands, may_refuse=frozenset(["fit"])),
        "record": Target("csv", [queue(1, False)], _spoil, _reader_commands, {"reader.toml": READER.replace("WHO", "")}),
        "record-of-many": Target("csv", [queue(3, True)], _spoil, _reader_commands, {"reader.toml": READER.replace("WHO", handed)}),
    }
