#!/usr/bin/env python3
"""Compares what `interplay check` says of the processor time of runs with what they take.

    python tests/peers/plan_times.py RUNS SEED [INTERPLAY]

Each run is an authored scenario with vehicles, of which two thirds get another planner and two thirds another horizon. Prints how many are
right within a factor of three, those that are not, and for each kind of driver the median ratio. Needs a Unix system.
"""

import collections
import json
import random
import re
import resource
import statistics
import subprocess
import sys

KINDS = ["negotiation", "bayesian", "game", "conservative", "cooperative", "contingency", "nash", "idm", "human"]
FACTOR = 3.0


def processor_s(command):
    """Processor time of a command [s]; none if it fails."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    ended = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return used_s if ended.returncode in (0, 1) else None


def main():
    runs, seed = int(sys.argv[1]), int(sys.argv[2])
    interplay = sys.argv[3] if len(sys.argv) > 3 else "interplay"
    listed = json.loads(subprocess.run([interplay, "list", "--json"], stdout=subprocess.PIPE, check=True).stdout)
    names = [row["name"] for row in listed if not row["name"].startswith(("building/", "mixed/"))]
    draw = random.Random(seed)
    ratios = []
    while len(ratios) < runs:
        name, kind = draw.choice(names), draw.choice([*KINDS, None, None, None, None])
        horizon = draw.choice([None, None, 15, 20, 40, 60])
        changes = ["--set", "counterfactual=[]"]
        changes += ["--planner", kind] if kind else []
        changes += ["--set", f"horizon_steps={horizon}"] if horizon else []
        said = subprocess.run([interplay, "check", name, *changes], stdout=subprocess.PIPE, text=True, check=False).stdout
        predicted = re.search(r"about ([\d.]+) s of a processor", said)
        taken_s = processor_s([interplay, "run", name, "--no-record", "--json", *changes]) if predicted else None
        if taken_s is not None:
            # A tenth of a second is as good as nothing.
            ratios.append(((float(predicted[1]) + 0.1) / (taken_s + 0.1), name, kind, horizon, taken_s))
    wrong = [one for one in ratios if not 1 / FACTOR <= one[0] <= FACTOR]
    print(f"{len(ratios) - len(wrong)} of {len(ratios)} within a factor of {FACTOR:.0f}")
    for ratio, name, kind, horizon, taken_s in sorted(wrong, key=str):
        print(f"  {ratio:.2f} of {taken_s:.2f} s: {name}, planner {kind or 'of the file'}, horizon {horizon or 'of the file'}")
    by_kind = collections.defaultdict(list)
    for ratio, _, kind, *_ in ratios:
        by_kind[kind or "of the file"].append(ratio)
    for kind, values in sorted(by_kind.items()):
        print(f"{kind}: median ratio {statistics.median(values):.2f} of {len(values)}")


main()
