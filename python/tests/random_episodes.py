"""Random episodes in all families: nothing may fail but what is wrong, and memory must not grow.

    python random_episodes.py [EPISODES] [SEED]

Views, actions and scenarios are random; some actions are none (not finite, of another shape, no numbers), which must be a ValueError,
and some episodes are left before their end. Resident memory after a first part of the episodes and at the end is printed; the end may
have at most 1.05 times as much. Then environments are made for an episode each and dropped. They leave holes of all sizes, so there
it is the bytes in use of the allocator that may not grow, where it tells them; resident memory is printed, too.
"""

from __future__ import annotations

import ctypes
import gc
import sys
import time
from collections.abc import Callable
from typing import Any, ClassVar

import gymnasium
import numpy as np
from numpy.typing import NDArray

import interplay
from interplay.building import BuildingEnv
from interplay.envs import InterplayEnv, InterplayVectorEnv

OBSERVATIONS: list[Any] = ["Kinematics", "Lane", "OccupancyGrid", "Plan", "Belief", ["Lane", "Kinematics"]]
ACTIONS = ["Continuous", "DiscreteMeta", "Plan"]
#: Decisions of an episode at most.
DECISIONS = 12
#: Episodes after which memory is looked at for the first time, at most.
FIRST = 1000
#: How many times as much memory there may be at the end.
GROWTH = 1.05
BAD: list[Callable[[Any], Any]] = [
    lambda space: np.full(space.shape, np.nan),
    lambda space: np.full(space.shape, np.inf),
    lambda space: np.zeros((*space.shape, 2)),
    lambda space: np.zeros(7),
    lambda space: "left",
    lambda space: None,
    lambda space: [object()],
    lambda space: {"steering": 0.0},
    lambda space: -1 if isinstance(space, gymnasium.spaces.Discrete) else -np.inf,
]


def resident_mb() -> float:
    """Memory of this process."""
    gc.collect()
    try:
        with open("/proc/self/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * 4096 / 1e6
    except OSError:
        import resource

        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3


class Heap(ctypes.Structure):
    """What the allocator of the GNU C library tells of itself, in bytes."""

    _fields_: ClassVar[list[tuple[str, Any]]] = [
        (name, ctypes.c_size_t)
        for name in "arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks fordblks keepcost".split()
    ]


def in_use_mb() -> float | None:
    """Memory that is allocated and not freed; none where the allocator does not tell it."""
    gc.collect()
    try:
        tell = ctypes.CDLL(None).mallinfo2
    except (AttributeError, OSError, TypeError):
        return None
    tell.restype = Heap
    heap = tell()
    return float(heap.uordblks + heap.hblkhd) / 1e6


def families() -> dict[str, list[str]]:
    """The scenarios of each family with vehicles."""
    found: dict[str, list[str]] = {}
    for row in interplay.list():
        found.setdefault(row.name.split("/")[0], []).append(row.name)
    del found["building"]
    return found


def any_environment(random: np.random.Generator, families: list[list[str]]) -> InterplayEnv:
    """An environment of a random scenario of a random family, with a random view and kind of action."""
    names = families[random.integers(len(families))]
    observation = OBSERVATIONS[random.integers(len(OBSERVATIONS))]
    return InterplayEnv(names[random.integers(len(names))], observation=observation, action=ACTIONS[random.integers(len(ACTIONS))])


def environments(random: np.random.Generator) -> list[gymnasium.Env[Any, Any]]:
    """Environments of every family in all kinds of actions, with random views, and of a building."""
    made: list[gymnasium.Env[Any, Any]] = [BuildingEnv(), BuildingEnv("mixed/garage")]
    for names in families().values():
        for action in ACTIONS:
            observation = OBSERVATIONS[random.integers(len(OBSERVATIONS))]
            made.append(InterplayEnv(names[random.integers(len(names))], observation=observation, action=action))
    return made


def action(space: Any, random: np.random.Generator) -> Any:
    """A random action; numbers are beyond the space now and then."""
    if isinstance(space, gymnasium.spaces.Discrete):
        return int(random.integers(int(space.n)))
    numbers: NDArray[np.float64] = random.normal(0.0, 0.5, space.shape)
    return numbers


def episode(env: Any, random: np.random.Generator) -> tuple[int, int]:
    """A random episode; returns how many decisions and how many refusals there were."""
    seen, _ = env.reset(seed=int(random.integers(2**63)) if random.random() < 0.7 else None)
    decisions, refusals = int(random.integers(1, DECISIONS + 1)), 0
    for decision in range(decisions):
        assert env.observation_space.contains(seen), env.observation_space
        if random.random() < 0.1:
            refused(env, BAD[random.integers(len(BAD))](env.action_space))
            refusals += 1
        seen, reward, terminated, truncated, _ = env.step(action(env.action_space, random))
        assert np.isfinite(reward)
        if terminated or truncated:
            try:
                env.step(action(env.action_space, random))
            except interplay.RunError:
                return decision + 1, refusals + 1
            raise AssertionError("an episode that is over was stepped")
    return decisions, refusals


def refused(env: Any, bad: Any) -> None:
    """Steps with an invalid action, which must raise a ValueError."""
    try:
        env.step(bad)
    except (ValueError, TypeError):
        return
    raise AssertionError(f"{bad!r} was taken for an action")


def worlds_at_once(env: InterplayVectorEnv, random: np.random.Generator) -> int:
    """Some steps of many worlds; returns about how many episodes that were."""
    env.reset(seed=int(random.integers(2**31)))
    for _ in range(DECISIONS):
        env.step(np.stack([np.asarray(action(env.single_action_space, random)) for _ in range(env.num_envs)]))
    return env.num_envs


def stay(episodes: int, random: np.random.Generator) -> bool:
    """Episodes in environments that stay; whether resident memory does so, too."""
    made, began = environments(random), time.monotonic()
    many = [InterplayVectorEnv("intersection/nice", num_envs=4, action=kind) for kind in ("Continuous", "DiscreteMeta")]
    first_at, first_mb = min(FIRST, episodes // 2), 0.0
    done = decisions = refusals = 0
    while done < episodes:
        if random.random() < 0.05:
            done += worlds_at_once(many[random.integers(2)], random)
        else:
            count, bad = episode(made[random.integers(len(made))], random)
            done, decisions, refusals = done + 1, decisions + count, refusals + bad
        if not first_mb and done >= first_at:
            first_mb = resident_mb()
            print(f"{done} episodes: {first_mb:.1f} MB", flush=True)
    last_mb = resident_mb()
    print(f"{done} episodes: {last_mb:.1f} MB, {last_mb / first_mb:.3f} times as much")
    print(f"{decisions} decisions one by one, {refusals} refusals, {time.monotonic() - began:.0f} s", flush=True)
    return last_mb <= GROWTH * first_mb


def pass_by(count: int, random: np.random.Generator) -> bool:
    """Environments that live for an episode; whether they leave nothing behind."""
    named, first_mb = list(families().values()), None
    for place in range(count):
        if place == count // 5:
            first_mb = in_use_mb()
        episode(any_environment(random, named), random)
    last_mb = in_use_mb()
    words = "" if first_mb is None or last_mb is None else f", {last_mb:.1f} MB in use, {last_mb / first_mb:.3f} times as much"
    print(f"{count} environments made and dropped: {resident_mb():.1f} MB{words}")
    return first_mb is None or last_mb is None or last_mb <= GROWTH * first_mb


def main(episodes: int = 10_000, seed: int = 1) -> int:
    """Runs the episodes and returns the exit code."""
    random = np.random.default_rng(seed)
    stays, passes = stay(episodes, random), pass_by(episodes // 20, random)
    return 0 if stays and passes else 1


if __name__ == "__main__":
    sys.exit(main(*(int(word) for word in sys.argv[1:])))
