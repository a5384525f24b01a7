"""Streets with obstacles, people on foot, lights, flows and recorded vehicles."""

import random
import re

import edits
from target import ROOT, RECORD, Commands, Target, documented, shortened

FAMILIES = ("people", "full-size", "all-way-stop", "on-ramp", "overtaking", "curve", "roundabout", "mixed")
LONGEST_S = 10.0
# Things of a street, each of which any scenario with a lane of that name may have.
THINGS = [
    '[[obstacle]]\nname = "cone"\nkind = "cone"\nlane = "LANE"\nalong_m = 60.0\nlateral_offset_m = -0.8\n',
    '[[obstacle]]\nname = "crane"\nlength_m = 3.0\nwidth_m = 1.0\ntimetable = [[0.0, 10.0, 5.0, 1.57], [8.0, 10.0, 9.0, 1.57]]\n',
    '[[obstacle]]\nname = "heap"\nlane = "LANE"\nalong_m = 70.0\ncorners_m = [[1.5, -0.8], [1.5, 0.4], [-1.0, 0.8], [-1.5, -0.8]]\n',
    '[[obstacle]]\nname = "pillar"\nkind = "wall"\nx_m = 20.0\ny_m = 4.0\nheading_deg = 30.0\nradius_m = 0.5\n',
    '[[light]]\nname = "signal"\nlanes = ["LANE"]\noffset_s = -2\nphases = [{ colour = "red", duration_s = 4 }, '
    '{ colour = "green", duration_s = 3 }, { colour = "amber", duration_s = 1 }]\n',
    '[[flow]]\nname = "stream"\nvehicles_per_h = 900\nfrom = ["LANE"]\nalong_m = 5.0\nspeed_mps = 8.0\nspeed_sd_mps = 1.0\n',
    '[[flow]]\nname = "surge"\nrates = [[0.0, 300.0], [5.0, 1200.0]]\nfrom = ["LANE"]\nalong_m = 2.0\nspeed_mps = 10.0\n'
    'mix = [{ share = 0.5, speed_mps = 8.0, vehicle = { class = "truck", driver = { kind = "idm" } } }, { share = 0.5 }]\n',
    '[[detector]]\nname = "counter"\nlanes = ["LANE"]\nalong_m = 40.0\ninterval_s = 2.0\n',
    '[[vehicle]]\nname = "walking"\nclass = "pedestrian"\nstart = { lane = "LANE", along_m = 30.0, speed_mps = 1.2 }\n'
    'driver = { kind = "walker", style = "bold" }\n',
    '[[vehicle]]\nname = "late"\nstart = { lane = "LANE", along_m = 5.0, speed_mps = 8.0 }\nenters_s = 2.0\nleaves_s = 6.0\n',
    '[[vehicle]]\nname = "seen"\nstart = { x_m = 30.0, y_m = 1.75, speed_mps = 12.0 }\ndriver = { kind = "recorded", '
    "points = [[0.0, 30.0, 1.75, 0.0, 12.0], [1.0, 42.0, 1.75, 0.0, 12.0], [4.0, 60.0, 1.75, 0.0, 3.0]], "
    'hands_over = { to = "human", when = "disturbed" } }\n',
    '[[vehicle]]\nname = "ordered"\nstart = { lane = "LANE", along_m = 15.0, speed_mps = 6.0 }\ndriver = { kind = "scripted", '
    'script = [{ when = { vehicle = "ego", reaches = { lane = "LANE", along_m = 40.0 } }, speed_mps = 0.0, acceleration_mps2 = 1.5 }] }\n',
]
LANE = re.compile(r'\blane = "([\w-]+)"|\bname = "([\w-]+)", points')
LONG_LIST = re.compile(r"(?m)^(obstacle|light|vehicle|flow|detector) = \[$")


def _seeds() -> list[str]:
    """Authored streets and those of the documentation, of a few seconds each."""
    found = [text for page in ("street.md", "recordings.md", "commonroad.md", "traffic.md", "authoring.md") for text in documented(page)]
    for family in FAMILIES:
        for file in sorted((ROOT / "scenarios/files" / family).glob("*.toml")):
            text = file.read_text("utf-8")
            found.append(re.sub(r'(?m)^extends = "([\w-]+)\.toml"', rf'extends = "{family}/\1"', text))
    return [shortened(text, LONGEST_S) for text in found]


def _spoil(text: str, others: list[str], dice: random.Random) -> str:
    """A street with more things on it, of which none may be on that road, and with mistakes."""
    lanes = sorted({first or second for first, second in LANE.findall(text)})
    for _ in range(dice.choice([0, 0, 1, 1, 2])):
        among = THINGS if lanes else [thing for thing in THINGS if "LANE" not in thing]
        thing = dice.choice(among).replace("LANE", dice.choice(lanes or [""]))
        block = re.match(r"\[\[(\w+)\]\]", thing)
        # A list that stands in one piece takes no further tables.
        if block and any(found[1] == block[1] for found in LONG_LIST.finditer(text)):
            continue
        text += "\n" + thing
    return (edits.values if dice.random() < 0.8 else edits.toml)(text, others, dice) if dice.random() < 0.9 else text


def _commands(text: str) -> Commands:
    tables = ["--trajectories", "all.csv", "--detectors", "counts.csv"] if "[[detector]]" in text else []
    return ["check", "input.toml"], [["run", "input.toml", *RECORD, *tables]]


def targets(_binary: str) -> dict[str, Target]:
    """Streets."""
    return {"street": Target("toml", _seeds(), _spoil, _commands)}
