"""Streets of the generator as environments: each episode is on a street of its own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .envs import InterplayEnv, InterplayVectorEnv

#: Safety weights of the styles of human drivers.
STYLES = {"nice": 50.0, "considerate": 20.0, "normal": 8.0, "assertive": 2.0, "tough": 0.0}
#: A street whose spaces all streets have.
SCENARIO = "streets/van/0"


def _settings(kinds: str | Sequence[str] | None, density: float, styles: str | Sequence[str] | None, more: dict[str, Any]) -> dict[str, Any]:
    names = [kinds] if isinstance(kinds, str) else list(kinds or ())
    more = {**more, "streets": {"kinds": names, "density": float(density)}}
    if styles is None:
        return more
    words = [styles] if isinstance(styles, str) else list(styles)
    if unknown := [word for word in words if word not in STYLES]:
        raise ValueError(f"style {unknown[0]!r}; choose from {', '.join(STYLES)}")
    perturb = more.get("perturb", True)
    drawn = dict(perturb) if isinstance(perturb, dict) else {}
    return {**more, "perturb": {**drawn, "is_drawn": bool(perturb) or bool(words), "safety_weights": [STYLES[word] for word in words]}}


def street_env(
    *, kinds: str | Sequence[str] | None = None, density: float = 1.0, styles: str | Sequence[str] | None = None, **settings: Any
) -> InterplayEnv:
    """``interplay/Street-v0``: every reset draws another street by its seed; ``env.unwrapped.street`` is its name.

    :param kinds: kinds of streets, such as ``"ring"`` or ``["tee", "crossing"]``; by default all.
    :param density: probability with which each other vehicle is present, from 0 to 1.
    :param styles: styles of human drivers, of which each has one: ``nice``, ``considerate``, ``normal``, ``assertive``, ``tough``.

    The rest is as in :class:`interplay.envs.InterplayEnv`.
    """
    return InterplayEnv(SCENARIO, **_settings(kinds, density, styles, settings))


def street_vector_env(
    *, kinds: str | Sequence[str] | None = None, density: float = 1.0, styles: str | Sequence[str] | None = None, **settings: Any
) -> InterplayVectorEnv:
    """Many worlds, each on streets of its own; settings are those of :func:`street_env`."""
    return InterplayVectorEnv(SCENARIO, **_settings(kinds, density, styles, settings))
