#!/usr/bin/env python3
"""Runs buildings of ours in FMPy, and compares every temperature with a run of ours.

    pip install fmpy
    cargo build --release
    python tests/peers/fmu.py

Each scenario is exported in FMI 2.0 and 3.0 with the table of a run (`--reference`). FMPy validates both descriptions (by the
official schemas, which it has, and by rules of its own), loads the FMUs, gives them the heat of that run, step by step, and the
largest difference is printed. Beyond 1e-9 K the script fails, and so it does

- if the versions differ by a bit, here or in a simulation by FMPy's own loop,
- if a run from a state, or from its bytes in another instance, is not the run that went on, bit for bit,
- if two instances that take turns differ by a bit from one that has the process for itself,
- if the shared library lacks a function of the official headers, which FMPy has, too.

    python tests/peers/fmu.py --serve FILE.fmu --port 7878

makes an FMU, of ours or of another program, the plant of a run (docs/guide/foreign-plants.md): its inputs and outputs must be called
`ZONE.heat` [kW] and `ZONE.temperature` [°C].
"""

import argparse
import csv
import ctypes
import importlib.util
import pathlib
import re
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
VERSIONS = ["2.0", "3.0"]
MAX_DIFFERENCE_K = 1e-9
# Functions of FMI 2.0 for model exchange (section 3.2).
MODEL_EXCHANGE = [
    "EnterEventMode",
    "NewDiscreteStates",
    "EnterContinuousTimeMode",
    "CompletedIntegratorStep",
    "SetTime",
    "SetContinuousStates",
    "GetDerivatives",
    "GetEventIndicators",
    "GetContinuousStates",
    "GetNominalsOfContinuousStates",
]


class Unit:
    """An FMU of either version that was loaded and initialised at time zero."""

    def __init__(self, path, folder=None):
        from fmpy import extract, read_model_description
        from fmpy.fmi2 import FMU2Slave
        from fmpy.fmi3 import FMU3Slave

        self.description = read_model_description(str(path))
        self._own_folder = None if folder else extract(str(path))
        self.references = {variable.name: variable.valueReference for variable in self.description.modelVariables}
        self.is_fmi3 = self.description.fmiVersion.startswith("3.")
        self.slave = (FMU3Slave if self.is_fmi3 else FMU2Slave)(
            guid=self.description.instantiationToken if self.is_fmi3 else self.description.guid,
            unzipDirectory=folder or self._own_folder,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="building",
        )
        self.slave.instantiate()
        if self.is_fmi3:
            self.slave.enterInitializationMode(startTime=0.0)
        else:
            self.slave.setupExperiment(startTime=0.0)
            self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()

    def get(self, names):
        read = self.slave.getFloat64 if self.is_fmi3 else self.slave.getReal
        return read([self.references[name] for name in names])

    def set(self, names, values):
        write = self.slave.setFloat64 if self.is_fmi3 else self.slave.setReal
        write([self.references[name] for name in names], values)

    def step(self, time_s, step_s):
        answer = self.slave.doStep(time_s, step_s)
        if self.is_fmi3 and answer != (False, False, False, time_s + step_s):
            raise ValueError(f"a step from {time_s} s by {step_s} s answered {answer}")

    def close(self):
        self.slave.terminate()
        self.slave.freeInstance()
        if self._own_folder:
            shutil.rmtree(self._own_folder, ignore_errors=True)


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
        self._unit.step(message["time_s"], self._step_s)

    def close(self):
        self._unit.close()


class Run:
    """The table of a run of ours: its heat, and its temperatures."""

    def __init__(self, table):
        with open(table, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        zones = [name.removesuffix(".heat_kw") for name in rows[0] if name.endswith(".heat_kw")]
        self.times_s = [float(row["time_s"]) for row in rows]
        self.heats = [f"{zone}.heat" for zone in zones]
        self.temperatures = [f"{zone}.temperature" for zone in zones]
        self.heat_kw = [[float(row[f"{zone}.heat_kw"]) for zone in zones] for row in rows]
        self.end_c = [[float(row[f"{zone}.end_temperature_c"]) for zone in zones] for row in rows]
        self.count = len(rows)

    def walk(self, unit, first, last, share=1.0):
        """Temperatures after each step from `first` to `last`, with a share of the heat of the run."""
        step_s = float(unit.description.defaultExperiment.stepSize)
        found = []
        for index in range(first, last):
            unit.set(self.heats, [share * heat for heat in self.heat_kw[index]])
            unit.step(self.times_s[index], step_s)
            found.append(list(unit.get(self.temperatures)))
        return found


def difference_k(run, found):
    """The largest difference between temperatures and those of our run."""
    return max(abs(ours - theirs) for row, other in zip(run.end_c, found, strict=True) for ours, theirs in zip(row, other))


def state_problems(fmu, run):
    """What goes wrong when the state is copied halfway, written as bytes, and the rest is simulated again."""
    from fmpy import extract

    half, folder = run.count // 2, extract(str(fmu))
    unit = Unit(fmu, folder)
    run.walk(unit, 0, half)
    state = unit.slave.getFMUState()
    serialize = unit.slave.serializeFMUState if unit.is_fmi3 else unit.slave.serializeFMUstate
    saved = serialize(state)
    went_on = run.walk(unit, half, run.count)
    unit.slave.setFMUState(state)
    problems = [] if run.walk(unit, half, run.count) == went_on else ["a run from a state differs"]
    unit.slave.freeFMUState(state)
    other = Unit(fmu, folder)
    deserialize = other.slave.deserializeFMUState if other.is_fmi3 else other.slave.deSerializeFMUstate
    state = deserialize(saved)
    other.slave.setFMUState(state)
    other.slave.freeFMUState(state)
    problems += [] if run.walk(other, half, run.count) == went_on else ["a run from the bytes of a state differs"]
    unit.close()
    other.close()
    shutil.rmtree(folder, ignore_errors=True)
    return problems


def instance_problems(fmu, run, alone):
    """What goes wrong when two instances of one library take turns, the second with half the heat."""
    from fmpy import extract

    folder = extract(str(fmu))
    single = Unit(fmu, folder)
    with_half = run.walk(single, 0, run.count, 0.5)
    single.close()
    first, second, found = Unit(fmu, folder), Unit(fmu, folder), ([], [])
    for index in range(run.count):
        found[0].extend(run.walk(first, index, index + 1))
        found[1].extend(run.walk(second, index, index + 1, 0.5))
    first.close()
    second.close()
    shutil.rmtree(folder, ignore_errors=True)
    problems = [] if with_half != alone else ["half the heat changes nothing"]
    return problems + ([] if found == (alone, with_half) else ["instances change each other"])


def loop_problems(fmus, run):
    """What differs between both versions when FMPy simulates them by its own loop, with the heat of the first step all along."""
    import numpy
    from fmpy import simulate_fmu

    inputs = numpy.array(
        [(0.0, *run.heat_kw[0])], dtype=[("time", float)] + [(name, float) for name in run.heats]
    )
    # Without an interval FMPy takes at most a thousand steps.
    interval_s = run.times_s[1] - run.times_s[0]
    results = [
        simulate_fmu(str(fmu), input=inputs, output=run.temperatures, output_interval=interval_s) for fmu in fmus
    ]
    columns = [[result[name].tolist() for name in ["time", *run.temperatures]] for result in results]
    problems = [] if columns[0] == columns[1] else ["the versions differ in a simulation by FMPy"]
    return problems + ([] if len(columns[0][0]) == run.count + 1 else [f"FMPy simulated {len(columns[0][0]) - 1} steps"])


def missing_functions(fmu):
    """Functions that the official headers declare and the shared library does not have."""
    import fmpy

    folder = pathlib.Path(fmpy.extract(str(fmu)))
    library = ctypes.CDLL(str(next((folder / "binaries").glob("*/*"))))
    headers = pathlib.Path(fmpy.__file__).parent / "c-code"
    names = set()
    for version in "23":
        text = (headers / f"fmi{version}Functions.h").read_text(encoding="utf-8")
        declared = re.findall(rf"FMI{version}_Export fmi{version}\w+TYPE\s+(fmi{version}\w+)", text)
        if len(declared) < 20:
            raise ValueError(f"the header of FMI {version} has {len(declared)} functions only")
        names.update(declared)
    # Those of model exchange alone, which a unit of FMI 2.0 for co-simulation need not have.
    names -= {f"fmi2{name}" for name in MODEL_EXCHANGE}
    missing = sorted(name for name in names if not hasattr(library, name))
    shutil.rmtree(folder, ignore_errors=True)
    return [f"the library has no {name}" for name in missing], len(names)


def compare(binary):
    from fmpy.validation import validate_fmu

    failed = False
    with tempfile.TemporaryDirectory() as folder:
        for name, changes in SCENARIOS:
            table = pathlib.Path(folder) / "building.csv"
            fmus = [pathlib.Path(folder) / f"building-{version}.fmu" for version in VERSIONS]
            for version, fmu in zip(VERSIONS, fmus):
                words = [binary, "export-fmu", name, "--out", fmu, "--reference", table, "--fmi", version]
                words += [word for change in changes for word in ("--set", change)]
                subprocess.run(words, cwd=ROOT, check=True, capture_output=True)
            run, walks = Run(table), []
            problems, functions = missing_functions(fmus[0])
            for fmu in fmus:
                unit = Unit(fmu)
                walks.append(run.walk(unit, 0, run.count))
                unit.close()
                problems += validate_fmu(str(fmu)) + state_problems(fmu, run) + instance_problems(fmu, run, walks[-1])
            problems += loop_problems(fmus, run)
            if walks[0] != walks[1]:
                problems.append("the versions differ")
            worst, count = max(difference_k(run, walk) for walk in walks), sum(map(len, run.end_c))
            sound = not problems and count > 0 and worst <= MAX_DIFFERENCE_K
            failed |= not sound
            verdict = f"ok, {functions} functions" if sound else f"FAILED {problems}"
            print(f"{name:40} {' '.join(changes):45} {count:7} temperatures, largest difference {worst:.1e} K  {verdict}", flush=True)
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
