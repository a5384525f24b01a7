"""Times of one plan with PIQP for the QP subproblems, beside ours and IPOPT's on the same recorded problems in one run.

    pip install casadi numpy scipy piqp          # PIQP 0.7, whose wheels have the multistage backend
    python tests/peers/bench_piqp.py
    SOLVE_PROBLEMS=target/release/examples/solve_problems python tests/peers/bench_piqp.py    # without cargo

PIQP solves convex QPs and no others, so it gets a descent around it: sequential quadratic programming on the problem of
`trajectory_nlp.py`. The unknowns of a QP are those of multiple shooting, in the order of the stages, so that PIQP's multistage backend finds
a block-tridiagonal matrix; a row that sums over all stages (persuasion, mean speed) gets a partial sum at every stage. The Hessian is that of
the Lagrangian, made convex stage by stage. The inputs are rolled out after every step, and a step is halved until the cost decreases.

Its time is that of PIQP alone (`update` and `solve`); "with derivatives" adds CasADi's evaluation of gradient, rows,
Jacobian and Hessian. Times of the peers are processor times, the shortest of the repetitions of each QP, each evaluation and each solve of
IPOPT; ours are wall times, the median: so other programs disturb ours and not the peers. What Python does between QPs is not counted, nor is the first `setup` for a
structure.
"""

import argparse
import math
import time

import casadi as ca
import numpy as np
import piqp
import scipy.sparse as sp

from bench_ipopt import FAST
from compare_ipopt import KINDS, ours, problems
from trajectory_nlp import Ipopt

#: A descent ends with a step in which no input changes by more,
LAST_STEP = 1e-6
#: or in which the cost decreases by less than this share of 1 + cost,
LEAST_DECREASE = 1e-9
#: or after this number of QPs.
MOST_STEPS = 100
#: Least eigenvalue of the Hessian of a stage.
LEAST_CURVATURE = 1e-8
BACKENDS = {"multistage": piqp.KKTSolver.sparse_multistage, "sparse": piqp.KKTSolver.sparse_ldlt}


class Descent:
    """Sequential quadratic programming with PIQP for programmes of one shape."""

    def __init__(self, programme, backend, tolerance, repeats):
        self.programme = programme
        x, p = programme.problem["x"], programme.problem["p"]
        f, g = programme.problem["f"], programme.problem["g"]
        self.equalities, self.soft = programme.equalities, len(programme.soft_rows)
        self.path = x.numel() - self.soft
        multipliers = ca.SX.sym("multipliers", g.numel())
        hessian, _ = ca.hessian(f + ca.dot(multipliers, g), x)
        self.derivatives = ca.Function("derivatives", [x, p, multipliers], [ca.gradient(f, x), g, ca.jacobian(g, x), hessian])
        self.cost = ca.Function("cost", [x, p], [f])
        self.jacobian_at = self._places(self.derivatives.sparsity_out(2))
        self.hessian_at = self._places(self.derivatives.sparsity_out(3))
        self._order(ca.vertcat(*programme.unknowns))
        self._groups()
        self.solver = None
        self.backend, self.tolerance, self.repeats = backend, tolerance, repeats

    @staticmethod
    def _places(sparsity):
        rows, columns = sparsity.get_triplet()
        return np.array(rows, dtype=int), np.array(columns, dtype=int)

    def _order(self, unknowns):
        """The stage of every variable, and the order of the stages."""
        self.is_input = np.zeros(self.path, dtype=bool)
        stage = np.zeros(self.path + self.soft, dtype=int)
        self.of = []
        for j in range(self.path):
            letter, vehicle, t = unknowns[j].name()[0], *map(int, unknowns[j].name().rstrip("0123456789").rstrip("_")[1:].split("_"))
            self.is_input[j] = letter == "u"
            stage[j] = t if letter == "u" else t - 1
            self.of.append((letter, vehicle, t))
        rows, columns = self.jacobian_at
        self.long_rows = []
        for j in range(self.soft):
            own = [stage[c] for r, c in zip(rows, columns) if r == self.equalities + j and c < self.path]
            # A row that sees nothing that is decided stays where it is.
            stage[self.path + j] = max(own, default=0)
            if own and max(own) - min(own) > 1:
                self.long_rows.append(j)
        #: A partial sum at every stage for every long row.
        self.sums = {(j, t): self.path + self.soft + i for i, (j, t) in
                     enumerate((j, t) for j in self.long_rows for t in range(self.programme.horizon))}
        all_stages = np.concatenate([stage, [t for _, t in self.sums]]).astype(int)
        self.count = len(all_stages)
        self.order = np.argsort(all_stages, kind="stable")
        self.position = np.empty(self.count, dtype=int)
        self.position[self.order] = np.arange(self.count)
        self.stage = stage

    def _groups(self):
        """Variables whose curvature belongs together: the states of all vehicles at a time, with the inputs there."""
        found = {}
        for j, (_, _, t) in enumerate(self.of):
            found.setdefault(t, []).append(j)
        self.groups = [np.array(members) for members in found.values()]
        self.group_of = np.full(self.path + self.soft, -1)
        self.place_in_group = np.zeros(self.path + self.soft, dtype=int)
        for i, members in enumerate(self.groups):
            self.group_of[members] = i
            self.place_in_group[members] = np.arange(len(members))

    def comfort(self, problem):
        """The Hessian of the cost of changes of inputs, which is convex and couples the stages."""
        rows, columns, values = [], [], []
        places = {of: [] for of in self.of}
        for j, of in enumerate(self.of):
            places[of].append(j)
        for i, vehicle in enumerate(problem["vehicles"]):
            known = len(vehicle.get("known_inputs", []))
            for t in range(known, self.programme.horizon):
                for axis in (0, 1):
                    now, weight = places["u", i, t][axis], 2.0 * vehicle["comfort"][axis]
                    before = places["u", i, t - 1][axis] if t > known else None
                    pairs = [(now, now, weight)]
                    if before is not None:
                        pairs += [(before, before, weight), (now, before, -weight), (before, now, -weight)]
                    for r, c, value in pairs:
                        rows.append(r), columns.append(c), values.append(value)
        return np.array(rows), np.array(columns), np.array(values)

    def convex(self, values, comfort):
        """The Hessian without negative curvature, as triplets with the same places every time."""
        rows, columns = self.hessian_at
        blocks = [np.zeros((len(members), len(members))) for members in self.groups]
        own = (self.group_of[rows] >= 0) & (self.group_of[rows] == self.group_of[columns])
        for r, c, v in zip(rows[own], columns[own], values[own]):
            blocks[self.group_of[r]][self.place_in_group[r], self.place_in_group[c]] += v
        for r, c, v in zip(*comfort):
            if self.group_of[r] == self.group_of[c]:
                blocks[self.group_of[r]][self.place_in_group[r], self.place_in_group[c]] -= v
        found = [list(comfort[0])], [list(comfort[1])], [list(comfort[2])]
        for members, block in zip(self.groups, blocks):
            least, vectors = np.linalg.eigh(0.5 * (block + block.T))
            block = (vectors * np.maximum(least, LEAST_CURVATURE)) @ vectors.T
            grid = np.meshgrid(members, members, indexing="ij")
            found[0].append(grid[0].ravel()), found[1].append(grid[1].ravel()), found[2].append(block.ravel())
        slacks = np.arange(self.path, self.path + self.soft)
        of_slack = np.full(self.soft, LEAST_CURVATURE)
        on_diagonal = (rows == columns) & (rows >= self.path)
        of_slack[rows[on_diagonal] - self.path] += values[on_diagonal]
        found[0].append(slacks), found[1].append(slacks), found[2].append(of_slack)
        return [np.concatenate(parts) for parts in found]

    def roll_out(self, problem, inputs):
        """Admissible inputs and the unknowns that they lead to."""
        unknowns, decided = [], []
        for vehicle, own in zip(problem["vehicles"], inputs):
            known, step = vehicle.get("known_inputs", []), problem["step_s"]
            braking, accelerating, steering, slowest, fastest = vehicle["limits"]
            front, rear = vehicle["body"][3:]
            x, y, heading, speed = vehicle["start"]
            first = speed
            chosen = []
            for t in range(self.programme.horizon):
                if t < len(known):
                    a, d = known[t]
                else:
                    elapsed = step * (t + 1)
                    low = max(braking, (min(slowest, first + accelerating * elapsed) - speed) / step)
                    high = min(accelerating, (max(fastest, first + braking * elapsed) - speed) / step)
                    a = max(min(own[t][0], high), low) if t < len(own) else max(min(0.0, high), low)
                    d = max(min(own[t][1], steering), -steering) if t < len(own) else 0.0
                    unknowns += [a, d]
                chosen.append([a, d])
                slip = math.atan(rear / (front + rear) * math.tan(d))
                x, y = x + step * speed * math.cos(heading + slip), y + step * speed * math.sin(heading + slip)
                heading, speed = heading + step * speed * math.sin(slip) / rear, speed + step * a
                unknowns += [x, y, heading, speed]
            decided.append(chosen)
        return decided, np.array(unknowns)

    def with_slacks(self, path, numbers):
        violations = np.maximum(0.0, -np.array(self.programme.soft_values(path, numbers)).ravel())
        return np.concatenate([path, violations])

    def qp(self, z, numbers, multipliers, bounds, comfort):
        """The QP subproblem at a point, and how long its derivatives took [ms]."""
        derivatives_ms = math.inf
        for _ in range(self.repeats):
            began = time.thread_time()
            gradient, rows, jacobian, hessian = self.derivatives(z, numbers, multipliers)
            derivatives_ms = min(derivatives_ms, 1e3 * (time.thread_time() - began))
        gradient, rows = np.array(gradient).ravel(), np.array(rows).ravel()
        values = np.array(jacobian.nonzeros())
        row_at, column_at = self.jacobian_at
        is_long = np.isin(row_at - self.equalities, self.long_rows) & (column_at < self.path)
        is_equality = row_at < self.equalities
        at = self.position
        # Dynamics, then partial sums.
        a_rows, a_columns, a_values = [row_at[is_equality]], [at[column_at[is_equality]]], [values[is_equality]]
        first = {j: self.equalities + i * self.programme.horizon for i, j in enumerate(self.long_rows)}
        for (j, t), variable in self.sums.items():
            here = [first[j] + t]
            a_rows.append(here), a_columns.append([at[variable]]), a_values.append([1.0])
            if t:
                a_rows.append(here), a_columns.append([at[self.sums[j, t - 1]]]), a_values.append([-1.0])
        long_at = np.flatnonzero(is_long)
        a_rows.append([first[row_at[k] - self.equalities] + self.stage[column_at[k]] for k in long_at])
        a_columns.append(at[column_at[long_at]]), a_values.append(-values[long_at])
        equalities = self.equalities + len(self.sums)
        matrix = lambda parts, shape: sp.csc_matrix((np.concatenate(parts[2]), (np.concatenate(parts[0]).astype(int), np.concatenate(parts[1]).astype(int))), shape)
        a = matrix((a_rows, a_columns, a_values), (equalities, self.count))
        b = np.concatenate([-rows[: self.equalities], np.zeros(len(self.sums))])
        kept = ~is_equality & ~is_long
        g_rows, g_columns, g_values = [row_at[kept] - self.equalities], [at[column_at[kept]]], [values[kept]]
        last = [at[self.sums[j, self.programme.horizon - 1]] for j in self.long_rows]
        g_rows.append(self.long_rows), g_columns.append(last), g_values.append(np.ones(len(last)))
        g = matrix((g_rows, g_columns, g_values), (self.soft, self.count))
        # Slacks are steps here, too.
        h = -rows[self.equalities:]
        p_rows, p_columns, p_values = self.convex(np.array(hessian.nonzeros()), comfort)
        p = sp.csc_matrix((p_values, (at[p_rows], at[p_columns])), (self.count, self.count))
        c = np.zeros(self.count)
        c[at[: len(gradient)]] = gradient
        low, high = np.full(self.count, -np.inf), np.full(self.count, np.inf)
        low[at[: len(z)]], high[at[: len(z)]] = bounds[0] - z, bounds[1] - z
        return dict(P=p, c=c, A=a, b=b, G=g, h_l=h, h_u=np.full(self.soft, np.inf), x_l=low, x_u=high), derivatives_ms

    def solve_qp(self, qp):
        """PIQP's result, and how long it took [ms]."""
        if self.solver is None:
            self.solver = piqp.SparseSolver()
            settings = self.solver.settings
            settings.kkt_solver = self.backend
            settings.eps_abs = settings.eps_rel = self.tolerance
            self.solver.setup(**qp)
            self.solver.solve()
        shortest_s = math.inf
        for _ in range(self.repeats):
            began = time.thread_time()
            self.solver.update(**qp)
            status = self.solver.solve()
            shortest_s = min(shortest_s, time.thread_time() - began)
        return status, self.solver.result, 1e3 * shortest_s, self.solver.result.info.iter

    def solve(self, problem):
        """The descent from the recorded guess."""
        numbers, bounds = self.programme.numbers(problem), self.programme.bounds(problem)
        comfort = self.comfort(problem)
        inputs, path = self.roll_out(problem, [problem["guess"][i] if i < len(problem["guess"]) else [] for i in range(len(problem["vehicles"]))])
        z = self.with_slacks(path, numbers)
        cost = float(self.cost(z, numbers))
        multipliers = np.zeros(self.equalities + self.soft)
        spent_ms, derivatives_ms, qps, iterations, failed = 0.0, 0.0, 0, 0, 0
        for _ in range(MOST_STEPS):
            qp, evaluated_ms = self.qp(z, numbers, multipliers, bounds, comfort)
            status, result, solved_ms, inner = self.solve_qp(qp)
            spent_ms, derivatives_ms, qps, iterations = spent_ms + solved_ms, derivatives_ms + evaluated_ms, qps + 1, iterations + inner
            if status != piqp.PIQP_SOLVED:
                failed += 1
                if failed > 1:
                    break
            step = np.array(result.x)[self.position[: self.path]]
            decided = step[self.is_input]
            share, found = 1.0, None
            while share > 1e-3:
                tried = []
                place = 0
                for vehicle, own in zip(problem["vehicles"], inputs):
                    known = len(vehicle.get("known_inputs", []))
                    changed = [list(u) for u in own]
                    for t in range(known, self.programme.horizon):
                        changed[t][0] += share * decided[place]
                        changed[t][1] += share * decided[place + 1]
                        place += 2
                    tried.append(changed)
                next_inputs, next_path = self.roll_out(problem, tried)
                next_z = self.with_slacks(next_path, numbers)
                next_cost = float(self.cost(next_z, numbers))
                if next_cost < cost:
                    found = next_inputs, next_z, next_cost
                    break
                share *= 0.5
            if found is None:
                break
            decrease = cost - found[2]
            inputs, z, cost = found
            multipliers[: self.equalities] = np.array(result.y)[: self.equalities]
            multipliers[self.equalities:] = -np.array(result.z_l)[: self.soft]
            if np.abs(decided).max() * share < LAST_STEP or decrease < LEAST_DECREASE * (1 + cost):
                break
        return {"cost": cost, "qps": qps, "iterations": iterations, "time_ms": spent_ms, "derivatives_ms": derivatives_ms, "failed": failed, "inputs": inputs}


def relative(a, b):
    """By how much a cost is dearer than another, of 1 + cost."""
    return (a - b) / (1 + abs(b))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=3, help="solves of every QP by PIQP, of every problem by IPOPT; ours seven times as many")
    parser.add_argument("--kind", action="append", choices=KINDS)
    parser.add_argument("--every", type=int, default=1, help="takes every N-th problem")
    parser.add_argument("--tolerance", type=float, default=1e-6, help="of PIQP")
    parser.add_argument("--backend", default="multistage", choices=BACKENDS)
    arguments = parser.parse_args()
    ipopt = Ipopt()
    print("| problems | solver | median ms | p99 ms | QPs in the median | inner iterations a QP | microseconds a QP | same cost as ours | dearer | cheaper |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for kind in arguments.kind or KINDS:
        posed = problems(kind)[:: arguments.every]
        own = {o["id"]: o for o in ours(kind, "robust", repeats=7 * arguments.repeats)}
        own = [own[problem["id"]] for problem in posed]
        descents, theirs, ms, with_derivatives = {}, [], [], []
        for problem in posed:
            programme = ipopt.programme(problem)
            if programme not in descents:
                descents[programme] = Descent(programme, BACKENDS[arguments.backend], arguments.tolerance, arguments.repeats)
            found = descents[programme].solve(problem)
            theirs.append(found)
            ms.append(found["time_ms"])
            with_derivatives.append(found["time_ms"] + found["derivatives_ms"])
        shortest = lambda problem: min(ipopt.solve(problem, problem["guess"], FAST)["processor_ms"] for _ in range(arguments.repeats))
        reference = [shortest(problem) for problem in posed]
        apart = [relative(f["cost"], o["cost"]) for f, o in zip(theirs, own) if o["cost"] is not None]
        verdicts = [sum(abs(a) <= 1e-4 for a in apart), sum(a > 1e-4 for a in apart), sum(a < -1e-4 for a in apart)]
        each = [1e3 * t / f["qps"] for t, f in zip(ms, theirs)]
        inner = np.median([f["iterations"] / f["qps"] for f in theirs])
        line = lambda name, times, rest: print(f"| {kind} | {name} | {np.median(times):.3f} | {np.percentile(times, 99):.3f} | {rest} |", flush=True)
        own_each = [1e3 * o["time_ms"] / o["programmes"] for o in own if o["programmes"]]
        own_qps = [o["programmes"] for o in own if o["programmes"]]
        own_inner = [o["inner_iterations"] / o["programmes"] for o in own if o["programmes"] and o["inner_iterations"]]
        line("ours, from the guess", [o["time_ms"] for o in own], f"{np.median(own_qps):.0f} | {np.median(own_inner) if own_inner else 0:.1f} | {np.median(own_each):.1f} | | | ")
        line("PIQP alone", ms, f"{np.median([f['qps'] for f in theirs]):.0f} | {inner:.1f} | {np.median(each):.1f} | {verdicts[0]} | {verdicts[1]} | {verdicts[2]}")
        line("PIQP with derivatives", with_derivatives, " | | | | | ")
        line("IPOPT, fast", reference, " | | | | | ")


if __name__ == "__main__":
    main()
