"""Environment steps a second, beside HighwayEnv in the same process: five vehicles, of which one merges.

Run it on a quiet machine: ``python beside_highwayenv.py``. A decision of both lasts a second; ours moves the world in ticks of 0.1 s,
HighwayEnv's in ticks of 1/15 s. Rounds alternate, and the median of the ratios of a round counts.
"""

from __future__ import annotations

import argparse
import statistics
import time
import warnings
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

import interplay
from interplay.envs import InterplayEnv, InterplayVectorEnv

MERGE = str(Path(__file__).with_name("merge.toml"))
WORLDS = 64


def steps_a_second(env: Any, seconds: float) -> float:
    """Steps a second with random actions, resets included."""
    env.reset(seed=0)
    env.action_space.seed(0)
    count, began = 0, time.perf_counter()
    while (passed := time.perf_counter() - began) < seconds:
        _, _, terminated, truncated, _ = env.step(env.action_space.sample())
        count += 1
        if terminated or truncated:
            env.reset()
    return count / passed


def vector_steps_a_second(env: InterplayVectorEnv, seconds: float) -> float:
    """Steps of single worlds a second."""
    env.reset(seed=0)
    env.action_space.seed(0)
    count, began = 0, time.perf_counter()
    while (passed := time.perf_counter() - began) < seconds:
        env.step(env.action_space.sample())
        count += env.num_envs
    return count / passed


def overheads_us(episodes: int = 200) -> tuple[float, float]:
    """What a step from Python costs beside the stepping of the world, which its report times, and beside the native step [µs].

    The first is all that an environment does: perceiving, the reward, the binding. The second is the binding with its arrays and
    dictionaries.
    """
    drivers = {f"vehicle.{name}.driver": {"kind": "idm"} for name in interplay.load(MERGE).vehicles if name != "ego"}
    env = InterplayEnv(MERGE, set=drivers)
    native = env._native
    action, steps, spent_s, world_s, native_s = np.zeros(2, dtype=np.float32), 0, 0.0, 0.0, 0.0
    for seed in range(episodes):
        began = time.perf_counter()
        env.reset(seed=seed)
        is_over = False
        while not is_over:
            _, _, terminated, truncated, _ = env.step(action)
            is_over, steps = terminated or truncated, steps + 1
        spent_s += time.perf_counter() - began
        report = env.report()
        assert report is not None
        world_s += report.wall_s
        began = time.perf_counter()
        native.reset(seed)
        while native.is_live:
            native.step(action)
        native_s += time.perf_counter() - began
    return 1e6 * (spent_s - world_s) / steps, 1e6 * (spent_s - native_s) / steps


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=2.0, help="of each measurement")
    parser.add_argument("--rounds", type=int, default=5)
    asked = parser.parse_args()
    warnings.simplefilter("ignore")
    import highway_env

    gymnasium.register_envs(highway_env)
    names = [name for name in interplay.load(MERGE).vehicles if name != "ego"]
    idm = {f"vehicle.{name}.driver": {"kind": "idm"} for name in names}
    usual = {"action": "DiscreteMeta", "decision_s": 1.0}
    others: dict[str, Any] = {
        "IDM and MOBIL": InterplayEnv(MERGE, set=idm, **usual),
        "humans that plan": InterplayEnv(MERGE, **usual),
    }
    many: dict[str, Any] = {
        "IDM and MOBIL": (InterplayVectorEnv(MERGE, num_envs=WORLDS, set=idm, **usual), InterplayVectorEnv(MERGE, num_envs=1, set=idm, **usual)),
        "humans that plan": (InterplayVectorEnv(MERGE, num_envs=WORLDS, **usual), InterplayVectorEnv(MERGE, num_envs=1, **usual)),
    }
    peer = gymnasium.make("merge-v0").unwrapped
    found: dict[str, list[float]] = {}
    for _ in range(asked.rounds):
        theirs = steps_a_second(peer, asked.seconds)
        found.setdefault("HighwayEnv merge-v0", []).append(theirs)
        for label, env in others.items():
            ours = steps_a_second(env, asked.seconds)
            found.setdefault(label, []).append(ours)
            found.setdefault(f"{label}, ratio to HighwayEnv", []).append(ours / theirs)
        for label, (worlds, one) in many.items():
            rates = [vector_steps_a_second(env, asked.seconds) for env in (worlds, one)]
            found.setdefault(f"{label}, {WORLDS} worlds in one call", []).append(rates[0])
            found.setdefault(f"{label}, {WORLDS} worlds, ratio to one", []).append(rates[0] / rates[1])
    for label, rates in found.items():
        print(f"{label:45} {statistics.median(rates):10.1f}   ({min(rates):.1f} to {max(rates):.1f})")
    beside_world_us, binding_us = overheads_us()
    print(f"{'a step beside the world of it':45} {beside_world_us:10.1f} µs")
    print(f"{'the binding in it':45} {binding_us:10.1f} µs")


if __name__ == "__main__":
    main()
