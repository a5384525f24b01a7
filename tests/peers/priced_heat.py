"""The cheapest heat of a day with prices by the hour and a heat pump, by SciPy.

Two zones behind walls, forward Euler in steps of an hour, limits that differ for heating and cooling, zones that are wanted warm at
other hours than each other. The cost

    J = sum W_e (r - T)^2 + W_u p(t)/mean p  mean COP/COP(T0(t)) u^2

is a linear least-squares problem with bounds in the heat, which scipy.optimize.lsq_linear solves (method "bvls", exact). Writes
what building/tests/energy.rs reads:

    python3 tests/peers/priced_heat.py > building/tests/data/priced_heat.json
"""
import json

import numpy as np
from scipy.optimize import lsq_linear

STEPS, STEP_S, ZONES = 24, 3600.0, 2
CAPACITY = np.array([6000.0, 9000.0])  # kJ/K
HEATING, COOLING = np.array([2.2, 1.6]), np.array([0.7, 0.4])  # kW
TO_AMBIENT, BETWEEN = np.array([12.0, 15.0]), 20.0  # K/kW
W_E, W_U, START_C = 0.5, 0.1, 20.0
HOURS = [[(8.0, 18.0, 21.0)], [(0.0, 7.0, 19.0), (17.0, 24.0, 22.0)]]
PRICES = [0.16] * 6 + [0.48] * 3 + [0.3] * 3 + [0.1] * 4 + [0.5] * 5 + [0.2] * 3
COP = [(-5.0, 2.0), (3.0, 3.0), (10.0, 4.4)]


def main():
    hours = np.arange(STEPS)
    outdoor = 2.0 + 7.0 * np.sin(2.0 * np.pi * (hours - 9.0) / 24.0)
    gains = 0.1 + 6.0 * np.stack([(hours >= 10) & (hours < 14), hours >= 19], axis=1)
    conductance = np.diag(1.0 / TO_AMBIENT + 1.0 / BETWEEN) - (np.ones((2, 2)) - np.eye(2)) / BETWEEN
    b = np.diag(STEP_S / CAPACITY)
    a = np.eye(ZONES) - b @ conductance

    free, state = [], np.full(ZONES, START_C)
    for t in range(STEPS):
        state = a @ state + b @ (outdoor[t] / TO_AMBIENT + gains[t])
        free.append(state)
    free = np.concatenate(free)
    g = np.zeros((STEPS * ZONES, STEPS * ZONES))
    for s in range(STEPS):
        response = b
        for t in range(s, STEPS):
            g[ZONES * t:ZONES * (t + 1), ZONES * s:ZONES * (s + 1)] = response
            response = a @ response

    wanted, weight = np.zeros(STEPS * ZONES), np.zeros(STEPS * ZONES)
    for t in range(STEPS):
        for zone in range(ZONES):
            for start, end, warm in HOURS[zone]:
                if start <= t + 1 <= end:
                    wanted[ZONES * t + zone], weight[ZONES * t + zone] = warm, W_E
    cops = np.interp(outdoor, [c for c, _ in COP], [cop for _, cop in COP])
    per_step = W_U * np.array(PRICES) / np.mean(PRICES) * np.mean([cop for _, cop in COP]) / cops
    matrix = np.vstack([np.sqrt(weight)[:, None] * g, np.diag(np.sqrt(np.repeat(per_step, ZONES)))])
    right = np.concatenate([np.sqrt(weight) * (wanted - free), np.zeros(STEPS * ZONES)])
    bounds = (-np.tile(COOLING, STEPS), np.tile(HEATING, STEPS))
    found = lsq_linear(matrix, right, bounds, method="bvls", tol=1e-14, max_iter=10000)
    assert found.success, found.message
    electric = np.abs(found.x).reshape(STEPS, ZONES).sum(axis=1) / cops
    print(json.dumps({
        "outdoor_c": outdoor.tolist(),
        "gains_kw": gains.reshape(-1).tolist(),
        "heat_kw": found.x.tolist(),
        "cost": 2.0 * found.cost,
        "electricity_kwh": float(electric.sum()),
        "money": float(np.dot(electric, PRICES)),
        "at_heating_limit": int(np.sum(found.x > bounds[1] - 1e-9)),
        "at_cooling_limit": int(np.sum(found.x < bounds[0] + 1e-9)),
    }))


main()
