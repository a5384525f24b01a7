#!/usr/bin/env python3
"""Authored scenarios with random mistakes in them: `check` answers each, and what it accepts is run with recording and report.

No command may panic, abort, hang, or refuse what `check` accepted, and no recording may be twice as large as `check` states.
Prints counts as Markdown; exits with 1, and keeps the files, if anything did not hold. The same seed makes the same files.

    tests/faults/mutations.py [--count 1000] [--seed 1] [--binary target/release/interplay]
"""

import argparse
import collections
import pathlib
import random
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?![\w.])")
NUMBERS = ["0", "0.0", "-1", "-0.0", "1e-9", "1e-300", "1e9", "1e308", "nan", "inf", "-inf", "0.5", "3", "64", "1000", "''", "[]", "true"]
PIECES = ["[", "]", "[[vehicle]]\n", "=", "'", '"', "\n", "{", "}", ",", "\t", "\0", "é", "extends = 'tower'\n", "duration_s = 2\n", "#"]
TIMEOUT_S = 120
STATED = re.compile(r"in about ([\d.]+) MB")


def mutated(text: str, dice: random.Random) -> str:
    """The text with one or two mistakes: numbers of another size, lines that are lost or doubled, pieces at random places."""
    for _ in range(dice.randint(1, 2)):
        kind = dice.random()
        numbers = list(NUMBER.finditer(text))
        if kind < 0.75 and numbers:
            number = dice.choice(numbers)
            scaled = f"{float(number[0]) * dice.choice([-1.0, 0.1, 0.5, 0.9, 1.1, 2.0, 10.0]):.6g}"
            text = text[: number.start()] + (scaled if dice.random() < 0.8 else dice.choice(NUMBERS)) + text[number.end() :]
        elif kind < 0.9:
            lines = text.splitlines(keepends=True)
            at = dice.randrange(len(lines))
            lines[at : at + 1] = dice.choice([[], [lines[at]] * 2, [lines[at], dice.choice(lines)]])
            text = "".join(lines) or "\n"
        else:
            at = dice.randrange(len(text) + 1)
            text = text[:at] + dice.choice(PIECES) + text[at + dice.choice([0, 0, 1, 5]) :]
    return text


def execute(binary: str, folder: pathlib.Path, *words: str) -> tuple[str, str]:
    """How a command ended, and what it said."""
    try:
        done = subprocess.run([binary, *words], cwd=folder, capture_output=True, timeout=TIMEOUT_S)
    except subprocess.TimeoutExpired:
        return "hang", f"no end in {TIMEOUT_S} s"
    said = (done.stdout + done.stderr).decode("utf-8", "replace")
    return str(done.returncode) if done.returncode in (0, 1, 2, 3) else f"crash {done.returncode}", said


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--binary", default="target/release/interplay")
    stated = parser.parse_args()
    binary = str(pathlib.Path(stated.binary).resolve())
    authored = [file.read_text("utf-8") for file in sorted((ROOT / "scenarios/files").rglob("*.toml"))]
    checks, runs, broken = collections.Counter(), collections.Counter(), []
    folder = pathlib.Path(tempfile.mkdtemp(prefix="interplay-mutations-"))
    for index in range(stated.count):
        dice = random.Random(f"{stated.seed}/{index}")
        name = f"{index}.toml"
        (folder / name).write_text(mutated(dice.choice(authored), dice), "utf-8")
        ended, said = execute(binary, folder, "check", name)
        checks[ended] += 1
        fault = None if ended in "02" else f"check: {ended}"
        if ended == "0":
            limit_mb = 2.0 * max(float(size) for size in STATED.findall(said))
            ended, said = execute(binary, folder, "run", name, "--record", "run.rrd", "--report", "page")
            runs[ended] += 1
            recording = folder / "run.rrd"
            if ended not in "013":
                fault = f"run: {ended}"
            elif recording.exists() and recording.stat().st_size > 1e6 * limit_mb:
                fault = f"the recording has {recording.stat().st_size} bytes, stated were {limit_mb / 2} MB"
            recording.unlink(missing_ok=True)
        if fault:
            broken.append(f"{folder / name}: {fault}\n{said[-600:]}")
        else:
            (folder / name).unlink()
    print("| | all | well (0) | expectation failed (1) | refused (2) | unfinished (3) | crash or hang |\n|---|---|---|---|---|---|---|")
    for title, counts in [("`check`", checks), ("`run --record --report`", runs)]:
        other = sum(count for ended, count in counts.items() if ended not in "0123")
        print(f"| {title} | {counts.total()} | {' | '.join(str(counts[code]) for code in '0123')} | {other} |")
    for line in broken:
        print(line, file=sys.stderr)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
