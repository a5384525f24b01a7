"""Scenarios, plans, flags, weather, prices and telemetry: the seeds, how they are spoilt, and the commands that read them."""

import json
import pathlib
import random
import re
import subprocess
import tomllib

import edits
from target import MOST_PLANS, MOST_STEPS, RECORD, ROOT, Target, checked_and_run, cost_is_small, reader_checked_and_run

BUDGET = [f"budget.plans={MOST_PLANS}", f"budget.steps={MOST_STEPS}"]
BUDGET_FLAGS = [word for budget in BUDGET for word in ("--set", budget)]
FAMILY = re.compile(r'(?m)^extends = "([\w-]+)\.toml"')

WEATHER = """extends = "building/epw-weather"
iterations = 3
weather.file = "input.epw"
weather.day = 1
expect.building = {}
"""
TARIFF = """extends = "building/office-and-flat"
iterations = 2
tariff = { prices_per_kwh = [], file = "input.csv" }
"""
MAPPINGS = [
    """walls = [["cabin", "outdoor"]]
time = { column = "time", format = "%Y-%m-%d %H:%M:%S", step_s = 900.0, gaps = "bridge" }
identify = { method = "state-space", most_states = 2, horizon_h = 6.0, train_days = 1.0 }

[[boundary]]
name = "outdoor"
temperature = "outdoor_c"
hold = "zero-order"

[[zone]]
name = "cabin"
temperature = "cabin_c"
heat = [{ kind = "power", column = "heating_kw", unit = "kw", factor = 1.0 }, { kind = "power", column = "appliances_kw", unit = "kw" }]
""",
    """walls = [["cabin", "loft"], ["loft", "outdoor"], ["cabin", "outdoor"]]
table = { separator = ",", decimal = ".", missing = ["NA"], temperature_unit = "celsius" }

[time]
column = "seconds"
format = "seconds"
step_s = 900.0
gaps = "split"
batch = "batch"

[[column]]
name = "mean"
mean_of = ["cabin_c", "outdoor_c"]
factor = 1.0

[[boundary]]
name = "outdoor"
temperature = "outdoor_c"

[[zone]]
name = "cabin"
temperature = "cabin_c"
heat_hold = "zero-order"
heat = [{ kind = "power", column = "heating_kw", unit = "kw" }]
solar = { column = "sun", unit = "w-per-m2", factor = 0.5 }

[[zone]]
name = "loft"
temperature = "mean"
heat = [
    { kind = "supply-air", flow = "flow", flow_unit = "m3-per-h", temperature = "supply_c" },
    { kind = "water", flow = "flow", flow_unit = "l-per-s", inlet = "supply_c", outlet = "cabin_c" },
]

[identify]
method = "prediction-error"
discretisation = "exact"
bandwidth_h = 1.25
autoregressive_order = 2
harmonics = 3
horizon_h = 6.0
train_days = 1.0
""",
]
PLANS = [
    'scenario = ["intersection/nice", "lane-change/front-nice"]\nplanner = ["idm", { name = "p", kind = "negotiation", '
    "set = { vehicle.ego.driver.patience_steps = 20 } }]\nsamples = 1\nseed = 1\nset = { duration_s = 3.0 }\n\n"
    "[vary]\nvehicle.ego.goal.speed_mps = { uniform = [1.0, 1.3] }\n",
    'scenario = ["lane-change/front-*"]\nplanner = ["conservative"]\nstyle = ["nice"]\nsampling = "latin-hypercube"\nmax_runs = 8\n'
    "jitter = { position_m = 0.1, speed_mps = 0.1 }\nsamples = 2\n\n[set]\nduration_s = 3.0\n\n[vary]\n"
    "vehicle.front.goal.speed_mps = { range = [1.2, 1.3], count = 2 }\nvehicle.rear.start.speed_mps = { log_uniform = [1.2, 1.3] }\n",
    'title = "Rooms"\nscenario = ["building/four-room-pid"]\nsamples = 1\nset = { iterations = 2 }\n\n'
    '[[style]]\nname = "cold"\nset = { building.initial_c = 20.0 }\nvary = { "building.step_s" = [900.0, 1800.0] }\n',
]


def embedded_parents(folder: str, text: str) -> str:
    """An authored scenario that extends the one in the binary in place of the file beside it."""
    return FAMILY.sub(lambda found: f'extends = "{folder}/{found[1]}"', text)


def _telemetry(rows: int) -> str:
    """The first rows of the sample, with columns besides that some mappings need."""
    lines = (ROOT / "assets/telemetry/cabin.csv").read_text("utf-8").splitlines()
    made = [lines[0] + ",seconds,batch,flow,supply_c,sun"]
    for index, line in enumerate(lines[1 : rows + 1]):
        made.append(f"{line},{900 * index},{index // 100},{0.01 * (index % 7):.2f},{30 + index % 5},{max(0, (index % 96 - 30) * 5)}")
    return "\n".join(made) + "\n"


def _leaves(value: object, path: str) -> list[tuple[str, str]]:
    """Paths and values of a scenario, as `--set` takes them; vehicles and zones go by their names."""
    if isinstance(value, dict):
        return [leaf for key, inner in value.items() for leaf in _leaves(inner, f"{path}.{key}" if path else key)]
    if isinstance(value, list) and value and all(isinstance(inner, dict) for inner in value):
        return [leaf for inner in value for leaf in _leaves(inner, f"{path}.{inner.get('name', '0')}")]
    return [(path, json.dumps(value, ensure_ascii=False, default=str))]


def _telemetry_commands(_: str) -> tuple[list[str], list[list[str]]]:
    return ["identify", "input.csv", "--mapping", "mapping.toml"], _found("input.csv", "mapping.toml")


def _mapping_commands(_: str) -> tuple[list[str], list[list[str]]]:
    return ["identify", "table.csv", "--mapping", "input.toml"], _found("table.csv", "input.toml")


def _found(table: str, mapping: str) -> list[list[str]]:
    """What is done with accepted telemetry: plots, and a scenario that must be accepted, too."""
    again = ["identify", table, "--mapping", mapping, "--out", "plots", "--scenario", "found.toml", "--json"]
    return [again, ["check", "found.toml"], ["run", "found.toml", *RECORD]]


def _plan_commands(_: str) -> tuple[list[str], list[list[str]]]:
    return ["sweep", "input.toml", "--dry-run"], [["sweep", "input.toml", "--out", "rows", "--jobs", "1"]]


def _flag_commands(text: str) -> tuple[list[str], list[list[str]]]:
    command, scenario, *words = json.loads(text)
    if command == "sweep":
        whole = ["sweep", "--scenario", scenario, *words, *BUDGET_FLAGS]
        return [*whole, "--dry-run"], [[*whole, "--out", "rows", "--jobs", "1"]]
    whole = ["run", scenario, *words, *BUDGET_FLAGS]
    return [*whole, "--no-record"], [[*whole, *RECORD, "--json"]]


def first_targets(binary: str) -> dict[str, Target]:
    """Targets of scenarios, plans, flags, weather, prices and telemetry, by name."""
    files = sorted((ROOT / "scenarios/files").rglob("*.toml"))
    authored = [file.read_text("utf-8") for file in files]
    within = [embedded_parents(file.parent.name, text) for file, text in zip(files, authored)]
    variants = [text for text in within if FAMILY.search(text) or "\nextends" in text]
    variants += [f'extends = "{file.parent.name}/{file.stem}"\n' for file in files] + ['extends = "base.toml"\n']
    plans = [file.read_text("utf-8") for file in sorted((ROOT / "scenarios/plans").glob("*.toml"))]
    epw = (ROOT / "scenarios/weather/tropical-july.epw").read_text("utf-8").splitlines()
    epw[7] = epw[7].replace("7/31", "7/ 4")
    prices = "hour,price_per_kwh\n" + "".join(f"{hour},{0.1 + 0.01 * (hour % 24)}\n" for hour in range(48))
    paths: dict[str, list[tuple[str, str]]] = {}
    for file, text in zip(files, authored):
        paths.setdefault(file.parent.name, []).extend(_leaves(tomllib.loads(text), ""))
    said = subprocess.run([binary, "check", str(ROOT / "scenarios/files")], capture_output=True, text=True).stdout.splitlines()
    cheap = [
        "/".join(pathlib.Path(name.split()[1]).with_suffix("").parts[-2:])
        for name, cost in zip(said, said[1:])
        if name.startswith("ok") and cost_is_small(cost)
    ]

    def texts(text: str, others: list[str], dice: random.Random) -> str:
        return edits.toml(text, others, dice)

    def tables(text: str, _: list[str], dice: random.Random) -> str:
        return edits.table(text, dice)

    def some_flags(text: str, _: list[str], dice: random.Random) -> str:
        return edits.flags(text, paths, cheap, dice)

    def some_variant(text: str, _: list[str], dice: random.Random) -> str:
        return edits.variant(text, within, dice)

    first_flags = '["run", "intersection/nice", "--set", "duration_s=1.0"]'
    base = 'extends = "lane-change/front-nice"\nduration_s = 2.0\nexpect = {}\n'
    return {
        "scenario": Target("toml", authored, texts, checked_and_run),
        "extends": Target("toml", variants, some_variant, checked_and_run, {"base.toml": base}),
        "weather": Target("epw", ["\n".join(epw[:104]) + "\n"], tables, reader_checked_and_run, {"reader.toml": WEATHER}),
        "tariff": Target("csv", [prices], tables, reader_checked_and_run, {"reader.toml": TARIFF}),
        "telemetry": Target("csv", [_telemetry(192)], tables, _telemetry_commands, {"mapping.toml": MAPPINGS[0]}),
        "mapping": Target("toml", MAPPINGS, texts, _mapping_commands, {"table.csv": _telemetry(192)}),
        "flags": Target("json", [first_flags], some_flags, _flag_commands),
        "plan": Target("toml", plans + 4 * PLANS, texts, _plan_commands),
    }
