#!/usr/bin/env python3
"""Compares `interplay identify` with darkgreybox (GPL, a referee only) on simulated houses whose truth is known.

    pip install lmfit pandas joblib && pip install --no-deps darkgreybox==0.3.0
    python tests/peers/grey_box.py --houses 30 --binary target/release/interplay

Houses have an air and a wall, a thermostat that switches within rows of an hour, weather of a random walk and two weeks of telemetry;
heat is recorded as the mean of a row. darkgreybox fits its model TiTe by Nelder and Mead from its documentation's start values, with the
sun of the known aperture added to the heat, since TiTe has no sun: it is given more than our program. Its values have no intervals, so
that every one counts as called known; one is absurd if it is off by more than a factor of two. It skips, and says so, without darkgreybox.
"""

import argparse
import importlib.util
import json
import math
import pathlib
import random
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
STEP_S = 3600
DAYS = 14
ABSURD = 2.0
MAPPING = """walls = [["house", "outdoor"]]
time = { column = "t", format = "seconds", step_s = 3600.0 }
boundary = [{ name = "outdoor", temperature = "Ta", hold = "zero-order" }]
[[zone]]
name = "house"
temperature = "Ti"
heat = [{ kind = "power", column = "Ph", unit = "kw" }]
solar = { column = "Ps", unit = "kw-per-m2", hold = "zero-order" }
"""


def house(seed):
    """True conductance [kW/K], capacity [kJ/K] and aperture [m²], and the rows of telemetry."""
    draw = random.Random(seed)
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
        measured, given = air + draw.gauss(0, noise), 0.0
        for _ in range(60):
            is_on = air < low + 0.6 if is_on else air < low
            heat = power if is_on else 0.0
            given += heat / 60
            heat += aperture * sun + white * math.sqrt(60) * draw.gauss(0, 1)
            for _ in range(6):
                to_wall = inner * (air - wall)
                air += 10 * (heat - to_wall) / (inside * capacity)
                wall += 10 * (to_wall - outer * (wall - outdoor)) / ((1 - inside) * capacity)
        rows.append((hour * STEP_S, outdoor, sun, given, measured))
    return (ua, capacity, aperture), rows


def ours(binary, folder, rows):
    """Conductance and capacity with their verdicts, and seconds."""
    table = folder / "house.csv"
    table.write_text("t,Ta,Ps,Ph,Ti\n" + "".join(",".join(map(repr, row)) + "\n" for row in rows))
    (folder / "house.toml").write_text(MAPPING)
    began = time.process_time_ns(), time.time()
    done = subprocess.run([binary, "identify", table, "--json"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return None, time.time() - began[1], done.stderr
    physical = {it["name"]: it for it in json.loads(done.stdout)["zones"][0]["physical"]}
    return physical, time.time() - began[1], ""


def theirs(rows, aperture):
    """Conductance and capacity of TiTe, and seconds."""
    import numpy
    from darkgreybox.models import TiTe
    table = numpy.array(rows)
    inside = table[:, 4]
    data = {"Ta": table[:, 1], "Ph": table[:, 3] + aperture * table[:, 2]}
    params = {
        "Ti0": {"value": inside[0], "vary": False}, "Te0": {"value": inside[0] - 2, "vary": True, "min": 0, "max": 25},
        # Capacities in kWh/K and resistances in K/kW, within generous limits.
        "Ci": {"value": 1.0, "min": 1e-3, "max": 1e3}, "Ce": {"value": 5.0, "min": 1e-3, "max": 1e4},
        "Rie": {"value": 1.0, "min": 1e-3, "max": 1e3}, "Rea": {"value": 5.0, "min": 1e-3, "max": 1e3},
    }
    began = time.time()
    found = TiTe(params, rec_duration=STEP_S / 3600).fit(data, inside, method="nelder").result.params
    value = {name: found[name].value for name in ("Ci", "Ce", "Rie", "Rea")}
    return 1 / (value["Rie"] + value["Rea"]), 3600 * (value["Ci"] + value["Ce"]), time.time() - began


def is_absurd(value, truth):
    """Whether a value is not finite, or off by more than a factor of two."""
    return not (value > 0 and max(value / truth, truth / value) <= ABSURD)


def main():
    """Prints a row for each house, and the sums."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--houses", type=int, default=30)
    parser.add_argument("--binary", default=str(ROOT / "target" / "release" / "interplay"))
    given = parser.parse_args()
    if importlib.util.find_spec("darkgreybox") is None:
        print("skipped: darkgreybox is not installed")
        return
    sums = {"known": 0, "absurd": 0, "held": 0, "bounded": 0, "their absurd": 0, "their values": 0}
    seconds = [[], []]
    for seed in range(given.houses):
        (ua, capacity, aperture), rows = house(1000 + seed)
        with tempfile.TemporaryDirectory() as name:
            physical, took, error = ours(given.binary, pathlib.Path(name), rows)
        seconds[0].append(took)
        their_ua, their_capacity, took = theirs(rows, aperture)
        seconds[1].append(took)
        line = []
        for name, truth, their in [("conductance to outdoor", ua, their_ua), ("heat capacity", capacity, their_capacity)]:
            sums["their values"] += 1
            sums["their absurd"] += is_absurd(their, truth)
            it = (physical or {}).get(name)
            if it is None:
                line.append(f"{truth:.4g}: – {error.strip()[:60]}, theirs {their:.4g}")
                continue
            low, high = it["interval"]
            sums["bounded"] += 1
            sums["held"] += (low is None or low <= truth) and (high is None or truth <= high)
            if it["verdict"]["confidence"] == "identified":
                sums["known"] += 1
                sums["absurd"] += is_absurd(it["value"] or math.nan, truth)
            line.append(f"{truth:.4g}: {it['value']} {it['verdict']['confidence']}, theirs {their:.4g}")
        print(f"house {seed}: " + "; ".join(line), flush=True)
        middle = [sorted(each)[len(each) // 2] for each in seconds]
        print(f"  so far: ours {sums['absurd']} absurd of {sums['known']} called identified, {sums['held']} of {sums['bounded']} "
              f"intervals hold the truth, median {middle[0]:.1f} s; darkgreybox {sums['their absurd']} absurd of "
              f"{sums['their values']}, median {middle[1]:.1f} s a fit", flush=True)


main()
