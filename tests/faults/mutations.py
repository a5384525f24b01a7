#!/usr/bin/env python3
"""Input with random mistakes in it: a command answers each, and what it accepts is run with recording and report.

No command may panic, abort, hang, or refuse what was accepted, no recording may be twice as large as `check` states, no text may have
control characters, and no result may be NaN or infinite.
A refusal names a file with its line, or a flag. Inputs that led to a message not seen before are kept in
tests/faults/corpus/corpus.json while these are small; they come first in the next call, and further mistakes are made in
them. Prints counts as Markdown; exits with 1 if anything did not hold, and keeps that input as small as it could be made.
The same seed and corpus make the same inputs.

    tests/faults/mutations.py [TARGET ...] [--count 1000 | --minutes 5] [--seed 1] [--binary target/release/interplay]
"""

import argparse
import collections
import dataclasses
import json
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import zlib

import judge
import messages
import targets
from target import Target, cost_is_small

CORPUS = pathlib.Path(__file__).resolve().parent / "corpus" / "corpus.json"
MOST_CORPUS_BYTES, MOST_INPUT_BYTES = 25_000, 8_000
# A hang takes this much time of a processor, or this much time at all: the machine may have other work.
PROCESSOR_LIMIT_S, TIMEOUT_S = 120, 1200
STATED = re.compile(r"in about ([\d.]+) MB")
# Telemetry can be good enough for a report and not for a network; only `--scenario` asks for one.
NO_NETWORK = "no scenario is written"
MOST_TRIALS, MOST_SHRINKING_S = 60, 20.0
# The share of a session that may go into making inputs small which are no faults.
MOST_SHRINKING_SHARE = 0.25


@dataclasses.dataclass
class Outcome:
    """What became of one input: exit codes, the messages, and what was wrong with the program, if anything."""

    checked: str
    said: str
    runs: list[str]
    left_out: bool = False
    fault: str | None = None
    kinds: set[str] = dataclasses.field(default_factory=set)


def execute(binary: str, folder: pathlib.Path, words: list[str]) -> tuple[str, str, str]:
    """How a command ended, what it said, and what of that are results."""
    bounded = ["prlimit", f"--cpu={PROCESSOR_LIMIT_S}", binary] if shutil.which("prlimit") else [binary]
    try:
        done = subprocess.run([*bounded, *words], cwd=folder, capture_output=True, timeout=TIMEOUT_S)
    except subprocess.TimeoutExpired:
        return "hang", f"no end in {TIMEOUT_S} s", ""
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return "hang", f"no end in {PROCESSOR_LIMIT_S} s of a processor", ""
    out, errors = done.stdout.decode("utf-8", "replace"), done.stderr.decode("utf-8", "replace")
    return str(done.returncode) if done.returncode in (0, 1, 2, 3) else f"crash {done.returncode}", out + errors, out


def attempt(binary: str, target: Target, text: str) -> Outcome:
    """Gives one input to the commands of its target."""
    with tempfile.TemporaryDirectory(prefix="interplay-mutations-") as name:
        folder = pathlib.Path(name)
        for file, content in {**target.files, f"input.{target.suffix}": text}.items():
            (folder / file).write_bytes(content.encode("utf-8", "surrogateescape"))
        with target.beside(folder, text):
            if target.own:
                ended, said, fault = target.own(binary, folder, text)
                return Outcome(ended, said, [], fault=fault or _fault("play", ended, said, ""), kinds=_kinds("", ended, said))
            return _attempt(binary, folder, target, text)


def _attempt(binary: str, folder: pathlib.Path, target: Target, text: str) -> Outcome:
    """Gives an input to the commands, which stands in a folder."""
    check, runs = target.commands(text)
    ended, said, out = execute(binary, folder, check)
    outcome = Outcome(ended, said, [], kinds=_kinds("", ended, said))
    outcome.fault = _fault(" ".join(check), ended, said, out)
    if ended not in "02" and (check[0] == "check" or "--dry-run" in check):
        outcome.fault = f"{' '.join(check)}: {ended}"
    elif ended in "01" and not outcome.fault:
        _run(binary, folder, target, runs, outcome)
    return outcome


def _fault(command: str, ended: str, said: str, out: str) -> str | None:
    """What is wrong with how a command ended and what it said."""
    if ended not in "0123":
        return f"{command}: {ended}"
    wrong = judge.of_text(said) or judge.of_results(ended, out)
    return f"{command}: {wrong}" if wrong else None


def _kinds(command: str, ended: str, said: str) -> set[str]:
    return {f"{command} {ended}: {kind}".strip() for kind in messages.kinds(said) or {messages.first_line(said) if ended in "23" else ""}}


def _run(binary: str, folder: pathlib.Path, target: Target, runs: list[list[str]], outcome: Outcome) -> None:
    """Runs what was accepted, and adds to the outcome."""
    all_said = [outcome.said]
    for words in runs:
        if not cost_is_small(outcome.said):
            outcome.left_out = True
            return
        stated_mb = [float(size) for size in STATED.findall(outcome.said)]
        ended, said, out = execute(binary, folder, words)
        outcome.runs.append(ended)
        outcome.said = said
        all_said.append(said)
        outcome.kinds |= _kinds(words[0], ended, said)
        if NO_NETWORK in said or ended == "2" and not target.may_refuse.isdisjoint(words):
            return
        outcome.fault = _fault(" ".join(words), ended, said, out) or _fault_of_run(folder, words, ended, said, stated_mb)
        if ended not in "01" or outcome.fault:
            return
    outcome.fault = target.disagreement(all_said)


def _fault_of_run(folder: pathlib.Path, words: list[str], ended: str, said: str, stated_mb: list[float]) -> str | None:
    """What is wrong with a command after what it does was accepted, and with its files."""
    command, recording = " ".join(words), folder / "run.rrd"
    if ended == "2":
        return f"{command}: refused after it was accepted"
    if ended == "3" and not said.strip():
        return f"{command}: unfinished without a reason"
    if stated_mb and recording.exists() and recording.stat().st_size > 2e6 * max(stated_mb):
        return f"the recording has {recording.stat().st_size} bytes, stated were {max(stated_mb)} MB"
    wrong = judge.of_files(folder) if words[0] == "run" and ended in "01" else None
    return f"{command}: {wrong}" if wrong else None


def smaller(binary: str, target: Target, text: str, wanted: Outcome, trials: int) -> str:
    """A smaller input with the same messages and the same fault, found by leaving out lines or, of lists, words."""
    is_list = target.suffix == "json"
    parts = json.loads(text) if is_list else text.splitlines(keepends=True)
    size, end = len(parts) // 2, time.monotonic() + MOST_SHRINKING_S
    while size and trials and time.monotonic() < end:
        at = 2 if is_list else 0
        while at < len(parts) and trials and time.monotonic() < end:
            fewer = parts[:at] + parts[at + size :]
            trials -= 1
            shorter = json.dumps(fewer) if is_list else "".join(fewer)
            if _is_same(attempt(binary, target, shorter), wanted):
                parts = fewer
            else:
                at += size
        size //= 2
    return json.dumps(parts) if is_list else "".join(parts)


def _is_same(found: Outcome, wanted: Outcome) -> bool:
    return found.kinds == wanted.kinds and (found.fault is None) == (wanted.fault is None)


def read_corpus() -> dict[str, dict[str, str]]:
    """The kept inputs of each target, by their keys."""
    return json.loads(CORPUS.read_text("utf-8")) if CORPUS.exists() else {}


class Session:
    """All inputs of one target, what is known of them, and the corpus that remains."""

    def __init__(self, binary: str, name: str, target: Target) -> None:
        self.binary, self.name, self.target = binary, name, target
        self.kept = read_corpus().get(name, {})
        self.corpus = [self.kept[key] for key in sorted(self.kept)]
        self.seen: dict[str, int] = collections.Counter()
        self.unplaced: dict[str, str] = {}
        self.checks, self.runs = collections.Counter(), collections.Counter()
        self.left_out, self.faults, self.examples, self.began = 0, [], {}, time.monotonic()
        self.shrinking_s = 0.0

    def drive(self, count: int, minutes: float | None, seed: int) -> None:
        """Replays the corpus, then makes new inputs until there are enough or the time is over."""
        for text in self.corpus:
            self.judge(text, is_kept=True)
        index = 0
        while time.monotonic() - self.began < 60 * minutes if minutes else index < count:
            dice = random.Random(f"{seed}/{self.name}/{index}")
            from_corpus = self.corpus and dice.random() < 0.3
            text = dice.choice(self.corpus if from_corpus else self.target.seeds)
            self.judge(self.target.spoil(text, self.target.seeds, dice), is_kept=False)
            index += 1

    def judge(self, text: str, is_kept: bool) -> None:
        """Counts one input, and keeps it if it shows something new."""
        outcome = attempt(self.binary, self.target, text)
        self.checks[outcome.checked] += 1
        self.runs.update(outcome.runs[-1:])
        self.left_out += outcome.left_out
        new = outcome.kinds - self.seen.keys()
        self.seen.update(outcome.kinds)
        if outcome.checked == "2" and not messages.names_place(outcome.said):
            self.unplaced.update({kind: outcome.said for kind in outcome.kinds if kind not in self.unplaced})
        if outcome.fault and outcome.fault not in [fault for fault, _, _ in self.faults]:
            trials = 0 if "hang" in outcome.fault else MOST_TRIALS
            text = smaller(self.binary, self.target, text, outcome, trials)
            self.faults.append((outcome.fault, text, outcome.said))
            if not is_kept:
                self.keep("fault-", text)
        elif new:
            began = time.monotonic()
            if not is_kept and not outcome.runs and self.shrinking_s <= MOST_SHRINKING_SHARE * (began - self.began):
                text = smaller(self.binary, self.target, text, outcome, MOST_TRIALS)
                self.shrinking_s += time.monotonic() - began
            self.examples.update({kind: (text, outcome.said) for kind in new})
            if not is_kept:
                self.keep("", text)

    def keep(self, prefix: str, text: str) -> None:
        """Puts an input into the corpus, if there is room."""
        content = text.encode("utf-8", "surrogateescape")
        used = sum(len(kept.encode("utf-8", "surrogateescape")) for kept in self.kept.values())
        if self.target.keeps and len(content) <= MOST_INPUT_BYTES and used + len(content) <= MOST_CORPUS_BYTES:
            self.kept.setdefault(f"{prefix}{zlib.crc32(content):08x}", text)
            # Sorted and in ASCII, an input a line: equal inputs give equal bytes, and a difference can be read.
            corpus = read_corpus() | {self.name: self.kept}
            CORPUS.write_text(json.dumps(corpus, indent=0, sort_keys=True) + "\n", "utf-8")

    def row(self) -> str:
        """Counts as a row of a table."""
        answered = [self.checks["2"], self.checks["3"], self.checks.total() - sum(self.checks[code] for code in "0123")]
        ran = [self.runs.total(), self.runs["1"], self.runs["3"]]
        minutes = f"{(time.monotonic() - self.began) / 60:.1f}"
        accepted = self.checks["0"] + self.checks["1"]
        cells = [minutes, self.checks.total(), accepted, *answered[:2], *ran, self.left_out, len(self.seen), len(self.unplaced), len(self.faults)]
        return f"| `{self.name}` | " + " | ".join(str(cell) for cell in cells) + " |"


HEADER = "target | minutes | inputs | accepted | refused (2) | unfinished (3) | run | expectation failed (1) | run unfinished (3) "
HEADER += "| left out as costly | distinct outcomes | messages without a place | faults"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("target", nargs="*")
    parser.add_argument("--count", type=int, default=1000, help="inputs of each target besides the corpus")
    parser.add_argument("--minutes", type=float, help="time for each target, in place of a count")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--binary", default="target/release/interplay")
    parser.add_argument("--messages", type=pathlib.Path, help="a new folder for all distinct messages, each with its input")
    stated = parser.parse_args()
    binary = str(pathlib.Path(stated.binary).resolve())
    every = targets.all_targets(binary)
    unknown = [name for name in stated.target if name not in every]
    if unknown:
        parser.error(f"there is no target {unknown[0]}; there are: {', '.join(every)}")
    print(f"| {HEADER} |\n|{'---|' * len(HEADER.split('|'))}", flush=True)
    faults = 0
    for name in stated.target or every:
        session = Session(binary, name, every[name])
        session.drive(stated.count, stated.minutes, stated.seed)
        print(session.row(), flush=True)
        faults += len(session.faults)
        for fault, text, said in session.faults:
            print(f"{name}: {fault}\n{text}\n{said[-1500:]}\n", file=sys.stderr, flush=True)
        if stated.messages:
            write_messages(stated.messages, session)
    return 1 if faults else 0


def write_messages(folder: pathlib.Path, session: Session) -> None:
    """Writes each distinct outcome of a target: how often it occurred, the first input, and what was said."""
    folder.mkdir(parents=True, exist_ok=True)
    parts = [
        f"## {count} x {kind}{'   (NO PLACE)' if kind in session.unplaced else ''}\n--- input\n{session.examples.get(kind, ('', ''))[0][-600:]}\n"
        f"--- said\n{session.examples.get(kind, ('', ''))[1][-1500:]}\n"
        for kind, count in session.seen.items()
    ]
    (folder / f"{session.name}.txt").write_text("\n".join(parts), "utf-8", "surrogateescape")


if __name__ == "__main__":
    sys.exit(main())
