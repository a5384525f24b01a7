"""The environments of Gymnasium, one for each family of scenarios."""

from __future__ import annotations

from typing import Any

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
    usual = ("interplay.envs:InterplayEnv", "interplay.envs:InterplayVectorEnv")
    entries: dict[str, tuple[tuple[str, str], dict[str, Any]]] = {
        identifier(family): (usual, {"scenario": scenario}) for family, scenario in families().items()
    }
    entries["interplay/Scenario-v0"] = (usual, {})
    for name, task in {"Street": "street", "Highway": "highway", "Merge": "merge"}.items():
        module = "streets" if task == "street" else "highway"
        made = (f"interplay.{module}:{task}_env", f"interplay.{module}:{task}_vector_env")
        entries[f"interplay/{name}-v0"] = (made, {})
    for name, (made, settings) in [*entries.items()]:
        entries[name.replace("-v0", "-Discrete-v0")] = (made, {**settings, "action": "DiscreteMeta", "flat": True})
    for name, ((entry, vector), settings) in entries.items():
        if name not in gymnasium.registry:
            gymnasium.register(id=name, entry_point=entry, vector_entry_point=vector, kwargs=settings)
    if "interplay/Building-v0" not in gymnasium.registry:
        gymnasium.register(id="interplay/Building-v0", entry_point="interplay.building:BuildingEnv")
