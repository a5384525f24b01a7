#!/usr/bin/env python3
"""Finds the network and the COP of table.py: heats the heat pump's test case by chance for 35 days and fits two temperatures to a free run.

    python tests/peers/boptest/identify.py --boptest FOLDER --fmu FILE.fmu

The days (from the tenth of February on) lie outside of the periods of table.py. Unknown are the capacities of the zone and of one mass, three
resistances and an aperture for global horizontal sun; the heat is that of the condenser. It needs what serve.py needs, or skips.
"""

import argparse
import logging
import pathlib
import random

import serve

FIRST_DAY, DAYS, STEP_S = 40, 35, 900
# Beyond these temperatures chance does not decide [K].
COLDEST_K, WARMEST_K = 291.5, 297.0


def excited(case):
    """Rows of heat [kW] in each step, and of temperatures [°C], sun [W/m²] and people [kW] at its end."""
    import numpy as np

    case.set_step(STEP_S)
    case.initialize(FIRST_DAY * 86_400, 7 * 86_400)
    chance, left, level, zone_k = random.Random(3), 0, 0.0, 294.0
    ends = []
    for _ in range(DAYS * 86_400 // STEP_S):
        if left <= 0:
            left, level = chance.choice([4, 8, 12, 16, 24, 36]), chance.choice([0, 0, 0.3, 0.5, 0.7, 1.0])
            if zone_k < COLDEST_K:
                level = chance.choice([0.7, 1])
            if zone_k > WARMEST_K:
                level = 0
        left -= 1
        status, message, now = case.advance({"oveHeaPumY_u": level, "oveHeaPumY_activate": 1})
        if status != 200:
            raise RuntimeError(message)
        zone_k = now["reaTZon_y"]
        ends.append((now["time"], zone_k - 273.15, now["weaSta_reaWeaTDryBul_y"] - 273.15, now["weaSta_reaWeaHGloHor_y"]))
    ends = np.array(ends)
    times, heat_w = np.array(case.y_store["time"]), np.array(case.y_store["reaQHeaPumCon_y"])
    last = np.searchsorted(times, ends[:, 0])
    heat_kw = np.array([heat_w[index - 29 : index + 1].mean() for index in last]) / 1000
    gains = case.data[["InternalGainsCon[1]", "InternalGainsRad[1]"]].sum(axis=1) / 1000
    people_kw = gains.loc[(ends[:, 0] - STEP_S).astype(int)].to_numpy()
    return np.column_stack([heat_kw, ends[:, 1:], people_kw])


def performance(case):
    """Heat by the electricity of compressor, fan and pump while the compressor runs at full speed, by outdoor temperature [°C]."""
    import numpy as np

    names = ("reaQHeaPumCon_y", "reaPHeaPum_y", "reaPFan_y", "reaPPumEmi_y", "reaHeaPumY_y", "weaSta_reaWeaTDryBul_y")
    heat_w, *powers_w, speed, outdoor_k = (np.array(case.y_store[name]) for name in names)
    found = []
    for least_c, most_c in ((-6, 0), (0, 4), (4, 8), (8, 12), (12, 16)):
        chosen = (speed > 0.99) & (outdoor_k >= least_c + 273.15) & (outdoor_k < most_c + 273.15)
        if chosen.any():
            found.append(((least_c + most_c) / 2, heat_w[chosen].sum() / sum(power_w[chosen].sum() for power_w in powers_w)))
    return found


def fit(rows):
    """The parameters of the least squares, and the root mean square error of the free run [K]."""
    import numpy as np
    from scipy.linalg import expm
    from scipy.optimize import least_squares

    heat_kw, zone_c, outdoor_c, sun, people_kw = rows.T

    def errors_k(parameters):
        zone, mass, between, to_outdoor, mass_to_outdoor, aperture = np.exp(parameters[:6])
        rates = np.zeros((4, 4))
        rates[0] = [-(1 / between + 1 / to_outdoor) / zone, 1 / between / zone, 1 / zone, 1 / to_outdoor / zone]
        rates[1] = [1 / between / mass, -(1 / between + 1 / mass_to_outdoor) / mass, 0, 1 / mass_to_outdoor / mass]
        step = expm(rates * STEP_S)
        inputs = np.column_stack([heat_kw + people_kw + aperture * sun / 1000, outdoor_c]) @ step[:2, 2:].T
        state, found = np.array([zone_c[0], parameters[6]]), np.empty(len(zone_c))
        found[0] = zone_c[0]
        for index in range(1, len(zone_c)):
            state = step[:2, :2] @ state + inputs[index]
            found[index] = state[0]
        return found - zone_c

    begin = np.r_[np.log([60_000, 100_000, 0.5, 6, 20, 8]), 22]
    least = np.r_[np.log([1000, 1000, 0.005, 1, 1, 0.1]), 18]
    most = np.r_[np.log([1e6, 3e5, 10, 1000, 1000, 60]), 30]
    solved = least_squares(errors_k, begin, bounds=(least, most), max_nfev=60)
    return np.exp(solved.x[:6]), float(np.sqrt(np.mean(solved.fun**2)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--boptest", type=pathlib.Path, help="a copy of BOPTEST")
    parser.add_argument("--fmu", type=pathlib.Path, help="the test case")
    arguments = parser.parse_args()
    if arguments.boptest is None or arguments.fmu is None or serve.missing():
        print("skipped: " + (f"not installed: {', '.join(serve.missing())}" if serve.missing() else "no --boptest and --fmu"))
        return
    serve.enter(arguments.boptest.resolve(), arguments.fmu.resolve())
    from testcase import TestCase

    case = TestCase()
    logging.disable(logging.CRITICAL)
    rows = excited(case)
    found, error_k = fit(rows)
    names = ("zone [kJ/K]", "mass [kJ/K]", "zone to mass [K/kW]", "zone to outdoor", "mass to outdoor", "aperture [m²]")
    print(", ".join(f"{name} {value:.5g}" for name, value in zip(names, found)))
    print("COP at full speed: " + ", ".join(f"{cop:.2f} at {outdoor_c:.0f} °C" for outdoor_c, cop in performance(case)))
    print(f"free run of {DAYS} days: root mean square error {error_k:.3f} K")


if __name__ == "__main__":
    main()
