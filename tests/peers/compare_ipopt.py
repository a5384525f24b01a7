"""Compares our optima of the recorded problems with those of CasADi + IPOPT.

    python tests/peers/compare_ipopt.py            # straight roads, table on standard output, details in compare_ipopt.json
    python tests/peers/compare_ipopt.py --curved   # curved roads

For every problem both solvers start from the recorded guess, IPOPT with a tolerance of 1e-8 and then on from there to the
last digits. Then each starts at the other's optimum, to tell a second local optimum from unfinished work. IPOPT's inputs
are rolled out and charged by our cost function; its own objectives are kept in the details. The same method with Clarabel for
its step problems ("sparse") is a third opinion.
"""

import argparse
import json
import os
import pathlib
import subprocess
import tempfile

import numpy as np

from trajectory_nlp import Ipopt

ROOT = pathlib.Path(__file__).absolute().parents[2]
KINDS = ["human", "conservative", "negotiation", "bayesian", "game", "cooperative"]
CURVED_KINDS = ["curved-human", "curved-conservative", "curved-negotiation"]
#: Costs below this count as this much in a relative difference.
FLOOR = 1e-2


def ours(kind, solver, starts=None, repeats=1):
    """Our outcome of every problem, from the recorded guesses or from given inputs by id."""
    build = ["cargo", "run", "--release", "--quiet", "-p", "interplay-planners", "--example", "solve_problems", "--"]
    built = os.environ.get("SOLVE_PROBLEMS")
    command = [*([built] if built else build), kind, solver, str(repeats)]
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        if starts is not None:
            json.dump(starts, file)
            file.flush()
            command.append(file.name)
        answer = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout
    return json.loads(answer)


def problems(kind):
    return json.loads((ROOT / f"planners/tests/data/{kind}.json").read_text())


def relative(a, b, floor=FLOOR):
    """By how much `a` is dearer than `b`."""
    return (a - b) / max(abs(b), floor)


def compare(kind, ipopt, solver):
    """Every problem's costs: ours and IPOPT's from the guess and from each other's optimum, all by our cost function."""
    posed, mine, third = problems(kind), ours(kind, solver), ours(kind, "sparse")
    alone = "resumed" if solver == "planner" else solver
    first = [ipopt.solve(p, p["guess"], Ipopt.PLAIN) for p in posed]
    theirs = [ipopt.solve(p, f["inputs"], Ipopt.NEARBY) for p, f in zip(posed, first)]
    at_first = ours(kind, alone, {p["id"]: f["inputs"] for p, f in zip(posed, first)})
    at_theirs = ours(kind, alone, {p["id"]: t["inputs"] for p, t in zip(posed, theirs)})
    nearby = [ipopt.solve(p, m["inputs"] or p["guess"], Ipopt.NEARBY) for p, m in zip(posed, mine)]
    at_nearby = ours(kind, alone, {p["id"]: n["inputs"] for p, n in zip(posed, nearby)})
    rows = []
    for p, m, c, f, af, t, at, n, an in zip(posed, mine, third, first, at_first, theirs, at_theirs, nearby, at_nearby):
        solved = m["inputs"] is not None
        better = [cost for cost, outcome in [(af["start_cost"], f), (at["start_cost"], t)] if outcome["solved"]]
        rows.append({
            "id": p["id"], "ours": m["cost"], "error": m["error"], "residual": m["residual"],
            "programmes": m["programmes"], "safety_slack": m["safety_slack"], "guess": m["start_cost"],
            "guess_difference": abs(ipopt.programme(p).cost_at(p, p["guess"]) - m["start_cost"]) / (1 + m["start_cost"]),
            "clarabel": c["cost"], "penalty": ipopt.programme(p).penalty(p, m["inputs"]) if solved else None,
            "ipopt": min(better, default=None), "ipopt_status": f["status"], "ipopt_iterations": f["iterations"],
            "ipopt_objectives": [f["cost"], t["cost"]],
            "ours_from_ipopt": at["cost"], "ours_from_ipopt_error": at["error"],
            "ipopt_from_ours": an["start_cost"], "ipopt_from_ours_status": n["status"],
            "inputs_moved_by_ipopt": gap(m["inputs"], n["inputs"]) if solved else None,
            "other_side": passes_elsewhere(p, m["inputs"], t["inputs"]) if solved else None,
        })
        rows[-1]["verdict"] = verdict(rows[-1])
    return rows


def gap(a, b):
    """Largest difference of inputs."""
    return max(float(np.abs(np.array(x) - np.array(y)).max()) for x, y in zip(a, b))


def passes_elsewhere(problem, ours, theirs):
    """Whether two joint plans pass one another on different sides: whether the direction from the second vehicle to the first
    turns by angles that differ by more than a quarter turn."""
    if len(problem["vehicles"]) < 2:
        return False

    def turned(inputs):
        paths = [roll_out(vehicle, own, problem["step_s"]) for vehicle, own in zip(problem["vehicles"], inputs)]
        apart = paths[0] - paths[1]
        return np.unwrap(np.arctan2(apart[:, 1], apart[:, 0]))[[0, -1]] @ [-1, 1]

    return bool(abs(turned(ours) - turned(theirs)) > np.pi / 2)


def roll_out(vehicle, inputs, step_s):
    """Positions of a bicycle (eq. 6.1-6.5)."""
    front, rear = vehicle["body"][3:]
    x, y, heading, speed = vehicle["start"]
    path = [(x, y)]
    for acceleration, steering in inputs:
        slip = np.arctan(rear / (front + rear) * np.tan(steering))
        x, y = x + step_s * speed * np.cos(heading + slip), y + step_s * speed * np.sin(heading + slip)
        heading, speed = heading + step_s * speed * np.sin(slip) / rear, speed + step_s * acceleration
        path.append((x, y))
    return np.array(path)


def verdict(row, close=1e-6):
    """What a problem shows."""
    if row["error"]:
        return "unsolved by us"
    if row["ipopt"] is None:
        return "unsolved by IPOPT"
    apart = relative(row["ours"], row["ipopt"])
    if abs(apart) <= close:
        return "same"
    if apart > 0:
        here = abs(relative(row["ipopt_from_ours"], row["ipopt"])) <= close
        return "unfinished by us" if here else "ours is a dearer optimum"
    improved = row["ours_from_ipopt"] is not None and relative(row["ipopt"], row["ours_from_ipopt"]) > close
    return "unfinished by IPOPT" if improved else "ours is a cheaper optimum"


def table(results):
    lines = ["| | " + " | ".join(results) + " |", "|---|" + "---|" * len(results)]

    def line(name, value):
        lines.append(f"| {name} | " + " | ".join(str(value(rows)) for rows in results.values()) + " |")

    def share(rows, close, floor=FLOOR, others=("ipopt",)):
        best = [min((r[other] for other in others if r[other] is not None), default=None) for r in rows]
        met = [r for r, b in zip(rows, best)
               if not r["error"] and (b is None or relative(r["ours"], b, floor) <= close)]
        return f"{100 * len(met) / len(rows):.1f} %"

    line("problems", len)
    line("ours within 1e-4 of the better one", lambda rows: share(rows, 1e-4))
    line("ours within 1e-6 of the better one", lambda rows: share(rows, 1e-6))
    line("ours within 1e-6 of the better of IPOPT's and Clarabel's", lambda rows: share(rows, 1e-6, others=["ipopt", "clarabel"]))
    line("the same, costs below 1 counting as 1", lambda rows: share(rows, 1e-6, 1.0))
    for name in ["same", "ours is a cheaper optimum", "unfinished by IPOPT", "unsolved by IPOPT",
                 "ours is a dearer optimum", "unfinished by us", "unsolved by us"]:
        line(name, lambda rows: sum(r["verdict"] == name for r in rows))
    line("dearer, and IPOPT's passes on another side",
         lambda rows: sum(r["verdict"] == "ours is a dearer optimum" and r["other_side"] for r in rows))
    line("cheaper, and IPOPT's passes on another side",
         lambda rows: sum(r["verdict"] == "ours is a cheaper optimum" and r["other_side"] for r in rows))
    line("largest difference of both costs of a guess, by 1 + cost",
         lambda rows: f"{max(row['guess_difference'] for row in rows):.0e}")
    line("largest KKT residual", lambda rows: f"{max(r['residual'] for r in rows if not r['error']):.1e}")
    line("KKT residual above 1e-6", lambda rows: sum(r["residual"] > 1e-6 for r in rows if not r["error"]))
    line("largest safety slack", lambda rows: f"{max(r['safety_slack'] for r in rows if not r['error']):.1e}")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--solver", default="planner", choices=["planner", "global", "resumed", "robust", "structured", "sparse"])
    parser.add_argument("--kind", action="append", choices=KINDS + CURVED_KINDS)
    parser.add_argument("--curved", action="store_true", help="the problems on curved roads")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "tests/peers/compare_ipopt.json")
    arguments = parser.parse_args()
    ipopt = Ipopt()
    results = {kind: compare(kind, ipopt, arguments.solver) for kind in arguments.kind or (CURVED_KINDS if arguments.curved else KINDS)}
    arguments.out.write_text(json.dumps(results, indent=1))
    print(table(results))
    for kind, rows in results.items():
        for row in rows:
            if row["verdict"] != "same":
                print(f"{kind} {row['id']}: {describe(row)}")


def describe(row):
    """One problem in a line."""
    number = lambda value: "-" if value is None else f"{value:.8f}"
    text = f"{row['verdict']}: ours {number(row['ours'])}, IPOPT {number(row['ipopt'])}"
    text += f", IPOPT from ours {number(row['ipopt_from_ours'])}, ours from IPOPT {number(row['ours_from_ipopt'])}"
    if row["error"]:
        return f"{text} ({row['error']})"
    return (f"{text}; {row['programmes']} programmes, residual {row['residual']:.0e}, penalty paid {row['penalty']:.1e}, "
            f"IPOPT moves our inputs by {row['inputs_moved_by_ipopt']:.0e}")


if __name__ == "__main__":
    main()
