"""Stops, cut-ins, pull-outs and crossings that are not announced: which contacts could braking have avoided?

    python tests/peers/unannounced.py --interplay target/release/interplay --kind stops --count 600
    python tests/peers/unannounced.py --kind all --count 48 --keep FOLDER

`--count` is the number of files of each kind. File `i` of a kind depends on `--seed` and `i` alone, its driver is number `i` of
`DRIVERS`, counted round, and half of the intruders (leaders that stop, vehicles that cut in, pull out or cross) follow a record (CSV),
the others a script. Exit codes: 0 no avoidable contact, 1 an avoidable contact, 2 wrong arguments or a run that did not finish.

Closed form of avoidability. Let `v` be the speed of the driver, `b = -limits.acceleration_min_mps2` (a car: 6.4 m/s²), `r` its
reaction time (human 0.6 s, others 0), `T` the planning period (0.2 s), and `t_s` the first tick (every 0.1 s) whose state shows the
motion. Braking with `b` begins one plan after the first plan that can know of it, at `t_b = T ceil((t_s + r) / T) + T`; the limit
of jerk is left out. Until `t_b` the driver moves as it did in the run, in the textbook with `v`. With `τ = t_b − t_s` it is
`x(t) = v τ + v t' − b t'²/2` further on `t' = t − t_b` later, and stands after `v τ + v²/(2b)`. So a contact is avoidable

- behind a leader at gap `d` that brakes from `u` with `a`, if `v τ + v²/(2b) < d + u²/(2a)`, and, where the leader is still moving when
  the speeds are equal, at `t* = (v + b τ − u)/(b − a)` with `b > a`, also `x(t*) < d + u t* − a t*²/2`;
- behind a vehicle that cuts in with `u` at gap `d`, if `(v − u) τ + (v − u)²/(2b) < d`;
- before a vehicle across the lane at distance `d`, if `v τ + v²/(2b) < d`, or if that vehicle has left the lane before.

These are one condition: at no tick does the braking driver overlap what the intruder's body covers of the driver's strip (its width,
straight ahead in its lane). `margin` evaluates it with the intruder's driven motion, of any form; differences from the formulas are
below 1 cm, from its sampling at ticks. The same holds for the vehicle that was touched (another follower, a vehicle
beside), so a swerve into a third vehicle counts as avoidable if braking in the lane avoids both.

When motion shows: a leader's, when it brakes with more than 0.5 m/s²; sideways motion, at 0.375 m from where it began (the wandering
zone of UN Regulation 157); that of a vehicle without right of way, when it could stop before the strip only by braking harder than
3 m/s²; that of another driver that was touched, when its last braking before the contact began, or, where it did not brake, when the
intruder's motion showed. A contact before all that is avoidable: there was no reason for it.

Of two drivers that touch, the one that moved sideways is judged, otherwise the rear one. Later contacts of drivers that were in one are
not judged, since the run continues as if there had been none.

`stand` counts drivers that stand at the end although the way ahead is free for 15 m, `not 2-4 m` the followers that are not 2 to 4 m
behind the vehicle ahead 15 s after their leader stopped, of `followers` without contact. Intervals are Wilson's, at 95 %.
"""

import argparse
import concurrent.futures
import csv
import functools
import itertools
import json
import math
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from unannounced_cases import BODIES, BRAKING_MPS2, DRIVERS, KINDS, PLAN_S, STEP_S, STYLES, make

REACTION_S, SHOWN_BRAKING_MPS2, SHOWN_SIDEWAYS_M = 0.6, 0.5, 0.375
#: Least gap that counts as avoided, more than the error of sampling [m].
LEAST_M = 0.05
#: A driver that stops braking for at most this long brakes on, and stands below this speed [m/s].
PAUSE_TICKS, STANDING_MPS = 10, 0.1
#: A driver that moved this far sideways is judged for a contact with another driver [m].
SWERVE_M = 0.6

HEAD = ["kind", "driver", "runs", "runs with contact", "runs with avoidable contact", "contacts", "avoidable", "stand", "followers"]
HEAD += ["not 2-4 m", "median gap m"]


class Way:
    """The line of the drivers' lane: distances along it and beside it. Beyond its ends it is straight."""

    def __init__(self, points, heading):
        (x, y), far = points[0], 1000.0
        self.points = [(x - far * math.cos(heading), y - far * math.sin(heading)), points[0]]
        for point in points[1:]:
            if math.dist(point, self.points[-1]) > 1.0:
                self.points.append(point)
        (x0, y0), (x1, y1) = self.points[-2:]
        reach = far / math.dist((x0, y0), (x1, y1))
        self.points.append((x1 + reach * (x1 - x0), y1 + reach * (y1 - y0)))

    def project(self, x, y, heading):
        """Distance along the line, distance to its left, and the heading from its direction."""
        best, passed = None, 0.0
        for (x0, y0), (x1, y1) in itertools.pairwise(self.points):
            length = math.dist((x0, y0), (x1, y1))
            cos, sin = (x1 - x0) / length, (y1 - y0) / length
            along = min(max((x - x0) * cos + (y - y0) * sin, 0.0), length)
            off = math.dist((x, y), (x0 + along * cos, y0 + along * sin))
            if best is None or off < best[0]:
                best = off, passed + along, (y - y0) * cos - (x - x0) * sin, heading - math.atan2(sin, cos)
            passed += length
        return best[1:]


class Drive:
    """What the vehicles of a run did, seen along the way of its drivers."""

    def __init__(self, case, table):
        self.case, self.tracks = case, {}
        with table.open() as rows:
            for row in csv.DictReader(rows):
                state = tuple(float(row[key]) for key in ("x_m", "y_m", "heading_rad", "speed_mps"))
                self.tracks.setdefault(row["vehicle"], []).append(state)
        leader = self.tracks["leader" if case.line is None else "intruder"]
        points = [state[:2] for state in leader] if case.line is None else [case.line(0.0)[:2], case.line(100.0)[:2]]
        self.way = Way(points, leader[0][2] if case.line is None else 0.0)
        self.intruder = "leader" if case.line is None else "intruder"
        self.last = len(leader) - 1

    @functools.cache
    def seen(self, name, tick):
        return (*self.way.project(*self.tracks[name][tick][:3]), self.tracks[name][tick][3])

    def covered(self, name, tick, low, high):
        """The first and the last distance along the way that the body covers in a strip; None if it is beside the strip."""
        s, n, heading, _ = self.seen(name, tick)
        front, rear, width = BODIES[self.case.classes[name]]
        cos, sin = math.cos(heading), math.sin(heading)
        corners = [(front, width / 2), (front, -width / 2), (-rear, -width / 2), (-rear, width / 2)]
        corners = [(s + along * cos - left * sin, n + along * sin + left * cos) for along, left in corners]
        inside = [s for s, n in corners if low <= n <= high]
        for (s0, n0), (s1, n1) in zip(corners, corners[1:] + corners[:1]):
            inside += [s0 + (edge - n0) / (n1 - n0) * (s1 - s0) for edge in (low, high) if (n0 - edge) * (n1 - edge) < 0.0]
        return (min(inside), max(inside)) if inside else None

    def brakes(self, name, tick):
        return self.tracks[name][tick - 1][3] - self.tracks[name][tick][3] > SHOWN_BRAKING_MPS2 * STEP_S

    def intruder_shows(self):
        """The first tick whose state shows the motion of the intruder; None if there is none."""
        if self.case.shows_s is not None:
            return math.ceil(self.case.shows_s / STEP_S)
        onset = round(self.case.onset_s / STEP_S)
        for tick in range(onset + 1, self.last + 1):
            moved_m = abs(self.seen(self.intruder, tick)[1] - self.seen(self.intruder, onset)[1])
            if self.brakes(self.intruder, tick) or moved_m > SHOWN_SIDEWAYS_M:
                return tick
        return None

    def driver_shows(self, name, contact):
        """The first tick of the last time that a driver braked or stood before a contact; None if it did neither."""
        first, tick = None, contact
        while tick > 0 and (first or contact) - tick <= PAUSE_TICKS:
            if self.brakes(name, tick) or self.tracks[name][tick][3] < STANDING_MPS:
                first = tick
            tick -= 1
        return first

    def margin(self, name, others, shown, until):
        """The least gap to the others if the driver brakes at its limit one plan after it can know; negative if they touch."""
        reaction = REACTION_S if self.case.drivers[name] in STYLES else 0.0
        begins = round((math.ceil((shown * STEP_S + reaction) / PLAN_S - 1e-6) + 1) * PLAN_S / STEP_S)
        if begins > until:
            return -math.inf
        front, rear, width = BODIES["car"]
        middle, (s, _, _, v) = self.seen(name, min(shown, begins))[1], self.seen(name, begins)
        least = math.inf
        for tick in range(begins, min(max(until, begins + 50) + 30, self.last) + 1):
            braked = min((tick - begins) * STEP_S, v / BRAKING_MPS2)
            at = s + v * braked - 0.5 * BRAKING_MPS2 * braked**2
            for other in others:
                covered = self.covered(other, tick, middle - width / 2, middle + width / 2)
                if covered:
                    least = min(least, max(covered[0] - at - front, at - rear - covered[1]))
        return least

    def judged(self, pair, tick):
        """Which driver of a contact is judged: the one that moved sideways, otherwise the rear one."""
        drivers = [name for name in pair if name in self.case.drivers]
        if len(drivers) < 2:
            return drivers[0]
        moved = {name: abs(self.seen(name, tick)[1] - self.seen(name, 0)[1]) for name in drivers}
        least, most = sorted(drivers, key=moved.get)
        if moved[most] > max(SWERVE_M, moved[least] + SWERVE_M / 2):
            return most
        return min(drivers, key=lambda name: self.seen(name, tick)[0])

    def contacts(self, collisions):
        """Of each first contact of a driver: who, with whom, when, and the margin."""
        found, touched = [], set()
        for collision in sorted(collisions, key=lambda collision: collision["time_s"]):
            pair, tick = collision["between"], min(int(collision["time_s"] / STEP_S), self.last)
            name = self.judged(pair, tick)
            if name not in touched:
                other = next(other for other in pair if other != name)
                shown = None if other == self.intruder else self.driver_shows(other, tick)
                if shown is None and collision["time_s"] > self.case.onset_s:
                    shown = self.intruder_shows()
                margin = math.inf if shown is None else self.margin(name, {other, self.intruder}, shown, tick)
                found.append((name, other, collision["time_s"], margin))
            touched.update(pair)
        return found

    def room(self, name, tick):
        """The gap to the next vehicle ahead in the strip of a driver."""
        s, n, _, _ = self.seen(name, tick)
        front, _, width = BODIES["car"]
        ahead = [self.covered(other, tick, n - width / 2, n + width / 2) for other in self.tracks if other != name]
        return min((covered[0] - s - front for covered in ahead if covered and covered[1] > s), default=math.inf)

    def ends(self, touched):
        """Gaps of followers behind the leader that stands, and how many drivers stand with their way free at the end."""
        clear = [name for name in self.case.followers if name not in touched]
        gaps = []
        if self.case.stands_until_s is not None:
            tick = min(int(self.case.stands_until_s / STEP_S), self.last)
            leader = self.seen(self.intruder, tick)[0]
            behind = [name for name in clear if self.seen(name, tick)[0] < leader]
            gaps = [gap for gap in (self.room(name, tick) for name in behind) if gap < math.inf]
        free = [name for name in clear if self.room(name, self.last) > 15.0]
        return gaps, sum(self.tracks[name][self.last][3] < STANDING_MPS for name in free)


def run(program, folder, job):
    """One file: its case, contacts, gaps and standing drivers, or what went wrong."""
    kind, index, seed = job
    case = make(kind, index, seed, folder)
    file, table = folder / f"{case.name}.toml", folder / f"{case.name}-run.csv"
    command = [program, "run", str(file), "--no-record", "--json", "--trajectories", str(table)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        return case, [], [], 0, f"{file}: exit code {done.returncode}\n{done.stderr.strip()}"
    drive = Drive(case, table)
    table.unlink()
    collisions = json.loads(done.stdout)["collisions"]
    gaps, stand = drive.ends({name for collision in collisions for name in collision["between"]})
    return case, drive.contacts(collisions), gaps, stand, None


def share(count, of):
    """A count with Wilson's interval of 95 % of its share."""
    if not of:
        return "–"
    z, p = 1.959964, count / of
    middle, half = p + z * z / (2 * of), z * math.sqrt(p * (1 - p) / of + z * z / (4 * of * of))
    low, high = (100 * max(bound, 0.0) / (1 + z * z / of) for bound in (middle - half, middle + half))
    return f"{count} ({low:.0f} to {high:.0f} %)"


def print_table(results):
    print("| " + " | ".join(HEAD) + " |\n" + "|---" * len(HEAD) + "|")
    rows = [(kind, driver) for kind in KINDS for driver in [*DRIVERS, "all"]]
    for kind, driver in rows:
        of = [result for result in results if result[0].kind == kind and driver in (result[0].driver, "all") and not result[4]]
        if not of:
            continue
        avoidable = [[contact for contact in contacts if contact[3] > LEAST_M] for _, contacts, *_ in of]
        gaps = [gap for result in of for gap in result[2]]
        far = sum(not 2.0 <= round(gap, 1) <= 4.0 for gap in gaps)
        cells = [kind, driver, len(of), share(sum(bool(result[1]) for result in of), len(of)), share(sum(map(bool, avoidable)), len(of))]
        cells += [sum(len(result[1]) for result in of), sum(map(len, avoidable)), sum(result[3] for result in of), len(gaps)]
        cells += [share(far, len(gaps)), f"{statistics.median(gaps):.1f}" if gaps else "–"]
        print("| " + " | ".join(map(str, cells)) + " |")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--interplay", default="target/release/interplay", help="the program")
    parser.add_argument("--kind", choices=[*KINDS, "all"], default="all")
    parser.add_argument("--count", type=int, default=24, help="files of each kind")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="runs at a time")
    parser.add_argument("--keep", type=Path, help="folder for all files; without it those of avoidable contacts stay in a temporary one")
    options = parser.parse_args()
    if not shutil.which(options.interplay):
        parser.error(f"`{options.interplay}` is not a program; build it, or name it with --interplay")
    if options.count < 1 or options.jobs < 1:
        parser.error("--count and --jobs are at least 1")
    return options


def main():
    options = arguments()
    folder = options.keep or Path(tempfile.mkdtemp(prefix="unannounced-"))
    folder.mkdir(parents=True, exist_ok=True)
    kinds = KINDS if options.kind == "all" else [options.kind]
    jobs = [(kind, index, options.seed) for kind in kinds for index in range(options.count)]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        results = list(pool.map(functools.partial(run, options.interplay, folder), jobs))
    print_table(results)
    faults = {}
    for case, contacts, *_ in results:
        for name, other, time_s, margin in contacts:
            if margin > LEAST_M:
                spare = "before the motion showed" if margin == math.inf else f"braking leaves {margin:.1f} m"
                lines = faults.setdefault(case.name, [f"{folder / case.name}.toml: {case.note}"])
                lines.append(f"    {time_s:.1f} s: {name} touches {other}; {spare}")
    if faults:
        print("\nAvoidable contacts (`interplay run FILE --no-record`):")
        print("\n".join(line for lines in faults.values() for line in lines))
    unfinished = [result[4] for result in results if result[4]]
    if unfinished:
        print("\nNot finished:", *unfinished, sep="\n")
    for case, *_, problem in [] if options.keep else results:
        if case.name not in faults and not problem:
            for file in folder.glob(f"{case.name}*"):
                file.unlink()
    if not any(folder.iterdir()):
        folder.rmdir()
    return 1 if faults else 2 if unfinished else 0


if __name__ == "__main__":
    sys.exit(main())
