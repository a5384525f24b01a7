"""Trains an agent to change lanes among nice and tough humans, and compares it on unseen starts with planners and baselines.

``python train_ppo.py OUT`` trains with five seeds, evaluates on 200 unseen starts, and leaves in the folder OUT the learning curves
(``curves.csv``), the networks, and the rows of two sweeps, which ``interplay compare`` reads: ``test`` with nice and tough humans, as
in training, and ``unmet`` with safety weights that the agent never met. It needs stable-baselines3.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import time
from pathlib import Path
from typing import Any

import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback

import interplay
from interplay.sb3 import VecEnv

SCENARIO = "lane-change/front-nice"
#: What the agent sees and decides, and what that is worth.
VIEW: dict[str, Any] = {"observation": "Lane", "action": "DiscreteMeta"}
REWARD = {"progress": 0.0, "goal": 1.0, "contact": -1.0, "off_road": -1.0, "hard_braking": -0.1, "gap": -0.5, "rule_broken": -0.1}
#: Humans of training are nice or tough.
START = {"position_m": 0.2, "speed_mps": 0.1, "safety_weights": [50.0, 0.0]}
#: Episodes of training are drawn from these seeds; test starts are drawn by the sweep's own. Nothing was tuned on either.
TRAINING_SEEDS, TEST_SEED = (1_000_000, 2_000_000, 3_000_000, 4_000_000, 5_000_000), 77
WORLDS = 16


class Curve(BaseCallback):
    """Shares of the last 200 episodes, once a rollout."""

    def __init__(self, seed: int) -> None:
        super().__init__()
        self.seed, self.endings, self.rows = seed, [], []

    def _on_step(self) -> bool:
        self.endings += [info["ending"] for info in self.locals["infos"] if "ending" in info]
        return True

    def _on_rollout_end(self) -> None:
        last = self.endings[-200:]
        shares = [last.count(word) / max(len(last), 1) for word in ("goal", "contact", "off_road", "time")]
        self.rows.append([self.seed, self.num_timesteps, *(round(share, 4) for share in shares)])


def train(seed: int, steps: int) -> tuple[PPO, list[list[Any]]]:
    """A network, and its learning curve."""
    worlds = VecEnv(SCENARIO, num_envs=WORLDS, reward=REWARD, perturb=START, **VIEW)
    worlds.seed(seed)
    model = PPO(
        "MlpPolicy", worlds, seed=seed, n_steps=128, batch_size=512, n_epochs=8, gamma=0.98, gae_lambda=0.95,
        ent_coef=0.01, learning_rate=lambda left: 1e-3 * left, policy_kwargs={"net_arch": [64, 64]}, device="cpu",
    )  # fmt: skip
    curve = Curve(seed)
    model.learn(steps, callback=curve)
    return model, curve.rows


def idle(_: Any) -> int:
    """Lane and speed stay."""
    return 1


def at_random(seen: Any) -> int:
    """Any meta-action: a number that is a function of what is seen, so that a run can be repeated."""
    return hashlib.sha256(seen.tobytes()).digest()[0] % 5


def evaluate(networks: dict[str, PPO], out: Path, samples: int) -> None:
    """Rows of all policies and planners under the same conditions."""
    functions = {**networks, "idle": idle, "random": at_random}
    policies = [{name: interplay.PolicyFunction(function, **VIEW)} for name, function in functions.items()]
    plan = {
        "title": "A trained agent among humans",
        "scenario": [SCENARIO],
        "planner": [*policies, "idm", "conservative", "negotiation"],
        "samples": samples,
        "seed": TEST_SEED,
        "jitter": {"position_m": START["position_m"], "speed_mps": START["speed_mps"]},
        "set": {"expect": {}},
    }
    for name, styles in {"test": ["nice", "tough"], "unmet": ["considerate", "normal", "assertive"]}.items():
        rows = interplay.sweep({**plan, "style": styles}, out / name)
        shares = rows.assign(contact=rows["contacts"] > 0 if "contacts" in rows else np.nan)
        print(name, shares.groupby(["planner", "style"])["success"].mean().unstack().round(3), sep="\n")


def main() -> None:
    """Trains, then evaluates."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path)
    parser.add_argument("--steps", type=int, default=200_000, help="decisions of training for each seed")
    parser.add_argument("--samples", type=int, default=200)
    parser.add_argument("--seeds", type=int, default=len(TRAINING_SEEDS))
    parser.add_argument("--evaluate-only", action="store_true", help="with the networks that are there")
    asked = parser.parse_args()
    torch.set_num_threads(1)
    asked.out.mkdir(parents=True, exist_ok=True)
    networks, rows = {}, []
    for number, seed in enumerate(TRAINING_SEEDS[: asked.seeds], start=1):
        began, saved = time.perf_counter(), asked.out / f"ppo-{number}.zip"
        if asked.evaluate_only:
            networks[f"ppo-{number}"] = PPO.load(saved, device="cpu")
            continue
        networks[f"ppo-{number}"], curve = train(seed, asked.steps)
        networks[f"ppo-{number}"].save(saved)
        rows += curve
        print(f"seed {number}: {time.perf_counter() - began:.0f} s, {curve[-1]}", flush=True)
        with (asked.out / "curves.csv").open("w", newline="") as file:
            csv.writer(file).writerows([["seed", "decisions", "goal", "contact", "off_road", "time"], *rows])
    evaluate(networks, asked.out, asked.samples)


if __name__ == "__main__":
    main()
