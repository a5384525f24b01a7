#!/usr/bin/env python3
"""Computes indicators with BOPTEST's own `kpis/kpi_calculator.py`, unchanged, from signals that `building/tests/benchmark.rs` has too.

    pip install "numpy<2" "scipy<1.14" "pandas<2.2"
    python tests/peers/boptest/indicators.py --boptest FOLDER

FOLDER is a copy of github.com/ibpsa/project1-boptest, at commit 21433f81 or another one with the same calculator. The signals are
piecewise linear with few digits, so that both languages have the same numbers. Without the folder it says that it skips.
"""

import argparse
import importlib.util
import json
import pathlib
import sys

AREA_M2 = 192.0


def wave(index, period, low, high):
    """A triangle that rises from `low` to `high` and falls back, within `period` samples."""
    phase = index % period
    half = period / 2
    return low + (high - low) * (phase / half if phase < half else (period - phase) / half)


def signals():
    """Times that begin within a quarter of an hour and are 30 s and 50 s apart, and the signals at them."""
    times, time = [], 1000.0
    for index in range(4001):
        times.append(time)
        time += 30.0 if index % 2 == 0 else 50.0
    steps = range(len(times))
    measured = {
        "reaT1_y": [wave(index, 700, 291.0, 299.0) for index in steps],
        "reaT2_y": [wave(index, 1100, 293.0, 296.0) for index in steps],
        "reaCO2_y": [wave(index, 900, 400.0, 1200.0) for index in steps],
        "reaPHea_y": [wave(index, 130, 0.0, 4000.0) for index in steps],
        "reaPPum_y": [wave(index, 50, 10.0, 90.0) for index in steps],
        "reaPGas_y": [wave(index, 310, 0.0, 9000.0) for index in steps],
        "reaPDis_y": [wave(index, 410, 500.0, 7000.0) for index in steps],
        "reaWat_y": [wave(index, 210, 0.0, 0.0002) for index in steps],
    }
    known = {
        "LowerSetp[1]": [288.15 if index % 500 < 200 else 294.15 for index in steps],
        "UpperSetp[1]": [297.15 for _ in steps],
        "LowerSetp[2]": [294.15 for _ in steps],
        "UpperSetp[2]": [295.15 if index % 500 < 200 else 299.15 for index in steps],
        "UpperCO2[1]": [894.0 for _ in steps],
        "PriceElectricPowerConstant": [0.2535 for _ in steps],
        "PriceElectricPowerDynamic": [0.2383 if index % 300 < 100 else 0.2666 for index in steps],
        "PriceElectricPowerHighlyDynamic": [wave(index, 170, 0.1, 0.4) for index in steps],
        "PriceGasPower": [0.07 for _ in steps],
        "PriceDistrictHeatingPower": [0.1 for _ in steps],
        "PriceFreshWaterFlowRate": [4.5 for _ in steps],
        "EmissionsElectricPower": [0.167 for _ in steps],
        "EmissionsGasPower": [0.2 for _ in steps],
        "EmissionsDistrictHeatingPower": [0.15 for _ in steps],
    }
    return times, measured, known


class Data:
    """Stands in for BOPTEST's data manager."""

    def __init__(self, known):
        self._known = known

    def get_data(self, index=None, variables=None, **_):
        return {name: self._known[name] for name in variables}


class Case:
    """Stands in for BOPTEST's test case."""

    def __init__(self):
        times, measured, known = signals()
        self.y_store = {"time": times, **measured}
        self.u_store = {"time": times}
        self.initial_time = times[0]
        self.data_manager = Data(known)
        self.kpi_json = {
            "OperativeZoneTemperature[1]": ["reaT1_y"],
            "AirZoneTemperature[2]": ["reaT2_y"],
            "CO2Concentration[1]": ["reaCO2_y"],
            "ElectricPower": ["reaPHea_y", "reaPPum_y"],
            "GasPower": ["reaPGas_y"],
            "DistrictHeatingPower": ["reaPDis_y"],
            "FreshWaterFlowRate": ["reaWat_y"],
        }

    def _get_area(self):
        return AREA_M2

    def _get_elapsed_control_time_ratio(self):
        return []


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--boptest", type=pathlib.Path, help="a copy of BOPTEST")
    arguments = parser.parse_args()
    missing = [name for name in ("numpy", "scipy", "pandas") if importlib.util.find_spec(name) is None]
    if arguments.boptest is None or missing:
        print("skipped: " + (f"not installed: {', '.join(missing)}" if missing else "no copy of BOPTEST (--boptest)"))
        return
    sys.path.insert(0, str(arguments.boptest))
    from kpis.kpi_calculator import KPI_Calculator

    for prices in ("Constant", "Dynamic", "HighlyDynamic"):
        indicators = KPI_Calculator(Case()).get_core_kpis(price_scenario=prices)
        print(prices, json.dumps({name: value and float(value) for name, value in indicators.items()}))


if __name__ == "__main__":
    main()
