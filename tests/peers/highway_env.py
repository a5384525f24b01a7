"""How much faster than real time are highway-env and Interplay, on one machine, in one run of this script?

    pip install highway-env
    python tests/peers/highway_env.py [--binary target/release/interplay] [--repetitions 15]

Every repetition runs each case once, one after the other, so that a load of the machine falls on all of them. highway-env drives
its own merge and intersection with the settings that it comes with, without drawing: its ego keeps the action "idle", all others
follow IDM and MOBIL. A repetition of it is 10 episodes with seeds of their own; only `step` is timed. Interplay runs a scenario
without a recording; the time is `wall_s` of its report. On both sides the start of the program is left out.

Prints a table of medians, and ends well with a word where the package is not installed.
"""

import argparse
import datetime
import json
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

EPISODES = 10
IDLE = 1
# Scenario, what to call the case, and flags. With `--planner` the scenario is run alone, without its counterfactuals.
IDM = ["--planner", "idm"]
for name in ("front", "rear"):
    IDM += ["--set", f'vehicle.{name}.driver={{ kind = "idm" }}']
OURS = [
    ("ramp-merge/nice", "negotiating ego", ["--planner", "negotiation"]),
    ("ramp-merge/nice", "conservative ego", ["--planner", "conservative"]),
    ("ramp-merge/nice", "all IDM", IDM),
    ("intersection/nice", "negotiating ego", ["--planner", "negotiation"]),
    ("intersection/nice", "conservative ego", ["--planner", "conservative"]),
    ("intersection/four-way", "Bayesian ego", ["--planner", "bayesian"]),
]
PEERS = ["merge-v0", "intersection-v0"]


def run_peer(environment, seed: int):
    """Simulated seconds, wall seconds and mean number of vehicles of some episodes."""
    simulated = wall = vehicle_seconds = 0.0
    bare = environment.unwrapped
    for episode in range(EPISODES):
        environment.reset(seed=seed + episode)
        over = False
        while not over:
            ticks = bare.steps
            begin = time.perf_counter()
            _, _, terminated, truncated, _ = environment.step(IDLE)
            wall += time.perf_counter() - begin
            seconds = (bare.steps - ticks) / bare.config["simulation_frequency"]
            simulated += seconds
            vehicle_seconds += seconds * len(bare.road.vehicles)
            over = terminated or truncated
    return simulated, wall, vehicle_seconds / simulated


def run_ours(binary: Path, scenario: str, flags: list[str]):
    """The same of one run; exit code 1 only says that an expectation of the scenario did not hold."""
    command = [binary, "run", scenario, "--no-record", "--json", *flags]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        sys.exit(done.stderr)
    report = json.loads(done.stdout)
    return report["simulated_s"], report["wall_s"], len(report["vehicles"])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", default="target/release/interplay")
    parser.add_argument("--repetitions", type=int, default=15)
    chosen = parser.parse_args()
    binary = Path(chosen.binary).resolve()
    # This script has the name of the package.
    here = Path(__file__).resolve().parent
    sys.path[:] = [folder for folder in sys.path if Path(folder or ".").resolve() != here]
    try:
        import gymnasium
        import highway_env
    except ImportError:
        print("skipped: no highway-env here")
        return 0
    if not binary.exists():
        print(f"skipped: no {binary} here", file=sys.stderr)
        return 0
    gymnasium.register_envs(highway_env)

    cases = {}
    frequencies = {}
    for name in PEERS:
        environment = gymnasium.make(name)
        config = environment.unwrapped.config
        frequencies[name] = (config["simulation_frequency"], config["policy_frequency"])
        cases[f"highway-env `{name}`"] = lambda turn, environment=environment: run_peer(environment, 1000 * turn)
    for scenario, called, flags in OURS:
        cases[f"Interplay `{scenario}`, {called}"] = lambda _, s=scenario, f=flags: run_ours(binary, s, f)

    loads = [os.getloadavg()[0]]
    measured = {name: [] for name in cases}
    for turn in range(chosen.repetitions + 1):
        for name, case in cases.items():
            result = case(turn)
            if turn:  # the first turn warms up
                measured[name].append(result)

    loads.append(os.getloadavg()[0])
    versions = f"highway-env {highway_env.__version__}, Gymnasium {gymnasium.__version__}, Python {sys.version.split()[0]}"
    ours = subprocess.run([binary, "--version"], capture_output=True, text=True).stdout.strip()
    print(f"{datetime.date.today()}; {versions}; {ours}; {chosen.repetitions} repetitions")
    print(f"{os.cpu_count()} cores; load average {loads[0]:.1f} before and {loads[1]:.1f} after")
    for name, (simulation, policy) in frequencies.items():
        print(f"{name}: {simulation} steps of the simulation and {policy} of the ego's policy a second")
    print("\n| case | vehicles | times real time, median | slowest to fastest | vehicle-seconds a second |\n|---|---|---|---|---|")
    for name, results in measured.items():
        factors = [simulated / wall for simulated, wall, _ in results]
        vehicles = statistics.mean(count for _, _, count in results)
        middle = statistics.median(factors)
        print(f"| {name} | {vehicles:.1f} | {middle:.0f} | {min(factors):.0f} to {max(factors):.0f} | {middle * vehicles:.0f} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
