"""The crates that are linked into the command, from `cargo metadata`."""

import json
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent


def said(*command: str) -> str:
    """What a command prints."""
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout


def shipped() -> list[dict]:
    """Packages of the tree of `interplay`, sorted by name and version; `links` of each are the indices of what it depends on.

    Only dependencies that are linked count: none of build scripts and tests, and no procedural macros, whose code runs
    in the compiler. The platform is that of this machine.
    """
    target = next(line.removeprefix("host: ") for line in said("rustc", "-vV").splitlines() if line.startswith("host: "))
    metadata = json.loads(said("cargo", "metadata", "--format-version=1", "--locked", "--filter-platform", target))
    packages = {package["id"]: package for package in metadata["packages"]}
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    root = next(package["id"] for package in metadata["packages"] if package["name"] == "interplay")
    found, waiting = {}, [root]
    while waiting:
        package = waiting.pop()
        if package in found or is_macro(packages[package]):
            continue
        linked = [it["pkg"] for it in nodes[package]["deps"] if any(kind["kind"] is None for kind in it["dep_kinds"])]
        found[package] = linked
        waiting.extend(linked)
    order = sorted(found, key=lambda package: (packages[package]["name"], packages[package]["version"]))
    index = {package: at for at, package in enumerate(order)}
    return [packages[it] | {"links": sorted(index[other] for other in found[it] if other in index)} for it in order]


def is_macro(package: dict) -> bool:
    """Whether the package is a procedural macro and nothing else."""
    kinds = {kind for target in package["targets"] for kind in target["kind"]}
    return "proc-macro" in kinds


def is_own(package: dict) -> bool:
    """Whether the package is part of this repository."""
    return package["source"] is None
