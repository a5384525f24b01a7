"""The environments of Gymnasium, one for each family of scenarios."""

from __future__ import annotations

import gymnasium

from . import _native

#: The scenario of a family whose environment is not asked for another one; of other families the first.
USUAL = {"lane-change": "lane-change/front-nice", "ramp-merge": "ramp-merge/front-nice", "intersection": "intersection/nice"}
#: Families without vehicles that could be driven.
BUILDINGS = "building"


def families() -> dict[str, str]:
    """The families of scenarios with vehicles, each with its usual scenario."""
    found: dict[str, str] = {}
    names = _native.scenario_names()
    for name in names:
        family = name.split("/")[0]
        if family != BUILDINGS:
            found.setdefault(family, USUAL.get(family, name))
    return {family: scenario if scenario in names else found[family] for family, scenario in found.items()}


def identifier(family: str) -> str:
    """The name of a family's environment, such as ``interplay/LaneChange-v0``."""
    return f"interplay/{''.join(word.capitalize() for word in family.split('-'))}-v0"


def register() -> None:
    """Registers all environments; those that are there stay as they are."""
    entries = {identifier(family): {"scenario": scenario} for family, scenario in families().items()}
    entries["interplay/Scenario-v0"] = {}
    for name, settings in entries.items():
        if name not in gymnasium.registry:
            gymnasium.register(
                id=name,
                entry_point="interplay.envs:InterplayEnv",
                vector_entry_point="interplay.envs:InterplayVectorEnv",
                kwargs=settings,
            )
    if "interplay/Building-v0" not in gymnasium.registry:
        gymnasium.register(id="interplay/Building-v0", entry_point="interplay.building:BuildingEnv")
