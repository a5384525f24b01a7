"""Times of one plan of one vehicle by fatrop, beside ours on the same recorded problems.

    pip install casadi numpy scipy piqp      # CasADi's wheels have fatrop
    python tests/peers/bench_fatrop.py

The problems of `human` and `conservative`, stage by stage (`one_vehicle.py`); slacks are inputs. Times are processor times of the solver call,
the shortest of the repetitions, functions evaluated by CasADi's virtual machine; ours are wall times, the median.
"""

import argparse

import casadi as ca
import numpy as np

import one_vehicle
from bench_piqp import Descent, relative
from compare_ipopt import ours, problems
from trajectory_nlp import Ipopt

INF = np.inf


class Fatrop:
    """fatrop for all problems of a shape."""

    def __init__(self, ellipses, has_end, horizon):
        stage = one_vehicle.Stage(ellipses, has_end)
        self.rows, self.horizon = 4 + ellipses, horizon
        following = ca.Function("following", [stage.x, stage.u, stage.p], [stage.next])
        soft = ca.Function("soft", [stage.x, stage.p], [stage.rows])
        deviation = ca.Function("deviation", [stage.x, stage.p], [stage.deviation])
        p = [ca.SX.sym(f"p{t}", stage.p.numel()) for t in range(horizon + 1)]
        price, weight, first = ca.SX.sym("price", 2, self.rows), ca.SX.sym("weight", 6), ca.SX.sym("first", 6)
        x = [ca.SX.sym(f"x{t}", 6) for t in range(horizon + 1)]
        # The slacks of stage t are inputs of stage t - 1, whose state leads there.
        u = [ca.SX.sym(f"u{t}", 2 + self.rows) for t in range(horizon)]
        unknowns, constraints, equality, counts, cost = [], [], [], [], 0
        for t in range(horizon + 1):
            unknowns.append(x[t])
            here = 0
            if t < horizon:
                unknowns.append(u[t])
                slacks = u[t][2:]
                then = following(x[t], u[t][:2], p[t])
                constraints.append(x[t + 1] - then)
                equality += [True] * 6
                change = u[t][:2] - x[t][4:]
                cost += ca.dot(weight[:2], change**2) + ca.dot(price[0, :].T, slacks) + ca.dot(price[1, :].T, slacks**2)
            if t == 0:
                constraints.append(x[0] - first)
                equality += [True] * 6
                here += 6
            else:
                cost += ca.dot(weight[2:], deviation(x[t], p[t]) ** 2)
            if t < horizon:
                constraints.append(soft(then, p[t + 1]) + slacks)
                equality += [False] * self.rows
                here += self.rows
            counts.append(here)
        given = ca.vertcat(*p, ca.vec(price), weight, first)
        options = {"print_time": False, "record_time": True, "error_on_fail": False, "structure_detection": "manual", "nx": [6] * (horizon + 1),
                   "nu": [2 + self.rows] * horizon + [0], "ng": counts, "N": horizon, "equality": equality,
                   "fatrop.print_level": 0, "fatrop.tol": 1e-6, "fatrop.mu_init": 1e-2, "fatrop.max_iter": 300}
        self.solver = ca.nlpsol("fatrop", "fatrop", {"x": ca.vertcat(*unknowns), "f": cost, "g": ca.vertcat(*constraints), "p": given}, options)
        self.upper = np.where(equality, 0.0, INF)

    def solve(self, problem, states, inputs, repeats):
        vehicle, n = problem["vehicles"][0], self.horizon
        braking, accelerating, steering, *_ = vehicle["limits"]
        guess, low, high = [], [], []
        for t in range(n + 1):
            guess += [*states[t], *(inputs[t - 1] if t else vehicle["previous_input"])]
            slowest, fastest = one_vehicle.speeds(problem, t) if t else (-INF, INF)
            low += [-INF] * 3 + [slowest, -INF, -INF]
            high += [INF] * 3 + [fastest, INF, INF]
            if t < n:
                guess += [*inputs[t], *[0.0] * self.rows]
                low += [braking, -steering, *[0.0] * self.rows]
                high += [accelerating, steering, *[INF] * self.rows]
        given = [*[one_vehicle.numbers(problem, t) for t in range(n + 1)], one_vehicle.prices(problem).T.ravel(), [*vehicle["comfort"], *vehicle["weights"]], one_vehicle.first_state(problem)]
        call = {"x0": guess, "lbx": low, "ubx": high, "lbg": np.zeros(len(self.upper)), "ubg": self.upper, "p": np.concatenate(given)}
        times = []
        for _ in range(repeats):
            found = self.solver(**call)
            times.append(1e3 * self.solver.stats()["t_proc_total"])
        stats, at, decided = self.solver.stats(), 0, []
        solution = np.array(found["x"]).ravel()
        for _ in range(n):
            decided.append(solution[at + 6 : at + 8].tolist())
            at += 8 + self.rows
        return decided, min(times), bool(stats["success"]), stats.get("iter_count", -1)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--kind", action="append", choices=one_vehicle.KINDS)
    parser.add_argument("--every", type=int, default=1, help="takes every N-th problem")
    arguments = parser.parse_args()
    ipopt, solvers, descents = Ipopt(), {}, {}
    print("| problems | solver | median ms | p99 ms | iterations in the median | solved by its own judgement | same cost as ours | dearer | cheaper |")
    print("|---|---|---|---|---|---|---|---|---|")
    for kind in arguments.kind or one_vehicle.KINDS:
        posed = problems(kind)[:: arguments.every]
        own = {o["id"]: o for o in ours(kind, "robust", repeats=7 * arguments.repeats)}
        own = [own[problem["id"]] for problem in posed]
        times, iterations, solved, apart = [], [], 0, []
        for problem, o in zip(posed, own):
            key = one_vehicle.shape(problem)
            if key not in solvers:
                solvers[key] = Fatrop(*key)
            programme = ipopt.programme(problem)
            descent = descents.setdefault(programme, Descent(programme, None, 0.0, 1))
            inputs, path = descent.roll_out(problem, problem["guess"])
            states = [problem["vehicles"][0]["start"], *path.reshape(-1, 6)[:, 2:]]
            found, ms, is_solved, count = solvers[key].solve(problem, states, inputs[0], arguments.repeats)
            times.append(ms), iterations.append(count)
            solved += is_solved
            given = programme.numbers(problem)
            cost = float(descent.cost(descent.with_slacks(descent.roll_out(problem, [found])[1], given), given))
            if o["cost"] is not None:
                apart.append(relative(cost, o["cost"]) if np.isfinite(cost) else INF)
        verdicts = [sum(abs(a) <= 1e-4 for a in apart), sum(a > 1e-4 for a in apart), sum(a < -1e-4 for a in apart)]
        mine = [o["time_ms"] for o in own]
        print(f"| {kind} | ours, from the guess | {np.median(mine):.3f} | {np.percentile(mine, 99):.3f} | | {sum(o['error'] is None for o in own)} | | | |")
        print(f"| {kind} | fatrop, 1e-6 | {np.median(times):.3f} | {np.percentile(times, 99):.3f} | {np.median(iterations):.0f} | {solved} | {verdicts[0]} | {verdicts[1]} | {verdicts[2]} |", flush=True)


if __name__ == "__main__":
    main()
