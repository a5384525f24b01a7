"""A server that answers like one of BOPTEST, with lies in its answers."""

import contextlib
import json
import pathlib
import random
from collections.abc import Iterator

from bench_server import serving
from target import RECORD, Commands, Target

SCENARIO = """title = "A heat pump of BOPTEST"
shows = "A controller heats a house of BOPTEST"
iterations = ITERATIONS
counterfactual = []

[building]
step_s = 1800.0

[building.plant]
kind = "boptest"
url = "http://127.0.0.1:PORT"
prices = "dynamic"
timeout_s = 1.0
START

[[building.plant.zones]]
temperature = "reaTZon_y"
inputs = [{ name = "oveHeaPumY_u", per_kw = 0.085, least_on = 0.9 }]

[building.plant.indicators]
area_m2 = 192.0
zones = ["1"]
carbon_dioxide = ["reaCO2RooAir_y"]
electricity = ["reaPHeaPum_y", "reaPFan_y"]
FORECAST
[[building.zone]]
name = "house"
capacity_kj_per_k = 60000.0
heating_limit_kw = 11.0
cooling_limit_kw = 0.0

[[building.wall]]
between = ["house", "ambient"]
resistance_k_per_kw = 4.2

[setpoints]
other_c = 21.5

[controller]
kind = "KIND"
"""
FORECAST = '\n[building.plant.forecast]\nzones = ["1"]\nwanted_above_lower_k = 0.6\n'
STARTS = {"period": 'period = "peak_heat_day"', "day": "start_day = 30\nwarmup_days = 0", "case": 'period = "peak_heat_day"\ncase = "house"'}
KINDS = ["pid", "pid", "economic-mpc", "economic-mpc", "model-predictive", "iterative", "concurrent", "thermostat"]
ASKED = ["inputs", "measurements", "step", "scenario", "initialize", "forecast", "forecast", "forecast", "advance", "advance", "results", "results", "kpi", "select"]
TOKENS = ["NaN", "Infinity", "-Infinity", "1e308", "-1e308", "1e999", "0", "-0.0", "1e-300", "null", "true", '"21"', '""', "[]", "{}", "[1]", "273.15", "-1"]
TOKENS += ["500", "20", "1000000", '"\\u009b31m\\u0000"', "[" * 200 + "]" * 200, "9" * 400, "abc", "'"]
ON_THE_WIRE = ["status", "stated", "cut", "raw", "close", "late", "length", "header", "chunked", "empty"]


def _lie(dice: random.Random) -> dict[str, object]:
    """One lie: of which answer, and what is wrong with it."""
    lie: dict[str, object] = {"at": dice.choice(ASKED)}
    if dice.random() < 0.6:
        lie["nth"] = dice.choice([0, 0, 1, 1, 7, 47, 48, 95])
    kind = dice.choice(["value"] * 6 + ["drop", "series", "series", "scaled", "scaled", "shorter", "longer", "extra"] + ON_THE_WIRE)
    if kind == "late" and lie["at"] == "advance":
        lie["nth"] = 0
    lie |= {"kind": kind, "where": round(dice.random(), 4), "token": dice.choice(TOKENS), "factor": dice.choice([-1, 0, 0.001, 0.5, 1.5, 10, 1e6, 1e300])}
    return lie


def _spoil(text: str, _others: list[str], dice: random.Random) -> str:
    start, kind, *lies = json.loads(text)
    if dice.random() < 0.6:
        start, kind, lies = dice.choice(list(STARTS)) + dice.choice(["", "+forecast"]), dice.choice(KINDS), []
    lies += [_lie(dice) for _ in range(dice.choice([1, 1, 2]))]
    return json.dumps([start, kind, *lies])


def _scenario(start: str, kind: str, port: int) -> str:
    name, _, forecast = start.partition("+")
    text = SCENARIO.replace("START", STARTS[name]).replace("FORECAST", FORECAST if forecast else "").replace("KIND", kind)
    return text.replace("ITERATIONS", "2").replace("PORT", str(port))


@contextlib.contextmanager
def _server_beside(folder: pathlib.Path, text: str) -> Iterator[None]:
    """A server with these lies, and the scenario that asks it."""
    start, kind, *lies = json.loads(text)
    with serving(lies) as port:
        (folder / "reader.toml").write_text(_scenario(start, kind, port), "utf-8")
        yield


def _commands(text: str) -> Commands:
    run = ["run", "reader.toml", *RECORD, "--series", "series.csv"]
    return ["check", "reader.toml"], [run + ["--json"] * (len(text) % 2)]


def targets(_binary: str) -> dict[str, Target]:
    """A test bench."""
    seeds = ['["period+forecast", "economic-mpc"]', '["case", "pid"]']
    return {"boptest": Target("json", seeds, _spoil, _commands, beside=_server_beside)}
