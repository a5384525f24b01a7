#!/usr/bin/env python3
"""Fault and kill loops: the n-th change of a file fails, or the command is killed there, for n = 1, 2, … until none is left. Then
the n-th allocation of memory fails, for the first ones and others spread over the command.

After a fault the exit code is 3, every file is the old one or whole, and nothing else is there. After a kill every file is
the old one or whole, and the same command works. Where the C library itself ends a process for want of memory, which no program can
prevent, files are as after a kill. The standard output is a file, too, whose faults count. `--short` takes every
seventh n from the tenth on, and a tenth of the allocations. Prints a table as Markdown; exits with 1 if anything did not hold. Needs Linux on x86-64 and a C
compiler; says so where it skips.

    tests/faults/loops.py [--short] [--allocations 100] [--binary target/release/interplay] [COMMAND ...]
"""

import argparse
import json
import os
import pathlib
import platform
import shutil
import signal
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

HERE = pathlib.Path(__file__).resolve().parent
SCENARIO = """title = "Faults"
shows = "A short run"
duration_s = 0.3
vehicle = [{ name = "ego", start = { x_m = 0.0, y_m = 0.2, speed_mps = 1.0 } }]
"""
PLAN = 'scenario = ["mine.toml"]\nsamples = 2\njitter = { position_m = 0.1, speed_mps = 0.1 }\n'
INPUTS = {"mine.toml": SCENARIO, "plan.toml": PLAN}
# A file of this content stands there before the command, where it may be replaced.
OLD = "old"
# All that the command makes stands there already, from a run before.
AGAIN = "again"
TIMEOUT_S = 120
RUN = ["run", "mine.toml", "--record", "first.rrd", "--report", "page", "--json"]

COMMANDS = {
    "run": (["run", "mine.toml", "--record", "first.rrd"], ["first.rrd"]),
    "run --record --report --json": (RUN, []),
    "the same again": (RUN, AGAIN),
    "suite --junit": (["suite", "mine.toml", "--junit", "results.xml"], ["results.xml"]),
    "sweep": (["sweep", "plan.toml", "--out", "swept", "--jobs", "1"], []),
    "new": (["new", "made/fresh.toml"], []),
    "reproduce": (["reproduce", "table-6.1", "--out", "figures"], []),
}


def is_whole(path: pathlib.Path, reference: pathlib.Path, killed: bool) -> bool:
    """Whether a file is what the command writes when all goes well, as far as its format tells."""
    content, wanted = path.read_bytes(), reference.read_bytes()
    match path.suffix:
        case ".svg" | ".xml":
            try:
                return xml.etree.ElementTree.fromstring(content) is not None
            except xml.etree.ElementTree.ParseError:
                return False
        case ".png":
            return content == wanted
        case ".html":
            return content.rstrip().endswith(b"</html>")
        case ".rrd":
            return content[:4] == wanted[:4] and content[-8:] == wanted[-8:]
        case ".parquet":
            return content[:4] == content[-4:] == b"PAR1"
        case ".jsonl":
            # Journals grow by lines; the next run cuts off a torn one and makes it again.
            lines = content.split(b"\n")[: -1 if killed else None]
            return all(json.loads(line) is not None for line in lines if line)
        case _:
            return content == wanted


def is_ended_by_c_library(outcome: subprocess.CompletedProcess) -> bool:
    """Whether glibc had no memory for its own list of what a thread has to clean up: it ends the process then."""
    return outcome.returncode == -signal.SIGABRT and outcome.stderr.startswith("Fatal glibc error: failed to register TLS destructor")


def files(folder: pathlib.Path) -> dict[str, pathlib.Path]:
    return {str(path.relative_to(folder)): path for path in sorted(folder.rglob("*")) if path.is_file()}


def prepare(folder: pathlib.Path, old: list[str] | str, reference: pathlib.Path | None = None) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    if old == AGAIN:
        if reference:
            shutil.copytree(reference, folder)
            return
        old = []
    folder.mkdir(parents=True)
    for name, text in INPUTS.items():
        (folder / name).write_text(text)
    for name in old:
        (folder / name).write_text(OLD)


class Loop:
    """One command, with a fault or a kill at each of its changes of files."""

    def __init__(self, tools: dict[str, pathlib.Path], binary: pathlib.Path, base: pathlib.Path, short: bool):
        self.tools, self.binary, self.base, self.short = tools, binary, base, short
        self.broken: list[str] = []

    def execute(
        self, words: list[str], folder: pathlib.Path, before: list[str], environment: dict[str, str] | None = None
    ) -> subprocess.CompletedProcess:
        """Runs the command with its standard output in a file; one that hangs has exit code -9."""
        command = [*before, str(self.binary), *words]
        with open(self.base / "stdout", "w") as stdout:
            told = {"env": {**os.environ, **(environment or {})}, "cwd": folder, "stdout": stdout, "stderr": subprocess.PIPE, "text": True, "timeout": TIMEOUT_S}
            try:
                return subprocess.run(command, **told)
            except subprocess.TimeoutExpired:
                return subprocess.CompletedProcess(command, -9, stderr=f"hangs: no end in {TIMEOUT_S} s")

    def check(self, at: str, folder: pathlib.Path, reference: pathlib.Path, old: list[str] | str, killed: bool) -> int:
        """Counts files that were left behind; everything else that is wrong is noted."""
        wanted, left = files(reference), 0
        old = list(wanted) if old == AGAIN else old
        for name, path in files(folder).items():
            if name in old and path.read_text("utf-8", "replace") == OLD:
                continue
            if name not in wanted:
                left += 1
                if not killed:
                    self.broken.append(f"{at}: {name} was left behind")
            elif not is_whole(path, wanted[name], killed):
                self.broken.append(f"{at}: {name} is not whole ({path.stat().st_size} bytes)")
        for name in [*INPUTS, *old]:
            if not (folder / name).exists():
                self.broken.append(f"{at}: {name} is lost")
        return left

    def run(self, title: str, mode: str) -> tuple[int, int]:
        """Returns how many faults were made, and how many files were left behind."""
        words, old = COMMANDS[title]
        reference, folder = self.base / "reference", self.base / "work"
        prepare(reference, old)
        sound = self.execute(words, reference, [])
        if sound.returncode != 0:
            sys.exit(f"{title} does not work even without faults: {sound.stderr}")
        # A file that `new` made is not overwritten the second time.
        again_codes = (0, 2) if title == "new" else (0,)
        n, made, left = 0, 0, 0
        while True:
            n += 7 if self.short and n >= 10 else 1
            prepare(folder, old, reference)
            outcome = self.execute(words, folder, [str(self.tools["inject"]), mode, str(n)])
            at = f"{title}, {mode} {n}"
            code = outcome.returncode
            if code in (-9, 97, 98, 101):
                self.broken.append(f"{at}: exit code {code}: {outcome.stderr[-300:]}")
                return made, left
            if code >= 100:
                return made, left
            made += 1
            if mode == "fail" and code != 3:
                self.broken.append(f"{at}: exit code {code}: {outcome.stderr[-300:]}")
            left += self.check(at, folder, reference, old, mode == "kill")
            if mode == "kill":
                again = self.execute(words, folder, [])
                if again.returncode not in again_codes:
                    self.broken.append(f"{at}: afterwards exit code {again.returncode}: {again.stderr[-300:]}")

    def exhaust(self, title: str, most: int) -> tuple[int, int, int]:
        """Lets allocations fail, each in a run of its own; returns how many, how many runs did without and ended well, and how many
        the C library ended."""
        words, old = COMMANDS[title]
        reference, folder, counted = self.base / "reference", self.base / "work", self.base / "allocations"
        shim = {"LD_PRELOAD": str(self.tools["malloc"]), "ALLOCATIONS": str(counted)}
        prepare(reference, old)
        sound = self.execute(words, reference, [], {**shim, "FAILING_ALLOCATION": "0"})
        if sound.returncode != 0:
            sys.exit(f"{title} does not work with counted allocations: {sound.stderr}")
        count = int(counted.read_text())
        first, done, ended = min(most // 2, count), 0, 0
        spread = [first + 1 + (count - first - 1) * at // (most - first) for at in range(most - first)]
        for n in [*range(1, first + 1), *spread]:
            prepare(folder, old, reference)
            outcome = self.execute(words, folder, [], {**shim, "FAILING_ALLOCATION": str(n)})
            at = f"{title}, allocation {n} of {count}"
            if outcome.returncode == 0:
                # The C library can do without some; and how many there are depends on the threads.
                done += 1
                missing = set(files(reference)) - set(files(folder))
                self.broken.extend(f"{at}: exit code 0 without {name}" for name in sorted(missing))
            elif is_ended_by_c_library(outcome):
                ended += 1
            elif outcome.returncode != 3:
                self.broken.append(f"{at}: exit code {outcome.returncode}: {outcome.stderr[-300:]}")
            self.check(at, folder, reference, old, is_ended_by_c_library(outcome))
        return most, done, ended


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--allocations", type=int, default=100, metavar="COUNT", help="how many allocations fail, a command")
    parser.add_argument("--binary", default="target/release/interplay")
    parser.add_argument("commands", nargs="*", metavar="COMMAND")
    stated = parser.parse_args()
    if platform.system() != "Linux" or platform.machine() != "x86_64" or not shutil.which("cc"):
        print("skipped: fault loops need Linux on x86-64 and a C compiler")
        return 0
    with tempfile.TemporaryDirectory() as base:
        base = pathlib.Path(base)
        inject = base / "inject"
        subprocess.run(["cc", "-O1", "-Wall", "-o", str(inject), str(HERE / "inject.c")], check=True)
        if subprocess.run([str(inject), "fail", "1", "true"], capture_output=True).returncode != 100:
            print("skipped: processes cannot be traced here")
            return 0
        malloc = base / "failing_malloc.so"
        subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-Wall", "-o", str(malloc), str(HERE / "failing_malloc.c")], check=True)
        loop = Loop({"inject": inject, "malloc": malloc}, pathlib.Path(stated.binary).resolve(), base, stated.short)
        print("| command | faults | kills | left behind after a fault | after a kill | failed allocations | done without | ended by the C library |\n|---|---|---|---|---|---|---|---|")
        allocations = max(1, stated.allocations // 10) if stated.short else stated.allocations
        for title in stated.commands or COMMANDS:
            failed, killed = loop.run(title, "fail"), loop.run(title, "kill")
            exhausted = loop.exhaust(title, allocations)
            print(f"| `{title}` | {failed[0]} | {killed[0]} | {failed[1]} | {killed[1]} | {exhausted[0]} | {exhausted[1]} | {exhausted[2]} |", flush=True)
    for line in loop.broken:
        print(line, file=sys.stderr)
    print(f"{len(loop.broken)} faults of the program", file=sys.stderr)
    return 1 if loop.broken else 0


if __name__ == "__main__":
    sys.exit(main())
