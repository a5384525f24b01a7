"""How many scenes of CommonRoad an ego solves, as CommonRoad's own referee judges: drawn by a seed from many repositories, by kinds.

    python -m pip install commonroad-io==2024.3 commonroad-drivability-checker==2025.4.0 triangle
    python tests/peers/commonroad_solved.py CLONES [--program INTERPLAY] [--each 20] [--seed 1] [--ego conservative] [--json FILE]

CLONES has clones of the repositories of `commonroad_clones.py`. Of each kind (hand-made, NGSIM, other recorded) as many distinct scenes with a
planning problem are drawn as stated, one repository after the other. Each is driven twice: by an ego that sees motion, and with
`--ego-knows-records`. A table says, by kind, how many are valid solutions of the scene as published, with Wilson's interval, and what the referee
has against the others; pairs are compared by McNemar's exact test. Without packages or clones the script says that it skips.
"""

import argparse
import collections
import json
import math
import random
import re
import sys
import tempfile
from pathlib import Path

from commonroad_clones import NGSIM, content, files, site_of
from commonroad_referee import REACHED, driven, quietly, referee
from commonroad.common.file_reader import CommonRoadFileReader
from commonroad.common.solution import CommonRoadSolutionReader

KINDS = ["hand-made", "NGSIM", "other recorded"]
SIZES = range(3000, 3_000_000)
VARIANTS = {"sees motion": [], "knows records": ["--ego-knows-records"]}


def kind_of(path):
    site = site_of(path)
    if site is not None:
        return "NGSIM" if site in NGSIM else "other recorded"
    is_made = re.match(r"(C-)?ZAM_[A-Za-z]+-\d+_\d+_[TS]-\d", path.rsplit("/", 1)[-1]) and "/interactive/" not in path
    return "hand-made" if is_made else None


def draw(clones, each, seed):
    """As many scenes of each kind, one repository after the other, each distinct by its name and its content."""
    found = collections.defaultdict(lambda: collections.defaultdict(list))
    for repository, path, place, size in files(clones):
        kind = kind_of(path)
        if kind and size in SIZES:
            found[kind][repository].append((path, place))
    drawn = []
    for kind in KINDS:
        order, names, count = random.Random(f"{seed} {kind}"), set(), 0
        queues = [(repository, order.sample(of_it, len(of_it))) for repository, of_it in sorted(found[kind].items())]
        while count < each and any(queue for _, queue in queues):
            for repository, queue in queues:
                while queue and count < each:
                    path, place = queue.pop()
                    name, text = path.rsplit("/", 1)[-1], content(place)
                    if name.split(".")[0] in names or b"<planningProblem" not in text or b"<commonRoad" not in text[:4096]:
                        continue
                    names.add(name.split(".")[0])
                    drawn.append((kind, repository, name, text))
                    count += 1
                    break
    return drawn


def objections(path, solution):
    """What the referee has against a solution of a scene as published; nothing if it is valid."""
    try:
        roads, problems = quietly(CommonRoadFileReader(str(path)).open)
        judged = quietly(CommonRoadSolutionReader.fromstring, solution)
        problems.planning_problem_dict = {
            key: it for key, it in problems.planning_problem_dict.items() if key in judged.planning_problem_ids
        }
        questions = {
            "touches a vehicle": lambda: referee.obstacle_collision(roads, problems, judged),
            "leaves the road": lambda: referee.boundary_collision(roads, problems, judged),
            "infeasible": lambda: not all(it[0] for it in referee.solution_feasible(judged, roads.dt, problems).values()),
            "another start": lambda: not referee.starts_at_correct_state(judged, problems),
            "misses the goal": lambda: not referee.goal_reached(roads, problems, judged),
        }
    except Exception as refusal:  # the referee raises one of many kinds
        return [f"{type(refusal).__name__}: {' '.join(str(refusal).split())[:80]}"]
    found = []
    for words, question in questions.items():
        try:
            is_so = quietly(question)
        except Exception:
            is_so = True
        found += [words] if is_so else []
    return found


def judged(kind, repository, name, text, words, options):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, name)
        path.write_bytes(text)
        outcome, _, solution = driven(path, options.program, options.ego, options.seconds, words)
        against = [outcome] if solution is None else objections(path, solution)
    if outcome == REACHED and against == ["misses the goal"]:
        against = ["misses the goal for the referee alone"]
    return against


def wilson(count, of):
    if of == 0:
        return [0.0, 1.0]
    z, share = 1.96, count / of
    middle, half = share + z * z / (2 * of), z * math.sqrt(share * (1 - share) / of + z * z / (4 * of * of))
    return [(middle + side * half) / (1 + z * z / of) for side in (-1, 1)]


def mcnemar(one, other):
    first, second = sum(a and not b for a, b in zip(one, other)), sum(b and not a for a, b in zip(one, other))
    tail = sum(math.comb(first + second, k) for k in range(min(first, second) + 1)) / 2 ** (first + second)
    return first, second, min(1.0, 2 * tail)


def report(results):
    print("| scenes | " + " | ".join(VARIANTS) + " | against the others that know records |\n|---" + "|---" * (1 + len(VARIANTS)) + "|")
    for kind in [*KINDS, "all"]:
        of_kind = [it for it in results if kind in (it["kind"], "all")]
        cells = []
        for variant in VARIANTS:
            valid = sum(not it[variant] for it in of_kind)
            low, high = wilson(valid, len(of_kind))
            cells.append(f"{valid} of {len(of_kind)}, {100 * valid / max(len(of_kind), 1):.0f} % ({100 * low:.0f} to {100 * high:.0f})")
        last = list(VARIANTS)[-1]
        why = collections.Counter(reason.split(":")[0] for it in of_kind for reason in it[last])
        print(f"| {kind} | " + " | ".join(cells) + " | " + ", ".join(f"{reason} {count}" for reason, count in why.most_common()) + " |")
    one, other = ([not it[variant] for it in results] for variant in VARIANTS)
    first, second, p = mcnemar(one, other)
    print(f"\nvalid only if it sees motion {first}, only if it knows records {second}, p = {p:.2g}")
    print(f"repositories: {', '.join(sorted({it['repository'] for it in results}))}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("clones")
    parser.add_argument("--program", default="interplay")
    parser.add_argument("--ego", default="conservative")
    parser.add_argument("--each", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=300)
    parser.add_argument("--json")
    options = parser.parse_args()
    scenes = draw(options.clones, options.each, options.seed)
    if not scenes:
        print(f"skipped: no scenes of CommonRoad with a planning problem below {options.clones}")
        return
    # The kinds in turn, so that a run that is cut short has judged as many of each.
    by_kind = [[scene for scene in scenes if scene[0] == kind] for kind in KINDS]
    scenes = [scene for row in range(options.each) for of_kind in by_kind for scene in of_kind[row : row + 1]]
    results = []
    for kind, repository, name, text in scenes:
        found = {variant: judged(kind, repository, name, text, words, options) for variant, words in VARIANTS.items()}
        results.append({"kind": kind, "repository": repository, "name": name, **found})
        said = "; ".join(f"{variant}: {', '.join(against) or 'valid'}" for variant, against in found.items())
        print(f"{kind:15} {name:44} {said}", file=sys.stderr, flush=True)
        if options.json:
            Path(options.json).write_text(json.dumps(results, indent=1))
    report(results)


if __name__ == "__main__":
    main()
