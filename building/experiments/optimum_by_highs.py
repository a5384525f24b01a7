"""The cheapest run of the house in January, found by independent code: its own reader of the weather, its own discretisation, and
the linear programme solver HiGHS of SciPy.

    python building/experiments/optimum_by_highs.py january-house.toml DEU_Mannheim.epw prices.csv 20.1 19.2 12.3

The last numbers are the temperatures of house and wall at the end of the run, as `january_house` prints them.
"""

import csv
import sys
import tomllib
from datetime import date, timedelta

import numpy as np
from scipy.linalg import expm
from scipy.optimize import linprog
from scipy.sparse import lil_matrix

STEP_H = 0.25
STEPS = 96
DAYS = 14
DISCOMFORT_PRICE = 100.0  # per K h: so high that there is none where heat can prevent it


def weather(path: str, first: date) -> tuple[np.ndarray, np.ndarray]:
    """Outdoor temperature [deg C] and radiation [kW/m2] in the middle of each step."""
    with open(path, encoding="latin-1") as lines:
        rows = list(csv.reader(lines))[8:]
    temperature = np.array([float(row[6]) for row in rows])
    sun = np.array([float(row[13]) for row in rows]) / 1000.0
    start_h = 24 * (first - date(first.year, 1, 1)).days
    hours = start_h + STEP_H * (np.arange(DAYS * STEPS) + 0.5)
    # Row k holds the temperature at k + 1 hours and the mean radiation around k + 1/2 hours.
    index = np.arange(-1, len(rows) + 1)
    wrapped = lambda values: values[index % len(rows)]
    return np.interp(hours, index + 1.0, wrapped(temperature)), np.interp(hours, index + 0.5, wrapped(sun))


def network(house: dict, walls: list[dict]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Continuous dynamics dT/dt = F T + K [T0, heat of the air, sun], in hours: the air first, then the heavy walls."""
    heavy = [wall for wall in walls if "capacity_kj_per_k" in wall]
    capacities = np.array([house["capacity_kj_per_k"]] + [wall["capacity_kj_per_k"] for wall in heavy]) / 3600.0
    count = len(capacities)
    conductances, ambient = np.zeros((count, count)), np.zeros(count)
    sun = np.array([house.get("solar_aperture_m2", 0.0)] + [wall.get("solar_aperture_m2", 0.0) for wall in heavy])
    for wall in walls:
        total = 1.0 / wall["resistance_k_per_kw"]
        if wall not in heavy:
            ambient[0] += total
            continue
        node, share = 1 + heavy.index(wall), wall.get("mass_position", 0.5)
        conductances[0, node] = conductances[node, 0] = total / share
        ambient[node] = total / (1.0 - share)
    flow = conductances - np.diag(conductances.sum(1) + ambient)
    inputs = np.column_stack([ambient, np.eye(count)[:, 0], sun])
    return flow / capacities[:, None], inputs / capacities[:, None], capacities


def steps_of_schedule(scenario: dict, first: date) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Lower and upper bound [deg C] at the end of each step (infinite where free), and the heat of people [kW] within it."""
    lower, upper = np.full(DAYS * STEPS, -np.inf), np.full(DAYS * STEPS, np.inf)
    people = np.zeros(DAYS * STEPS)
    for day in range(DAYS):
        kind = "weekend" if (first + timedelta(days=day)).weekday() >= 5 else "workday"
        for schedule in scenario["schedule"]:
            if kind not in schedule["days"]:
                continue
            for step in range(STEPS):
                t, middle, end = day * STEPS + step, (step + 0.5) * STEP_H, (step + 1) * STEP_H
                people[t] = schedule.get("base_kw", 0.0)
                for period in schedule["period"]:
                    if period["from_h"] <= middle < period["to_h"]:
                        people[t] += period["people_kw"]
                for period in sorted(schedule["period"], key=lambda period: -period["from_h"]):
                    if period["from_h"] <= end <= period["to_h"]:
                        lower[t] = period["wanted_c"] - period["band_k"]
                        upper[t] = period["wanted_c"] + period["band_k"]
    return lower, upper, people


def main() -> None:
    path, epw, price_file, *end = sys.argv[1:]
    with open(path, "rb") as file:
        scenario = tomllib.load(file)
    first = date.fromisoformat(scenario["calendar"]["first_day"])
    house = scenario["building"]["zone"][0]
    flow, inputs, capacities = network(house, scenario["building"]["wall"])
    nodes = len(capacities)
    exact = expm(np.block([[flow, inputs], [np.zeros((3, nodes + 3))]]) * STEP_H)
    a, b = exact[:nodes, :nodes], exact[:nodes, nodes:]
    outdoor, sun = weather(epw, first)
    lower, upper, people = steps_of_schedule(scenario, first)
    with open(price_file) as lines:
        prices = np.repeat([float(row[1]) for row in list(csv.reader(lines))[1:]], 4)[: DAYS * STEPS]
    points = scenario["heat_pump"]["heating"]
    cop = np.interp(outdoor, [point["outdoor_c"] for point in points], [point["cop"] for point in points])

    # Unknowns: heat of each step, discomfort of each step, temperatures at the ends of the steps.
    count = DAYS * STEPS
    cost = np.concatenate([prices * STEP_H / cop, np.full(count, DISCOMFORT_PRICE * STEP_H), np.zeros(nodes * count)])
    dynamics, known = lil_matrix((nodes * count, len(cost))), np.zeros(nodes * count)
    comfort, beyond = lil_matrix((2 * count, len(cost))), np.zeros(2 * count)
    for t in range(count):
        state = 2 * count + nodes * t
        for i in range(nodes):
            row = nodes * t + i
            dynamics[row, state + i] = 1.0
            dynamics[row, t] = -b[i, 1]
            known[row] = b[i] @ [outdoor[t], people[t], sun[t]]
            for j in range(nodes):
                if t == 0:
                    known[row] += a[i, j] * scenario["building"]["initial_c"]
                else:
                    dynamics[row, state - nodes + j] = -a[i, j]
        for k, (sign, bound) in enumerate([(1.0, upper[t]), (-1.0, -lower[t])]):
            comfort[2 * t + k, state] = sign
            comfort[2 * t + k, count + t] = -1.0
            beyond[2 * t + k] = min(bound, 1e4)
    bounds = [(0.0, house["heating_limit_kw"])] * count + [(0.0, None)] * count + [(None, None)] * (nodes * count)
    bounds[-nodes:] = [(float(value), float(value)) for value in end]
    found = linprog(cost, comfort.tocsr(), beyond, dynamics.tocsr(), known, bounds, method="highs")
    if found.status != 0:
        sys.exit(found.message)
    heat, discomfort = found.x[:count], found.x[count : 2 * count]
    print(f"{cost[:count] @ heat:.3f} EUR, {STEP_H * discomfort.sum():.4f} K h, {STEP_H * heat.sum():.1f} kWh of heat")


if __name__ == "__main__":
    main()
