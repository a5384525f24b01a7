"""Every planner as the ego of recorded scenes: among recorded cars, among recorded cars that hand over, and among drivers of ours.

    python tests/peers/commonroad_planners.py FOLDER [--program INTERPLAY] [--scenes 10] [--seed 1] [--planners human,idm]

FOLDER has scenarios of CommonRoad with recorded cars and a planning problem. Of the distinct ones whose run lasts at least 2.5 s, some are drawn
by the seed. Each is driven by each planner in four kinds of traffic:

    recorded    every vehicle follows its record
    hands over  every vehicle follows its record until that would lead into another, and then drives as a normal human
    humans      every vehicle is a human of the style `measured`
    idm         every vehicle drives after the intelligent driver model

A table says, for each kind of traffic and planner, how many runs had a contact of the ego, how far the ego came on average as a share of how far it
came with the planner that came farthest in that scene and traffic, and how hard it braked. Ranks of planners by that progress, contacts last, are
compared between kinds of traffic by Kendall's tau. Without scenarios it says that it skips.
"""

import argparse
import csv
import hashlib
import itertools
import json
import random
import subprocess
import sys
import tempfile
from pathlib import Path

PLANNERS = ["human", "idm", "conservative", "negotiation", "bayesian", "game", "contingency", "nash"]
TRAFFIC = {
    "recorded": ([], []),
    "hands over": ([], ['defaults.driver={ kind = "recorded", hands_over = { to = "human", when = "disturbed" } }']),
    "humans": (["--replace", "all=human:measured"], []),
    "idm": (["--replace", "all=idm"], []),
}
LEAST_S = 2.5


def scenes(folder, count, seed):
    distinct = {}
    for path in sorted(Path(folder).rglob("*.xml")):
        text = path.read_text(errors="replace")
        if "<planningProblem" in text and text.count("<dynamicObstacle") >= 3:
            distinct.setdefault(hashlib.sha256(text.encode()).hexdigest(), path)
    drawn = sorted(distinct.values())
    random.Random(seed).shuffle(drawn)
    return drawn


def imported(program, path, replace, folder, name):
    out = Path(folder) / f"{name}.toml"
    done = subprocess.run([program, "import", str(path), "--out", str(out), *replace], capture_output=True, text=True)
    return out if done.returncode == 0 and out.exists() else None


def driven(program, scenario, planner, settings):
    sets = list(itertools.chain.from_iterable(("--set", setting) for setting in settings))
    table = Path(scenario).with_suffix(".trajectories.csv")
    table.unlink(missing_ok=True)
    command = [program, "run", str(scenario), "--planner", planner, "--no-record", "--json", "--trajectories", str(table)]
    done = subprocess.run([*command, *sets], capture_output=True, text=True, timeout=900)
    if not done.stdout.startswith("{"):
        return None
    with table.open() as rows:
        speeds = [float(row["speed_mps"]) for row in csv.DictReader(rows) if row["vehicle"] == "ego"]
    return {**json.loads(done.stdout), "mean_speed_mps": sum(speeds) / len(speeds)}


def outcome(report):
    ego = next(vehicle for vehicle in report["vehicles"] if vehicle["name"] == "ego")
    contact = any("ego" in hit["between"] for hit in report["collisions"])
    return {
        "contact": contact,
        "by_ego": bool(report.get("contact_by_ego")),
        "speed": report["mean_speed_mps"],
        "braking": ego["peak_braking_mps2"] or 0.0,
    }


def tau(first, second):
    pairs = list(itertools.combinations(first, 2))
    agree = sum((first[a] - first[b]) * (second[a] - second[b]) > 0 for a, b in pairs)
    against = sum((first[a] - first[b]) * (second[a] - second[b]) < 0 for a, b in pairs)
    return (agree - against) / len(pairs)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder")
    parser.add_argument("--program", default="interplay")
    parser.add_argument("--scenes", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--planners", default=",".join(PLANNERS))
    options = parser.parse_args()
    planners = options.planners.split(",")
    candidates = scenes(options.folder, options.scenes, options.seed)
    if not candidates:
        sys.exit(print(f"skipped: no recorded scenes with planning problems in {options.folder}"))
    results = {traffic: {planner: [] for planner in planners} for traffic in TRAFFIC}
    used = []
    with tempfile.TemporaryDirectory() as folder:
        for path in candidates:
            if len(used) == options.scenes:
                break
            files = {
                traffic: imported(options.program, path, replace, folder, f"{len(used)}-{number}")
                for number, (traffic, (replace, _)) in enumerate(TRAFFIC.items())
            }
            if None in files.values():
                continue
            first = driven(options.program, files["recorded"], "idm", [])
            if first is None or first["simulated_s"] < LEAST_S:
                continue
            used.append(path.stem)
            for traffic, (_, settings) in TRAFFIC.items():
                reports = {planner: driven(options.program, files[traffic], planner, settings) for planner in planners}
                found = {planner: outcome(report) for planner, report in reports.items() if report}
                fastest = max(result["speed"] for result in found.values()) or 1.0
                for planner, result in found.items():
                    results[traffic][planner].append({**result, "share": result["speed"] / fastest})
            print(f"{len(used)}: {path.stem}", file=sys.stderr, flush=True)
    print(f"{len(used)} scenes: {', '.join(used)}\n")
    ranks = {}
    for traffic, of_planners in results.items():
        print(f"| {traffic} | runs | contacts (by the ego) | progress | hardest braking, median [m/s2] |\n|---|---|---|---|---|")
        worth = {}
        for planner, runs in of_planners.items():
            count = len(runs)
            contacts, own = sum(run["contact"] for run in runs), sum(run["contact"] and run["by_ego"] for run in runs)
            share = sum(run["share"] for run in runs) / max(count, 1)
            braking = sorted(run["braking"] for run in runs)[count // 2] if runs else float("nan")
            worth[planner] = share - contacts / max(count, 1)
            print(f"| {planner} | {count} | {contacts} ({own}) | {100 * share:.0f} % | {braking:.1f} |")
        ranks[traffic] = worth
        print()
    for first, second in itertools.combinations(TRAFFIC, 2):
        print(f"tau of the ranks, {first} and {second}: {tau(ranks[first], ranks[second]):.2f}")


if __name__ == "__main__":
    main()
