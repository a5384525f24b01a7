"""Policies: planners of Interplay in any environment, and Python functions in any run."""

from __future__ import annotations

import copy
import hashlib
import inspect
import itertools
import json
import os
import threading
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, Union

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._spaces import flat_action, observation_settings, shaped_observation

#: The kinds of drivers that can drive the ego.
Kind = Literal[
    "human", "idm", "scripted", "recorded", "walker", "external", "inputs", "conservative", "negotiation", "bayesian", "game",
    "cooperative", "nash", "contingency",
]  # fmt: skip
#: A kind of driver, the path of a network, a policy, or functions by name; none for the scenario's own.
Planner = Union[Kind, "os.PathLike[str]", Mapping[str, Any], "PlannerPolicy", "Network", None]

#: Numbers of registrations of functions for one run each; 0 is that of sweeps.
_registrations = itertools.count(1)
#: Held while a model draws from the random numbers of torch, which are those of the process.
_SAMPLING = threading.Lock()


class PolicyFunction:
    """A function from an observation to an action, with what it sees and decides.

    The function is given observations as an environment with the same ``observation`` has them, and returns actions as its
    ``action`` has them. An object with ``predict``, such as a model of stable-baselines3, is accepted as well. ``version`` tells its results
    from those of earlier ones in a sweep; without it, it is made of the source of the function. ``deterministic=False`` lets a model
    sample its actions: from the seed of the run and the observation, so that a run can be repeated.
    """

    def __init__(
        self,
        function: Any,
        *,
        observation: Any = "Kinematics",
        action: str = "Continuous",
        decision_s: float | None = None,
        version: str | None = None,
        deterministic: bool = True,
    ) -> None:
        self.observations = observation_settings(observation)
        self.is_single = not isinstance(observation, (list, tuple))
        self.action, self.decision_s = action, decision_s
        if not deterministic and not hasattr(function, "predict"):
            raise ValueError("`deterministic` is for models with `predict`; a function decides itself")
        self._model, self.deterministic = function if hasattr(function, "predict") else None, deterministic
        self._function: Callable[[Any], Any] | None = None if hasattr(function, "predict") else function
        own = version if version is not None else _version(function)
        self.version = own if deterministic else f"{own}-sampled"
        #: The seed of sampled actions, that of the scenario in a run.
        self.seed = 0

    def function(self, seen: Any) -> Any:
        """The action of the function, or of the model."""
        if self._function is not None:
            return self._function(seen)
        assert self._model is not None
        if self.deterministic:
            return self._model.predict(seen, deterministic=True)[0]
        import torch

        parts = [seen[name] for name in sorted(seen)] if isinstance(seen, Mapping) else [seen]
        digest = hashlib.sha256(str(self.seed).encode() + b"".join(np.asarray(part).tobytes() for part in parts)).digest()
        with _SAMPLING, torch.random.fork_rng(devices=[]):
            torch.manual_seed(int.from_bytes(digest[:8], "little") >> 1)
            return self._model.predict(seen, deterministic=False)[0]

    def settings(self, name: str, registration: int = 0) -> dict[str, Any]:
        """The driver of a scenario file that stands for it."""
        driver = {
            "kind": "python",
            "policy": name,
            "registration": registration,
            "version": self.version,
            "observations": self.observations,
            "action": self.action,
        }
        return driver if self.decision_s is None else {**driver, "decision_s": float(self.decision_s)}

    def _checked(self, action: Any) -> NDArray[np.float32]:
        """The numbers of an action of the function; what is none is a ValueError."""
        numbers = np.asarray(action)
        count = {"Continuous": 2, "DiscreteMeta": 1}.get(self.action, numbers.size)
        if numbers.dtype.kind not in "fiub" or numbers.size != count or not np.isfinite(numbers).all():
            raise ValueError(f"a function with the action {self.action} returned {action!r}")
        return flat_action(numbers)


class Registered:
    """A function that drivers call while the context lasts; its first error is kept, since runs go on with failed plans meanwhile."""

    def __init__(self, name: str, function: PolicyFunction, is_of_sweep: bool = False) -> None:
        self.name, self.function = name, function
        self._registration = 0 if is_of_sweep else next(_registrations)
        self._failure: BaseException | None = None
        self.settings = function.settings(name, self._registration)

    def _act(self, numbers: NDArray[np.float32], shapes: Sequence[tuple[str, Sequence[int]]]) -> NDArray[np.float32]:
        try:
            function = self.function
            return function._checked(function.function(shaped_observation(numbers, shapes, function.is_single)))
        except BaseException as error:
            self._failure = self._failure or error
            raise

    def __enter__(self) -> Registered:
        if not _native.register_policy(self.name, self._registration, self._act):
            raise ValueError(f"a sweep with a function `{self.name}` goes on in another thread; choose another name")
        return self

    def __exit__(self, *_: Any) -> None:
        _native.remove_policy(self.name, self._registration)

    def raise_failure(self) -> None:
        """Raises the first error of the function, if there was one."""
        if self._failure is not None:
            raise self._failure


def resolved(planner: Planner) -> tuple[str | None, dict[str, Any] | None, Registered | None]:
    """The driver of the ego in one run: its kind, or its settings, and the function that they call."""
    if isinstance(planner, PlannerPolicy):
        return None, {"kind": planner.kind, **planner.settings}, None
    file = planner.file if isinstance(planner, Network) else planner
    if isinstance(file, os.PathLike) or (isinstance(file, str) and file.endswith(".safetensors")):
        return None, {"kind": "policy", "file": os.path.abspath(file)}, None
    if planner is None or isinstance(planner, str):
        return planner, None, None
    if not isinstance(planner, Mapping) or len(planner) != 1:
        raise TypeError(
            "`planner` is the kind of a driver, `interplay.policy(…)`, the path of a network, or one function by name: {'mine': function}"
        )
    [(name, function)] = planner.items()
    registered = Registered(name, copy.copy(as_function(function)))
    return None, registered.settings, registered


def _version(function: Any) -> str:
    """A digest of what a function is made of: its source, or the numbers of a network."""
    if hasattr(function, "get_parameters"):
        digest = hashlib.sha256()
        for parameters in function.get_parameters().values():
            for name, value in sorted(parameters.items(), key=lambda entry: str(entry[0])):
                if hasattr(value, "cpu"):
                    digest.update(str(name).encode() + value.cpu().numpy().tobytes())
        return digest.hexdigest()[:16]
    try:
        source = inspect.getsource(function)
    except (OSError, TypeError):
        source = repr(type(function))
    return hashlib.sha256(source.encode()).hexdigest()[:16]


def as_function(function: Any) -> PolicyFunction:
    """A function with what it sees and decides; by default the five nearest vehicles, and acceleration and steering."""
    return function if isinstance(function, PolicyFunction) else PolicyFunction(function)


class PlannerPolicy:
    """One of our planners, acting in environments; ``predict`` is that of stable-baselines3.

    It plans in what the agent's vehicle senses, which is more than an observation tells: it looks at the environment. ``bind`` says
    which. With ``Continuous`` actions the others do not know its plan; with ``Plan`` they do.
    """

    def __init__(self, kind: str, settings: Mapping[str, Any]) -> None:
        self.kind, self.settings = kind, dict(settings)
        self._planner = _native.Planner(json.dumps({"kind": kind, **settings}))
        self._env: Any = None

    def bind(self, env: Any) -> PlannerPolicy:
        """Acts in an environment from now on: one of Gymnasium, or a vector environment of Interplay."""
        self._env, self._planner = getattr(env, "unwrapped", env), self._planner
        self._planner.forget()
        return self

    def act(self, agent: str | int | None = None) -> Any:
        """The action for the present state of the environment, in its action space; of several agents for the named one."""
        if self._env is None:
            raise _native.RunError("say in which environment it acts: `policy.bind(env)`")
        return self._env.planned(self._planner, agent)

    def predict(
        self,
        observation: Any = None,
        state: Any = None,
        episode_start: Any = None,
        deterministic: bool = True,
    ) -> tuple[Any, Any]:
        """The action, and no state; the observation is not looked at. ``episode_start`` makes it forget."""
        if episode_start is not None and np.any(episode_start):
            for which in np.flatnonzero(np.ravel(episode_start)):
                self._planner.forget(int(which))
        return self.act(), state

    def reset(self) -> None:
        """Forgets all that it remembers; to be called where an episode begins."""
        self._planner.forget()


class Network:
    """A trained network of a ``.safetensors`` file, which decides as it does with ``kind = "policy"``, bit for bit.

    ``predict`` is that of stable-baselines3; ``outputs`` are those of the last layer.
    """

    def __init__(self, file: str | os.PathLike[str]) -> None:
        self.file = os.path.abspath(file)
        self._native = _native.Network(self.file)
        views, action, self.digest = self._native.about()
        self.observations, self.action = json.loads(views), json.loads(action)

    def outputs(self, observation: Any) -> NDArray[np.float64]:
        """The outputs of the last layer: means of the numbers of an action, or a value for each meta-action."""
        return np.array(self._native.decide(flat_action(observation))[0])

    def predict(
        self, observation: Any, state: Any = None, episode_start: Any = None, deterministic: bool = True
    ) -> tuple[Any, Any]:
        """The action for an observation, and no state."""
        action = np.array(self._native.decide(flat_action(observation))[1], dtype=np.float32)
        return (np.int64(action[0]) if self.action == "DiscreteMeta" else action), state

    def __reduce__(self) -> tuple[Any, ...]:
        return Network, (self.file,)


def policy(kind: Kind, **settings: Any) -> PlannerPolicy:
    """A planner of Interplay, such as ``negotiation``, ``conservative`` or ``idm``, that acts in any of the environments.

    >>> policy = interplay.policy("negotiation").bind(env)
    >>> observation, reward, terminated, truncated, info = env.step(policy.act())
    """
    return PlannerPolicy(kind, settings)
