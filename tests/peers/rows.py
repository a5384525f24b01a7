"""Dense rows of people: 80 cars on three lanes, and rows behind a slow vehicle. Do they touch, and do they settle?

    python tests/peers/rows.py [--binary target/release/interplay] [--only crowd rows] [--seconds 60]

`crowd`: 80 cars at about 25 m/s on three lanes, 40 m apart in each, each with its own wanted speed (23.4 to 26.6 m/s), 60 s; all of one
style, and of the styles in turn. `rows`: 12 cars that want 30 m/s behind one at a constant speed, on one lane, 150 s and longer; a row has
settled if all are within 0.5 m/s of the leader over the last 20 s. Prints tables; exit code 1 if any touch or do not settle.
"""

import argparse
import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

STYLES = ["nice", "considerate", "normal", "assertive", "tough"]
FOLLOWERS, WANTED_MPS, SETTLED_MPS, LAST_S = 12, 30.0, 0.5, 20.0
SPEEDS_MPS = [2.0, 5.0, 10.0, 15.0, 20.0, 25.0]
BUDGET = "budget = { plans = 100_000_000, steps = 1_000_000_000 }\n"


def human(style: str) -> str:
    return f'{{ kind = "human", style = "{style}" }}'


def crowd(styles: list[str], seconds: float) -> str:
    text = (
        f'title = "A motorway"\nshows = "Three lanes"\nscale = "full"\nduration_s = {seconds}\n' + BUDGET
        + 'road = { kind = "lanes", lane_count = 3, lane_width_m = 3.5 }\ndefaults = { class = "car" }\n'
    )
    for index in range(80):
        lane, place = index % 3, index // 3
        speed_mps = 25.0 + 0.8 * ((index * 7) % 5) - 1.6
        text += (
            f'[[vehicle]]\nname = "car-{index}"\nstart = {{ lane = {lane}, along_m = {-40.0 * place - 13.0 * lane}, speed_mps = {speed_mps:.1f} }}\n'
            f"goal = {{ lane = {lane}, speed_mps = {speed_mps:.1f} }}\ndriver = {human(styles[index % len(styles)])}\n"
        )
    return text


def row(style: str, speed_mps: float, seconds: float) -> str:
    text = (
        f'title = "A row of cars"\nshows = "A row of cars behind a slow one"\nscale = "full"\nduration_s = {seconds}\n' + BUDGET
        + 'road = { kind = "lanes", lane_count = 1, lane_width_m = 3.5 }\n'
        + f'defaults = {{ class = "car", driver = {human(style)} }}\n[[vehicle]]\nname = "ego"\ndriver = {{ kind = "idm" }}\n'
        + f"start = {{ lane = 0, along_m = 0.0, speed_mps = {speed_mps} }}\ngoal = {{ speed_mps = {speed_mps} }}\n"
    )
    for number in range(1, FOLLOWERS + 1):
        along_m = -number * (10.0 + 2.0 * speed_mps)
        text += (
            f'[[vehicle]]\nname = "car-{number}"\nstart = {{ lane = 0, along_m = {along_m}, speed_mps = {speed_mps} }}\n'
            f"goal = {{ speed_mps = {WANTED_MPS} }}\n"
        )
    return text


def run(binary: Path, text: str):
    """The report, and of each vehicle its speeds and positions over time."""
    with tempfile.TemporaryDirectory() as folder:
        file, table = Path(folder) / "row.toml", Path(folder) / "row.csv"
        file.write_text(text)
        command = [binary, "run", file, "--no-record", "--json", "--trajectories", table]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode not in (0, 1):
            sys.exit(done.stderr)
        ways = {}
        for one in csv.DictReader(table.open()):
            ways.setdefault(one["vehicle"], []).append(tuple(float(one[key]) for key in ("time_s", "x_m", "y_m", "speed_mps")))
        return json.loads(done.stdout), ways


def contacts(report) -> tuple[int, int, str]:
    hits = report["collisions"]
    at_fault = sum(bool(one.get("fault")) for one in hits)
    return len(hits), at_fault, f"{min(one['time_s'] for one in hits):.1f}" if hits else ""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", type=lambda path: Path(path).resolve(), default=Path("target/release/interplay").resolve())
    parser.add_argument("--only", nargs="*", default=["crowd", "rows"])
    parser.add_argument("--styles", nargs="*", default=["normal", "tough"])
    parser.add_argument("--speeds", nargs="*", type=float, default=SPEEDS_MPS)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--row-seconds", type=float, default=300.0)
    options = parser.parse_args()
    is_well = True
    if "crowd" in options.only:
        print("| 80 people | contacts | first after s | lowest speed m/s | on a lane line for more than 5 s |\n|---|---|---|---|---|")
        for styles in [["normal"], ["tough"], STYLES]:
            report, ways = run(options.binary, crowd(styles, options.seconds))
            count, _, first = contacts(report)
            lowest_mps = min(mps for way in ways.values() for *_, mps in way)
            astride = sum(longest_astride_s(way) > 5.0 for way in ways.values())
            print(f"| {', '.join(styles)} | {count} | {first} | {lowest_mps:.1f} | {astride} |", flush=True)
            is_well &= count == 0
    if "rows" in options.only:
        print("| row | leader m/s | settled | spacing m | contacts | first after s | lowest m/s | most aside m |\n|" + "---|" * 8)
        for style in options.styles:
            for speed_mps in options.speeds:
                report, ways = run(options.binary, row(style, speed_mps, options.row_seconds))
                count, _, first = contacts(report)
                end_s = max(at[0] for at in ways["ego"])
                last = [at for name, way in ways.items() if name != "ego" for at in way if at[0] > end_s - LAST_S]
                settled = all(abs(at[3] - speed_mps) < SETTLED_MPS for at in last)
                ends = sorted((way[-1][1] for name, way in ways.items()), reverse=True)
                aside_m = max(abs(at[2] - 1.75) for at in last)
                spacing_m = (ends[0] - ends[-1]) / (len(ends) - 1)
                lowest_mps = min(at[3] for at in last)
                word = "yes" if settled else "no"
                print(f"| {style} | {speed_mps:.0f} | {word} | {spacing_m:.1f} | {count} | {first} | {lowest_mps:.1f} | {aside_m:.2f} |", flush=True)
                is_well &= settled and count == 0
    return 0 if is_well else 1


def longest_astride_s(way) -> float:
    """How long a car of 1.8 m is over a lane line at once."""
    longest, since = 0.0, None
    for time_s, _, y_m, _ in way:
        off_m = abs(y_m % 3.5 - 1.75)
        since = (time_s if since is None else since) if off_m > 0.85 else None
        longest = max(longest, time_s - since if since is not None else 0.0)
    return longest


if __name__ == "__main__":
    sys.exit(main())
