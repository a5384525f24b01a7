"""Environments of Gymnasium: one world, many worlds, and a building."""

from __future__ import annotations

import copy as _copy
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._copies import EnvSnapshot, copied, without_window
from ._library import Changes, Report, ScenarioLike, load
from ._reports import records
from ._spaces import drawn_scenarios, environment_settings, flat_action, needs, own_seed

needs("gymnasium", "rl")

import gymnasium
from gymnasium import spaces

from ._views import PICTURE_PX, PICTURES_PER_S, Reward, Views, info_of, of_size, weights_of

class InterplayEnv(gymnasium.Env[Any, Any]):
    """A scenario in which one vehicle, by default the ego, is driven by an agent; all others are driven by their planners.

    :param scenario: a name of ``interplay.list()``, a path, or a :class:`interplay.Scenario`; or a list of names and paths, of which
        each episode draws one.
    :param observation: ``Kinematics``, ``Lane``, ``OccupancyGrid``, ``Plan`` or ``Belief``, or a dictionary with a ``kind`` and
        settings, or a list of them, of which the observation is a dictionary.
    :param flat: whether the observation is one row of numbers, which scripts for simple tasks expect.
    :param action: ``Continuous``, ``DiscreteMeta`` or ``Plan``.
    :param reward: weights of the terms by name; those that are not named keep their defaults. Or a function of the terms and ``info``.
    :param agent: the vehicle; by default the ego.
    :param perturb: whether starts and styles are drawn for each episode, or what of them: ``position_m``, ``speed_mps``,
        ``safety_weights``.
    :param decision_s: time from one decision to the next; by default each plan is a decision, and a meta-action is kept for half a
        second of a real car.
    :param set: changes of the scenario by path.
    :param streets: draws a street of the generator for each episode instead of the scenario's: a dictionary with ``kinds`` and
        ``density``, which may be empty; see :func:`interplay.streets.street_env`.
    """

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array"], "render_fps": PICTURES_PER_S}

    def __init__(
        self,
        scenario: ScenarioLike | Sequence[ScenarioLike] = "lane-change/front-nice",
        *,
        observation: Any = "Kinematics",
        action: Any = "Continuous",
        reward: Reward = None,
        agent: str | None = None,
        perturb: bool | Mapping[str, Any] = True,
        decision_s: float | None = None,
        set: Changes = None,
        streets: Mapping[str, Any] | None = None,
        flat: bool = False,
        render_mode: str | None = None,
    ) -> None:
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise ValueError(f"render_mode {render_mode!r}; choose from {', '.join(self.metadata['render_modes'])}")
        self.render_mode = render_mode
        self._observation, self._flat = observation, flat
        agents = None if agent is None else [agent]
        if isinstance(scenario, Sequence) and not isinstance(scenario, str):
            scenario, streets = drawn_scenarios(scenario, streets)
        self._reward = reward if callable(reward) else None
        self._settings = environment_settings(observation, action, weights_of(reward), agents, perturb, decision_s, streets, set)
        self._set = set
        self._play(load(scenario, set=set))
        self.observation_space, self.action_space = self._views.observation_space, self._views.action_space
        self._window: Any = None

    def _play(self, scenario: _native.Scenario) -> None:
        """Before the first episode of a scenario."""
        self.scenario, self._is_seeded = scenario, False
        self._native = _native.Environment(scenario, self._settings)
        self._views = Views(self._native, self._observation, self._flat)

    @property
    def agent(self) -> str:
        """The vehicle that the agent drives."""
        return self._native.agents[0]

    @property
    def decision_s(self) -> float:
        """Time from one decision to the next [s]."""
        return self._native.decision_s

    @property
    def observation_names(self) -> dict[str, list[str]]:
        """What the entries of the last axis of each view are."""
        return self._views.names

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begins an episode, of which everything is drawn from ``seed``; without a seed the next one of the sequence.

        ``options`` may have another ``scenario`` with the same spaces, or a ``seed`` of the scenario itself: then the episode is the
        scenario as it is written, as ``interplay run --seed`` runs it.
        """
        super().reset(seed=seed)
        options = options or {}
        if unknown := [name for name in options if name not in ("scenario", "seed")]:
            raise ValueError(f"option {unknown[0]!r}; choose from scenario, seed")
        if "scenario" in options:
            self._change_scenario(options["scenario"])
        if options.get("seed") is not None:
            self._native.reset_as_written(own_seed(options["seed"]))
        else:
            if seed is None and not self._is_seeded:
                seed = int(self.np_random.integers(2**63))
            self._native.reset(None if seed is None else own_seed(seed))
        self._is_seeded = True
        if self.render_mode == "human":
            self.render()
        info = info_of(self._native, 0, None)
        return self._views.observed(self._native.observe(0)), info if self.street is None else {**info, "street": self.street}

    @property
    def street(self) -> str | None:
        """The name of the street of the episode, where streets are drawn."""
        return self._native.street

    def _change_scenario(self, scenario: ScenarioLike) -> None:
        if self.street is not None:
            raise ValueError("each episode draws its street: choose `kinds`, and not a scenario")
        changed = load(scenario, set=self._set if not isinstance(scenario, _native.Scenario) else None)
        native = _native.Environment(changed, self._settings)
        views = Views(native, self._observation, self._flat)
        if (views.observation_space, views.action_space) != (self.observation_space, self.action_space):
            raise ValueError(f"`{changed.source}` has other spaces than `{self.scenario.source}`, and options never change spaces")
        self.scenario, self._native, self._is_seeded = changed, native, False

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Drives for one decision; ``info`` has the terms of the reward, and how the episode ended."""
        self._native.step(self._views.acted(action))
        reward, terminated, truncated, ending = self._native.outcome(0)
        if self.render_mode == "human":
            self.render()
        info = info_of(self._native, 0, ending)
        if self._reward is not None:
            reward = float(self._reward(info["reward_terms"], info))
        return self._views.observed(self._native.observe(0)), reward, terminated, truncated, info

    def action_masks(self) -> NDArray[np.bool_]:
        """Which meta-actions can be done now, by number."""
        mask = self._native.action_mask(0)
        if mask is None:
            raise ValueError("only meta-actions have a mask")
        return np.array(mask, dtype=np.bool_)

    def planned(self, planner: _native.Planner, agent: str | int | None = None) -> Any:
        """The action of an Interplay planner now; see :func:`interplay.policy`."""
        return self._views.planned(planner.act(self._native, 0))

    def states(self) -> dict[str, NDArray[np.float64]]:
        """x_m, y_m, heading_rad and speed_mps of every vehicle now."""
        return {name: np.array(state) for name, state in self._native.states()}

    def report(self) -> Report | None:
        """Ends the episode and says what was measured in it; none before the first."""
        text = self._native.finish()
        return None if text is None else Report({**records(text), "scenario": self.street or self.scenario.name})

    def render(self) -> Any:
        """The world from above: an array of 544 × 720 pixels, or a window."""
        if self.render_mode is None:
            gymnasium.logger.warn("say how to render: gymnasium.make(…, render_mode='rgb_array')")
            return None
        picture = self._native.picture()
        if picture is None:
            raise _native.RunError("call reset before render")
        picture = of_size(picture, PICTURE_PX)
        if self.render_mode == "rgb_array":
            return picture
        self._show(picture)
        return None

    def _show(self, picture: NDArray[np.uint8]) -> None:
        try:
            import pygame
        except ImportError:
            raise gymnasium.error.DependencyNotInstalled("pygame is not here: pip install 'interplay[render]'") from None
        if self._window is None:
            pygame.display.init()
            self._window = pygame.display.set_mode((picture.shape[1], picture.shape[0]))
            pygame.display.set_caption(self.scenario.title)
        self._window.blit(pygame.surfarray.make_surface(picture.swapaxes(0, 1)), (0, 0))
        pygame.event.pump()
        pygame.display.flip()

    def close(self) -> None:
        """Closes the window, if there is one."""
        if self._window is not None:
            import pygame

            pygame.display.quit()
            self._window = None

    def snapshot(self) -> EnvSnapshot:
        """A copy of all state, for :meth:`restore`; it costs about as much as a step."""
        return EnvSnapshot(_copy.deepcopy(self._native), self.scenario, self._is_seeded, _copy.deepcopy(self._np_random))

    def restore(self, snapshot: EnvSnapshot) -> None:
        """Goes back, or forth, to a snapshot of this environment or of one with the same spaces."""
        native = copied(snapshot, [self.agent])
        views = Views(native, self._observation, self._flat)
        if (views.observation_space, views.action_space) != (self.observation_space, self.action_space):
            raise ValueError("the snapshot is of an environment with other spaces")
        self._native, self._views = native, views
        self.scenario, self._is_seeded = snapshot.scenario, snapshot.is_seeded
        self._np_random = _copy.deepcopy(snapshot.random)

    def __getstate__(self) -> dict[str, Any]:
        """All state but a window: a copy goes on where the original is."""
        return without_window(self.__dict__)


class InterplayVectorEnv(gymnasium.vector.VectorEnv[Any, Any, Any]):
    """Many worlds that are stepped in one call, on all cores: same seeds and actions, same numbers as each world alone.

    :param scenario: one for all worlds, or a list with one for each.
    :param num_envs: number of worlds.
    :param agents: several vehicles of each world as agents. Rows are then agents, those of the first world first, and
        ``info["present"]`` says whose actions count: an agent whose episode is over waits until its world begins anew.
    :param autoreset_mode: one of Gymnasium's.
    :param copy: whether every observation is a new array; otherwise the last one is overwritten.

    The rest is as in :class:`InterplayEnv`.
    """

    metadata: dict[str, Any] = {
        "render_modes": ["rgb_array"],
        "render_fps": PICTURES_PER_S,
        "autoreset_mode": gymnasium.vector.AutoresetMode.NEXT_STEP,
    }

    def __init__(
        self,
        scenario: ScenarioLike | Sequence[ScenarioLike] = "lane-change/front-nice",
        *,
        num_envs: int = 1,
        observation: Any = "Kinematics",
        action: Any = "Continuous",
        reward: Reward = None,
        agent: str | None = None,
        agents: Sequence[str] | None = None,
        perturb: bool | Mapping[str, Any] = True,
        decision_s: float | None = None,
        set: Changes = None,
        streets: Mapping[str, Any] | None = None,
        flat: bool = False,
        autoreset_mode: gymnasium.vector.AutoresetMode | str = gymnasium.vector.AutoresetMode.NEXT_STEP,
        copy: bool = True,
        render_mode: str | None = None,
    ) -> None:
        if num_envs < 1:
            raise ValueError("num_envs is at least 1")
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f"render_mode {render_mode!r}; the only one of many worlds is rgb_array")
        if agent is not None and agents is not None:
            raise ValueError("choose `agent` or `agents`")
        mode = gymnasium.vector.AutoresetMode(autoreset_mode)
        names = {"NEXT_STEP": "next_step", "SAME_STEP": "same_step", "DISABLED": "disabled"}
        self._worlds, self._mode, self._copy, self.render_mode = num_envs, mode, copy, render_mode
        self._reward = reward if callable(reward) else None
        self.metadata = {**self.metadata, "autoreset_mode": mode}
        named = agents if agent is None else [agent]
        settings = environment_settings(observation, action, weights_of(reward), named, perturb, decision_s, streets, set)
        several = isinstance(scenario, Sequence) and not isinstance(scenario, str)
        listed: list[Any] = list(scenario) if several else [scenario] * num_envs  # type: ignore[arg-type]
        if len(listed) != num_envs:
            raise ValueError(f"{len(listed)} scenarios for {num_envs} worlds")
        loaded = {name if isinstance(name, str) else id(name): load(name, set=set) for name in listed}
        self.scenarios = [loaded[name if isinstance(name, str) else id(name)] for name in listed]
        self._native = _native.Batch(self.scenarios, settings, names[mode.name])
        self._views = Views(self._native, observation, flat)
        self._agents = len(self._native.agents(0))
        self.num_envs = num_envs = num_envs * self._agents
        self._present: NDArray[np.bool_] = np.zeros(num_envs, dtype=np.bool_)
        self.single_observation_space, self.single_action_space = self._views.observation_space, self._views.action_space
        self.observation_space = gymnasium.vector.utils.batch_space(self.single_observation_space, num_envs)
        self.action_space = gymnasium.vector.utils.batch_space(self.single_action_space, num_envs)
        self._is_seeded = False
        self._terms = _native.Environment.reward_terms()
        self._buffer: NDArray[np.float32] | None = None

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begins an episode in every world; world ``i`` has the seed ``seed + i``. ``options={"reset_mask": …}`` resets some."""
        seeds: list[int | None]
        if seed is None:
            seeds = [None] * self._worlds
            if not self._is_seeded:
                seeds = [int(number) for number in self.np_random.integers(2**63, size=self._worlds)]
        elif isinstance(seed, (int, np.integer)):
            self._np_random, self._np_random_seed = gymnasium.utils.seeding.np_random(int(seed))
            seeds = [own_seed(int(seed) + world) for world in range(self._worlds)]
        else:
            seeds = [None if number is None else own_seed(number) for number in seed]
        which: NDArray[np.bool_] = np.ones(self._worlds, dtype=np.bool_)
        if options is not None:
            options = dict(options)
            mask = np.asarray(options.pop("reset_mask", np.ones(self.num_envs)), dtype=np.bool_)
            which[:] = mask.reshape(self._worlds, -1).any(axis=1)
            if options:
                raise ValueError(f"option {next(iter(options))!r}; the only one of many worlds is reset_mask")
        self._native.reset(seeds, [bool(word) for word in which])
        self._is_seeded = True
        self._present |= np.repeat(which, self._agents)
        return self._observed(self._native.observe()), self._masks()

    def _observed(self, numbers: NDArray[np.float32]) -> Any:
        if not self._copy:
            if self._buffer is None:
                self._buffer = np.empty_like(numbers)
            self._buffer[:] = numbers
            numbers = self._buffer
        return self._views.observed(numbers)

    def _masks(self) -> dict[str, Any]:
        masks = {} if self._agents == 1 else {"present": self._present.copy()}
        if not isinstance(self.single_action_space, spaces.Discrete):
            return masks
        return {**masks, "action_mask": np.array(self._native.action_masks(), dtype=np.int8)}

    def step(self, actions: Any) -> tuple[Any, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Steps all worlds by one decision each."""
        numbers = np.asarray(actions)
        if numbers.shape != self.action_space.shape or numbers.dtype.kind not in "fiub":
            raise ValueError(f"actions of all worlds have the shape {self.action_space.shape}, and not {numbers.shape}")
        seen, last, rewards, terminated, truncated, terms, self._present, endings = self._native.step(flat_action(numbers))
        info: dict[str, Any] = {"reward_terms": {name: terms[:, place] for place, name in enumerate(self._terms)}}
        over = terminated | truncated
        if over.any():
            info["ending"] = np.array(endings, dtype=object)
            info["_ending"] = over
            info["is_success"] = np.array([ending == "goal" for ending in endings])
            info["_is_success"] = over
            if self._mode == gymnasium.vector.AutoresetMode.SAME_STEP:
                final = np.full(self.num_envs, None, dtype=object)
                for row in np.flatnonzero(over):
                    final[row] = self._views.observed((last if self._present[row] else seen)[row])
                info["final_obs"], info["_final_obs"] = final, over
                info["final_info"] = {"ending": info["ending"], "is_success": info["is_success"]}
                info["_final_info"] = over
        info |= self._masks()
        if self._reward is not None:
            rewards = np.broadcast_to(np.asarray(self._reward(info["reward_terms"], info), np.float64), over.shape).copy()
        return self._observed(seen), rewards, terminated, truncated, info

    def action_masks(self) -> NDArray[np.bool_]:
        """Which meta-actions can be done now, a row a world."""
        return np.array(self._native.action_masks(), dtype=np.bool_)

    def planned(self, planner: _native.Planner, agent: str | int | None = None) -> Any:
        """The actions of an Interplay planner in all worlds now; see :func:`interplay.policy`."""
        if self._agents > 1:
            raise ValueError("planners act in worlds with one agent")
        actions = [self._views.planned(planner.act_in(self._native, world)) for world in range(self._worlds)]
        return np.stack(actions)

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """The worlds from above, an array of 544 × 720 pixels for each."""
        if self.render_mode is None:
            return None
        pictures = [self._native.picture(world) for world in range(self._worlds)]
        return tuple(of_size(picture, PICTURE_PX) for picture in pictures if picture is not None)

    def call(self, name: str, *arguments: Any, **named: Any) -> tuple[Any, ...]:
        """What a method of each world returns, or its attribute: ``time_s``, ``street``, ``agents``, ``scenario``, ``states()``."""
        if arguments or named or name not in (known := ("time_s", "street", "agents", "scenario", "states", "render")):
            raise AttributeError(f"the worlds have no method `{name}` with arguments; choose from {', '.join(known)}, without any")
        if name == "render":
            return self.render() or ()
        of_world: dict[str, Callable[[int], Any]] = {
            "time_s": lambda world: self._native.about(world)[0],
            "street": lambda world: self._native.about(world)[1],
            "agents": self._native.agents,
            "scenario": self.scenarios.__getitem__,
            "states": lambda world: {vehicle: np.array(state) for vehicle, state in self._native.states(world)},
        }
        return tuple(of_world[name](world) for world in range(self._worlds))

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """An attribute of each world; see :meth:`call`."""
        return self.call(name)

    def set_attr(self, name: str, values: Any) -> None:
        """Refused: worlds are set by the arguments with which they are made."""
        raise AttributeError(f"`{name}` of worlds in one call cannot be set; make the environment with other settings")
