"""What `play` reads and writes: the messages of a page in a file, and scenarios that repeat what was played."""

import contextlib
import json
import pathlib
import random
import re
from collections.abc import Iterator

import edits
from target import RECORD, Commands, Target, checked_and_run

SEATS = [("lane-change/front-nice", "ego"), ("lane-change/front-nice", "front"), ("intersection/nice", "ego"), ("people/high-street", "ego")]
SEATS += [("roundabout/nice", "ego"), ("narrow-passage/nice", "ego"), ("lane-keeping/nice", "ego"), ("people/high-street", "oncoming")]
PLANNERS = ["negotiation", "conservative", "human", "idm", "nash", "external", "inputs", "recorded", "walker", "x", "", "\u009b31m", None]
NUMBERS = [0, 1, -1, 0.3, -0.4, 0.05, 1e-300, 1e308, -1e308, 5, 1000, 9007199254740993, 18446744073709551615, -0.0]
ODD = ["NaN", "Infinity", "1e999", "null", '"1"', "[]", "true", "-", "9" * 400, "18446744073709551616"]
DIGEST = re.compile(r'"digest":\s*"(\w+)"')
LAST_TICK = 60


def message(dice: random.Random, planners: list = PLANNERS) -> dict[str, object]:
    """What a page may say."""
    number = dice.choice(NUMBERS)
    made = dice.choice([
        {"type": "input", "acceleration": dice.uniform(-1, 1), "steering": dice.uniform(-0.3, 0.3), "assist": dice.random() < 0.5},
        {"type": "input", "acceleration": number, "steering": dice.choice(NUMBERS), "seq": dice.choice([0, 7, 2**64 - 1])},
        {"type": "rewind", "seconds": dice.choice([0.5, 5, number])},
        {"type": "hand_over", "to": dice.choice(planners)},
        {"type": "restart"},
        {"type": "rate", "ratio": number},
        {"type": "pause", "paused": False},
        {"type": "echo", "at": number},
    ])
    return made


def spoilt_line(line: str, dice: random.Random) -> str:
    """A message that is none, or nearly."""
    kind = dice.random()
    if kind < 0.4:
        return re.sub(r"-?\d[\d.e+-]*", lambda _: dice.choice(ODD), line, count=1)
    if kind < 0.7:
        return re.sub(r'"(\w+)":', lambda found: f'"{dice.choice(["type", "to", "far", "seconds", "tick", found[1] + "x"])}":', line, count=1)
    return edits.other_piece(line, edits.CELLS + ["{", "}", ",", ":", "\u009b", '"\\ud800"', "[" * 200], dice)


def _drive(dice: random.Random) -> list[str]:
    ticks = sorted(dice.randrange(LAST_TICK) for _ in range(dice.randint(1, 8)))
    lines = [json.dumps({"tick": tick, **message(dice)}) for tick in ticks]
    return [*lines, json.dumps({"tick": LAST_TICK, "type": "end"})]


def _spoil(text: str, _others: list[str], dice: random.Random) -> str:
    scenario, seat, *lines = json.loads(text)
    if dice.random() < 0.6:
        scenario, seat = dice.choice(SEATS)
        lines = _drive(dice)
    if dice.random() < 0.3:
        seat = dice.choice(["ego", "front", "rear", "crossing", "walker", "bus", "x"])
    if lines and dice.random() < 0.4:
        at = dice.randrange(len(lines))
        lines[at] = spoilt_line(lines[at], dice)
    return json.dumps([scenario, seat, *lines])


@contextlib.contextmanager
def _file_beside(folder: pathlib.Path, text: str) -> Iterator[None]:
    """The lines as a file."""
    content = "\n".join(json.loads(text)[2:]) + "\n"
    (folder / "drive.jsonl").write_bytes(content.encode("utf-8", "surrogateescape"))
    yield


def _commands(text: str) -> Commands:
    scenario, seat = json.loads(text)[:2]
    play = ["play", scenario, "--as", seat, "--input", "drive.jsonl", "--out", "again.toml", "--json"]
    return play, [["check", "again.toml"], ["run", "again.toml", *RECORD, "--json"]]


def _digests_differ(said: list[str]) -> str | None:
    """Whether the run that was kept is not the one that was played."""
    digests = [found[1] for text in said if (found := DIGEST.search(text))]
    return "the digest of the run is not that of what was played" if len(set(digests)) > 1 else None


KEPT = """extends = "SCENARIO"
duration_s = 6.0
expect = {}
counterfactual = []

[[vehicle]]
name = "ego"
driver = { kind = "inputs", inputs = [[0, 0.4, 0.0], [12, -1.0, 0.02], [20, 0.0, -0.1]], hand_overs = [{ plan = 8, to = "negotiation" }, { plan = 16 }] }
"""


def _kept_spoilt(text: str, others: list[str], dice: random.Random) -> str:
    return (edits.values if dice.random() < 0.7 else edits.toml)(text, others, dice)


def targets(_binary: str) -> dict[str, Target]:
    """What is played, and what was."""
    dice = random.Random("seeds of plays")
    drives = [json.dumps([*seat, *_drive(dice)]) for seat in SEATS]
    kept = [KEPT.replace("SCENARIO", name) for name in sorted({scenario for scenario, _ in SEATS})]
    return {
        "played": Target("json", drives, _spoil, _commands, beside=_file_beside, disagreement=_digests_differ),
        "inputs": Target("toml", kept, _kept_spoilt, checked_and_run),
    }
