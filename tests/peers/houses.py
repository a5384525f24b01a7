#!/usr/bin/env python3
"""Identifies simulated houses whose truth is known by `interplay identify`, and counts what holds.

    python tests/peers/houses.py --houses 30 --held
    python tests/peers/houses.py --houses 10 --world clock

Houses have an air and a wall, a thermostat that switches within rows of an hour, weather of a random walk and two weeks of telemetry;
heat is recorded as the mean of a row. The simulation shares no code with `building/experiments/identify_coverage`. A world other than
`matched` differs from what the models take for granted (`WORLDS`). With `--held` each house is identified again with the mean heat of
each row held in it.
"""

import argparse
import json
import math
import pathlib
import random
import statistics
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
STEP_S = 3600
DAYS = 14
#: An identified value is off beyond this share.
OFF = 0.25
#: What differs, and the cause that should be named first.
WORLDS = {
    "matched": None,
    "clock": "clock",  # the weather's clock is an hour slow or fast
    "people": "people",  # one to four people and the evening's appliances are in no column
    "sun": "sun",  # the sun shines on the house four hours later than on the sensor
    "late": "late-heat",  # heat is recorded a row late
    "electricity": "varying-gain",  # the electricity of a heat pump is recorded as its heat
}
MAPPING = """walls = [["house", "outdoor"]]
time = { column = "t", format = "seconds", step_s = 3600.0 }
boundary = [{ name = "outdoor", temperature = "Ta", hold = "zero-order" }]
[[zone]]
name = "house"
temperature = "Ti"
heat = [{ kind = "power", column = "Ph", unit = "kw" }]
solar = { column = "Ps", unit = "kw-per-m2", hold = "zero-order" }
"""


def house(seed, world="matched", held=None):
    """True conductance [kW/K], capacity [kJ/K] and aperture [m²], and the rows of telemetry; `held` is heat for each row [kW]."""
    draw = random.Random(seed)
    people = 0.1 * draw.randint(1, 4)
    ua = math.exp(draw.uniform(math.log(0.08), math.log(0.4)))
    capacity = ua * draw.uniform(20, 80) * 3600
    share, inside = draw.uniform(0.1, 0.4), draw.uniform(0.1, 0.25)
    inner, outer, aperture = ua / share, ua / (1 - share), 10 * ua * draw.uniform(0.5, 1.5)
    air, wall = 19.0, 14.0
    low, power, noise = draw.uniform(18, 21), 20 * ua * draw.uniform(1.2, 2.2), draw.uniform(0.01, 0.05)
    white = 20 * ua * draw.uniform(0.01, 0.05)
    rows, drift, cloud, is_on = [], 0.0, 0.5, True
    for hour in range(24 * DAYS):
        drift += -drift / 40 + draw.gauss(0, 0.5)
        cloud = min(max(cloud + draw.gauss(0, 0.15), 0.1), 1.0)
        outdoor = 4 + 3.5 * math.sin(math.tau * (hour % 24 - 9) / 24) + drift
        sun = 0.4 * cloud * math.sin(math.pi * (hour % 24 - 7) / 10) if 7 <= hour % 24 < 17 else 0.0
        late = hour % 24 - 4
        true_sun = 0.4 * cloud * math.sin(math.pi * (late - 7) / 10) if 7 <= late < 17 else 0.0
        shining = true_sun if world == "sun" else sun
        measured, given = air + draw.gauss(0, noise), 0.0
        at_home = not (hour // 24 % 7 < 5 and 8 <= hour % 24 < 17)
        unmeasured = people * at_home + 0.3 * (18 <= hour % 24 < 22) if world == "people" else 0.0
        for _ in range(60):
            is_on = air < low + 0.6 if is_on else air < low
            heat = (power if is_on else 0.0) if held is None else held[hour]
            given += heat / 60
            heat += aperture * shining + unmeasured + white * math.sqrt(60) * draw.gauss(0, 1)
            for _ in range(6):
                to_wall = inner * (air - wall)
                air += 10 * (heat - to_wall) / (inside * capacity)
                wall += 10 * (to_wall - outer * (wall - outdoor)) / ((1 - inside) * capacity)
        rows.append((hour * STEP_S, outdoor, sun, given, measured))
    return (ua, capacity, aperture), recorded(rows, world, seed)


def recorded(rows, world, seed):
    """Rows as the world records them."""
    columns = [list(column) for column in zip(*rows)]

    def shifted(column, by):
        return [column[min(max(row - by, 0), len(column) - 1)] for row in range(len(column))]

    if world == "clock":
        columns[1:3] = [shifted(column, 1 if seed % 2 else -1) for column in columns[1:3]]
    if world == "late":
        columns[3] = shifted(columns[3], 1)
    if world == "electricity":
        columns[3] = [heat / (3.2 + 0.08 * outdoor) for heat, outdoor in zip(columns[3], columns[1])]
    return list(zip(*columns))


def ours(binary, rows):
    """The report's zone, the causes that it names, and seconds; the error in place of the zone."""
    with tempfile.TemporaryDirectory() as name:
        table = pathlib.Path(name) / "house.csv"
        table.write_text("t,Ta,Ps,Ph,Ti\n" + "".join(",".join(map(repr, row)) + "\n" for row in rows))
        (pathlib.Path(name) / "house.toml").write_text(MAPPING)
        began = time.time()
        done = subprocess.run([binary, "identify", table, "--json"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return done.stderr, [], time.time() - began
    report = json.loads(done.stdout)
    causes = [it["cause"] for it in report.get("suspicions", ())]
    return {it["name"]: it for it in report["zones"][0]["physical"]}, causes, time.time() - began


class Sums:
    """Counts over the houses."""

    def __init__(self):
        self.bounded, self.held, self.known, self.off, self.known_ua, self.ua = 0, 0, 0, 0, 0, 0
        self.houses, self.warned, self.first, self.anywhere = 0, 0, 0, 0
        self.widths, self.seconds = {}, []

    def add(self, physical, truths):
        """Counts what was found of one house."""
        for name, truth in truths.items():
            it = physical.get(name)
            if it is None:
                continue
            low, high = it["interval"]
            if low is not None or high is not None:
                self.bounded += 1
                self.held += (low is None or low <= truth) and (high is None or truth <= high)
            is_known = it["verdict"]["confidence"] == "identified"
            self.ua += name.startswith("conductance")
            self.known_ua += is_known and name.startswith("conductance")
            self.known += is_known
            self.off += is_known and not abs((it["value"] or math.inf) / truth - 1) <= OFF

    def add_width(self, physical, held):
        """Widths of intervals over those with the heat held."""
        for name in physical.keys() & held.keys():
            ends = [it[name]["interval"] for it in (physical, held)]
            if all(low and high and high > low for low, high in ends):
                ratio = math.log(ends[0][1] / ends[0][0]) / math.log(ends[1][1] / ends[1][0])
                self.widths.setdefault(name, []).append(ratio)

    def text(self):
        """One line of everything."""
        widths = ", ".join(f"{name} {statistics.median(self.widths[name]):.2f} ({len(self.widths[name])})"
                           for name in ("heat capacity", "conductance to outdoor", "aperture to the sun") if name in self.widths)
        return (f"{self.houses} houses: {self.held} of {self.bounded} intervals hold the truth; warned {self.warned}; conductances identified "
                f"{self.known_ua} of {self.ua}; identified and off {self.off} of {self.known}; right cause first "
                f"{self.first}, anywhere {self.anywhere}; width over that with heat held: {widths or '–'}; {statistics.median(self.seconds):.1f} s "
                f"a house")


def main():
    """Prints a row for each house, and the sums."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--houses", type=int, default=30)
    parser.add_argument("--first", type=int, default=1000, help="seed of the first house")
    parser.add_argument("--world", choices=WORLDS, default="matched")
    parser.add_argument("--held", action="store_true", help="also with the heat of each row held")
    parser.add_argument("--binary", default=str(ROOT / "target" / "release" / "interplay"))
    given = parser.parse_args()
    sums = Sums()
    for seed in range(given.first, given.first + given.houses):
        (ua, capacity, aperture), rows = house(seed, given.world)
        truths = {"conductance to outdoor": ua, "heat capacity": capacity, "aperture to the sun": aperture}
        physical, causes, took = ours(given.binary, rows)
        sums.houses += 1
        sums.seconds.append(took)
        if isinstance(physical, str):
            print(f"{seed}: refused: {physical.strip()[:200]}", flush=True)
            continue
        sums.add(physical, truths)
        sums.warned += bool(causes)
        sums.first += bool(causes) and causes[0] == WORLDS[given.world]
        sums.anywhere += WORLDS[given.world] in causes
        if given.held:
            held, _, _ = ours(given.binary, house(seed, given.world, [row[3] for row in rows])[1])
            if not isinstance(held, str):
                sums.add_width(physical, held)
        found = ", ".join(f"{name} {physical[name]['value'] or 0:.4g} for {truth:.4g}" for name, truth in truths.items() if name in physical)
        print(f"{given.world} {seed}: {found}; {causes}", flush=True)
        print(f"  {sums.text()}", flush=True)


main()
