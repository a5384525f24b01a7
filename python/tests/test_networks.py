"""Trained networks as drivers, streets as environments, and functions in several threads."""

from __future__ import annotations

import importlib.util
import json
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import gymnasium
import numpy as np
import pytest

import interplay
from helpers import equal, refused
from interplay import PolicyFunction
from interplay.envs import InterplayEnv, InterplayVectorEnv


class Weights:
    """The numbers of a layer, with the methods of a tensor of torch that the script uses."""

    def __init__(self, numbers: Any) -> None:
        self.numbers = np.asarray(numbers, np.float32)

    def detach(self) -> Weights:
        return self

    cpu = detach

    def numpy(self) -> Any:
        return self.numbers


def exported(path: Path, sizes: list[int], action: str) -> Any:
    """Writes a random network with the script of the examples, and returns its function."""
    found = importlib.util.spec_from_file_location("export_policy", Path(os.environ["INTERPLAY_EXAMPLES"]) / "export_policy.py")
    assert found is not None and found.loader is not None
    script = importlib.util.module_from_spec(found)
    found.loader.exec_module(script)
    random = np.random.default_rng(5)
    parts = [(random.normal(0, 0.3, (to, of)), random.normal(0, 0.1, to)) for of, to in zip(sizes, sizes[1:])]
    layers = [SimpleNamespace(weight=Weights(weight), bias=Weights(bias)) for weight, bias in parts]
    script.export(str(path), layers, observations=json.dumps([{"kind": "Kinematics"}]), action=action, activation="tanh")

    def function(seen: Any) -> Any:
        values = np.ravel(seen).astype(np.float64)
        for place, layer in enumerate(layers):
            values = layer.weight.numbers.astype(np.float64) @ values + layer.bias.numbers
            values = np.tanh(values) if place < len(layers) - 1 else values
        return int(np.argmax(values)) if action == "DiscreteMeta" else values.astype(np.float32)

    return function


@pytest.mark.skipif("INTERPLAY_EXAMPLES" not in os.environ, reason="the folder of the examples is not known")
@pytest.mark.parametrize("action, outputs", [("Continuous", 2), ("DiscreteMeta", 5)])
def test_a_network_of_a_file_drives_as_its_function(tmp_path: Path, action: str, outputs: int) -> None:
    path = tmp_path / "mine.safetensors"
    function = exported(path, [35, 64, 64, outputs], action)
    from_file = interplay.run("lane-change/front-nice", path).frames()
    of_python = interplay.run("lane-change/front-nice", {"mine": PolicyFunction(function, action=action)}).frames()
    assert from_file["x_m"] == pytest.approx(of_python["x_m"], abs=1e-4)
    assert from_file["y_m"] == pytest.approx(of_python["y_m"], abs=1e-4)
    driver = {"kind": "policy", "file": str(path)}
    reports = interplay.run_many("lane-change/front-nice", [path, str(path)], jobs=2)
    reports.append(interplay.run("lane-change/front-nice", set={"vehicle.ego.driver": driver}))
    assert len({report.digest for report in reports}) == 1 and reports[0].vehicles[0].driver == "policy"
    network = interplay.Network(path)
    of_values = interplay.run("lane-change/front-nice", {"mine": PolicyFunction(network, action=action)})
    assert equal(dict(of_values.frames()), dict(from_file)) and interplay.run("lane-change/front-nice", network).digest == reports[0].digest
    assert "inputs" in refused(lambda: network.outputs(np.zeros(3)))
    rows = interplay.sweep({"scenario": ["lane-change/front-nice"], "planner": ["idm", path]}, jobs=2)
    assert sorted(rows["planner"]) == ["idm", "mine"]
    path.write_bytes(path.read_bytes()[:-4])
    assert "mine.safetensors" in refused(lambda: interplay.run("lane-change/front-nice", path))


def test_every_episode_of_streets_has_its_own_road() -> None:
    env = gymnasium.make("interplay/Street-v0", disable_env_checker=True)
    names = [env.reset(seed=seed)[1]["street"] for seed in range(30)]
    assert len(set(names)) == 30 and len({name.split("/")[1] for name in names}) > 5
    assert env.reset(seed=3)[1]["street"] == names[3]
    assert InterplayEnv("streets/van/0", streets={}, perturb=False).reset(seed=3)[1]["street"] == names[3]
    rings = gymnasium.make("interplay/Street-v0", kinds="ring", density=0.0, styles=["nice"], disable_env_checker=True)
    assert rings.reset(seed=1)[1]["street"].startswith("streets/ring/")
    assert len(rings.unwrapped.states()) == 1  # type: ignore[attr-defined]
    worlds = gymnasium.make_vec("interplay/Street-v0", num_envs=2, vectorization_mode="vector_entry_point")
    assert isinstance(worlds, InterplayVectorEnv)
    assert np.array_equal(worlds.reset(seed=3)[0][0], env.reset(seed=3)[0])
    assert "ring" in refused(lambda: gymnasium.make("interplay/Street-v0", kinds="rign", disable_env_checker=True))
    assert "style" in refused(lambda: gymnasium.make("interplay/Street-v0", styles="rude", disable_env_checker=True))


def test_functions_of_one_name_in_several_threads_are_told_apart() -> None:
    def run(value: float) -> str:
        digest: str = interplay.run("lane-change/front-nice", {"mine": lambda seen: [value, 0.0]}, set={"duration_s": 1.0}).digest
        return digest

    expected = [run(-0.5), run(0.5)]
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(run, [-0.5, 0.5] * 10)) == expected * 10


def test_functions_may_run_something_but_not_without_end() -> None:
    calls: list[int] = []

    def deep(seen: Any) -> Any:
        calls.append(1)
        if len(calls) > 100:
            return [0.0, 0.0]
        interplay.run("lane-change/front-nice", {"mine": deep}, set={"duration_s": 0.1})
        return [0.0, 0.0]

    with pytest.raises(RecursionError):
        interplay.run("lane-change/front-nice", {"mine": deep}, set={"duration_s": 0.1})


def test_small_things_are_said() -> None:
    assert interplay.run("lane-change/front-nice", interplay.policy("idm")).digest == interplay.run("lane-change/front-nice", "idm").digest
    for call in (lambda: interplay.run("lane-change/front-nice", seed=-1), lambda: interplay.Simulation("lane-change/front-nice", seed=-1)):
        assert "2^64" in refused(call)
    wide = PolicyFunction(lambda seen: [0.0, 0.0], observation={"kind": "OccupancyGrid", "cells": [10**6, 10**6]})
    assert "observations" in refused(lambda: interplay.run("lane-change/front-nice", {"mine": wide}))
    assert "deterministic" in refused(lambda: PolicyFunction(lambda seen: seen, deterministic=False))
    code = "import sys; sys.modules['gymnasium'] = None; import interplay; interplay.envs"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert "pip install 'interplay[rl]'" in said.stderr, said.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.parametrize("call", ["run(S, {'mine': f})", "run_many([S] * 50, {'mine': f}, jobs=2)", "run_many([S] * 50, 'game')"])
def test_an_interrupt_ends_runs(call: str) -> None:
    code = f"import time, interplay; S = 'lane-change/front-nice'; f = lambda seen: time.sleep(0.05) or [0.0, 0.0]; print(1, flush=True); interplay.{call}"
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None and child.stderr is not None
        child.stdout.readline()
        time.sleep(0.7)
        sent = time.monotonic()
        child.send_signal(signal.SIGINT)
        assert "KeyboardInterrupt" in child.stderr.read()
    assert time.monotonic() - sent < 5.0
