"""Writes a trained network of torch as a driver that needs no Python: ``driver = { kind = "policy", file = "mine.safetensors" }``."""

import json
import struct
import sys
from collections.abc import Sequence
from typing import Any


def export(path: str, layers: Sequence[Any], **about: str) -> None:
    """Writes layers (``torch.nn.Linear``); ``about`` are ``observations``, ``action``, ``activation``, ``output``, ``decision_s``."""
    header: dict[str, Any] = {"__metadata__": about}
    numbers = b""
    for place, layer in enumerate(layers):
        for name, tensor in (("weight", layer.weight), ("bias", layer.bias)):
            part = tensor.detach().cpu().numpy().astype("<f4")
            entry = {"dtype": "F32", "shape": list(part.shape), "data_offsets": [len(numbers), len(numbers) + part.nbytes]}
            header[f"layers.{place}.{name}"], numbers = entry, numbers + part.tobytes()
    text = json.dumps(header).encode()
    with open(path, "wb") as file:
        file.write(struct.pack("<Q", len(text)) + text + numbers)


def export_ppo(model: Any, path: str, observations: Any = ({"kind": "Kinematics"},)) -> None:
    """Writes a PPO of stable-baselines3 with an ``MlpPolicy``."""
    policy = model.policy
    layers = [layer for layer in policy.mlp_extractor.policy_net if hasattr(layer, "weight")] + [policy.action_net]
    action = "DiscreteMeta" if hasattr(policy.action_space, "n") else "Continuous"
    export(path, layers, observations=json.dumps(observations), action=action, activation="tanh")


if __name__ == "__main__":  # export_policy.py MODEL.zip OUT.safetensors
    from stable_baselines3 import PPO

    export_ppo(PPO.load(sys.argv[1], device="cpu"), sys.argv[2])
