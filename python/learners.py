"""Runs what learners use on the installed package: tests of other projects, trainings, tree search, videos, and measurements.

``python learners.py --sources FOLDER`` looks in the folder for ``gymnasium``, ``cleanrl`` and ``rl-agents``, clones of the projects. A check
whose project or package is not there says that it skips. The last line counts; the exit code is 1 if a check failed.
"""

from __future__ import annotations

import argparse
import copy
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

import interplay

IDS = sorted(name for name in gymnasium.registry if name.startswith("interplay/"))
SCENARIO = "lane-change/front-nice"
TRAINING_STEPS = 20_480
#: Makes the environments of Interplay those that the tests of Gymnasium are run with.
PLUGIN = """
import sys, types, gymnasium, interplay
utils = types.ModuleType("tests.envs.utils")
utils.all_testing_env_specs = [spec for name, spec in gymnasium.registry.items() if name.startswith("interplay/")]
utils.all_testing_initialised_envs = [spec.make(disable_env_checker=True).unwrapped for spec in utils.all_testing_env_specs]
utils.mujoco_testing_env_specs, utils.gym_testing_env_specs = [], utils.all_testing_env_specs
sys.modules["tests.envs.utils"] = utils
"""


class Skipped(Exception):
    """Why a check is not made."""


def needed(folder: Path, name: str) -> Path:
    """The clone of a project."""
    if not (folder / name).is_dir():
        raise Skipped(f"{folder} does not have a folder {name}")
    return folder / name


def module(name: str) -> Any:
    """A package that need not be there."""
    try:
        return __import__(name, fromlist=["_"])
    except ImportError as error:
        raise Skipped(f"{name} is not installed ({error})") from None


def run(*words: str, cwd: Path, path: Path | None = None) -> str:
    """What a program prints; raises what it printed last if it fails."""
    environment = {**os.environ, "PYTHONPATH": str(path or cwd)}
    said = subprocess.run(words, cwd=cwd, env=environment, capture_output=True, text=True, check=False)
    if said.returncode:
        raise RuntimeError((said.stdout + said.stderr)[-1500:])
    return said.stdout


def tests_of_gymnasium(folder: Path) -> str:
    """The files of Gymnasium's tests that take every environment, on every id."""
    tests = needed(folder, "gymnasium")
    with tempfile.TemporaryDirectory() as passing:
        (Path(passing) / "interplay_plugin.py").write_text(PLUGIN)
        files = ["tests/envs/test_envs.py"]
        words = ["-p", "interplay_plugin", "-q", "-o", "addopts=", "-p", "no:cacheprovider", "--import-mode=importlib"]
        said = run(sys.executable, "-m", "pytest", *words, *files, cwd=tests, path=Path(f"{passing}{os.pathsep}{tests}"))
    return f"{len(IDS)} ids: {said.strip().splitlines()[-1]}"


def tests_of_pettingzoo(_: Path) -> str:
    """PettingZoo's tests of parallel environments, its seeds, states, and of the same as AEC, on every family."""
    test, convert = module("pettingzoo.test"), module("pettingzoo.utils.conversions")
    from pettingzoo.test.state_test import test_parallel_env

    from interplay._registration import families
    from interplay.parallel import parallel_env

    for scenario in families().values():
        test.parallel_api_test(parallel_env(scenario), num_cycles=30)
        test.parallel_seed_test(lambda scenario=scenario: parallel_env(scenario), num_cycles=20)
        test_parallel_env(parallel_env(scenario))
        test.api_test(convert.parallel_to_aec(parallel_env(scenario)), num_cycles=30)
    return f"{len(families())} families, 4 tests each"


def cleanrl(folder: Path) -> str:
    """CleanRL's ``ppo.py``, unchanged."""
    module("torch"), module("tyro"), module("tensorboard")
    script = needed(folder, "cleanrl") / "cleanrl" / "ppo.py"
    with tempfile.TemporaryDirectory() as passing:
        words = ["--env-id", "interplay:interplay/LaneChange-Discrete-v0", "--total-timesteps", "4096", "--no-cuda"]
        said = run(sys.executable, str(script), *words, cwd=Path(passing))
    returns = [float(line.split("=")[-1]) for line in said.splitlines() if "episodic_return" in line]
    return f"4,096 steps, last line {said.strip().splitlines()[-1]!r}, {len(returns)} episodes"


def tree_search(folder: Path) -> str:
    """A tree search of rl-agents, which copies the environment for every node, finds the lane change."""
    sys.path.insert(0, str(needed(folder, "rl-agents")))
    planner = module("rl_agents.agents.tree_search.deterministic")

    def reward(terms: dict[str, float], info: dict[str, Any]) -> float:
        # The planner expects rewards from 0 to 1.
        value = 0.2 + 0.2 * terms["progress"] + 0.6 * terms["goal"] - terms["contact"] - terms["off_road"]
        return float(np.clip(value, 0.0, 1.0))

    settings = {"perturb": False, "reward": reward, "disable_env_checker": True}
    env = gymnasium.make("interplay/LaneChange-Discrete-v0", **settings).unwrapped
    seen, info = env.reset(seed=1)
    agent = planner.DeterministicPlannerAgent(env, {"budget": 100, "gamma": 0.9, "terminal_reward": 0})
    is_over, steps = False, 0
    while not is_over:
        seen, _, terminated, truncated, info = env.step(agent.act(seen))
        is_over, steps = terminated or truncated, steps + 1
    assert info["ending"] == "goal", info["ending"]
    return f"goal after {steps} decisions, a search of 100 nodes before each"


def copies(_: Path) -> str:
    """What a copy in mid-episode costs, in steps."""
    env = gymnasium.make("interplay/LaneChange-v0", disable_env_checker=True).unwrapped
    env.reset(seed=1)
    action = np.zeros(2, np.float32)
    spent: dict[str, list[float]] = {"step": [], "copy": []}
    for _step in range(20):
        for name, call in (("step", lambda: env.step(action)), ("copy", lambda: copy.deepcopy(env))):
            began = time.perf_counter()
            call()
            spent[name].append(time.perf_counter() - began)
    step_s, copy_s = (float(np.median(spent[name])) for name in ("step", "copy"))
    assert copy_s <= 5 * step_s, (copy_s, step_s)
    return f"a copy takes {1e6 * copy_s:.0f} µs, a step {1e6 * step_s:.0f} µs"


def stable_baselines(_: Path) -> str:
    """PPO and SAC of stable-baselines3, briefly, in many worlds and in one."""
    sb3 = module("stable_baselines3")
    from stable_baselines3.common.env_checker import check_env

    from interplay.sb3 import VecEnv

    check_env(gymnasium.make("interplay/LaneChange-v0").unwrapped)
    sb3.PPO("MlpPolicy", VecEnv(num_envs=4), n_steps=64, device="cpu").learn(512)
    sb3.SAC("MlpPolicy", gymnasium.make("interplay/LaneChange-v0"), learning_starts=100, device="cpu").learn(300)
    sb3.PPO("MlpPolicy", VecEnv("intersection/nice", agents=["ego", "human"], num_envs=2), n_steps=64, device="cpu").learn(256)
    return "PPO 512 steps, SAC 300, PPO with two agents in each of two worlds"


def videos(_: Path) -> str:
    """``RecordVideo`` of a vector."""
    module("moviepy")
    with tempfile.TemporaryDirectory() as passing:
        made = {"num_envs": 2, "vectorization_mode": "vector_entry_point", "render_mode": "rgb_array"}
        env: Any = gymnasium.make_vec("interplay/LaneChange-v0", **made)  # type: ignore[arg-type]
        env = gymnasium.wrappers.vector.RecordVideo(env, passing, video_length=10)
        env.reset(seed=1)
        for _step in range(12):
            env.step(env.action_space.sample())
        env.close()
        sizes = [file.stat().st_size for file in Path(passing).glob("*.mp4")]
    assert sizes and min(sizes) > 1000
    return f"a video of {sizes[0]} bytes"


def joblib(_: Path) -> str:
    """joblib over ``run``, in processes, beside ``run_many``."""
    parallel = module("joblib")
    jobs = (parallel.delayed(interplay.run)(SCENARIO, "idm", seed=seed) for seed in range(4))
    found = [report.digest for report in parallel.Parallel(n_jobs=2)(jobs)]
    for count in range(1, 9):
        assert [report.digest for report in interplay.run_many(SCENARIO, "idm", range(4), count)] == found, count
    return "4 reports equal those of run_many with 1 to 8 jobs"


def networks(_: Path) -> str:
    """Outputs and actions of a ``.safetensors`` policy beside those of torch."""
    torch = module("torch")
    sys.path.insert(0, str(Path(__file__).parent / "examples"))
    export = module("export_policy").export
    torch.manual_seed(3)
    layers = [torch.nn.Linear(35, 128), torch.nn.Linear(128, 128), torch.nn.Linear(128, 5)]
    model = torch.nn.Sequential(layers[0], torch.nn.Tanh(), layers[1], torch.nn.Tanh(), layers[2])
    seen = torch.rand(10_000, 35) * 2 - 1
    with tempfile.TemporaryDirectory() as passing, torch.no_grad():
        file = Path(passing) / "net.safetensors"
        export(str(file), layers, observations=json.dumps([{"kind": "Kinematics"}]), action="DiscreteMeta")
        network, outputs = interplay.Network(file), model(seen).numpy()
        ours = np.array([network.outputs(row) for row in seen.numpy()])
        same = sum(int(network.predict(row)[0]) == int(best) for row, best in zip(seen.numpy(), outputs.argmax(axis=1)))
    error = float(np.abs(ours - outputs).max())
    assert error < 1e-6 and same == 10_000, (error, same)
    return f"largest difference of an output {error:.1e}, {same} of 10,000 actions equal"


def trained(_: Path) -> str:
    """A PPO drives equally in its environment, as a function in runs, and as ``kind = "policy"``; deterministic and sampled."""
    sb3, torch = module("stable_baselines3"), module("torch")
    from interplay.sb3 import VecEnv

    torch.set_num_threads(1)
    reward = {"progress": 0.2, "gap": -1.0, "jerk": -0.1, "lateral": -0.2}
    worlds = VecEnv(SCENARIO, num_envs=8, reward=reward)
    settings = {"n_steps": 128, "batch_size": 256, "n_epochs": 8, "gamma": 0.97, "learning_rate": 1e-3, "seed": 1, "device": "cpu"}
    model = sb3.PPO("MlpPolicy", worlds, **settings).learn(TRAINING_STEPS)
    sys.path.insert(0, str(Path(__file__).parent / "examples"))
    file = Path(tempfile.mkdtemp()) / "ppo.safetensors"
    module("export_policy").export_ppo(model, str(file))
    network, jitter = interplay.Network(file), {"start_jitter": {"position_m": 0.1, "speed_mps": 0.1}}
    env = gymnasium.make("interplay/LaneChange-v0", set=jitter, perturb=False, disable_env_checker=True).unwrapped

    def goals_in_environment(act: Callable[[Any], Any], seed: int) -> tuple[bool, list[Any]]:
        seen, info = env.reset(options={"seed": seed})
        states = []
        while "ending" not in info:
            seen, _, _, _, info = env.step(act(seen))
            states.append(env.states()["ego"])
        return info["ending"] == "goal", states

    counts, bits = np.zeros(5, dtype=int), 0
    for seed in range(30):
        sampled = interplay.PolicyFunction(model, deterministic=False)
        sampled.seed = seed
        of_network, states = goals_in_environment(lambda seen: network.predict(seen)[0], seed)
        reports = [
            interplay.run(SCENARIO, planner, seed=seed, set=jitter)
            for planner in (file, {"ppo": interplay.PolicyFunction(model)}, {"ppo": sampled})
        ]
        in_runs = [report.vehicles[0].completed_s is not None and not report.collisions for report in reports]
        in_environment = [of_network, goals_in_environment(sampled.function, seed)[0]]
        counts += np.array([in_environment[0], *in_runs[:2], in_environment[1], in_runs[2]])
        frames = reports[0].frames()
        driven = np.stack([frames[name][1 : len(states) + 1, 0] for name in ("x_m", "y_m", "heading_rad", "speed_mps")], axis=1)
        bits += int(np.array_equal(driven, np.array(states)[: len(driven)]))
    assert counts[0] == counts[1] == counts[2] and counts[3] == counts[4] and bits == 30, (counts, bits)
    return (
        f"of 30 starts after {TRAINING_STEPS} steps: {counts[0]} in the environment, {counts[1]} as kind policy, {counts[2]} as a function; "
        f"sampled {counts[3]} and {counts[4]}; motions equal bit for bit in {bits}"
    )


def streets(_: Path) -> str:
    """Roads of 1,000 resets."""
    env = gymnasium.make("interplay/Street-v0", disable_env_checker=True).unwrapped
    roads = set()
    began = time.perf_counter()
    for seed in range(1000):
        env.reset(seed=seed)
        roads.add(interplay.load(env.street).to_toml().split("[[vehicle]]")[0].split("[road]")[-1])
    assert len(roads) >= 900, len(roads)
    return f"{len(roads)} different roads of 1,000 resets, {time.perf_counter() - began:.0f} s"


def memory(_: Path) -> str:
    """Memory of 10,000 episodes of a few decisions each."""
    env = gymnasium.make("interplay/LaneChange-v0", disable_env_checker=True)
    action, at = np.zeros(2, np.float32), []
    for episode in range(10_000):
        env.reset(seed=episode)
        env.step(action)
        if episode in (999, 9_999):
            pages = int(Path("/proc/self/statm").read_text().split()[1])
            at.append(pages * resource.getpagesize() / 2**20)
    assert at[1] <= 1.05 * at[0], at
    return f"{at[0]:.1f} MB after 1,000 episodes, {at[1]:.1f} MB after 10,000"


CHECKS: list[Callable[[Path], str]] = [
    copies,
    tests_of_gymnasium,
    tests_of_pettingzoo,
    cleanrl,
    tree_search,
    stable_baselines,
    videos,
    joblib,
    networks,
    trained,
    streets,
    memory,
]


def main() -> int:
    """Makes the checks and counts them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sources", type=Path, default=Path("sources"), help="the folder with clones of the projects")
    parser.add_argument("--only", nargs="*", choices=[check.__name__ for check in CHECKS], help="these checks alone")
    asked = parser.parse_args()
    passed = failed = skipped = 0
    for check in CHECKS:
        if asked.only and check.__name__ not in asked.only:
            continue
        began = time.perf_counter()
        try:
            said, word = check(asked.sources.resolve()), "ok"
            passed += 1
        except Skipped as reason:
            said, word = str(reason), "skipped"
            skipped += 1
        except Exception:
            said, word = traceback.format_exc(), "FAILED"
            failed += 1
        print(f"{word:8} {check.__name__}: {said} [{time.perf_counter() - began:.0f} s]", flush=True)
    print(f"{passed} passed, {failed} failed, {skipped} skipped")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
