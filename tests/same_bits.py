#!/usr/bin/env python3
"""Whether every scenario ends with the same digest wherever it is computed: other numbers of threads, one processor core, mathematics of
the C library without its vector instructions, processors without and with AVX2 and FMA, and other builds of the command.

Prints a row for each and exits with 1 if a digest differs. What is not there to try is named as skipped.

    tests/same_bits.py [--binary target/release/interplay] [--build NAME=PATH]... [SCENARIO]...

A processor is emulated by `qemu-x86_64` (or `qemu-x86_64-static`), some fifty times slower than the machine itself, so this is done
with `--emulated` scenarios only. A build with musl, and one without optimisations, to be named by `--build`:

    CC_x86_64_unknown_linux_musl=musl-gcc cargo build --release --locked -p interplay --target x86_64-unknown-linux-musl
    cargo build --locked -p interplay
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import time

# A planner of each kind, a curved road, a network, sensing, the dynamic plant, and a controller of each kind.
EMULATED = [
    "lane-change/front-nice",
    "intersection/bayesian-nice",
    "intersection/game-nash",
    "intersection/cooperative",
    "intersection/inferred-sensed",
    "t-junction/bayesian-tough",
    "curve/lane-drop-cars",
    "crash/side-impact",
    "building/iterative-warm-nights",
    "building/concurrent-uncertain",
    "building/distributed",
    "building/model-predictive",
]
# glibc chooses its sines and exponentials by these.
WITHOUT_VECTORS = "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F,-AVX,-AVX2_Usable,-FMA_Usable,-AVX512F_Usable"


def digests(command: list[str], **environment: str) -> dict[str, str]:
    """The digests of a suite, by scenario; those of counterfactuals too."""
    made = subprocess.run(command, capture_output=True, text=True, env={**os.environ, **environment})
    if made.returncode not in (0, 1):
        sys.exit(f"{' '.join(command[:6])} … ends with {made.returncode}: {made.stderr[-2000:]}")
    found = {}
    for report in json.loads(made.stdout):
        found[report["scenario"]] = report["digest"]
        for other in report.get("counterfactuals", []):
            found[f"{report['scenario']}: {other['name']}"] = other["digest"]
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0], formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", default="target/release/interplay")
    parser.add_argument("--build", action="append", default=[], metavar="NAME=PATH", help="another build of the command")
    parser.add_argument("--emulated", nargs="*", default=EMULATED, metavar="SCENARIO")
    parser.add_argument("scenarios", nargs="*", metavar="SCENARIO", help="default: all")
    given = parser.parse_args()

    def suite(binary: str, scenarios: list[str]) -> list[str]:
        return [binary, "suite", "--json", *scenarios]

    own = suite(given.binary, given.scenarios)
    print("| how | runs | other digests | s |\n|---|---|---|---|", flush=True)
    reference: dict[str, str] = {}
    differing = 0

    def row(how: str, command: list[str], **environment: str) -> None:
        nonlocal differing
        began = time.monotonic()
        found = digests(command, **environment)
        if not reference:
            reference.update(found)
        unknown = found.keys() - reference.keys()
        if unknown or not found:
            sys.exit(f"{how}: other runs than before: {sorted(unknown)}")
        others = sorted(name for name in found if found[name] != reference[name])
        differing += len(others)
        print(f"| {how} | {len(found)} | {len(others)} | {time.monotonic() - began:.0f} |", flush=True)
        for name in others:
            print(f"differs, {how}: {name}", file=sys.stderr, flush=True)

    row("as it is", own)
    for jobs in [1, 2, 4, 8]:
        row(f"`--jobs {jobs}`", [*own, "--jobs", str(jobs)], RAYON_NUM_THREADS=str(jobs))
    if shutil.which("taskset"):
        row("on one core (`taskset`)", ["taskset", "-c", "0", *own])
    else:
        print("skipped: no taskset here", file=sys.stderr)
    row("glibc without AVX and FMA", own, GLIBC_TUNABLES=WITHOUT_VECTORS)
    for build in given.build:
        name, path = build.split("=", 1)
        row(name, suite(path, given.scenarios))
    emulator = shutil.which("qemu-x86_64") or shutil.which("qemu-x86_64-static")
    for processor, has in [("Nehalem", "no AVX"), ("Haswell", "AVX2 and FMA")] if emulator and given.emulated else []:
        command = [emulator, "-cpu", processor, *suite(given.binary, given.emulated)]
        row(f"emulated {processor} ({has})", command)
    if not emulator:
        print("skipped: no qemu-x86_64 here to emulate other processors", file=sys.stderr)
    return min(differing, 1)


if __name__ == "__main__":
    sys.exit(main())
