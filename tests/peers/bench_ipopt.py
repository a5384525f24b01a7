"""Times of one plan from the recorded guess: ours and CasADi + IPOPT's on the same problems, one after the other.

    python tests/peers/bench_ipopt.py          # or tests/peers/bench.sh, which runs the criterion benchmark first

A time is the median of several solves of one problem (wall clock, one thread; IPOPT's is that of its solver call alone,
functions evaluated by CasADi's virtual machine); the table shows median and 99th percentile over the problems. IPOPT is
shown as in the comparison (tolerance 1e-8) and as fast as we could make it: adaptive barrier, tolerance 1e-6.

"resumed" is one descent with the multipliers of the plan before; "planner" adds the comparison of the classes of motion, finished
at once, whereas in closed loop it rests for a few plans or takes several. "robust" is the descent from the guess alone,
"structured" and "sparse" are the same with other solvers of step problems.
"""

import argparse
import statistics

import numpy as np

from compare_ipopt import KINDS, ours, problems
from trajectory_nlp import Ipopt

FAST = Ipopt.PLAIN | {"ipopt.tol": 1e-6, "ipopt.mu_strategy": "adaptive"}


def ipopt_times(ipopt, posed, options, repeats):
    def median(problem):
        return statistics.median(ipopt.solve(problem, problem["guess"], options)["time_ms"] for _ in range(repeats))

    return [median(problem) for problem in posed]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=3, help="solves of every problem by IPOPT; ours do seven times that")
    parser.add_argument("--kind", action="append", choices=KINDS)
    arguments = parser.parse_args()
    ipopt = Ipopt()
    print("| problems | solver | median ms | p99 ms | max ms | unsolved | IPOPT's median / this |\n|---|---|---|---|---|---|---|")
    for kind in arguments.kind or KINDS:
        posed = problems(kind)
        times, unsolved = {}, {}
        often = 7 * arguments.repeats
        for solver, repeats in [("planner", often), ("resumed", often), ("robust", often), ("structured", often), ("sparse", 1)]:
            outcomes = ours(kind, solver, repeats=repeats)
            if solver in ("planner", "resumed"):
                # The first plan of a run has nothing to resume.
                outcomes = [o for o, problem in zip(outcomes, posed) if problem.get("memory")]
            times[solver] = [outcome["time_ms"] for outcome in outcomes]
            unsolved[solver] = sum(outcome["error"] is not None for outcome in outcomes)
        times["IPOPT, 1e-8"] = ipopt_times(ipopt, posed, Ipopt.PLAIN, arguments.repeats)
        times["IPOPT, fast"] = ipopt_times(ipopt, posed, FAST, arguments.repeats)
        reference = np.median(times["IPOPT, fast"])
        for solver, own in times.items():
            print(f"| {kind} | {solver} | {np.median(own):.3f} | {np.percentile(own, 99):.3f} | {max(own):.3f} | "
                  f"{unsolved.get(solver, '')} | {reference / np.median(own):.1f} |")


if __name__ == "__main__":
    main()
