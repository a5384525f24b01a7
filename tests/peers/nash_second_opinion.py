"""A second opinion on Nash equilibria: does IPOPT find a deviation by which a player gains?

    cargo run --release -p interplay-planners --example nash_games -- 100 1 FILE.json
    python tests/peers/nash_second_opinion.py FILE.json

Every record is the own problem of one player of a random game, while the others keep to the equilibrium that the guess is part
of. IPOPT solves it from the equilibrium, and from driving straight on without a change of speed. By our cost function a player may gain at
most 1e-4.
"""

import collections
import json
import pathlib
import sys

from trajectory_nlp import Ipopt

#: Most that a player may gain by leaving.
TOLERATED_GAIN = 1e-4


def main(path):
    problems = json.loads(pathlib.Path(path).read_text())
    ipopt = Ipopt()
    gains, unsolved = collections.defaultdict(list), collections.Counter()
    for problem in problems:
        game, players, _ = problem["id"].split("/")
        cost = ipopt.programme(problem).cost_at(problem, problem["guess"])
        straight = [[[0.0, 0.0]] * problem["horizon"]]
        best = 0.0
        for start, guess, options in [("equilibrium", problem["guess"], Ipopt.NEARBY), ("straight", straight, Ipopt.PLAIN)]:
            found = ipopt.solve(problem, guess, options)
            if not found["solved"]:
                unsolved[start] += 1
                continue
            gain = cost - ipopt.programme(problem).cost_at(problem, found["inputs"])
            gains[start].append(gain)
            best = max(best, gain)
        gains["either"].append(best)
        gains[f"games of {players}: either"].append(best)
    games = {problem["id"].split("/")[0] for problem in problems}
    print(f"{len(games)} games, {len(problems)} players")
    for start, found in gains.items():
        above = sum(gain > TOLERATED_GAIN for gain in found)
        print(f"  {start}: largest gain {max(found):.2e}, {above} of {len(found)} above {TOLERATED_GAIN:g}; "
              f"IPOPT did not solve {unsolved[start]}")


if __name__ == "__main__":
    main(sys.argv[1])
