"""How fast a batch of worlds is, and how much memory a world takes.

    python python/benchmarks/many_worlds.py [scenario ...]

For each number of worlds the decisions of all of them a second on the wall's clock, and the memory that the process holds
more for each further world after some decisions [KiB].
"""

import sys
import time

import gymnasium
import interplay  # noqa: F401  registers the environments

COUNTS = (1, 4, 16, 64)
SECONDS = 3.0


def resident_kib() -> int:
    with open("/proc/self/status", encoding="ascii") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS:"))


def measured(scenario: str, count: int) -> tuple[float, int]:
    worlds = gymnasium.make_vec("interplay/Scenario-v0", num_envs=count, scenario=scenario, action="DiscreteMeta")
    worlds.reset(seed=0)
    worlds.action_space.seed(0)
    for _ in range(3):
        worlds.step(worlds.action_space.sample())
    held_kib, steps, began = resident_kib(), 0, time.perf_counter()
    while time.perf_counter() - began < SECONDS:
        worlds.step(worlds.action_space.sample())
        steps += 1
    per_s = steps * count / (time.perf_counter() - began)
    worlds.close()
    return per_s, held_kib


def main() -> None:
    scenarios = sys.argv[1:] or ["lane-change/front-nice", "roundabout/nice", "people/high-street"]
    print("| scenario | " + " | ".join(f"{count} worlds" for count in COUNTS) + " | KiB a world |")
    print("|---" * (len(COUNTS) + 2) + "|")
    for scenario in scenarios:
        rows = [measured(scenario, count) for count in COUNTS]
        per_world = (rows[-1][1] - rows[0][1]) / (COUNTS[-1] - COUNTS[0])
        print(f"| `{scenario}` | " + " | ".join(f"{per_s:.0f}" for per_s, _ in rows) + f" | {per_world:.0f} |", flush=True)


if __name__ == "__main__":
    main()
