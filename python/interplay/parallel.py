"""Several agents at once, with the interface of PettingZoo."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._copies import EnvSnapshot, copied
from ._library import Changes, ScenarioLike, load
from ._spaces import environment_settings, needs, own_seed

needs("gymnasium", "rl")
needs("pettingzoo", "rl")

from gymnasium import spaces
from pettingzoo import ParallelEnv

from ._views import PICTURE_PX, PICTURES_PER_S, Reward, Views, info_of, of_size, weights_of


class InterplayParallelEnv(ParallelEnv):
    """A scenario in which any vehicles are agents, by default all that have a driver; our planners drive the rest.

    An agent leaves when its episode is over: its vehicle then goes on along its lane. Settings are those of
    :class:`interplay.envs.InterplayEnv`.
    """

    metadata: dict[str, Any] = {
        "name": "interplay_v0",
        "render_modes": ["rgb_array"],
        "render_fps": PICTURES_PER_S,
        "is_parallelizable": True,
    }

    def __init__(
        self,
        scenario: ScenarioLike = "lane-change/front-nice",
        agents: Sequence[str] | None = None,
        *,
        observation: Any = "Kinematics",
        action: Any = "Continuous",
        reward: Reward = None,
        perturb: bool | Mapping[str, Any] = True,
        decision_s: float | None = None,
        set: Changes = None,
        render_mode: str | None = None,
    ) -> None:
        self.scenario = load(scenario, set=set)
        if agents is None:
            agents = self.scenario.default_agents
        self.render_mode = render_mode
        self._reward = reward if callable(reward) else None
        settings = environment_settings(observation, action, weights_of(reward), agents, perturb, decision_s)
        self._native = _native.Environment(self.scenario, settings)
        self._views = Views(self._native, observation)
        self.possible_agents: list[str] = list(self._native.agents)
        # Each agent has spaces of its own, which draw random samples of their own.
        own = (self._views.observation_space, self._views.action_space)
        self._spaces = {agent: copy.deepcopy(own) for agent in self.possible_agents}
        #: Position, heading and speed of every vehicle of the scenario, in its order.
        self.state_space: spaces.Space[Any] = spaces.Box(-np.inf, np.inf, (4 * len(self.scenario.vehicles),), np.float32)
        self.agents: list[str] = []
        self._rng = np.random.default_rng()
        self._is_seeded = False

    def observation_space(self, agent: str) -> Any:
        """What an agent sees."""
        return self._spaces[agent][0]

    def action_space(self, agent: str) -> Any:
        """What an agent decides."""
        return self._spaces[agent][1]

    def reset(self, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[dict[str, Any], dict[str, Any]]:
        """Begins an episode with all agents, of which everything is drawn from the seed.

        ``options={"seed": …}`` is the seed of the scenario itself; other options are not looked at, which PettingZoo asks for.
        """
        if options and options.get("seed") is not None:
            self._native.reset_as_written(own_seed(options["seed"]))
        else:
            if seed is None and not self._is_seeded:
                seed = int(self._rng.integers(2**63))
            self._native.reset(None if seed is None else own_seed(seed))
        self._is_seeded = True
        self.agents = list(self.possible_agents)
        return self._seen(self.agents), {agent: info_of(self._native, self._place(agent), None) for agent in self.agents}

    def _seen(self, agents: Sequence[str]) -> dict[str, Any]:
        return {agent: self._views.observed(self._native.observe(self._place(agent))) for agent in agents}

    def _place(self, agent: str) -> int:
        return self.possible_agents.index(agent)

    def step(
        self, actions: Mapping[str, Any]
    ) -> tuple[dict[str, Any], dict[str, float], dict[str, bool], dict[str, bool], dict[str, Any]]:
        """Drives all agents for one decision."""
        if not self.agents:
            return {}, {}, {}, {}, {}
        if missing := [agent for agent in self.agents if agent not in actions]:
            raise ValueError(f"there is no action for `{missing[0]}`")
        rows, count = self._native.action_space()
        idle: NDArray[np.float32] = np.zeros(1 if count is not None else 2 * (rows or 1), dtype=np.float32)
        acts = [self._views.acted(actions[agent]) if agent in self.agents else idle for agent in self.possible_agents]
        self._native.step(np.concatenate(acts))
        outcomes = {agent: self._native.outcome(self._place(agent)) for agent in self.agents}
        seen = self._seen(self.agents)
        rewards = {agent: outcome[0] for agent, outcome in outcomes.items()}
        terminated = {agent: outcome[1] for agent, outcome in outcomes.items()}
        truncated = {agent: outcome[2] for agent, outcome in outcomes.items()}
        infos = {agent: info_of(self._native, self._place(agent), outcome[3]) for agent, outcome in outcomes.items()}
        if self._reward is not None:
            rewards = {agent: float(self._reward(info["reward_terms"], info)) for agent, info in infos.items()}
        self.agents = [agent for agent in self.agents if not (terminated[agent] or truncated[agent])]
        return seen, rewards, terminated, truncated, infos

    def state(self) -> NDArray[np.float32]:
        """The state of the world for a central critic: position, heading and speed of every vehicle, as ``state_space`` has it."""
        states = [state for _, state in self._native.states()] or [[0.0] * 4] * len(self.scenario.vehicles)
        return np.array(states, dtype=np.float32).reshape(-1)

    def planned(self, planner: _native.Planner, agent: str | int | None = None) -> Any:
        """The action of an Interplay planner for an agent now; see :func:`interplay.policy`."""
        place = agent if isinstance(agent, int) else self._place(agent or self.possible_agents[0])
        return self._views.planned(planner.act(self._native, place))

    def render(self) -> Any:
        """The world from above, an array of 544 × 720 pixels."""
        picture = self._native.picture()
        return None if picture is None else of_size(picture, PICTURE_PX)

    def snapshot(self) -> EnvSnapshot:
        """A copy of all state, for :meth:`restore`; it costs about as much as a step."""
        random = copy.deepcopy(self._rng)
        return EnvSnapshot(copy.deepcopy(self._native), self.scenario, self._is_seeded, random, tuple(self.agents))

    def restore(self, snapshot: EnvSnapshot) -> None:
        """Goes back, or forth, to a snapshot of this environment or of one with the same settings."""
        self._native = copied(snapshot, self.possible_agents)
        self.scenario, self._is_seeded = snapshot.scenario, snapshot.is_seeded
        self._rng, self.agents = copy.deepcopy(snapshot.random), [*snapshot.agents]

    def close(self) -> None:
        """Nothing is left open."""


def parallel_env(scenario: ScenarioLike = "lane-change/front-nice", agents: Sequence[str] | None = None, **settings: Any) -> InterplayParallelEnv:
    """An environment of several agents; see :class:`InterplayParallelEnv`."""
    return InterplayParallelEnv(scenario, agents, **settings)
