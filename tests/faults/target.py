"""What a target is, and what the commands of several targets have in common."""

import contextlib
import dataclasses
import pathlib
import random
import re
from collections.abc import Callable, Iterator

ROOT = pathlib.Path(__file__).resolve().parents[2]
# A run that states more than this is left out.
MOST_PLANS, MOST_STEPS, MOST_GIGA_OPERATIONS, MOST_RUNS = 800, 60_000, 1.0, 8
RECORD = ["--record", "run.rrd", "--report", "page"]
Commands = tuple[list[str], list[list[str]]]


@contextlib.contextmanager
def nothing_beside(_folder: pathlib.Path, _text: str) -> Iterator[None]:
    """No server, and no files but those of the target."""
    yield


@dataclasses.dataclass
class Target:
    """What is spoilt, and who reads it."""

    suffix: str
    seeds: list[str]
    spoil: Callable[[str, list[str], random.Random], str]
    # From the input: the command that says whether it is accepted, and those that must then accept it, too.
    commands: Callable[[str], Commands]
    files: dict[str, str] = dataclasses.field(default_factory=dict)
    # Commands and flags after the first command with which an input may be refused that it accepted.
    may_refuse: frozenset[str] = frozenset()
    # What stands beside the commands while they are given an input, such as a server.
    beside: Callable[[pathlib.Path, str], contextlib.AbstractContextManager[None]] = nothing_beside
    # From what each command said: what does not agree, if anything.
    disagreement: Callable[[list[str]], str | None] = lambda _: None
    # In place of commands: from the program, a folder and the input to an exit code, what was said, and what was wrong.
    own: Callable[[str, pathlib.Path, str], tuple[str, str, str | None]] | None = None
    # Whether inputs may be kept in the corpus.
    keeps: bool = True


def checked_and_run(_: str) -> Commands:
    """A scenario is checked, and run with recording and report."""
    return ["check", "input.toml"], [["run", "input.toml", *RECORD]]


def reader_checked_and_run(_: str) -> Commands:
    """The same, of a scenario that reads the input."""
    return ["check", "reader.toml"], [["run", "reader.toml", *RECORD]]


def documented(page: str) -> list[str]:
    """The scenarios that a page of the documentation has in full."""
    blocks = re.findall(r"(?ms)^```toml\n(.*?)^```", (ROOT / "docs/guide" / page).read_text("utf-8"))
    return [block for block in blocks if re.search(r"(?m)^title = ", block)]


def shortened(text: str, most_s: float) -> str:
    """A scenario that ends after at most `most_s` seconds."""
    return re.sub(r"(?m)^duration_s = ([\d.]+)", lambda found: f"duration_s = {min(float(found[1]), most_s)}", text)


def cost_is_small(said: str) -> bool:
    """Whether a command stated little enough work to do it."""
    plans = [int(count) for count in re.findall(r"(\d+) plans", said)]
    steps = [int(count) for count in re.findall(r"(\d+) steps", said)]
    operations = [float(count) for count in re.findall(r"([\d.]+) thousand million operations", said)]
    runs = [int(count) for count in re.findall(r": (\d+) runs?$", said, re.MULTILINE)]
    stated = [(plans, MOST_PLANS), (steps, MOST_STEPS), (operations, MOST_GIGA_OPERATIONS), (runs, MOST_RUNS)]
    return all(count <= most for counts, most in stated for count in counts)
