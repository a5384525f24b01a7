#!/usr/bin/env python3
"""Serves a test case of BOPTEST with its own `restapi.py` and `testcase.py`, unchanged, on this machine.

    pip install "numpy<2" "scipy<1.14" "pandas<2.2" matplotlib fmpy flask flask-restful flask-cors six ptvsd pytz requests
    python tests/peers/boptest/serve.py --boptest FOLDER --fmu FILE.fmu [--port 8080]

FOLDER is a copy of github.com/ibpsa/project1-boptest that still has `restapi.py`: commit 21433f81 is the last one. FILE is the case, with
its data in `resources` (docs/guide/foreign-plants.md says where they are from). PyFMI, which has no wheels, is replaced by `shim/pyfmi.py`, over FMPy.
The FMU runs in the server's process, so a crash of it ends the server and not a run of ours, which then ends with exit code 3.
Without one of these it says that it skips.
"""

import argparse
import importlib.util
import os
import pathlib
import shutil
import sys
import tempfile

NEEDED = ("numpy", "scipy", "pandas", "matplotlib", "fmpy", "flask", "flask_restful", "flask_cors", "six", "ptvsd", "pytz")


def missing():
    return [name for name in NEEDED if importlib.util.find_spec(name) is None]


def enter(boptest, fmu):
    """Makes the current folder one from which BOPTEST's modules run: they expect `version.txt` and `models/wrapped.fmu` in it."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="boptest-"))
    (folder / "models").mkdir()
    shutil.copy(fmu, folder / "models" / "wrapped.fmu")
    shutil.copy(boptest / "version.txt", folder / "version.txt")
    sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent / "shim"), str(boptest)]
    os.chdir(folder)
    return folder


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--boptest", type=pathlib.Path, help="a copy of BOPTEST")
    parser.add_argument("--fmu", type=pathlib.Path, help="the test case")
    parser.add_argument("--port", type=int, default=8080)
    arguments = parser.parse_args()
    if arguments.boptest is None or arguments.fmu is None or missing():
        print("skipped: " + (f"not installed: {', '.join(missing())}" if missing() else "no --boptest and --fmu"))
        return
    folder = enter(arguments.boptest.resolve(), arguments.fmu.resolve())
    try:
        import restapi

        print(f"listening at http://127.0.0.1:{arguments.port}", flush=True)
        # One thread: a test case is one simulation.
        restapi.app.run(host="127.0.0.1", port=arguments.port, threaded=False)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main()
