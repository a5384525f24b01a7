"""Processor time of traffic after the intelligent driver model on three lanes, beside SUMO 1.28, alternating in one run.

    python -m venv venv && venv/bin/pip install eclipse-sumo==1.28.0
    cargo build --release -p interplay -p interplay-simulation --example throughput
    venv/bin/python python/benchmarks/beside_sumo.py [vehicles ...]

Both move every vehicle and let it decide every 0.1 s. Each program runs for two durations, one after the other in turns; the processor
time of the longer less that of the shorter is that of the difference, without start and reading. The medians of the rounds count. Ours is
measured three times: subscribed to the contacts, the progress and the digest of the states (the example `throughput`), as `run` with its
report, and as SUMO is with `--lateral-resolution`, which moves vehicles across their lanes as ours always does.

Without `eclipse-sumo` it says that it skips.
"""

from __future__ import annotations

import os
import resource
import statistics
import subprocess
import sys
import tempfile
from importlib import metadata, util
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COUNTS = (80, 320, 1000, 5000)
DURATIONS_S = (10, 30)
ROUNDS = 3
SPACING_M = 40.0
LANES = 3


def places(count: int) -> list[tuple[int, float, float]]:
    """Lane, place from the front of the road backwards [m] and speed [m/s] of each car."""
    return [(i % LANES, -SPACING_M * (i // LANES) - 13.0 * (i % LANES), 23.4 + 0.8 * ((i * 7) % 5)) for i in range(count)]


def scenario(count: int, seconds: int) -> str:
    head = f"""title = "Motorway"
shows = "Three lanes"
scale = "full"
duration_s = {seconds}.0
step_s = 0.1
planning_period_s = 0.1
horizon_steps = 40
budget = {{ plans = 1000000000, steps = 100000000000 }}
road = {{ kind = "lanes", lane_count = {LANES}, lane_width_m = 3.5 }}
defaults = {{ class = "car", driver = {{ kind = "idm" }} }}
"""
    cars = (
        f'[[vehicle]]\nname = "car-{i}"\nstart = {{ lane = {lane}, along_m = {along:.1f}, speed_mps = {speed:.1f} }}\n'
        f"goal = {{ lane = {lane}, speed_mps = {speed:.1f} }}\n"
        for i, (lane, along, speed) in enumerate(places(count))
    )
    return head + "".join(cars)


def sumo_files(folder: Path, count: int) -> tuple[Path, Path]:
    """The network and the vehicles of SUMO; cars start where ours do."""
    nodes, edges, network, routes = (folder / name for name in ("n.nod.xml", "e.edg.xml", "net.xml", "r.rou.xml"))
    back_m = SPACING_M * (count // LANES + 2)
    nodes.write_text(f'<nodes><node id="a" x="0" y="0"/><node id="b" x="{back_m + 5000.0}" y="0"/></nodes>')
    edges.write_text(f'<edges><edge id="e" from="a" to="b" numLanes="{LANES}" speed="50" width="3.5"/></edges>')
    program = sumo_program("netconvert")
    subprocess.run([program, "-n", nodes, "-e", edges, "-o", network], check=True, capture_output=True)
    # All cars are there from the start, also those whose gap SUMO would not insert them into.
    cars = (
        f'<vehicle id="{i}" type="idm" route="r" depart="0" departLane="{lane}" departPos="{back_m + along:.1f}" '
        f'departSpeed="{speed:.1f}" insertionChecks="none"/>'
        for i, (lane, along, speed) in enumerate(places(count))
    )
    kind = '<vType id="idm" carFollowModel="IDM" accel="1.4" decel="2.0" tau="1.5" minGap="2" maxSpeed="27" speedDev="0"/>'
    routes.write_text(f'<routes>{kind}<route id="r" edges="e"/>{"".join(cars)}</routes>')
    return network, routes


def sumo_program(name: str) -> str:
    spec = util.find_spec("sumo")
    assert spec is not None and spec.origin is not None
    return str(Path(spec.origin).parent / "bin" / name)


def processor_s(command: list[str]) -> float:
    """User and system time of a command [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def commands(folder: Path, count: int, seconds: int) -> dict[str, list[str]]:
    network, routes = folder / "net.xml", folder / "r.rou.xml"
    sumo = [sumo_program("sumo"), "-n", str(network), "-r", str(routes), "--step-length", "0.1", "--end", str(seconds)]
    sumo += ["--no-step-log", "--duration-log.disable", "--collision.action", "none", "--time-to-teleport", "-1"]
    file = folder / f"{seconds}.toml"
    file.write_text(scenario(count, seconds))
    release = ROOT / "target" / "release"
    return {
        "SUMO": sumo,
        "SUMO, sublane": [*sumo, "--lateral-resolution", "0.8"],
        "subscribed": [str(release / "examples" / "throughput"), "subscribed", str(file)],
        "run": [str(release / "interplay"), "run", str(file), "--no-record", "--allow-contacts"],
    }


def vehicle_seconds(count: int) -> dict[str, float]:
    """Vehicle-seconds a second of processor time of each program."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        sumo_files(folder, count)
        both = [commands(folder, count, seconds) for seconds in DURATIONS_S]
        found: dict[str, list[float]] = {program: [] for program in both[0]}
        for _ in range(ROUNDS):
            for program in found:
                short_s, long_s = (processor_s(each[program]) for each in both)
                found[program].append(count * (DURATIONS_S[1] - DURATIONS_S[0]) / max(long_s - short_s, 1e-2))
        return {program: statistics.median(each) for program, each in found.items()}


def main() -> None:
    if util.find_spec("sumo") is None:
        print("skipped: eclipse-sumo is not installed")
        return
    print(f"SUMO {metadata.version('eclipse-sumo')}, {os.cpu_count()} cores; vehicle-seconds a second of processor time")
    counts = [int(word) for word in sys.argv[1:]] or COUNTS
    print("| vehicles | SUMO | SUMO, sublane | subscribed | of SUMO | `run` | of SUMO |\n|---|---|---|---|---|---|---|")
    for count in counts:
        rates = vehicle_seconds(count)
        sumo, sublane, subscribed, run = rates.values()
        shares = [f"{subscribed:.0f} | {subscribed / sumo:.2f}", f"{run:.0f} | {run / sumo:.2f}"]
        print(f"| {count} | {sumo:.0f} | {sublane:.0f} | {' | '.join(shares)} |", flush=True)


if __name__ == "__main__":
    main()
