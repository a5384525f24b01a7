"""The problem of one vehicle among known motions stage by stage, as solvers of optimal control want it: bench_acados.py, bench_fatrop.py.

The state is that of the bicycle and the last input. Rows at t = 1...N: four corners inside the road, then the ellipses.
"""

import casadi as ca
import numpy as np

from trajectory_nlp import Programme, axes_of, bicycle, clearances, headings_of, in_axes, outside

KINDS = ["human", "conservative"]
#: How many numbers a stage is given: body, road, end of the lane, target, axes, time step, and those of an ellipse.
SIZES, ELLIPSE = [5, 3, 3, 4, 2, 1], 6


class Stage:
    """Dynamics, residuals and soft rows of a stage."""

    def __init__(self, ellipses, has_end):
        self.x, self.u = ca.SX.sym("x", 6), ca.SX.sym("u", 2)
        sizes = SIZES + [ELLIPSE] * ellipses
        self.p = ca.SX.sym("p", sum(sizes))
        body, road, end, target, axes, step, *around = ca.vertsplit(self.p, np.cumsum([0, *sizes]).tolist())
        x, u = self.x, self.u
        self.next = ca.vertcat(bicycle(x[:4], u, body[3], body[4], step), u)
        self.change, self.deviation = u - x[4:], in_axes(x[:4] - target, axes)
        rows = [clearances(x[:4], body, road, end if has_end else None)]
        self.rows = ca.vertcat(*rows, *[outside(x[:2], e[:2], e[2:5], e[5]) for e in around])


def shape(problem):
    """How many ellipses there are, whether the lane ends, and how many stages there are."""
    vehicle = problem["vehicles"][0]
    return len(vehicle.get("keep_outs", [])), vehicle.get("lane_end") is not None, problem["horizon"]


def numbers(problem, t):
    """What stage t is given."""
    vehicle, n = problem["vehicles"][0], problem["horizon"]
    at = max(t - 1, 0)
    targets = vehicle["targets"]
    target = targets[0] if len(targets) == 1 else targets[at]
    found = [*vehicle["body"], *vehicle["road"], *(vehicle.get("lane_end") or [0.0, 0.0, 1.0]), *target, *axes_of(vehicle), problem["step_s"]]
    for e in vehicle.get("keep_outs", []):
        found += [*e["centres"][at], *e["shape"], headings_of(e, n)[at]]
    return np.array(found)


def prices(problem):
    """What a violation of each row costs, linear and squared."""
    ellipses = problem["vehicles"][0].get("keep_outs", [])
    return np.array([Programme.ROAD_EDGE] * 4 + [e["penalty"] for e in ellipses], dtype=float).T


def first_state(problem):
    """The state before the first input."""
    vehicle = problem["vehicles"][0]
    return np.array([*vehicle["start"], *vehicle["previous_input"]])


def speeds(problem, t):
    """The bounds on the speed at a stage after the first."""
    vehicle, elapsed = problem["vehicles"][0], problem["step_s"] * t
    braking, accelerating, _, slowest, fastest = vehicle["limits"]
    return min(slowest, vehicle["start"][3] + accelerating * elapsed), max(fastest, vehicle["start"][3] + braking * elapsed)
