"""What is given mistakes: all targets by name."""

import benches
import economics
import maps
import pages
import plays
import records
import rows
import scenario_targets
import streets
from target import Target


def all_targets(binary: str) -> dict[str, Target]:
    """All targets by name."""
    others = (streets, maps, records, economics, benches, plays, pages, rows)
    return scenario_targets.first_targets(binary) | {name: found for module in others for name, found in module.targets(binary).items()}
