#!/usr/bin/env python3
"""Compares our integration of units for model exchange (FMI 2.0) with FMPy's, which uses CVODE.

    pip install fmpy
    cargo build --release
    python tests/peers/model_exchange.py [--reference-fmus FOLDER] [--binary interplay]

Both integrate the unit of `app/fmu_host/tests/units`, compiled here, and with a folder of the sources of the Modelica Association's
Reference FMUs (github.com/modelica/Reference-FMUs) three of those, with a relative tolerance of 1e-9. Beyond 1e-6 at any communication
point the script fails. It skips, and says so, without FMPy or a C compiler.
"""

import argparse
import importlib.util
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
UNITS = ROOT / "app" / "fmu_host" / "tests" / "units"
TOLERANCE = 1e-9
MAX_DIFFERENCE = 1e-6
#: Name, end [s] and communication step [s]. After 2.5 s the reference ball comes to rest by a rule on its speed.
REFERENCES = [("Dahlquist", 10.0, 0.1), ("VanDerPol", 20.0, 0.1), ("BouncingBall", 2.5, 0.01)]


def packed(folder, name, description, library):
    """Writes an FMU for model exchange."""
    path = folder / f"{name}.fmu"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", description)
        archive.write(library, f"binaries/linux64/{name}.so")
    return path


def own(folder):
    """The unit of our tests."""
    library = folder / "unit.so"
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", UNITS / "unit.c", "-o", library], check=True)
    return packed(folder, "unit", (UNITS / "unit.xml").read_text(), library)


def reference(folder, sources, name):
    """A Reference FMU, for model exchange only, with our tolerance."""
    library = folder / f"{name}.so"
    files = [sources / name / "model.c", sources / "src" / "fmi2Functions.c", sources / "src" / "cosimulation.c"]
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-w", "-DFMI_VERSION=2", "-DDISABLE_PREFIX", f"-I{sources}/include", f"-I{sources}/{name}",
                    *files, "-lm", "-o", library], check=True)
    text = (sources / name / "FMI2.xml").read_text()
    text = re.sub(r"<CoSimulation\b([^>]*/>|.*?</CoSimulation>)", "", text, flags=re.S)
    text = re.sub(r'(<DefaultExperiment[^>]*?)\s*(tolerance="[^"]*")?\s*(/?>)', rf'\1 tolerance="{TOLERANCE}"\3', text)
    return packed(folder, name, text, library)


def ours(binary, folder, fmu, names, end_s, step_s):
    """Values at the communication points by `interplay fmu-host`."""
    from fmpy import extract, read_model_description
    unit = read_model_description(fmu)
    unpacked = pathlib.Path(extract(fmu, unzipdir=folder / f"{fmu.stem}-unpacked"))
    library = unpacked / "binaries" / "linux64" / f"{unit.modelExchange.modelIdentifier}.so"
    told = not unit.modelExchange.completedIntegratorStepNotNeeded
    shape = f"{unit.numberOfContinuousStates},{unit.numberOfEventIndicators},{str(told).lower()},{TOLERANCE}"
    references = {variable.name: variable.valueReference for variable in unit.modelVariables}
    reals = [references[name] for name in names]
    count = round(end_s / step_s)
    requests = [
        {"call": "initialize", "start_s": 0.0},
        {"call": "steps", "from_s": 0.0, "step_s": step_s, "count": count, "reals": reals, "booleans": []},
        {"call": "end"},
    ]
    done = subprocess.run([*binary, library, unit.guid, unpacked.as_uri() + "/resources", shape], text=True,
                          input="".join(json.dumps(request) + "\n" for request in requests), capture_output=True, check=True)
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    failed = [answer for answer in answers if answer["answer"] == "failed"]
    if failed:
        sys.exit(f"{fmu.name}: {failed[0]['reason']}")
    return answers[2]["rows"]


def compare(binary, folder, fmu, end_s, step_s):
    """The largest difference of any state at any communication point."""
    from fmpy import read_model_description, simulate_fmu
    unit = read_model_description(fmu)
    names = [derivative.variable.derivative.name for derivative in unit.derivatives]
    rows = ours(binary, folder, fmu, names, end_s, step_s)
    theirs = simulate_fmu(str(fmu), fmi_type="ModelExchange", stop_time=end_s, relative_tolerance=TOLERANCE,
                          output_interval=step_s, output=names, record_events=False)
    # At an event on a communication point FMPy has two rows; the last one is after it.
    points = {round(row["time"] / step_s): row for row in theirs if abs(row["time"] / step_s % 1.0 - 0.5) > 0.499}
    worst = 0.0
    for index, row in enumerate(rows, start=1):
        for name, value in zip(names, row):
            worst = max(worst, abs(value - points[index][name]))
    print(f"{fmu.stem:14} {len(names)} states, {len(rows)} points: largest difference {worst:.1e}")
    return worst


def main():
    """Compares all units."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", nargs="+", default=[str(ROOT / "target" / "release" / "interplay"), "fmu-host"],
                        help="the command that runs a unit")
    parser.add_argument("--reference-fmus", type=pathlib.Path, help="sources of github.com/modelica/Reference-FMUs")
    given = parser.parse_args()
    if importlib.util.find_spec("fmpy") is None or shutil.which("cc") is None:
        print("skipped: FMPy and a C compiler `cc` are needed")
        return
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        worst = [compare(given.binary, folder, own(folder), 14_400.0, 300.0)]
        if given.reference_fmus is None:
            print("skipped: the Reference FMUs, without --reference-fmus")
        else:
            for name, end_s, step_s in REFERENCES:
                worst.append(compare(given.binary, folder, reference(folder, given.reference_fmus, name), end_s, step_s))
    if max(worst) > MAX_DIFFERENCE:
        sys.exit(f"differences beyond {MAX_DIFFERENCE}")


main()
