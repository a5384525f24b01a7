"""Policies: planners of Interplay in any environment, and Python functions in any run."""

from __future__ import annotations

import hashlib
import inspect
import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Union

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._spaces import flat_action, observation_settings, shaped_observation

#: A kind of driver, or functions by name; none for the scenario's own.
Planner = Union[str, Mapping[str, Any], None]

#: The first error of each function that was registered, by its name.
_failures: dict[str, BaseException] = {}


class PolicyFunction:
    """A function from an observation to an action, with what it sees and decides.

    The function is given observations as an environment with the same ``observation`` has them, and returns actions as its
    ``action`` has them. An object with ``predict``, such as a model of stable-baselines3, is accepted as well. ``version`` tells its results
    from those of earlier ones in a sweep; without it, it is made of the source of the function.
    """

    def __init__(
        self,
        function: Any,
        *,
        observation: Any = "Kinematics",
        action: str = "Continuous",
        decision_s: float | None = None,
        version: str | None = None,
    ) -> None:
        self.observations = observation_settings(observation)
        self.is_single = not isinstance(observation, (list, tuple))
        self.action, self.decision_s = action, decision_s
        self.function: Callable[[Any], Any] = (
            (lambda seen: function.predict(seen, deterministic=True)[0]) if hasattr(function, "predict") else function
        )
        self.version = version if version is not None else _version(function)

    def settings(self, name: str) -> dict[str, Any]:
        """The driver of a scenario file that stands for it."""
        driver = {
            "kind": "python",
            "policy": name,
            "version": self.version,
            "observations": self.observations,
            "action": self.action,
        }
        return driver if self.decision_s is None else {**driver, "decision_s": float(self.decision_s)}

    def register(self, name: str) -> dict[str, Any]:
        """Lets drivers of that name call it, and returns such a driver."""

        def act(numbers: NDArray[np.float32], shapes: Sequence[tuple[str, Sequence[int]]]) -> NDArray[np.float32]:
            try:
                return self._checked(self.function(shaped_observation(numbers, shapes, self.is_single)))
            except BaseException as error:
                _failures.setdefault(name, error)
                raise

        _failures.pop(name, None)
        _native.register_policy(name, act)
        return self.settings(name)


    def _checked(self, action: Any) -> NDArray[np.float32]:
        """The numbers of an action of the function; what is none is a ValueError."""
        numbers = np.asarray(action)
        count = {"Continuous": 2, "DiscreteMeta": 1}.get(self.action, numbers.size)
        if numbers.dtype.kind not in "fiub" or numbers.size != count or not np.isfinite(numbers).all():
            raise ValueError(f"a function with the action {self.action} returned {action!r}")
        return flat_action(numbers)


def raise_failures(names: Iterable[str]) -> None:
    """Raises the first error of the functions with these names, if there was one; runs go on with failed plans meanwhile."""
    for name in names:
        if (error := _failures.pop(name, None)) is not None:
            raise error


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


def registered(planner: Planner) -> tuple[str | None, dict[str, Any] | None]:
    """The kind of driver, or the driver of a function of Python."""
    if planner is None or isinstance(planner, str):
        return planner, None
    if not isinstance(planner, Mapping) or len(planner) != 1:
        raise TypeError("`planner` is the kind of a driver, or one function by name: {'mine': function}")
    [(name, function)] = planner.items()
    return None, as_function(function).register(name)


class PlannerPolicy:
    """One of our planners, acting in environments; ``predict`` is that of stable-baselines3.

    It plans in what the agent's vehicle senses, which is more than an observation tells: it looks at the environment. ``bind`` says
    which. With ``Continuous`` actions the others do not know its plan; with ``Plan`` they do.
    """

    def __init__(self, kind: str, settings: Mapping[str, Any]) -> None:
        self.kind = kind
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


def policy(kind: str, **settings: Any) -> PlannerPolicy:
    """A planner of Interplay, such as ``negotiation``, ``conservative`` or ``idm``, that acts in any of the environments.

    >>> policy = interplay.policy("negotiation").bind(env)
    >>> observation, reward, terminated, truncated, info = env.step(policy.act())
    """
    return PlannerPolicy(kind, settings)
