"""Decisions a second beside EnvPool and HighwayEnv, in one process: the same streets with as many vehicles and time steps.

    pip install envpool highway-env gymnasium        # Python 3.12 or later
    python python/benchmarks/beside_envpool.py > table.md

Every decision lasts a simulated second. Measurements alternate, round by round; the median of the rounds counts. A processor second is one
of all threads of the process together, so that other programs on the machine disturb it less than the wall clock.
"""

from __future__ import annotations

import argparse
import os
import re
import statistics
import tempfile
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

THREADS = 2
# Before the first world: the pool of threads is made once.
os.environ.setdefault("RAYON_NUM_THREADS", str(THREADS))

import gymnasium  # noqa: E402
import numpy as np  # noqa: E402
from peer_streets import HUMAN, IDM, STREETS, Street  # noqa: E402

import interplay  # noqa: E402
from interplay.envs import InterplayEnv, InterplayVectorEnv  # noqa: E402

WORLDS = 64
#: Plans a second where vehicles plan by optimisation, and as many steps of the simulation.
PLANS_A_SECOND = 5
#: Their horizon: 4 s.
PLANNED_STEPS = 20

Step = Callable[[], int]


class Measured:
    """Something that decides."""

    def __init__(self, street: str, label: str, steps_a_decision: float, begin: Callable[[], Step]) -> None:
        self.street, self.label, self.steps_a_decision, self.begin = street, label, steps_a_decision, begin
        self.wall: list[float] = []
        self.processor: list[float] = []
        self._step: Step | None = None

    def measure(self, seconds: float) -> None:
        """Decides for some time, resets included."""
        if self._step is None:
            self._step = self.begin()
            self._step()
        decisions, began, began_cpu = 0, time.perf_counter(), time.process_time()
        while (passed := time.perf_counter() - began) < seconds or decisions == 0:
            decisions += self._step()
        self.wall.append(decisions / passed)
        self.processor.append(decisions / max(time.process_time() - began_cpu, 1e-6))


def meta_actions(street: Street) -> list[int]:
    """The meta-actions that are drawn: at the intersection HighwayEnv has no changes of lanes."""
    return [1, 3, 4] if street.name == "Intersection" else [0, 1, 2, 3, 4]


def highway_env(street: Street) -> Callable[[], Step]:
    """One environment of HighwayEnv."""

    def begin() -> Step:
        env: Any = gymnasium.make(street.peer).unwrapped
        env.reset(seed=0)
        env.action_space.seed(0)

        def step() -> int:
            _, _, terminated, truncated, _ = env.step(env.action_space.sample())
            if terminated or truncated:
                env.reset()
            return 1

        return step

    return begin


def env_pool(street: Street, worlds: int) -> Callable[[], Step]:
    """Environments of EnvPool, stepped together."""

    def begin() -> Step:
        import envpool

        env = envpool.make(street.envpool, env_type="gymnasium", num_envs=worlds, num_threads=min(worlds, THREADS), seed=1)
        count, drawn = int(env.action_space.n), np.random.default_rng(0)
        env.reset()

        def step() -> int:
            # Episodes that are over restart automatically.
            env.step(drawn.integers(count, size=worlds))
            return worlds

        return step

    return begin


def ours(street: Street, worlds: int | None, scenario: str, decision_s: float = 1.0) -> Callable[[], Step]:
    """One world of Interplay, or several in one call."""
    settings: dict[str, Any] = {
        "observation": {"kind": "Kinematics", "count": street.rows},
        "action": "DiscreteMeta",
        "decision_s": decision_s,
    }
    actions = np.array(meta_actions(street))

    def begin() -> Step:
        drawn = np.random.default_rng(0)
        if worlds is None:
            env = InterplayEnv(scenario, **settings)
            env.reset(seed=0)

            def step() -> int:
                _, _, terminated, truncated, _ = env.step(drawn.choice(actions))
                if terminated or truncated:
                    env.reset()
                return 1

            return step
        batch = InterplayVectorEnv(scenario, num_envs=worlds, **settings)
        batch.reset(seed=0)

        def step_all() -> int:
            batch.step(drawn.choice(actions, size=worlds))
            return worlds

        return step_all

    return begin


def negotiating(street: Street, scenario: str) -> Callable[[], Step]:
    """One world of Interplay, whose agent is the negotiating planner: a decision is a plan."""

    def begin() -> Step:
        env = InterplayEnv(scenario, observation={"kind": "Kinematics", "count": street.rows}, action="Plan")
        policy = interplay.policy("negotiation").bind(env)
        env.reset(seed=0)
        policy.reset()

        def step() -> int:
            _, _, terminated, truncated, _ = env.step(policy.act())
            if terminated or truncated:
                env.reset()
                policy.reset()
            return 1

        return step

    return begin


def contenders(street: Street, folder: Path) -> list[Measured]:
    """All that is measured on a street."""

    def scenario(label: str, driver: str, **how: Any) -> str:
        file = folder / f"{street.name.lower()}-{label}.toml"
        file.write_text(street.toml(driver, **how))
        return str(file)

    equal = scenario("idm", IDM)
    short = scenario("idm-short", IDM, horizon_steps=2)
    planned = {"rate_hz": PLANS_A_SECOND, "horizon_steps": PLANNED_STEPS}
    seldom, human = scenario("idm-seldom", IDM, **planned), scenario("human", HUMAN, **planned)
    each = street.rate_hz
    return [
        Measured(street.name, "HighwayEnv, 1", each, highway_env(street)),
        Measured(street.name, "EnvPool, 1", each, env_pool(street, 1)),
        Measured(street.name, f"EnvPool, {WORLDS}", each, env_pool(street, WORLDS)),
        Measured(street.name, "Interplay, IDM, 1", each, ours(street, None, equal)),
        Measured(street.name, f"Interplay, IDM, {WORLDS}", each, ours(street, WORLDS, equal)),
        Measured(street.name, "Interplay, IDM, plans of 2 steps, 1", each, ours(street, None, short)),
        Measured(street.name, f"Interplay, IDM, plans of 2 steps, {WORLDS}", each, ours(street, WORLDS, short)),
        Measured(street.name, "Interplay, IDM, 5 steps a second, 1", PLANS_A_SECOND, ours(street, None, seldom)),
        Measured(street.name, "Interplay, human traffic, 5 steps a second, 1", PLANS_A_SECOND, ours(street, None, human)),
        Measured(street.name, "Interplay, negotiating agent, IDM traffic, a decision each plan", 1, negotiating(street, seldom)),
        Measured(street.name, "Interplay, negotiating agent, human traffic, a decision each plan", 1, negotiating(street, human)),
    ]


def rounded(number: float) -> str:
    """Three digits that count."""
    return f"{number:,.0f}" if number >= 100 else f"{number:.3g}"


def spread(numbers: list[float]) -> str:
    """The median with the lowest and the highest."""
    return f"{rounded(statistics.median(numbers))} ({rounded(min(numbers))} to {rounded(max(numbers))})"


def table(measured: list[Measured]) -> str:
    """One row a measurement; ratios are those of a round."""
    one = next(entry for entry in measured if entry.label == "EnvPool, 1")
    many = next(entry for entry in measured if entry.label == f"EnvPool, {WORLDS}")
    lines = []
    for entry in measured:
        peer = many if entry.label.endswith(f", {WORLDS}") else one
        wall = statistics.median(own / other for own, other in zip(entry.wall, peer.wall))
        steps = statistics.median(entry.wall) * entry.steps_a_decision
        processor = statistics.median(entry.processor)
        ratio = statistics.median(own / other for own, other in zip(entry.processor, peer.processor))
        lines.append(f"| {entry.street} | {entry.label} | {spread(entry.wall)} | {rounded(steps)} | {rounded(processor)} | {wall:.2g} | {ratio:.2g} |")
    return "\n".join(lines)


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=1.0, help="of each measurement")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--only", default="", help="measures what matches this, beside EnvPool")
    parser.add_argument("--street", action="append", choices=[street.name for street in STREETS])
    asked = parser.parse_args()
    warnings.simplefilter("ignore")
    gymnasium.logger.min_level = gymnasium.logger.ERROR
    import highway_env as peer

    gymnasium.register_envs(peer)
    print("| street | | decisions a second (slowest to fastest round) | steps of the simulation a second | decisions a processor second | ratio to EnvPool | of processor time |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for street in STREETS:
            if asked.street and street.name not in asked.street:
                continue
            measured = [entry for entry in contenders(street, Path(folder)) if re.search(asked.only, entry.label) or "EnvPool" in entry.label]
            for _ in range(asked.rounds):
                for entry in measured:
                    entry.measure(asked.seconds)
            print(table(measured), flush=True)


if __name__ == "__main__":
    main()
