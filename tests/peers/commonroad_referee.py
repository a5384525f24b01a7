"""Whether CommonRoad's own referee accepts what `interplay run --export` writes.

    python -m pip install commonroad-io==2024.3 commonroad-drivability-checker==2025.4.0 triangle
    python tests/peers/commonroad_referee.py FOLDER... [--program INTERPLAY] [--ego conservative] [--most 1000] [--bundled CHECKOUT]

FOLDER has scenarios of CommonRoad with a planning problem. Each distinct one is driven by the ego's planner, exported, and judged by
`valid_solution` twice: in the scenario as published and in the one as driven. A solution that does not reach its goal counts apart: it is
judged by everything else, its start, contacts, the edge of the road and feasibility. The first valid solution is spoilt in three ways, and
each must be refused. `--bundled` is a checkout of CommonRoad/commonroad-drivability-checker, whose own example solutions are judged, too.
Without the packages or without files the script says that it skips.
"""

import argparse
import collections
import contextlib
import hashlib
import io
import logging
import re
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

warnings.filterwarnings("ignore")
logging.disable(logging.WARNING)
try:
    from commonroad.common.file_reader import CommonRoadFileReader
    from commonroad.common.solution import CommonRoadSolutionReader
    from commonroad_dc.feasibility import solution_checker as referee
except ImportError:
    sys.exit(print("skipped: commonroad-io or commonroad-drivability-checker is not installed"))

REACHED = "reaches its goal"
MISSED = "misses its goal, judged without it"


def quietly(function, *arguments):
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        return function(*arguments)


def but_for_the_goal(roads, problems, solution):
    """The referee's `valid_solution` without its question whether the goal is reached."""
    problems.planning_problem_dict = {
        key: problem for key, problem in problems.planning_problem_dict.items() if key in solution.planning_problem_ids
    }
    clashes = [
        referee.obstacle_collision(roads, problems, solution),
        referee.boundary_collision(roads, problems, solution),
    ]
    feasible = referee.solution_feasible(solution, roads.dt, problems).values()
    starts = referee.starts_at_correct_state(solution, problems)
    return starts and not any(clashes) and all(result[0] for result in feasible), None


def verdict(scenario, solution, judge=None):
    """`valid`, or why the referee refuses a solution (a text of XML) of a scenario (a path)."""
    try:
        roads, problems = quietly(CommonRoadFileReader(str(scenario)).open)
        judged = quietly(CommonRoadSolutionReader.fromstring, solution)
        is_valid, _ = quietly(judge or referee.valid_solution, roads, problems, judged)
    except Exception as refusal:  # the referee raises one of many kinds
        return f"{type(refusal).__name__}: {' '.join(str(refusal).split())[:120]}"
    return "valid" if is_valid else "infeasible"


def spoilt(solution):
    """The solution with one state moved, with one that is faster, and without its last states."""
    states = re.findall(r"<ksState>.*?</ksState>", solution)
    at = states[len(states) // 2]

    def with_change(tag, by):
        return re.sub(rf"<{tag}>([^<]*)</{tag}>", lambda found: f"<{tag}>{float(found[1]) + by}</{tag}>", at)

    yield "moved aside", solution.replace(at, with_change("y", 0.5))
    yield "turned", solution.replace(at, with_change("orientation", 0.2))
    yield "cut short", solution.replace("".join(f"    {state}\n" for state in states[2:]), "")


def driven(path, program, ego, seconds, more=()):
    """What became of the run, the exported scenario and the solution."""
    with tempfile.TemporaryDirectory() as folder:
        words = ["run", str(path.resolve()), "--planner", ego, "--no-record", "--export", "driven.xml", *more]
        try:
            run = subprocess.run([program, *words], cwd=folder, capture_output=True, text=True, timeout=seconds)
        except subprocess.TimeoutExpired:
            return "late", None, None
        if run.returncode not in (0, 1):
            return f"not run: {' '.join(run.stderr.split())[:100]}", None, None
        reaches = "does not reach the goal" not in run.stderr
        scenario, solution = (Path(folder, name).read_text() for name in ("driven.xml", "driven.solution.xml"))
        return REACHED if reaches else MISSED, scenario, solution


def files(folders):
    known = set()
    for path in sorted(path for folder in folders for path in Path(folder).rglob("*.xml")):
        content = path.read_bytes()
        digest = hashlib.sha256(content).digest()
        if b"<commonRoad" in content[:4096] and b"<planningProblem" in content and digest not in known:
            known.add(digest)
            yield path


def judge_bundled(checkout, folders):
    """Judges the example solutions of the referee's own repository, whose scenarios may also stand in other folders."""
    found = [path for folder in [*folders, checkout] for path in Path(folder).rglob("*.xml")]
    scenarios = {path.stem: path for path in found if b"<commonRoad" in path.read_bytes()[:4096]}
    counts = collections.Counter()
    for path in sorted(Path(checkout).rglob("*.xml")):
        text = path.read_text(errors="replace")
        if "<CommonRoadSolution" not in text[:500]:
            continue
        found = re.search(r'benchmark_id="[^":]*:[^":]*:([^":]*):', text)
        scenario = scenarios.get(found[1]) if found else None
        counts["no scenario" if scenario is None else verdict(scenario, text).split(":")[0]] += 1
    print(f"{sum(counts.values())} bundled solutions: " + ", ".join(f"{count} {word}" for word, count in counts.most_common()))


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("folders", nargs="*")
    arguments.add_argument("--program", default="interplay")
    arguments.add_argument("--ego", action="append")
    arguments.add_argument("--seconds", type=float, default=120)
    arguments.add_argument("--most", type=int, default=1000)
    arguments.add_argument("--bundled")
    asked = arguments.parse_args()
    if asked.bundled:
        judge_bundled(asked.bundled, asked.folders)
        return
    found = list(files(asked.folders))[: asked.most]
    if not found:
        print("skipped: no scenario of CommonRoad with a planning problem below " + (", ".join(asked.folders) or "nothing"))
        return
    is_spoilt = False
    for ego in asked.ego or ["conservative"]:
        counts = collections.Counter()
        for path in found:
            outcome, scenario, solution = driven(path, asked.program, ego, asked.seconds)
            if solution is None:
                counts[outcome] += 1
                print(f"{ego:12} {path.name:44} {outcome}", flush=True)
                continue
            with tempfile.TemporaryDirectory() as folder:
                written = Path(folder, "driven.xml")
                written.write_text(scenario)
                judge = None if outcome == REACHED else but_for_the_goal
                published, as_driven = (verdict(place, solution, judge) for place in (path, written))
                counts[f"{outcome}: as published {published.split(':')[0]}"] += 1
                counts[f"{outcome}: as driven {as_driven.split(':')[0]}"] += 1
                if published != "valid" or as_driven != "valid":
                    print(f"{ego:12} {path.name:44} {outcome}; {published}; as driven: {as_driven}", flush=True)
                elif outcome == REACHED and not is_spoilt:
                    is_spoilt = True
                    for how, text in spoilt(solution):
                        refused = verdict(path, text)
                        print(f"spoilt ({how}): {refused}")
                        if refused == "valid":
                            sys.exit(f"the referee accepts a solution that was {how}")
        print(f"\n{ego}: {len(found)} scenarios")
        for result, count in sorted(counts.items()):
            print(f"{count:6} {result}")


if __name__ == "__main__":
    main()
