#!/usr/bin/env python3
"""Runs a heat pump's test case of BOPTEST under its own controller and under ours, and prints the indicators of all cells.

    cargo build --release
    python tests/peers/boptest/table.py --boptest FOLDER --fmu FILE.fmu --out heat-pump/

Two periods (peak_heat_day, typical_heat_day) and three price scenarios. The case is served by BOPTEST's own `restapi.py` (see serve.py for what
that needs); our runs have `plant = { kind = "boptest" }`. All indicators of the table are those of BOPTEST's `kpi_calculator.py`; the largest
difference of ours from them is printed. Designs that know no prices are run once a period, and their cost is computed for each price
scenario. One set of parameters serves all cells. Without one of the needed things it says that it skips.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import threading

import serve

ROOT = pathlib.Path(__file__).resolve().parents[3]
CASE = "bestest_hydronic_heat_pump"
PRICES = ("constant", "dynamic", "highly_dynamic")
PERIODS = ("peak_heat_day", "typical_heat_day")
# How long a period of BOPTEST is.
DAYS = 14
# What BOPTEST published for the case's own controller (`baselines/csv/df_kpi_bestest_hydronic_heat_pump.csv`).
PUBLISHED = {
    "peak_heat_day": {"tdis_tot": 8.381374448, "ener_tot": 3.478023746, "pele_tot": 0.018912779, "emis_tot": 0.580829966},
    "typical_heat_day": {"tdis_tot": 9.442428804, "ener_tot": 1.773582647, "pele_tot": 0.016491932, "emis_tot": 0.296188302},
}
PUBLISHED_COST = {
    ("peak_heat_day", "constant"): 0.88167902,
    ("peak_heat_day", "dynamic"): 0.882847053,
    ("peak_heat_day", "highly_dynamic"): 0.908760724,
    ("typical_heat_day", "constant"): 0.449603201,
    ("typical_heat_day", "dynamic"): 0.442336352,
    ("typical_heat_day", "highly_dynamic"): 0.41267549,
}
# Full speed is about 11.8 kW of heat; below nine tenths of it the fan, which has one speed, costs more than it is worth.
INPUT = '{ name = "oveHeaPumY_u", per_kw = 0.085, least_on = 0.9 }'
SCENARIO = """title = "{design}, {period}, {prices}"
shows = "A design of ours heats a house of BOPTEST with a heat pump"
iterations = {days}

[building]
step_s = 900.0
initial_c = 21.0

[building.plant]
kind = "boptest"
url = "{url}"
{start}
prices = "{prices}"
zones = [{{ temperature = "reaTZon_y", inputs = [{inputs}] }}]

[building.plant.indicators]
area_m2 = 192.0
zones = ["1"]
carbon_dioxide = ["reaCO2RooAir_y"]
electricity = ["reaPHeaPum_y", "reaPFan_y", "reaPPumEmi_y"]

# Weather, people, bounds of comfort and prices are what the case foretells.
[building.plant.forecast]
zones = ["1"]
{wanted}

[[building.zone]]
name = "house"
# What identify.py found from 35 days after the tenth of February, outside of both periods.
capacity_kj_per_k = 70520.0
solar_aperture_m2 = 28.8
heating_limit_kw = 11.0
cooling_limit_kw = 0.0

[[building.wall]]
between = ["house", "ambient"]
resistance_k_per_kw = 3.75

[[building.wall]]
between = ["house", "ambient"]
resistance_k_per_kw = 12.36
capacity_kj_per_k = 300000.0
mass_position = 0.382

# Heat by electricity of compressor, fan and pump at full speed, from the same 35 days.
[heat_pump]
heating = [
    {{ outdoor_c = -3.0, cop = 2.63 }},
    {{ outdoor_c = 2.0, cop = 2.79 }},
    {{ outdoor_c = 6.0, cop = 3.01 }},
    {{ outdoor_c = 14.0, cop = 3.20 }},
]

[setpoints]
other_c = 21.5
occupied_weight = 1.0
other_weight = 1.0
input_weight = 0.001
weigh_energy = {weighs}

[controller]
{controller}
"""
PID = 'kind = "pid"\nproportional_kw_per_k = 8.0\nintegral_kw_per_k_h = 0.3\nderivative_kw_h_per_k = 0.0'
# Chosen, as the gain of the learning designs, by a run of the fourteen days from the second of March on, outside of both periods.
ECONOMIC = 'kind = "economic-mpc"\nmargin_k = 0.25'
# Designs that plan from the second day on have a feedback on the first, as strong as that of the PID controller.
LEARNING = "initial_gain_kw_per_k = 8.0"
# The band of the case is 21 to 24 °C with people, and 15 to 30 °C without. Designs with a wanted temperature keep near its lower end.
WANTED = "wanted_above_lower_k = 0.6"
# Name: input of the heat pump, controller, wanted temperature, and whether it knows prices.
DESIGNS = {
    "its own": ("", PID, WANTED, False),
    "PID": (INPUT, PID, WANTED, False),
    "MPC": (INPUT, 'kind = "model-predictive"\nhorizon_h = 24.0', WANTED, True),
    "economic MPC": (INPUT, ECONOMIC, "", True),
    "iterative": (INPUT, f'kind = "iterative"\n{LEARNING}', WANTED, False),
    "concurrent": (INPUT, f'kind = "concurrent"\n{LEARNING}', WANTED, False),
}


def indicators(case):
    """BOPTEST's indicators of the run that is over, for each price scenario."""
    found = {}
    for prices in PRICES:
        case.scenario["electricity_price"] = prices
        case.cal.initialize()
        found[prices] = case.get_kpis()[2]
    return found


def difference(report, official):
    """The largest relative difference of our indicators from the official ones."""
    ours = report["building"]["benchmark"]["ours"]
    names = {
        "tdis_tot": "tdis_k_h",
        "idis_tot": "idis_ppm_h",
        "ener_tot": "ener_kwh_per_m2",
        "cost_tot": "cost_per_m2",
        "emis_tot": "emis_kg_per_m2",
        "pele_tot": "pele_kw_per_m2",
    }
    return max(abs(ours[our] - official[their]) / max(abs(official[their]), 1e-9) for their, our in names.items())


def run(arguments, folder, case, url, period, design, prices):
    inputs, controller, wanted, priced = DESIGNS[design]
    start = f'period = "{period}"' if period in PERIODS else f"start_day = {period}"
    values = {"design": design, "period": period, "prices": prices, "url": url, "inputs": inputs, "controller": controller}
    text = SCENARIO.format(**values, start=start, wanted=wanted, days=DAYS, weighs=str(priced).lower())
    (folder / "cell.toml").write_text(text, encoding="utf-8")
    words = [str(arguments.interplay.resolve()), "run", "cell.toml", "--no-record", "--json"]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{design}, {period}, {prices}: exit code {done.returncode}\n{done.stderr}")
    (folder / f"{design}, {period}, {prices}.json").write_text(done.stdout, encoding="utf-8")
    found = indicators(case)
    return found, difference(json.loads(done.stdout), found[prices])


def table(arguments, folder, case, url):
    worst, baseline, better, cells = 0.0, {}, {}, 0
    print("| design | period | prices | tdis [K·h] | ener [kWh/m²] | cost [EUR/m²] | emis [kg/m²] | pele [kW/m²] |", flush=True)
    print("|---|---|---|---|---|---|---|---|", flush=True)
    for period in arguments.periods:
        for design in arguments.designs:
            priced = DESIGNS[design][3]
            found = {}
            for prices in PRICES if priced else PRICES[:1]:
                all_prices, apart = run(arguments, folder, case, url, period, design, prices)
                found.update({prices: all_prices[prices]} if priced else all_prices)
                worst = max(worst, apart)
            for prices, kpis in found.items():
                numbers = [kpis[name] for name in ("tdis_tot", "ener_tot", "cost_tot", "emis_tot", "pele_tot")]
                print(f"| {design} | {period} | {prices} | " + " | ".join(f"{number:.4f}" for number in numbers) + " |", flush=True)
                if design == "its own":
                    baseline[period, prices] = kpis
                    cells += 1
                elif (period, prices) in baseline:
                    than = baseline[period, prices]
                    wins = all(kpis[name] < than[name] for name in ("tdis_tot", "cost_tot"))
                    better[design] = better.get(design, 0) + wins
    for (period, prices), kpis in baseline.items():
        if period not in PUBLISHED:
            continue
        published = {**PUBLISHED[period], "cost_tot": PUBLISHED_COST[period, prices]}
        apart = max(abs(kpis[name] / value - 1) for name, value in published.items())
        print(f"its own, {period}, {prices}: at most {100 * apart:.3f} % from the published indicators")
        worst = max(worst, apart if apart > 0.01 else 0.0)
    print(f"our indicators differ from BOPTEST's by at most {worst:.1e} of their value")
    for design, count in better.items():
        print(f"{design}: less cost and less discomfort than its own controller in {count} of {cells} cells")
    return worst < 1e-3 and (not better or max(better.values()) >= 5)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--boptest", type=pathlib.Path, help="a copy of BOPTEST")
    parser.add_argument("--fmu", type=pathlib.Path, help="the test case")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("heat-pump"), help="folder for the files")
    parser.add_argument("--port", type=int, default=8080)
    parser.add_argument("--periods", nargs="+", default=list(PERIODS), help="periods of the case, or first days of the year, as 45")
    parser.add_argument("--designs", nargs="+", default=list(DESIGNS), choices=list(DESIGNS))
    parser.add_argument("--interplay", type=pathlib.Path, default=ROOT / "target" / "release" / "interplay")
    arguments = parser.parse_args()
    if arguments.boptest is None or arguments.fmu is None or serve.missing():
        print("skipped: " + (f"not installed: {', '.join(serve.missing())}" if serve.missing() else "no --boptest and --fmu"))
        return
    arguments.interplay, folder = arguments.interplay.resolve(), arguments.out.resolve()
    if not arguments.interplay.exists():
        sys.exit(f"there is no {arguments.interplay}: cargo build --release makes it, --interplay names another")
    folder.mkdir(parents=True, exist_ok=True)
    serve.enter(arguments.boptest.resolve(), arguments.fmu.resolve())
    import logging

    import restapi

    logging.disable(logging.CRITICAL)
    options = {"host": "127.0.0.1", "port": arguments.port, "threaded": False}
    threading.Thread(target=restapi.app.run, kwargs=options, daemon=True).start()
    sys.exit(0 if table(arguments, folder, restapi.case, f"http://127.0.0.1:{arguments.port}") else 1)


if __name__ == "__main__":
    main()
