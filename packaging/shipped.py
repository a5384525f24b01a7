"""The crates that are linked into the command, or into the package for Python, from `cargo metadata`."""

import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# What is shipped: the folder of its lock file, and its crate.
PRODUCTS = {"command": (ROOT, "interplay"), "python": (ROOT / "python", "interplay-python")}


def product() -> str:
    """What the first argument of a script names; without any, the command."""
    word = sys.argv[1] if len(sys.argv) > 1 else "command"
    if word not in PRODUCTS:
        sys.exit(f"{word}: choose from {', '.join(PRODUCTS)}")
    return word


def said(*command: str) -> str:
    """What a command prints."""
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout


def shipped(of: str) -> list[dict]:
    """Packages of the tree of a product, sorted by name and version; `links` of each are the indices of what it depends on.

    Only dependencies that are linked count: none of build scripts and tests, and no procedural macros, whose code runs
    in the compiler. The platform is that of this machine.
    """
    target = next(line.removeprefix("host: ") for line in said("rustc", "-vV").splitlines() if line.startswith("host: "))
    folder, name = PRODUCTS[of]
    manifest = f"--manifest-path={folder / 'Cargo.toml'}"
    asked = ("cargo", "metadata", "--format-version=1", "--locked", manifest, "--filter-platform", target)
    metadata = json.loads(said(*asked))
    packages = {package["id"]: package for package in metadata["packages"]}
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    root = next(package["id"] for package in metadata["packages"] if package["name"] == name)
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
