#!/usr/bin/env python3
"""Every authored scenario with its vehicles listed in reverse order: by how much final states differ.

Prints how many are equal to the last bit, how many differ by rounding (below 1e-9 in every state), and the others by name.
Nothing of it is a fault; it is what `docs/evidence/reliability.md` says of the order.

    tests/faults/reversed_order.py [--binary target/release/interplay]
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROUNDING = 1e-9
# A table of the file begins here; those of a vehicle belong to it.
TABLES = re.compile(r"(?m)^(?=\[\[vehicle\]\]|\[\[(?!vehicle)|\[(?!vehicle|\[))")


def reversed_vehicles(text: str) -> str | None:
    """The file with its vehicles in reverse order; none if there are fewer than two."""
    tables = TABLES.split(text)
    vehicles = [at for at, table in enumerate(tables) if table.startswith("[[vehicle]]")]
    turned = list(tables)
    for here, there in zip(vehicles, reversed(vehicles)):
        turned[here] = tables[there]
    return "".join(turned) if len(vehicles) > 1 else None


def final_states(binary: str, file: pathlib.Path) -> dict[tuple[str, str], float]:
    """Numbers of the state of each vehicle at the end, by its name and their own."""
    command = [binary, "run", str(file), "--no-record", "--json"]
    said = subprocess.run(command, capture_output=True, text=True).stdout
    vehicles = json.loads(said)["vehicles"]
    return {(it["name"], key): value for it in vehicles for key, value in it["final"].items() if isinstance(value, float)}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--binary", default="target/release/interplay")
    binary = str(pathlib.Path(parser.parse_args().binary).resolve())
    listed = subprocess.run([binary, "list"], check=True, capture_output=True, text=True).stdout
    names = re.findall(r"(?m)^ *([a-z-]+/[a-z0-9-]+) ", listed)
    differences: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            file = pathlib.Path(folder) / f"{name.replace('/', '_')}.toml"
            subprocess.run([binary, "new", str(file), "--from", name], check=True, capture_output=True)
            text = reversed_vehicles(file.read_text("utf-8"))
            if text is None:
                continue
            other = file.with_suffix(".reversed.toml")
            other.write_text(text, "utf-8")
            one, two = final_states(binary, file), final_states(binary, other)
            if one.keys() != two.keys():
                sys.exit(f"{name} has other vehicles when they are reversed")
            differences[name] = max(abs(one[key] - two[key]) for key in one)
    equal = sum(difference == 0.0 for difference in differences.values())
    large = {name: difference for name, difference in differences.items() if difference >= ROUNDING}
    print(f"{len(differences)} scenarios with two or more vehicles: {equal} equal to the last bit,", end=" ")
    print(f"{len(differences) - equal - len(large)} different below {ROUNDING:g}, {len(large)} above")
    for name, difference in large.items():
        print(f"{name}: {difference:.2g}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
