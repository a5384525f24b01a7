#!/usr/bin/env python3
"""Runs buildings of ours in FMPy, and compares every temperature with a run of ours.

    pip install fmpy
    cargo build --release
    python tests/peers/fmu.py

Each scenario is exported with the table of a run (`--reference`). FMPy validates the description and the binary, loads the FMU,
gives it the heat of that run, step by step, and the largest difference is printed. Beyond 1e-9 K the script fails.

    python tests/peers/fmu.py --serve FILE.fmu --port 7878

makes an FMU, of ours or of another program, the plant of a run (docs/foreign-plants.md): its inputs and outputs must be called
`ZONE.heat` [kW] and `ZONE.temperature` [°C].
"""

import argparse
import csv
import importlib.util
import pathlib
import shutil
import subprocess
import sys
import tempfile

import plant_server

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Dense and with walls that store heat; Euler; a file of weather; three designs; a hundred zones.
SCENARIOS = [
    ("building/four-room-pid", []),
    ("building/iterative-warm-nights", []),
    ("building/epw-weather", []),
    ("building/model-predictive", ["building.method=euler", "building.step_s=900"]),
    ("building/hundred-zones", []),
    ("assets/telemetry/cabin-scenario.toml", []),
]
MAX_DIFFERENCE_K = 1e-9


class Unit:
    """An FMU that was loaded and initialised at time zero."""

    def __init__(self, path):
        from fmpy import extract, read_model_description
        from fmpy.fmi2 import FMU2Slave

        self.description = read_model_description(str(path))
        self._folder = extract(str(path))
        self.references = {variable.name: variable.valueReference for variable in self.description.modelVariables}
        self.slave = FMU2Slave(
            guid=self.description.guid,
            unzipDirectory=self._folder,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="building",
        )
        self.slave.instantiate()
        self.slave.setupExperiment(startTime=0.0)
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()

    def get(self, names):
        return self.slave.getReal([self.references[name] for name in names])

    def set(self, names, values):
        self.slave.setReal([self.references[name] for name in names], values)

    def close(self):
        self.slave.terminate()
        self.slave.freeInstance()
        shutil.rmtree(self._folder, ignore_errors=True)


class Plant:
    """An FMU as the plant of a run."""

    def __init__(self, path, start):
        self._unit, self._step_s = Unit(path), start["step_s"]
        self._heats = [f"{zone}.heat" for zone in start["zones"]]
        self._temperatures = [f"{zone}.temperature" for zone in start["zones"]]
        for name in self._heats + self._temperatures:
            if name not in self._unit.references:
                raise ValueError(f"the FMU has no variable `{name}`")

    def temperatures_c(self):
        return self._unit.get(self._temperatures)

    def step(self, message):
        self._unit.set(self._heats, message["heat_kw"])
        self._unit.slave.doStep(message["time_s"], self._step_s)

    def close(self):
        self._unit.close()


def difference_k(fmu, table):
    """The largest difference between the temperatures of an FMU and those in the table of our run, and how many there are."""
    with open(table, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    zones = [name.removesuffix(".heat_kw") for name in rows[0] if name.endswith(".heat_kw")]
    unit, worst, count = Unit(fmu), 0.0, 0
    times = [float(row["time_s"]) for row in rows]
    step_s = float(unit.description.defaultExperiment.stepSize)
    for row, time_s in zip(rows, times):
        unit.set([f"{zone}.heat" for zone in zones], [float(row[f"{zone}.heat_kw"]) for zone in zones])
        unit.slave.doStep(time_s, step_s)
        for zone, ours in zip(zones, unit.get([f"{zone}.temperature" for zone in zones])):
            worst = max(worst, abs(ours - float(row[f"{zone}.end_temperature_c"])))
            count += 1
    unit.close()
    return worst, count


def compare(binary):
    from fmpy.validation import validate_fmu

    failed = False
    with tempfile.TemporaryDirectory() as folder:
        for name, changes in SCENARIOS:
            fmu, table = pathlib.Path(folder) / "building.fmu", pathlib.Path(folder) / "building.csv"
            words = [binary, "export-fmu", name, "--out", fmu, "--reference", table]
            words += [word for change in changes for word in ("--set", change)]
            subprocess.run(words, cwd=ROOT, check=True, capture_output=True)
            problems = validate_fmu(str(fmu))
            worst, count = difference_k(fmu, table)
            sound = not problems and count > 0 and worst <= MAX_DIFFERENCE_K
            failed |= not sound
            verdict = "ok" if sound else f"FAILED {problems}"
            print(f"{name:40} {' '.join(changes):45} {count:7} temperatures, largest difference {worst:.1e} K  {verdict}")
    sys.exit(1 if failed else 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--interplay", type=pathlib.Path, default=ROOT / "target" / "release" / "interplay")
    parser.add_argument("--serve", type=pathlib.Path, metavar="FILE.fmu", help="be the plant of runs instead")
    parser.add_argument("--port", type=int, default=7878)
    parser.add_argument("--runs", type=int, help="with --serve: end after this many runs")
    arguments = parser.parse_args()
    if importlib.util.find_spec("fmpy") is None:
        print("skipped: FMPy is not installed (pip install fmpy)")
        return
    if arguments.serve:
        server = plant_server.listen(arguments.port)
        print(f"listening at 127.0.0.1:{server.getsockname()[1]}", flush=True)
        plant_server.serve(lambda start: Plant(arguments.serve, start), server, arguments.runs)
        return
    if not arguments.interplay.exists():
        sys.exit(f"there is no {arguments.interplay}: cargo build --release makes it, --interplay names another")
    compare(str(arguments.interplay.resolve()))


if __name__ == "__main__":
    main()
