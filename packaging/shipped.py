"""The crates that are linked into the command, from `cargo metadata`."""

import json
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
TARGET = "x86_64-unknown-linux-gnu"


def shipped(target: str = TARGET) -> list[dict]:
    """Packages of the tree of `interplay`, sorted by name and version.

    Only dependencies that are linked count: none of build scripts and tests, and no procedural macros, whose code runs
    in the compiler.
    """
    command = ["cargo", "metadata", "--format-version=1", "--locked", "--filter-platform", target]
    said = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    metadata = json.loads(said)
    packages = {package["id"]: package for package in metadata["packages"]}
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    root = next(package["id"] for package in metadata["packages"] if package["name"] == "interplay")
    found, waiting = set(), [root]
    while waiting:
        package = waiting.pop()
        if package in found or is_macro(packages[package]):
            continue
        found.add(package)
        for dependency in nodes[package]["deps"]:
            if any(kind["kind"] is None for kind in dependency["dep_kinds"]):
                waiting.append(dependency["pkg"])
    return sorted((packages[package] for package in found), key=lambda it: (it["name"], it["version"]))


def is_macro(package: dict) -> bool:
    """Whether the package is a procedural macro and nothing else."""
    kinds = {kind for target in package["targets"] for kind in target["kind"]}
    return "proc-macro" in kinds


def is_own(package: dict) -> bool:
    """Whether the package is part of this repository."""
    return package["source"] is None
