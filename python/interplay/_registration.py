"""The environments of Gymnasium, one for each family of scenarios."""

from __future__ import annotations

import gymnasium

from . import _native

#: The scenario of a family, where it has one of them, whose environment is not asked for another one; of other families the first.
USUAL = ("front-nice", "nice")
#: Families without vehicles that could be driven.
BUILDINGS = "building"


def families() -> dict[str, str]:
    """The families of scenarios with vehicles, each with its usual scenario."""
    found: dict[str, list[str]] = {}
    for name in _native.scenario_names():
        family = name.split("/")[0]
        if family != BUILDINGS:
            found.setdefault(family, []).append(name)
    return {
        family: next((usual for word in USUAL if (usual := f"{family}/{word}") in names), names[0]) for family, names in found.items()
    }


def identifier(family: str) -> str:
    """The name of a family's environment, such as ``interplay/LaneChange-v0``."""
    return f"interplay/{''.join(word.capitalize() for word in family.split('-'))}-v0"


def register() -> None:
    """Registers all environments; those that are there stay as they are."""
    entries: dict[str, dict[str, str]] = {identifier(family): {"scenario": scenario} for family, scenario in families().items()}
    entries["interplay/Scenario-v0"] = {}
    entries.update({name.replace("-v0", "-Discrete-v0"): {**settings, "action": "DiscreteMeta"} for name, settings in entries.items()})
    for name, settings in entries.items():
        if name not in gymnasium.registry:
            gymnasium.register(
                id=name,
                entry_point="interplay.envs:InterplayEnv",
                vector_entry_point="interplay.envs:InterplayVectorEnv",
                kwargs=settings,
            )
    for name, chosen in {"interplay/Street-v0": {}, "interplay/Street-Discrete-v0": {"action": "DiscreteMeta"}}.items():
        if name not in gymnasium.registry:
            gymnasium.register(
                id=name,
                entry_point="interplay.streets:street_env",
                vector_entry_point="interplay.streets:street_vector_env",
                kwargs=chosen,
            )
    if "interplay/Building-v0" not in gymnasium.registry:
        gymnasium.register(id="interplay/Building-v0", entry_point="interplay.building:BuildingEnv")
