"""Times of one plan of one vehicle by acados (SQP and SQP-RTI with HPIPM), beside ours on the same recorded problems.

    pip install comma-deps-acados casadi numpy scipy piqp     # Python 3.12; acados 0.2.2 as a wheel, which needs a C compiler
    A=.../site-packages/acados ACADOS_SOURCE_DIR=$A/install ACADOS_PYTHON_INTERFACE_PATH=$A/acados_template TERA_PATH=$A/install/bin/t_renderer \\
    LD_LIBRARY_PATH=$A/install/lib PYTHONPATH=$A python tests/peers/bench_acados.py

The problems of `human` and `conservative`: one vehicle among known motions. The states are those of the bicycle and the last input; rows of
the road and of ellipses are soft, as in our problem. The Hessian is that of Gauss and Newton, the QPs are condensed partially and solved by
HPIPM. SQP goes on to a tolerance of 1e-4 with a line search; SQP-RTI is one QP from the recorded guess, which is the plan before shifted by
a step. All inputs are rolled out and charged by the cost of `trajectory_nlp.py`.
"""

import argparse
import math
import os
import tempfile
import time

import casadi as ca
import numpy as np
from acados_template import AcadosModel, AcadosOcp, AcadosOcpSolver

import one_vehicle
from bench_piqp import Descent, relative
from compare_ipopt import ours, problems
from one_vehicle import KINDS
from trajectory_nlp import Ipopt

def model_of(ellipses, has_end, name):
    """Dynamics, residuals and soft rows of a stage."""
    stage, model = one_vehicle.Stage(ellipses, has_end), AcadosModel()
    model.name, model.x, model.u, model.p = name, stage.x, stage.u, stage.p
    model.disc_dyn_expr = stage.next
    model.cost_y_expr = model.cost_y_expr_0 = ca.vertcat(stage.change, stage.deviation)
    model.cost_y_expr_e = stage.deviation
    model.con_h_expr = model.con_h_expr_e = stage.rows
    return model


def solver_of(ellipses, has_end, horizon, kind, tolerance):
    """A solver for all problems of a shape."""
    ocp = AcadosOcp()
    name = f"{kind.lower()}_{ellipses}_{int(has_end)}"
    ocp.model = model_of(ellipses, has_end, name)
    ocp.dims.N = horizon
    cost, rows = ocp.cost, 4 + ellipses
    cost.cost_type = cost.cost_type_0 = cost.cost_type_e = "NONLINEAR_LS"
    cost.W = cost.W_0 = np.eye(6)
    cost.W_e = np.eye(4)
    cost.yref = cost.yref_0 = np.zeros(6)
    cost.yref_e = np.zeros(4)
    constraints = ocp.constraints
    constraints.lh = constraints.lh_e = np.zeros(rows)
    constraints.uh = constraints.uh_e = np.full(rows, 1e9)
    constraints.idxsh = constraints.idxsh_e = np.arange(rows)
    for at in ("zl", "zu", "Zl", "Zu"):
        setattr(cost, at, np.ones(rows)), setattr(cost, at + "_e", np.ones(rows))
    constraints.idxbu, constraints.lbu, constraints.ubu = np.arange(2), -np.ones(2), np.ones(2)
    constraints.idxbx, constraints.lbx, constraints.ubx = np.array([3]), np.zeros(1), np.ones(1)
    constraints.idxbx_e, constraints.lbx_e, constraints.ubx_e = np.array([3]), np.zeros(1), np.ones(1)
    constraints.x0 = np.zeros(6)
    ocp.parameter_values = np.zeros(ocp.model.p.numel())
    options = ocp.solver_options
    # A step of the length 1: costs are not scaled by the time step.
    options.tf, options.integrator_type = float(horizon), "DISCRETE"
    options.nlp_solver_type, options.hessian_approx = kind, "GAUSS_NEWTON"
    options.qp_solver, options.qp_solver_cond_N = "PARTIAL_CONDENSING_HPIPM", horizon // 3
    # The fastest of BALANCE and SPEED, and of 5, 10 and 30 blocks; with SPEED, SQP does not come to its tolerance.
    options.hpipm_mode = "SPEED" if kind == "SQP_RTI" else "BALANCE"
    options.nlp_solver_max_iter, options.tol, options.qp_tol = 100, tolerance, 1e-6
    options.ext_fun_compile_flags = "-O2"
    if kind == "SQP":
        options.globalization = "MERIT_BACKTRACKING"
    ocp.code_export_directory = f"c_{name}"
    return AcadosOcpSolver(ocp, json_file=f"{name}.json", verbose=False)


def prepare(solver, problem, states, inputs):
    """Writes the numbers of a problem and the guess."""
    vehicle, n = problem["vehicles"][0], problem["horizon"]
    weights = 2.0 * np.array([*vehicle["comfort"], *vehicle["weights"]])
    braking, accelerating, steering, *_ = vehicle["limits"]
    linear, squared = one_vehicle.prices(problem)
    first = one_vehicle.first_state(problem)
    for t in range(n + 1):
        solver.set(t, "p", one_vehicle.numbers(problem, t))
        solver.cost_set(t, "W", np.diag(weights if 0 < t < n else weights[2:] if t else [*weights[:2], 0, 0, 0, 0]))
        if t:
            # acados has no soft rows at the first stage.
            solver.cost_set(t, "zl", linear), solver.cost_set(t, "zu", linear)
            solver.cost_set(t, "Zl", 2.0 * squared), solver.cost_set(t, "Zu", 2.0 * squared)
            slowest, fastest = one_vehicle.speeds(problem, t)
            solver.constraints_set(t, "lbx", np.array([slowest])), solver.constraints_set(t, "ubx", np.array([fastest]))
        else:
            solver.cost_set(0, "zl", np.zeros(len(linear))), solver.cost_set(0, "zu", np.zeros(len(linear)))
            solver.constraints_set(0, "lbx", first), solver.constraints_set(0, "ubx", first)
            solver.constraints_set(0, "lh", np.full(len(linear), -1e9))
        if t < n:
            solver.constraints_set(t, "lbu", np.array([braking, -steering])), solver.constraints_set(t, "ubu", np.array([accelerating, steering]))
            solver.set(t, "u", np.array(inputs[t]))
        before = inputs[t - 1] if t else vehicle["previous_input"]
        solver.set(t, "x", np.array([*states[t], *before]))
        if t:
            solver.set(t, "sl", np.zeros(len(linear))), solver.set(t, "su", np.zeros(len(linear)))
        if t < n:
            solver.set(t, "pi", np.zeros(6))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--tolerance", type=float, default=1e-4, help="of SQP; with 1e-6 it goes on to its limit of 100 QPs in most problems of `human`")
    parser.add_argument("--kind", action="append", choices=KINDS)
    parser.add_argument("--every", type=int, default=1, help="takes every N-th problem")
    arguments = parser.parse_args()
    ipopt, solvers, descents = Ipopt(), {}, {}
    own = {kind: {o["id"]: o for o in ours(kind, "robust", repeats=7 * arguments.repeats)} for kind in arguments.kind or KINDS}
    folder = tempfile.mkdtemp()
    os.chdir(folder)
    print("| problems | solver | median ms | p99 ms | QPs in the median | solved by its own judgement | same cost as ours | dearer | cheaper |")
    print("|---|---|---|---|---|---|---|---|---|")
    for kind in arguments.kind or KINDS:
        posed = problems(kind)[:: arguments.every]
        mine = [own[kind][problem["id"]] for problem in posed]
        print(f"| {kind} | ours, from the guess | {np.median([o['time_ms'] for o in mine]):.3f} | {np.percentile([o['time_ms'] for o in mine], 99):.3f} | "
              f"{np.median([o['programmes'] for o in mine]):.0f} | {sum(o['error'] is None for o in mine)} | | | |", flush=True)
        for method in ("SQP", "SQP_RTI"):
            times, qps, solved, apart = [], [], 0, []
            for problem, o in zip(posed, mine):
                vehicle = problem["vehicles"][0]
                key = *one_vehicle.shape(problem), method
                if key not in solvers:
                    solvers[key] = solver_of(*key, arguments.tolerance)
                programme = ipopt.programme(problem)
                descent = descents.setdefault(programme, Descent(programme, None, 0.0, 1))
                inputs, path = descent.roll_out(problem, problem["guess"])
                states = [vehicle["start"], *path.reshape(-1, 6)[:, 2:]]
                shortest_s = math.inf
                for _ in range(arguments.repeats):
                    prepare(solvers[key], problem, states, inputs[0])
                    began = time.thread_time()
                    status = solvers[key].solve()
                    shortest_s = min(shortest_s, time.thread_time() - began)
                times.append(1e3 * shortest_s)
                qps.append(int(np.ravel(solvers[key].get_stats("sqp_iter"))[0]) if method == "SQP" else 1)
                solved += status == 0
                found = [[solvers[key].get(t, "u").tolist() for t in range(problem["horizon"])]]
                numbers = programme.numbers(problem)
                cost = float(descent.cost(descent.with_slacks(descent.roll_out(problem, found)[1], numbers), numbers))
                if o["cost"] is not None:
                    apart.append(relative(cost, o["cost"]) if math.isfinite(cost) else math.inf)
            verdicts = [sum(abs(a) <= 1e-4 for a in apart), sum(a > 1e-4 for a in apart), sum(a < -1e-4 for a in apart)]
            print(f"| {kind} | acados, {method.replace('_', '-')} | {np.median(times):.3f} | {np.percentile(times, 99):.3f} | {np.median(qps):.0f} | {solved} | "
                  f"{verdicts[0]} | {verdicts[1]} | {verdicts[2]} |", flush=True)


if __name__ == "__main__":
    main()
